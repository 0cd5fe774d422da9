//! Loops in real time: error of the force against the time of a frame, with the deadlines.

use catalogue::metric;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::Family;
use records::cell::csv_line;

use super::axes::{Axis, Chart};
use super::backend::{CIRCLE, ring};
use super::drawing::{Drawn, TEXT, text};
use super::efficiency::helper;
use super::figure::{Data, Figure, PAGE, continued, paged};
use super::grid::{Content, multiples};
use super::style::{Style, find, styles};
use crate::select::{Run, by_case, labels};

/// A run at one rate.
struct Beat {
    rate: u64,
    /// 99th percentile of the time of a frame, or the longest of fewer than 100, s.
    seconds: f64,
    /// Relative error of the force.
    error: f64,
    /// Misses of 1000 frames.
    misses: f64,
}

/// The rates of a run.
struct Line {
    label: String,
    family: Family,
    run: String,
    beats: Vec<Beat>,
}

/// A panel for each case with a loop and a tool.
pub(super) fn figures(runs: &[Run]) -> Vec<Figure> {
    let cases: Vec<(String, Vec<Line>)> = by_case(runs)
        .map(|case| (case[0].is.case.clone(), lines(case)))
        .filter(|(_, lines)| !lines.is_empty())
        .collect();
    cases.chunks(PAGE).enumerate().map(|(page, panels)| figure(page, panels)).collect()
}

fn lines(case: &[Run]) -> Vec<Line> {
    let each = case.iter().zip(labels(case.iter().map(|run| run.is))).map(|(run, label)| {
        let beats = run.rates().into_iter().enumerate().filter_map(|(index, rate)| {
            let phase = format!("loop-{rate}");
            Some(Beat {
                rate,
                seconds: run.time(&phase, "p99").or_else(|| run.time(&phase, "max"))?,
                error: run.value(metric::LOOP_FORCE_ERROR.at(index)).filter(|error| *error > 0.0)?,
                misses: run.time(&phase, "misses")?,
            })
        });
        let label = format!("{label}, {} nodes", run.is.nodes);
        Line { label, family: run.is.family, run: run.is.run.clone(), beats: beats.collect() }
    });
    each.filter(|line| !line.beats.is_empty()).collect()
}

fn figure(page: usize, panels: &[(String, Vec<Line>)]) -> Figure {
    let all = panels.iter().flat_map(|(_, lines)| lines);
    let styles = styles(&all.map(|line| (line.label.clone(), line.family)).collect::<Vec<_>>());
    let contents = panels.iter().map(|(case, lines)| content(case, lines, &styles)).collect();
    let note = "Down and to the left is better. Dashed: the time between two frames. Discs: the part of the frames that are \
                late; the largest stands for all.";
    Figure {
        name: paged("real-time", page),
        title: continued("Loops in real time: error against the time of a frame", page),
        caption: "Error of the tool's force that 99 % of the frames keep, against the time that 99 % of the frames keep, with one \
                  marker for each rate of frames"
            .into(),
        drawing: multiples(contents, &styles, note),
        data: Data::Rows(rows(panels)),
    }
}

fn content<'a>(case: &str, lines: &'a [Line], styles: &'a [Style]) -> Content<'a> {
    let beats = || lines.iter().flat_map(|line| &line.beats);
    let times = beats().flat_map(|beat| [1e3 * beat.seconds, 1e3 / beat.rate as f64]);
    let mut rates: Vec<u64> = beats().map(|beat| beat.rate).collect();
    rates.sort_unstable();
    rates.dedup();
    Content {
        title: case.into(),
        x: Axis::log("frame, 99 % within [ms]", times),
        y: Axis::log("relative force error [1]", beats().map(|beat| beat.error)),
        series: Box::new(move |chart| {
            rates.iter().try_for_each(|&rate| deadline(chart, rate))?;
            for line in lines {
                let Some(style) = find(styles, &line.label) else { continue };
                let at = |beat: &Beat| (1e3 * beat.seconds, beat.error);
                chart.draw_series(line.beats.iter().filter(|beat| beat.misses > 0.0).map(|beat| {
                    let disc = ring(CIRCLE, 0.0, 40.0 + 110.0 * (beat.misses / 1e3).sqrt());
                    EmptyElement::at(at(beat)) + Polygon::new(disc, pale(style.look.colour))
                }))?;
                style.curve(chart, &line.beats.iter().map(at).collect::<Vec<_>>(), 1)?;
            }
            Ok(())
        }),
    }
}

/// A quarter of a colour on white.
fn pale(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let part = |of: u8| 191 + of / 4;
    RGBColor(part(red), part(green), part(blue))
}

/// Draws the time between two frames of a rate as a vertical line.
fn deadline(chart: &mut Chart<'_>, rate: u64) -> Drawn {
    let (x, y) = (1e3 / rate as f64, chart.y_range());
    chart.draw_series([helper(vec![(x, y.start), (x, y.end)])])?;
    let upwards = text(TEXT, HPos::Right).transform(FontTransform::Rotate270);
    let label = Text::new(format!("{rate} Hz"), (60, 40), upwards);
    chart.draw_series([EmptyElement::at((x, y.end)) + label])?;
    Ok(())
}

fn rows(panels: &[(String, Vec<Line>)]) -> String {
    let mut out = csv_line(&[
        "case",
        "series",
        "frames per second",
        "frame, 99 % within [s]",
        "relative force error [1]",
        "misses of 1000",
        "run",
    ]);
    for (case, lines) in panels {
        for line in lines {
            for Beat { rate, seconds, error, misses } in &line.beats {
                out.push_str(&csv_line(&[
                    case,
                    &line.label,
                    &rate.to_string(),
                    &format!("{seconds:e}"),
                    &format!("{error:e}"),
                    &misses.to_string(),
                    &line.run,
                ]));
            }
        }
    }
    out
}
