//! Uncertainty by the inputs of a scene: bands of histories, and the shares of the inputs.

use catalogue::metric;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::cell::csv_line;
use records::store::slug;

use super::drawing::{BLACK_INK, Drawing, GREY, LINE, TEXT, bold, noted, text, widest, wrapped};
use super::figure::{Data, Figure};
use super::grid::{Content, WIDTH, multiples};
use super::style::styles;
use crate::plot::{self, Curve, Plot, Scale};
use crate::quantity;
use crate::uncertain::Uncertain;

/// Grey of a band, light enough for the median on it.
const BAND: RGBColor = RGBColor(0xd6, 0xd6, 0xd6);
/// Colours of the share of an input alone and with its interactions.
const ALONE: RGBColor = RGBColor(0x1f, 0x6f, 0xa8);
const TOGETHER: RGBColor = RGBColor(0xa4, 0xcc, 0xe3);
const ROW: i32 = 230;
const TOP: i32 = 420;
/// Room for the number after the longest bar.
const NUMBER: i32 = 900;

/// Figures of the median with the band of 90 % of the results along the history.
pub(super) fn bands(all: &[Uncertain]) -> Vec<Figure> {
    all.iter().filter(|of| of.band.len() > 1).map(band).collect()
}

fn band(of: &Uncertain) -> Figure {
    let x = metric::find(&of.of.along).unwrap_or(metric::TIME.whole());
    let y = metric::find(&of.output.name).unwrap_or(metric::TOOL_FORCE.whole());
    let (across, up) = (quantity::scale(x), quantity::scale(y));
    let points = of.band.iter().map(|(at, q)| (at * across, q[1] * up)).collect();
    let curve = Curve {
        band: of.band.iter().map(|(at, q)| (at * across, q[0] * up, q[2] * up)).collect(),
        ..Curve::new(of.of.method.clone(), of.of.family, points, Vec::new())
    };
    let plots = vec![Plot {
        title: of.of.case.clone(),
        case: of.of.case.clone(),
        x: Scale::linear(&x.label(), quantity::unit(x)),
        y: Scale::linear(&y.label(), quantity::unit(y)),
        curves: vec![curve],
    }];
    let styles = styles(&plot::labels(&plots));
    let content = |plot| {
        Content::of(plot, &styles).over(move |chart| {
            let low = plot.curves.iter().flat_map(|curve| curve.band.iter().map(|b| (b.0, b.1)));
            let high = plot.curves.iter().flat_map(|curve| curve.band.iter().rev().map(|b| (b.0, b.2)));
            chart.draw_series([Polygon::new(low.chain(high).collect::<Vec<_>>(), BAND)])?;
            Ok(())
        })
    };
    let note = "Line: median. Grey band: 5 to 95 % of the results of the uncertain inputs.";
    let drawing = multiples(plots.iter().map(content).collect(), &styles, note);
    Figure {
        name: format!("uncertainty-{}", name(of)),
        title: format!("Uncertainty of the {}, {}", y.label(), of.of.case),
        caption: format!(
            "Median, and the band from 5 to 95 % of the results, over {} samples of the uncertain inputs",
            of.results
        ),
        drawing,
        data: Data::Plots(plots),
    }
}

fn name(of: &Uncertain) -> String {
    format!("{}-{}-{}", slug(&of.of.case), slug(&of.of.method), slug(&of.output.name))
}

/// Figures of the shares of the inputs in the variance.
pub(super) fn shares(all: &[Uncertain]) -> Vec<Figure> {
    let shared = |of: &&Uncertain| of.statistics.as_ref().is_some_and(|s| !s.indices.is_empty());
    all.iter().filter(shared).map(share).collect()
}

fn share(of: &Uncertain) -> Figure {
    Figure {
        name: format!("sobol-indices-{}", name(of)),
        title: format!("Shares of the inputs in the variance of the {}, {}", of.output.name, of.of.case),
        caption: "Shares of the uncertain inputs in the variance (Sobol indices): alone, and with their interactions, \
                  with intervals of 95 %"
            .into(),
        drawing: draw(of),
        data: Data::Rows(csv(of)),
    }
}

fn csv(of: &Uncertain) -> String {
    let head = ["input", "first", "first low", "first high", "total", "total low", "total high"];
    let mut out = csv_line(&head);
    let indices = of.statistics.iter().flat_map(|s| &s.indices);
    for (input, index) in of.of.inputs.iter().zip(indices) {
        let numbers = [index.first, index.total].map(|e| [e.value, e.low, e.high]).concat();
        let numbers: Vec<String> = numbers.iter().map(|v| format!("{v:e}")).collect();
        let cells = std::iter::once(input.key.as_str()).chain(numbers.iter().map(String::as_str));
        out.push_str(&csv_line(&cells.collect::<Vec<_>>()));
    }
    out
}

fn draw(of: &Uncertain) -> Drawing {
    let inputs = &of.of.inputs;
    let left = 120 + widest(inputs.iter().map(|input| &input.key)).min(2400);
    let scale = f64::from(WIDTH - left - NUMBER);
    let bottom = TOP + ROW * inputs.len() as i32;
    let notes = wrapped(
        "Dark: the input alone. Light: with its interactions. Lines: intervals of 95 %. Shares of the variance in per cent.",
        WIDTH - 240,
    );
    let height = bottom + 160 + LINE * notes.len() as i32;
    Drawing::new(WIDTH, height, |page| {
        let title = format!("{}, {}: {}", of.of.case, of.of.method, of.label());
        page.draw_text(&title, &bold(TEXT, HPos::Left), (60, 120))?;
        page.draw(&PathElement::new([(left, TOP - 40), (left, bottom)], GREY.stroke_width(8)))?;
        let indices = of.statistics.iter().flat_map(|s| &s.indices);
        for ((input, index), y) in inputs.iter().zip(indices).zip((TOP..).step_by(ROW as usize)) {
            page.draw_text(&input.key, &text(TEXT, HPos::Right), (left - 60, y + ROW / 2 - 15))?;
            let mut end = left;
            for (estimate, colour, top) in [(index.first, ALONE, y), (index.total, TOGETHER, y + 90)] {
                let at = |share: f64| left + (share * scale) as i32;
                page.draw(&Rectangle::new([(left, top), (at(estimate.value), top + 80)], colour.filled()))?;
                let whisker = [(at(estimate.low), top + 40), (at(estimate.high), top + 40)];
                page.draw(&PathElement::new(whisker, BLACK_INK.stroke_width(10)))?;
                end = end.max(at(estimate.high));
            }
            let number = format!("{:.1}, {:.1}", 100.0 * index.first.value, 100.0 * index.total.value);
            page.draw_text(&number, &text(TEXT, HPos::Left), (end + 40, y + ROW / 2 - 15))?;
        }
        let (_, foot) = page.split_vertically(bottom + 80);
        noted(&foot.margin(0, 0, 120, 120), &notes)
    })
}
