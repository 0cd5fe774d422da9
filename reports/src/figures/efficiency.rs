//! Run time against error: what the project is about.

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Canvas, GREY};
use super::grid::{Content, scattered};
use super::style::{Style, find, styles};
use super::{Figure, PAGE, chosen, continued, paged};
use crate::fronts::{Clock, DEADLINES, Deadline, FLOOR, QUESTIONS, Question, pareto, point};
use crate::quantity::label;
use crate::select::{Run, Series, kernels, labels, series};
use crate::text::list;

/// A series as `(label, meshfree, (seconds, error) pairs)`.
type Cluster = (String, bool, Vec<(f64, f64)>);

/// Ends the title of a panel that compares kernels.
const KERNELS: &str = ": kernels";

/// The error of the dashed line.
const PERCENT: f64 = 0.01;

/// What a panel shows.
struct Paned {
    title: String,
    error: &'static str,
    clusters: Vec<Cluster>,
    /// The method that the others are compared with: having no error, it has no place on the axes.
    reference: Option<String>,
}

/// For each kind of time a figure per question, with a panel per case that answers it. A method looks the same in all of them.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let asked = Clock::ALL.into_iter().flat_map(|clock| QUESTIONS.iter().map(move |q| (clock, q)));
    let answered: Vec<_> = asked.map(|(clock, q)| (clock, q, panels(runs, q, clock))).collect();
    let clusters = answered.iter().flat_map(|(_, _, panels)| panels).flat_map(|p| &p.clusters);
    let styles = styles(&clusters.map(|c| (c.0.clone(), c.1)).collect::<Vec<_>>());
    let pages = answered.iter().flat_map(|(clock, question, panels)| {
        let pages = panels.chunks(PAGE).enumerate();
        pages.map(move |(page, panels)| (*clock, *question, page, panels))
    });
    pages.map(|(clock, question, page, panels)| figure(question, clock, page, panels, &styles)).collect()
}

/// Where many kernels are compared, a panel of their own, once: for the displacement of a first solve.
fn panels(runs: &[Run], question: &Question, clock: Clock) -> Vec<Paned> {
    let (mut panels, mut compared) = (Vec::new(), Vec::new());
    for (title, group) in chosen(runs) {
        let Some(error) = question.error(group) else { continue };
        let (usual, every) = kernels(&series(group));
        let names = labels(usual.iter().map(|s| s.is()));
        let reference = group.iter().find(|r| r.is_reference());
        let reference = reference.map(|r| format!("{} with {} nodes", r.name(), r.is.nodes));
        let drawn = clusters(&usual, &names, error, clock);
        panels.push(Paned { title: title.clone(), error, clusters: drawn, reference });
        if clock == Clock::First && question.ending.is_empty() {
            let names: Vec<String> = every.iter().map(|s| s.is().variant.clone()).collect();
            let clusters = clusters(&every, &names, error, clock);
            compared.push(Paned { title: format!("{title}{KERNELS}"), error, clusters, reference: None });
        }
    }
    panels.extend(compared);
    // One run alone is neither faster nor better than another.
    panels.retain(|p| p.clusters.iter().map(|c| c.2.len()).sum::<usize>() > 1);
    panels
}

fn clusters(all: &[Series], names: &[String], error: &str, clock: Clock) -> Vec<Cluster> {
    let cluster = |(label, s): (&String, &Series)| {
        let points = s.runs.iter().filter_map(|run| point(run, error, clock));
        (label.clone(), !s.is().family.is_elements(), points.map(|(t, e)| (t, e.max(FLOOR))).collect())
    };
    names.iter().zip(all).map(cluster).filter(|c: &Cluster| !c.2.is_empty()).collect()
}

fn figure(question: &Question, clock: Clock, page: usize, panels: &[Paned], styles: &[Style]) -> Figure {
    let own = |s: &&Style| panels.iter().any(|p| p.clusters.iter().any(|c| c.0 == s.label));
    let styles: Vec<Style> = styles.iter().filter(own).cloned().collect();
    let contents = panels.iter().map(|panel| content(panel, clock, &styles)).collect();
    let (name, title, time) = match clock {
        Clock::First => ("efficiency", "Run time against error", "Median run time of all phases"),
        Clock::Repeated => (
            "efficiency-repeated",
            "Time of a repeated solve against error",
            "Time that 99 of 100 solves of a loop prepared once take at most (of fewer solves the slowest), each for the displacement of \
             all nodes,",
        ),
    };
    Figure {
        name: paged(&format!("{name}{}", question.ending), page),
        title: continued(&format!("{title}: {}", question.name), page),
        caption: format!(
            "{time} against the relative error of the {}, a marker for each run; the grey staircase is the Pareto front: no run \
             drawn is both faster and more accurate",
            question.name
        ),
        canvas: scattered(contents, &styles, &note(question, clock, panels)),
    }
}

