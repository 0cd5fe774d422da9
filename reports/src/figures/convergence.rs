//! Error against spacing, with the slopes that theory promises.

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Anchor, Canvas, GREY};
use super::grid::{Content, multiples};
use super::style::{find, styles};
use super::{Figure, PAGE, chosen, continued, paged};
use crate::order::ROUNDING;
use crate::quantity::label;
use crate::select::{Run, Series, labels, series};

/// One figure (or more pages) per error: L2, energy, pressure.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let mut out = Vec::new();
    for quantity in ["l2", "energy", "pressure"] {
        let mut panels = Vec::new();
        for (title, group) in chosen(runs) {
            let lines = lines(group, quantity);
            if !lines.is_empty() {
                panels.push((title, lines));
            }
        }
        for (page, panels) in panels.chunks(PAGE).enumerate() {
            out.push(figure(quantity, page, panels));
        }
    }
    out
}

/// A series as `(label, meshfree, points, theoretical order)`.
type Line = (String, bool, Vec<(f64, f64)>, Option<f64>);

fn lines(runs: &[Run], quantity: &str) -> Vec<Line> {
    let all: Vec<Series> = series(runs);
    labels(all.iter().map(|s| s.is()))
        .into_iter()
        .zip(&all)
        .map(|(label, s)| {
            let points: Vec<_> = s.points(quantity).into_iter().filter(|(_, e)| *e > ROUNDING).collect();
            (label, !s.is().family.is_elements(), points, s.theory(quantity))
        })
        .filter(|(_, _, points, _)| points.len() > 1)
        .collect()
}

fn figure(quantity: &str, page: usize, panels: &[(String, Vec<Line>)]) -> Figure {
    let all: Vec<(String, bool)> =
        panels.iter().flat_map(|p| p.1.iter().map(|l| (l.0.clone(), l.1))).collect();
    let styles = styles(&all);
    let contents = panels
        .iter()
        .enumerate()
        .map(|(i, (title, lines))| {
            let points = || lines.iter().flat_map(|l| l.2.iter());
            let y = Axis::log(&label(quantity), points().map(|p| p.1));
            let styles = &styles;
            Content {
                title: title.clone(),
                x: Axis::log("node spacing h [mm]", points().map(|p| p.0 * 1e3)),
                y: if i % 2 == 0 { y } else { y.without_label() },
                plot: Box::new(move |canvas, panel| {
                    slopes(canvas, panel, lines);
                    for (label, _, points, _) in lines {
                        if let Some(style) = find(styles, label) {
                            let at: Vec<_> = points.iter().map(|p| panel.at(p.0 * 1e3, p.1)).collect();
                            style.curve(canvas, &at);
                        }
                    }
                }),
            }
        })
        .collect();
    let note = "Grey: slopes promised by theory. Errors at rounding level are not drawn.";
    Figure {
        name: paged(&format!("convergence-{quantity}"), page),
        title: continued(
            &format!("Convergence of the {}", label(quantity).trim_end_matches(" [1]")),
            page,
        ),
        caption: "Error against node spacing on logarithmic axes; the grey fan has the slopes theory promises for the methods in the panel".into(),
        canvas: multiples(contents, &styles, note),
    }
}

/// A fan of theoretical slopes in the lower right corner, which converging data leave free.
fn slopes(canvas: &mut Canvas, panel: &Panel, lines: &[Line]) {
    let mut orders: Vec<f64> = lines.iter().filter_map(|l| l.3).collect();
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
        // Labels at least a line apart.
        lowest = top.1.min(lowest - TEXT);
        canvas.text((top.0 + 3.0, lowest), &format!("{order}"), TEXT, GREY, Anchor::Start);
    }
    if !orders.is_empty() {
        canvas.line(&[base, panel.at(right, foot)], GREY, 0.5);
    }
}
