//! Run time against error, the main result of a benchmark.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::text::list;

use super::axes::{Axis, Chart};
use super::backend::Attributed;
use super::drawing::{Drawn, GREY, TEXT, text};
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::{Style, find, styles};
use crate::fronts::{Clock, DEADLINES, Deadline, FLOOR, FRONT, Question, pareto};
use crate::plot::{self, Curve, Plot, Scale};
use crate::questions::{Ask, Line, Timed, asks};
use crate::seconds::Seconds;
use crate::select::Run;

/// Error of the dashed line.
const PERCENT: f64 = 0.01;

/// Figures for each kind of time and each question, with a panel for each case that answers the question.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let asks = asks(runs);
    let same = asks.chunk_by(|a, b| (a.clock, a.question.ending) == (b.clock, b.question.ending));
    let pages = same.flat_map(|of| of.chunks(PAGE).enumerate());
    pages.map(|(page, panels)| figure(panels[0].question, panels[0].clock, page, panels)).collect()
}

fn figure(question: &Question, clock: Clock, page: usize, panels: &[Ask]) -> Figure {
    let plots: Vec<Plot> = panels.iter().map(plotted).collect();
    let styles = styles(&plot::labels(&plots));
    let contents = panels.iter().map(|panel| content(panel, clock, &styles)).collect();
    let (name, title, time) = match clock {
        Clock::First => ("efficiency", "Run time against error", "Run time of all phases"),
        Clock::Repeated => (
            "efficiency-repeated",
            "Time of a repeated solve against error",
            "99th percentile of the time of a solve in a loop that is prepared once (the slowest of fewer than 100 \
             solves), each for the displacement of all nodes,",
        ),
    };
    Figure {
        name: paged(&format!("{name}{}", question.ending), page),
        title: continued(&format!("{title}: {}", question.name), page),
        caption: format!(
            "{time} against the relative error of the {}, with one line per method through its sizes; the grey \
             staircase is the Pareto front of three or more runs: no run in the panel is both faster and more accurate",
            question.name
        ),
        drawing: multiples(contents, &styles, &note(question, clock, panels)),
        data: Data::Fronts(plots),
    }
}

/// Data of a panel, with times in seconds.
fn plotted(ask: &Ask) -> Plot {
    let curve = |line: &Line| {
        let points = line.runs.iter().map(|r| (r.seconds, r.error)).collect();
        let ids = line.runs.iter().map(|r| r.run.clone()).collect();
        Curve::new(line.label.clone(), line.family, points, ids)
    };
    Plot {
        case: ask.case.clone(),
        title: format!("{}: {}", ask.title, ask.question.name),
        x: ask.time(),
        y: Scale::errors(ask.error),
        curves: ask.lines.iter().map(curve).collect(),
    }
}

/// Runs of all lines.
fn all(lines: &[Line]) -> impl Iterator<Item = &Timed> {
    lines.iter().flat_map(|line| &line.runs)
}

fn has_front(lines: &[Line]) -> bool {
    all(lines).count() >= FRONT
}

fn y_axis(panel: &Ask) -> Axis {
    let errors = all(&panel.lines).map(|r| r.error.max(FLOOR));
    Axis::of(&Scale::errors(panel.error), decade(errors.collect()).into_iter())
}