fn y_axis(panel: &Paned) -> Axis {
    let errors = panel.clusters.iter().flat_map(|c| c.2.iter().map(|p| p.1));
    Axis::log(&label(panel.error), decade(errors.collect()).into_iter())
}

/// Whether the axis reaches an error of 1 %.
fn shows_percent(y: &Axis) -> bool {
    (y.low()..y.high()).contains(&PERCENT)
}

fn content<'a>(panel: &'a Paned, clock: Clock, styles: &'a [Style]) -> Content<'a> {
    let Paned { title, clusters, .. } = panel;
    let points = || clusters.iter().flat_map(|c| c.2.iter().copied());
    let (scale, x) = match clock {
        Clock::First => (1.0, Axis::log("run time, median [s]", points().map(|p| p.0))),
        Clock::Repeated => {
            let near = near(&panel.clusters).into_iter().map(|d| d.seconds);
            let times = points().map(|p| 1e3 * p.0).chain(near.map(|t| 1e3 * t));
            (1e3, Axis::log("repeated solve, 99 % within [ms]", times))
        }
    };
    Content {
        title: title.clone(),
        x,
        y: y_axis(panel),
        plot: Box::new(move |canvas, panel| {
            let at = |p: &(f64, f64)| panel.at(scale * p.0, p.1);
            let best = pareto(clusters.iter().flat_map(|c| c.2.iter().copied()), |p| *p);
            front(canvas, panel, &best.iter().map(at).collect::<Vec<_>>());
            if shows_percent(&panel.y) {
                let ends = [panel.x.low(), panel.x.high()].map(|x| panel.at(x, PERCENT));
                canvas.dashed(&ends, GREY, 0.7, &[3.0, 2.0]);
            }
            if clock == Clock::Repeated {
                deadlines(canvas, panel, scale, &near(clusters));
            }
            for (label, _, points) in clusters {
                if let Some(style) = find(styles, label) {
                    points.iter().for_each(|p| style.mark(canvas, at(p)));
                }
            }
        }),
    }
}

/// Times by which a line may lie beyond the runs: one decade, or it would squeeze them into a corner.
const REACH: f64 = 10.0;

/// The least and the largest time of a panel.
fn range(clusters: &[Cluster]) -> (f64, f64) {
    let times = clusters.iter().flat_map(|c| c.2.iter().map(|p| p.0));
    times.fold((f64::INFINITY, 0.0), |(low, high), t| (t.min(low), t.max(high)))
}

/// The deadlines among the runs of a panel or near them.
fn near(clusters: &[Cluster]) -> Vec<Deadline> {
    let (low, high) = range(clusters);
    DEADLINES.into_iter().filter(|d| (low / REACH..=high * REACH).contains(&d.seconds)).collect()
}

/// What is said of the deadlines that are not drawn, with the panels: of all that every run keeps, the hardest; of all that none
/// keeps, the easiest.
fn beyond(panels: &[Paned]) -> Vec<String> {
    let mut said: Vec<(String, Vec<String>)> = Vec::new();
    for panel in panels {
        let (low, high) = range(&panel.clusters);
        let kept = DEADLINES.iter().find(|d| d.seconds > high * REACH).map(|d| ("faster", d));
        let missed = DEADLINES.iter().rev().find(|d| d.seconds < low / REACH).map(|d| ("slower", d));
        for (word, deadline) in kept.into_iter().chain(missed) {
            let text = format!("all {word} than {}", deadline.name);
            match said.iter_mut().find(|(other, _)| *other == text) {
                Some((_, titles)) => titles.push(panel.title.clone()),
                None => said.push((text, vec![panel.title.clone()])),
            }
        }
    }
    let place = |titles: &[String]| match titles.len() == panels.len() {
        true => String::new(),
        false => format!(" ({})", titles.join("; ")),
    };
    said.into_iter().map(|(text, titles)| text + &place(&titles)).collect()
}

/// Errors with as many around them as make a decade: closer ones would need digits that have no room beside an axis.
fn decade(mut errors: Vec<f64>) -> Vec<f64> {
    let low = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let high = errors.iter().copied().fold(0.0, f64::max);
    if high < 10.0 * low {
        let middle = (low * high).sqrt();
        errors.extend([middle / 10f64.sqrt(), middle * 10f64.sqrt()]);
    }
    errors
}

