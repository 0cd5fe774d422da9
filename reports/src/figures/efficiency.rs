//! Run time against error: what the project is about.

use super::axes::{Axis, Panel};
use super::canvas::{Canvas, GREY};
use super::grid::{Content, multiples};
use super::style::{Style, find, styles};
use super::{Figure, PAGE, chosen, continued, error_label, paged};
use crate::select::{Run, Series, kernels, labels, series};
use crate::text::list;

/// A series as `(label, meshfree, (seconds, error) pairs)`.
type Line = (String, bool, Vec<(f64, f64)>);

/// Relative errors below this are drawn at it: what is exact to rounding would squeeze all others into a corner.
pub(super) const FLOOR: f64 = 1e-6;

/// Ends the title of a panel that compares kernels.
const KERNELS: &str = ": kernels";

/// A panel as `(title, error, lines)`.
type Paned = (String, &'static str, Vec<Line>);

/// One panel per case: relative L2 error where there is one, RMS elsewhere; where many kernels are compared, a panel of their own.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let (mut panels, mut compared) = (Vec::new(), Vec::new());
    for (title, group) in chosen(runs) {
        let (usual, every) = kernels(&series(group));
        let names = labels(&usual.iter().map(|s| (s.name, s.is())).collect::<Vec<_>>());
        panels.extend(panel(title.clone(), &usual, &names));
        let names: Vec<String> = every.iter().map(|s| s.is().variant.clone()).collect();
        compared.extend(panel(format!("{title}{KERNELS}"), &every, &names));
    }
    panels.extend(compared);
    let styles =
        styles(&panels.iter().flat_map(|p| p.2.iter().map(|l| (l.0.clone(), l.1))).collect::<Vec<_>>());
    panels.chunks(PAGE).enumerate().map(|(page, panels)| figure(page, panels, &styles)).collect()
}

fn panel(title: String, all: &[Series], names: &[String]) -> Option<Paned> {
    let drawn = ["l2", "rms"].into_iter().map(|q| (q, lines(all, names, q)));
    drawn.into_iter().find(|(_, lines)| !lines.is_empty()).map(|(q, lines)| (title, q, lines))
}

fn lines(all: &[Series], names: &[String], quantity: &str) -> Vec<Line> {
    let scale = if quantity == "rms" { 1e3 } else { 1.0 };
    let least = if quantity == "rms" { 0.0 } else { FLOOR };
    names
        .iter()
        .zip(all)
        .map(|(label, s)| {
            let point = |r: &Run| Some((r.total().filter(|t| *t > 0.0)?, r.value(quantity)?));
            // An error of exactly nothing is the reference itself.
            let points = s.runs.iter().filter_map(point).filter(|p| p.1 > 0.0);
            (label.clone(), s.is().family != "fem", points.map(|p| (p.0, (p.1 * scale).max(least))).collect())
        })
        .filter(|line: &Line| !line.2.is_empty())
        .collect()
}

fn figure(page: usize, panels: &[Paned], styles: &[Style]) -> Figure {
    let own = |s: &&Style| panels.iter().any(|p| p.2.iter().any(|l| l.0 == s.label));
    let styles: Vec<Style> = styles.iter().filter(own).cloned().collect();
    let floored: Vec<String> = panels
        .iter()
        .filter(|p| p.1 == "l2" && p.2.iter().any(|l| l.2.iter().any(|p| p.1 <= FLOOR)))
        .map(|p| p.0.clone())
        .collect();
    let mut note =
        "Grey staircase: Pareto front. Dashed: an error of 1 %. Down and to the left is better.".to_string();
    if !floored.is_empty() {
        note += &format!(" Errors below 10⁻⁶ are drawn at 10⁻⁶ ({}).", list(&floored));
    }
    if panels.iter().any(|p| p.0.ends_with(KERNELS)) {
        note += " Kernels: a line for each rule of integration.";
    }
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
        title: continued("Run time against error", page),
        caption: "Median run time of all phases against error, each line one method from coarse to fine; \
                  the grey staircase is the Pareto front: no run drawn is both faster and more accurate"
            .into(),
        canvas: multiples(contents, &styles, &note),
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
