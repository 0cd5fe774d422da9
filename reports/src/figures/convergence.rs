//! Error as a function of spacing, with the theoretical slopes.

use catalogue::metric::{self, Metric};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::axes::Chart;
use super::drawing::{Drawn, GREY, TEXT, text};
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::styles;
use crate::order::ROUNDING;
use crate::plot::{self, Curve, Plot, Scale};
use crate::select::{Run, Series, chosen, labels, series};

/// Figures of each error (L2, energy, pressure), on one or more pages.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let mut out = Vec::new();
    for error in [&metric::L2, &metric::ENERGY, &metric::PRESSURE] {
        let mut panels = Vec::new();
        for (title, group) in chosen(runs) {
            let lines = lines(group, error);
            if !lines.is_empty() {
                panels.push((title, group[0].is.case.clone(), lines));
            }
        }
        for (page, panels) in panels.chunks(PAGE).enumerate() {
            out.push(figure(error, page, panels));
        }
    }
    out
}

/// A series with its theoretical order.
type Line = (Curve, Option<f64>);

fn lines(runs: &[Run], error: &'static Metric) -> Vec<Line> {
    let all: Vec<Series> = series(runs);
    labels(all.iter().map(|s| s.is()))
        .into_iter()
        .zip(&all)
        .map(|(label, s)| {
            let usable = |run: &Run| {
                let (h, e) = (run.is.spacing, run.value(error).filter(|e| *e > ROUNDING)?);
                (h > 0.0).then(|| ((h * 1e3, e), run.is.run.clone()))
            };
            let (points, ids) = s.runs.iter().filter_map(usable).unzip();
            (Curve::new(label, s.is().family, points, ids), s.theory(error))
        })
        .filter(|(curve, _)| curve.points.len() > 1)
        .collect()
}

/// Title, case and series of one panel.
type Paned = (String, String, Vec<Line>);

fn figure(error: &'static Metric, page: usize, panels: &[Paned]) -> Figure {
    let plots: Vec<Plot> = panels.iter().map(|panel| plotted(panel, error)).collect();
    let styles = styles(&plot::labels(&plots));
    let contents = plots.iter().zip(panels).enumerate().map(|(i, (plot, (_, _, lines)))| {
        let content = Content::of(plot, &styles).over(move |chart| slopes(chart, lines));
        let y = if i % 2 == 0 { content.y } else { content.y.without_label() };
        Content { y, ..content }
    });
    let note = "Grey: theoretical slopes. Errors at rounding level are not drawn.";
    Figure {
        name: paged(&format!("convergence-{}", error.name), page),
        title: continued(
            &format!("Convergence of the {}", error.whole().label()),
            page,
        ),
        caption: "Error against node spacing on logarithmic axes; the grey fan shows the theoretical slopes of the \
                  methods in the panel".into(),
        drawing: multiples(contents.collect(), &styles, note),
        data: Data::Plots(plots),
    }
}

fn plotted((title, case, lines): &Paned, error: &'static Metric) -> Plot {
    Plot {
        case: case.clone(),
        title: title.clone(),
        x: Scale::log("node spacing h", "mm"),
        y: Scale::errors(error),
        curves: lines.iter().map(|l| l.0.clone()).collect(),
    }
}

/// Draws a fan of theoretical slopes in the lower right corner, which converging data leave free.
fn slopes(chart: &mut Chart<'_>, lines: &[Line]) -> Drawn {
    let mut orders: Vec<f64> = lines.iter().filter_map(|l| l.1).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    let Some(steepest) = orders.last() else { return Ok(()) };
    let (x, y) = (chart.x_range(), chart.y_range());
    let (span, tall) = ((x.end / x.start).ln(), (y.end / y.start).ln());
    let run = (0.4 * span).min(0.5 * tall / steepest);
    let (right, foot) = (x.end / (0.08 * span).exp(), y.start * (0.06 * tall).exp());
    let base = (right / run.exp(), foot);
    let mut lowest = i32::MAX;
    for order in &orders {
        let top = (right, foot * (run * order).exp());
        chart.draw_series(LineSeries::new([base, top], GREY.stroke_width(10)))?;
        // Labels are at least one line apart.
        let height = chart.backend_coord(&top).1;
        lowest = height.min(lowest - TEXT as i32);
        let label = Text::new(order.to_string(), (30, lowest - height), text(TEXT, HPos::Left).color(&GREY));
        chart.draw_series([EmptyElement::at(top) + label])?;
    }
    chart.draw_series(LineSeries::new([base, (right, foot)], GREY.stroke_width(5)))?;
    Ok(())
}