fn note(question: &Question, clock: Clock, panels: &[Paned]) -> String {
    let mut note = "Grey staircase: Pareto front. Down and to the left is better.".to_string();
    if panels.iter().any(|panel| shows_percent(&y_axis(panel))) {
        note += " Dashed: an error of 1 %.";
    }
    if clock == Clock::Repeated {
        let drawn = |d: &&Deadline| panels.iter().any(|p| near(&p.clusters).iter().any(|n| n.name == d.name));
        let drawn = DEADLINES.iter().filter(drawn).map(|d| format!("{} ({})", d.name, d.what));
        let drawn: Vec<String> = drawn.collect();
        if !drawn.is_empty() {
            note += &format!(" Vertical lines: the periods of {}.", list(&drawn));
        }
        let beyond = beyond(panels);
        if !beyond.is_empty() {
            note += &format!(" Not drawn, more than a decade away: {}.", list(&beyond));
        }
    }
    if question.scalar {
        note += " A single number can be right by chance, where its errors cancel.";
    }
    let several = panels.len() > 1;
    let place = |p: &Paned| if several { format!(" ({})", p.title) } else { String::new() };
    let references: Vec<String> =
        panels.iter().filter_map(|p| Some(format!("{}{}", p.reference.as_ref()?, place(p)))).collect();
    if !references.is_empty() {
        note += &format!(" The reference has no error and is not drawn: {}.", list(&references));
    }
    let low = |p: &&Paned| p.clusters.iter().any(|c| c.2.iter().any(|at| at.1 <= FLOOR));
    let floored: Vec<String> = panels.iter().filter(low).map(|p| p.title.clone()).collect();
    if !floored.is_empty() {
        note += &format!(" Errors below 10⁻⁶ are drawn at 10⁻⁶ ({}).", list(&floored));
    }
    if panels.iter().any(|p| p.title.ends_with(KERNELS)) {
        note += " Kernels: a marker for each size and rule of integration.";
    }
    note
}

/// Vertical lines where a frame must be done.
fn deadlines(canvas: &mut Canvas, panel: &Panel, scale: f64, drawn: &[Deadline]) {
    let (_, top, _, bottom) = panel.frame;
    for deadline in drawn {
        let (x, _) = panel.at(scale * deadline.seconds, panel.y.low());
        canvas.dashed(&[(x, top), (x, bottom)], GREY, 0.7, &[3.0, 2.0]);
        // Along its line: beside it there is no room where that is near an end of the axis.
        canvas.vertical((x + 6.0, bottom - 18.0), deadline.name, TEXT);
    }
}

/// Along the best runs, on paper: from the first time an error is reached to the next smaller one, and on.
fn front(canvas: &mut Canvas, panel: &Panel, best: &[(f64, f64)]) {
    let (Some(first), Some(last)) = (best.first(), best.last()) else { return };
    let (_, top, right, _) = panel.frame;
    let mut path = vec![(first.0, top), *first];
    for pair in best.windows(2) {
        path.extend([(pair[1].0, pair[0].1), pair[1]]);
    }
    path.push((right, last.1));
    canvas.line(&path, [0xb8, 0xb8, 0xb8], 3.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::run;
    use crate::record::Family;
    use crate::select::runs;

    #[test]
    fn a_line_far_from_all_runs_is_not_drawn_but_said() {
        let panel = |title: &str, times: &[f64]| {
            let points = times.iter().map(|&t| (t, 0.1)).collect();
            Paned {
                title: title.into(),
                error: "l2",
                clusters: vec![("tet4".into(), false, points)],
                reference: None,
            }
        };
        let drawn = |p: &Paned| near(&p.clusters).iter().map(|d| d.name).collect::<Vec<_>>();
        let (quick, mixed) = (panel("quick", &[1e-5, 9e-5]), panel("mixed", &[2e-4, 0.02]));
        let (slow, mean) = (panel("slow", &[0.5, 2.0]), panel("mean", &[0.02, 0.05]));
        assert_eq!(drawn(&quick), [""; 0]);
        assert_eq!(
            (drawn(&mixed), drawn(&slow), drawn(&mean)),
            (vec!["1 kHz", "30 Hz"], vec![], vec!["30 Hz"])
        );
        assert_eq!(beyond(&[panel("quick", &[1e-5, 9e-5])]), ["all faster than 1 kHz"]);
        assert_eq!(
            beyond(&[quick, mixed, slow, mean]),
            ["all faster than 1 kHz (quick)", "all slower than 30 Hz (slow)", "all slower than 1 kHz (mean)"]
        );
    }

    #[test]
    fn the_note_names_the_reference() {
        let of = |name, family, error| run((name, family), 100, 1.0, &[("relative-rms", error)]);
        let (elements, clouds) = (Family::Fem, Family::Efg);
        let mut records = [of("tet4", elements, 0.2), of("efg", clouds, 0.1)].concat();
        let noted = |records: &[_]| {
            let runs = runs(records);
            let panels = panels(&runs, &QUESTIONS[0], Clock::First);
            assert_eq!(panels[0].clusters.len(), 2);
            note(&QUESTIONS[0], Clock::First, &panels)
        };
        assert!(!noted(&records).contains("reference"));
        records.extend(of("tet10", elements, 0.0));
        let note = noted(&records);
        assert!(
            note.ends_with(" The reference has no error and is not drawn: tet10 with 100 nodes."),
            "{note}"
        );
    }
}