fn content<'a>(panel: &'a Ask, clock: Clock, styles: &'a [Style]) -> Content<'a> {
    let (title, lines, kernels) = (&panel.title, &panel.lines, panel.kernels);
    let (scale, x) = match clock {
        Clock::First => (1.0, Axis::of(&panel.time(), all(lines).map(|r| r.seconds))),
        Clock::Repeated => {
            let near = near(&panel.lines).into_iter().map(|d| d.seconds);
            let times = all(lines).map(|r| 1e3 * r.seconds).chain(near.map(|t| 1e3 * t));
            (1e3, Axis::log("repeated solve, 99 % within [ms]", times))
        }
    };
    Content {
        title: title.clone(),
        x,
        y: y_axis(panel),
        series: Box::new(move |chart| {
            let at = |r: &Timed| (scale * r.seconds, r.error.max(FLOOR));
            let counted = |r: &Timed| (scale * r.seconds, r.counts.max(FLOOR));
            let best = pareto(all(lines).filter(|_| has_front(lines)), |r| (r.seconds, r.counts.max(FLOOR)));
            front(chart, &best.iter().map(|r| counted(r)).collect::<Vec<_>>())?;
            let (x, y) = (chart.x_range(), chart.y_range());
            if y.contains(&PERCENT) {
                chart.draw_series([helper(vec![(x.start, PERCENT), (x.end, PERCENT)])])?;
            }
            if clock == Clock::Repeated {
                deadlines(chart, scale, lines)?;
            }
            for line in lines {
                let Some(style) = find(styles, &line.label) else { continue };
                for run in line.runs.iter().filter(|r| r.counts > r.error) {
                    let thin = style.look.colour.stroke_width(6);
                    chart.draw_series(LineSeries::new([at(run), counted(run)], thin))?;
                }
                let points: Vec<_> = line.runs.iter().map(at).collect();
                // A kernel with several integration rules has no line.
                match kernels {
                    true => style.marks(chart, points.into_iter())?,
                    false => style.curve(chart, &points, 1)?,
                }
            }
            Ok(())
        }),
    }
}

/// Dashed line for orientation.
pub(super) fn helper(ends: Vec<(f64, f64)>) -> Attributed<(f64, f64)> {
    Attributed::line(ends, GREY.stroke_width(7), &[30.0, 20.0])
}

/// Largest ratio between a deadline and the nearest run of a panel. A line farther away would squeeze the
/// runs into a corner.
const REACH: f64 = 10.0;

/// Smallest and largest time of a panel, s.
fn range(lines: &[Line]) -> (f64, f64) {
    all(lines).map(|r| r.seconds).fold((f64::INFINITY, 0.0), |(low, high), t| (t.min(low), t.max(high)))
}

/// Deadlines among the runs of a panel, or close to them.
fn near(lines: &[Line]) -> Vec<Deadline> {
    let (low, high) = range(lines);
    DEADLINES.into_iter().filter(|d| (low / REACH..=high * REACH).contains(&d.seconds)).collect()
}

