//! Error as a function of spacing, with the theoretical slopes.

use catalogue::metric::{self, Metric};

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Anchor, Canvas, GREY};
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::{find, styles};
use crate::order::ROUNDING;
use crate::plot::{self, Curve, Plot, Scale};
use crate::quantity::label;
use crate::select::{Run, Series, chosen, labels, series};

const SPACING: &str = "node spacing h [mm]";

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
    let contents = panels
        .iter()
        .enumerate()
        .map(|(i, (title, _, lines))| {
            let points = || lines.iter().flat_map(|l| l.0.points.iter());
            let y = Axis::log(&label(error), points().map(|p| p.1));
            let styles = &styles;
            Content {
                title: title.clone(),
                x: Axis::log(SPACING, points().map(|p| p.0)),
                y: if i % 2 == 0 { y } else { y.without_label() },
                plot: Box::new(move |canvas, panel| {
                    slopes(canvas, panel, lines);
                    for (curve, _) in lines {
                        if let Some(style) = find(styles, &curve.label) {
                            let at: Vec<_> = curve.points.iter().map(|p| panel.at(p.0, p.1)).collect();
                            style.curve(canvas, &at);
                        }
                    }
                }),
            }
        })
        .collect();
    let note = "Grey: theoretical slopes. Errors at rounding level are not drawn.";
    Figure {
        name: paged(&format!("convergence-{}", error.name), page),
        title: continued(
            &format!("Convergence of the {}", label(error).trim_end_matches(" [1]")),
            page,
        ),
        caption: "Error against node spacing on logarithmic axes; the grey fan shows the theoretical slopes of the \
                  methods in the panel".into(),
        canvas: multiples(contents, &styles, note),
        data: Data::Plots(plots),
    }
}

fn plotted((title, case, lines): &Paned, error: &'static Metric) -> Plot {
    Plot {
        case: case.clone(),
        title: title.clone(),
        x: Scale::log(SPACING),
        y: Scale::log(&label(error)),
        curves: lines.iter().map(|l| l.0.clone()).collect(),
    }
}

/// Draws a fan of theoretical slopes in the lower right corner, which converging data leave free.
fn slopes(canvas: &mut Canvas, panel: &Panel, lines: &[Line]) {
    let mut orders: Vec<f64> = lines.iter().filter_map(|l| l.1).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    let span = (panel.x.high() / panel.x.low()).ln();
    let tall = (panel.y.high() / panel.y.low()).ln();
    let steepest = orders.last().copied().unwrap_or(1.0);
    let run = (0.4 * span).min(0.5 * tall / steepest);
    let right = panel.x.high() / (0.08 * span).exp();
    let (left, foot) = (right / run.exp(), panel.y.low() * (0.06 * tall).exp());
    let base = panel.at(left, foot);
    let mut lowest = f64::MAX;
    for order in &orders {
        let top = panel.at(right, foot * (run * order).exp());
        canvas.line(&[base, top], GREY, 1.0);
        // Labels are at least one line apart.
        lowest = top.1.min(lowest - TEXT);
        canvas.text((top.0 + 3.0, lowest), &format!("{order}"), TEXT, GREY, Anchor::Start);
    }
    if !orders.is_empty() {
        canvas.line(&[base, panel.at(right, foot)], GREY, 0.5);
    }
}
