//! Run time against error: what the project is about.

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Anchor, Canvas, GREY};
use super::grid::{Content, multiples};
use super::style::{find, styles};
use super::{Figure, PAGE, chosen, error_label, paged};
use crate::order::ROUNDING;
use crate::select::{Run, labels, series};

/// A series as `(label, meshfree, (seconds, error) pairs)`.
type Line = (String, bool, Vec<(f64, f64)>);

/// One panel per case: relative L2 error where there is one, RMS elsewhere.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let mut panels = Vec::new();
    for (title, group) in chosen(runs) {
        let quantity = ["l2", "rms"].into_iter().find(|q| !lines(group, q).is_empty());
        if let Some(quantity) = quantity {
            panels.push((title, quantity, lines(group, quantity)));
        }
    }
    panels.chunks(PAGE).enumerate().map(|(page, panels)| figure(page, panels)).collect()
}

fn lines(runs: &[Run], quantity: &str) -> Vec<Line> {
    let all = series(runs);
    let named: Vec<_> = all.iter().map(|s| (s.name, s.is())).collect();
    let scale = if quantity == "rms" { 1e3 } else { 1.0 };
    labels(&named)
        .into_iter()
        .zip(&all)
        .map(|(label, s)| {
            let point = |r: &Run| Some((r.total().filter(|t| *t > 0.0)?, r.value(quantity)?));
            let points = s.runs.iter().filter_map(point).filter(|p| p.1 > ROUNDING);
            (label, s.is().family != "fem", points.map(|p| (p.0, p.1 * scale)).collect())
        })
        .filter(|line: &Line| !line.2.is_empty())
        .collect()
}

fn figure(page: usize, panels: &[(String, &'static str, Vec<Line>)]) -> Figure {
    let all: Vec<(String, bool)> =
        panels.iter().flat_map(|p| p.2.iter().map(|l| (l.0.clone(), l.1))).collect();
    let styles = styles(&all);
    let contents = panels
        .iter()
        .map(|(title, quantity, lines)| {
            let points = || lines.iter().flat_map(|l| l.2.iter());
            let styles = &styles;
            Content {
                title: title.clone(),
                x: Axis::log("run time, median [s]", points().map(|p| p.0)),
                y: Axis::log(error_label(quantity), points().map(|p| p.1)),
                plot: Box::new(move |canvas, panel| {
                    front(canvas, panel, lines);
                    if *quantity == "l2" && (panel.y.low()..panel.y.high()).contains(&0.01) {
                        let (left, right) = (panel.at(panel.x.low(), 0.01), panel.at(panel.x.high(), 0.01));
                        canvas.dashed(&[left, right], GREY, 0.7, &[3.0, 2.0]);
                        canvas.text((right.0 - 1.0, right.1 - 6.0), "1 %", TEXT, GREY, Anchor::End);
                    }
                    for (label, _, points) in lines {
                        if let Some(style) = find(styles, label) {
                            let at: Vec<_> = points.iter().map(|p| panel.at(p.0, p.1)).collect();
                            style.curve(canvas, &at);
                        }
                    }
                }),
            }
        })
        .collect();
    Figure {
        name: paged("efficiency", page),
        title: "Run time against error".into(),
        caption: "Median run time of all phases against error, each line one method from coarse to fine; \
                  the grey staircase is the Pareto front: no run is both faster and more accurate"
            .into(),
        canvas: multiples(contents, &styles, "Grey staircase: Pareto front. Down and to the left is better."),
    }
}

/// The runs that no other beats in both time and error, by rising time.
pub(crate) fn pareto(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut sorted: Vec<(f64, f64)> = points.collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for point in sorted {
        if front.last().is_none_or(|last| point.1 < last.1) {
            front.push(point);
        }
    }
    front
}

fn front(canvas: &mut Canvas, panel: &Panel, lines: &[Line]) {
    let front = pareto(lines.iter().flat_map(|l| l.2.iter().copied()));
    let (Some(first), Some(last)) = (front.first(), front.last()) else { return };
    let mut path = vec![panel.at(first.0, panel.y.high())];
    for (i, point) in front.iter().enumerate() {
        if i > 0 {
            path.push(panel.at(point.0, front[i - 1].1));
        }
        path.push(panel.at(point.0, point.1));
    }
    path.push(panel.at(panel.x.high(), last.1));
    canvas.line(&path, [0xb8, 0xb8, 0xb8], 3.0);
}

#[cfg(test)]
mod tests {
    use super::pareto;

    #[test]
    fn the_front_drops_what_another_run_beats() {
        let runs = [(3.0, 0.1), (1.0, 0.5), (2.0, 0.6), (2.5, 0.2), (4.0, 0.1)];
        assert_eq!(pareto(runs.into_iter()), [(1.0, 0.5), (2.5, 0.2), (3.0, 0.1)]);
    }
}