/// Texts about deadlines that are not drawn, with the titles of their panels: the hardest that every run
/// meets, and the easiest that no run meets.
fn beyond(panels: &[Ask]) -> Vec<String> {
    let mut said: Vec<(String, Vec<String>)> = Vec::new();
    for panel in panels {
        let (low, high) = range(&panel.lines);
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

/// Extends a range of errors to a decade; on a shorter axis the tick labels would need too many digits.
fn decade(mut errors: Vec<f64>) -> Vec<f64> {
    let low = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let high = errors.iter().copied().fold(0.0, f64::max);
    if high < 10.0 * low {
        let middle = (low * high).sqrt();
        errors.extend([middle / 10f64.sqrt(), middle * 10f64.sqrt()]);
    }
    errors
}

fn note(question: &Question, clock: Clock, panels: &[Ask]) -> String {
    let mut note = String::new();
    if panels.iter().any(|panel| has_front(&panel.lines)) {
        note += "Grey staircase: Pareto front. ";
    }
    note += "Down and to the left is better.";
    if panels.iter().any(|panel| y_axis(panel).range().contains(&PERCENT)) {
        note += " Dashed: an error of 1 %.";
    }
    if clock == Clock::Repeated {
        let drawn = |d: &&Deadline| panels.iter().any(|p| near(&p.lines).iter().any(|n| n.name == d.name));
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
    if clock == Clock::First && panels.iter().any(|panel| panel.by == Seconds::Cpu) {
        note += " CPU time, summed over all processors, is shown if the machine was busy.";
    }
    if question.scalar {
        note += " A single number can be accurate by chance: a thin line leads to the error that is used instead, a \
                 third of the displacement error.";
    }
    let several = panels.len() > 1;
    let place = |p: &Ask| if several { format!(" ({})", p.title) } else { String::new() };
    let references: Vec<String> =
        panels.iter().filter_map(|p| Some(format!("{}{}", p.reference.as_ref()?, place(p)))).collect();
    if !references.is_empty() {
        note += &format!(" The reference has no error and is not drawn: {}.", list(&references));
    }
    let low = |p: &&Ask| all(&p.lines).any(|r| r.error <= FLOOR);
    let floored: Vec<String> = panels.iter().filter(low).map(|p| p.title.clone()).collect();
    if !floored.is_empty() {
        note += &format!(" Errors below 10⁻⁶ are drawn at 10⁻⁶ ({}).", list(&floored));
    }
    if panels.iter().any(|p| p.kernels) {
        note += " Kernels: one marker for each size and integration rule.";
    }
    note
}

/// Draws vertical lines at the deadlines of a frame.
fn deadlines(chart: &mut Chart<'_>, scale: f64, lines: &[Line]) -> Drawn {
    let markers: Vec<_> = all(lines).map(|r| chart.backend_coord(&(scale * r.seconds, r.error))).collect();
    let y = chart.y_range();
    for deadline in near(lines) {
        let x = scale * deadline.seconds;
        chart.draw_series([helper(vec![(x, y.start), (x, y.end)])])?;
        // The label runs along the line, because there may be no room next to it, and is placed where it
        // covers the fewest markers, first of all at an end.
        let [foot, head] = [y.start, y.end].map(|y| chart.backend_coord(&(x, y)));
        let aside = |part: f64| (60, (part * f64::from(head.1 - foot.1)) as i32);
        let covered = |part: &f64| {
            let at = (foot.0 + aside(*part).0, foot.1 + aside(*part).1);
            markers.iter().filter(|m| (m.0 - at.0).abs() < 90 && (m.1 - at.1).abs() < 200).count()
        };
        let part = [0.12, 0.88, 0.3, 0.7, 0.5].into_iter().min_by_key(covered).unwrap_or(0.5);
        let upwards = text(TEXT, HPos::Center).transform(FontTransform::Rotate270);
        let label = Text::new(deadline.name, aside(part), upwards);
        chart.draw_series([EmptyElement::at((x, y.start)) + label])?;
    }
    Ok(())
}

/// Draws a staircase along the best runs, from each time to the next smaller error.
fn front(chart: &mut Chart<'_>, best: &[(f64, f64)]) -> Drawn {
    let (Some(first), Some(last)) = (best.first(), best.last()) else { return Ok(()) };
    let mut path = vec![(first.0, chart.y_range().end), *first];
    for pair in best.windows(2) {
        path.extend([(pair[1].0, pair[0].1), pair[1]]);
    }
    path.push((chart.x_range().end, last.1));
    chart.draw_series(LineSeries::new(path, RGBColor(0xb8, 0xb8, 0xb8).stroke_width(30)))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::QUESTIONS;
    use crate::fronts::tests::run;
    use crate::questions::Rank;
    use crate::select::runs;
    use catalogue::metric;
    use records::Family;

    #[test]
    fn a_line_far_from_all_runs_is_not_drawn_but_said() {
        let panel = |title: &str, times: &[f64]| {
            let timed = |&t: &f64| Timed {
                run: String::new(),
                seconds: t,
                spread: None,
                estimate: None,
                error: 0.1,
                counts: 0.1,
            };
            let runs = times.iter().map(timed).collect();
            Ask {
                case: title.into(),
                poisson: 0.495,
                title: title.into(),
                question: &QUESTIONS[0],
                clock: Clock::First,
                by: Seconds::Wall,
                error: &metric::L2,
                lines: vec![Line { label: "tet4".into(), family: Family::Fem, runs }],
                reference: None,
                band: None,
                kernels: false,
                rank: Rank::default(),
            }
        };
        let drawn = |p: &Ask| near(&p.lines).iter().map(|d| d.name).collect::<Vec<_>>();
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
            let panels = asks(&runs);
            assert_eq!(panels[0].lines.len(), 2);
            note(&QUESTIONS[0], Clock::First, &panels[..1])
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
