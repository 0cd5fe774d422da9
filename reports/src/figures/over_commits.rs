//! Errors and CPU seconds of a study over commits.

use records::Family;
use records::cell::csv_line;

use super::axes::Axis;
use super::drawing::Drawing;
use super::figure::{Data, Figure};
use super::grid::{Content, multiples};
use super::style::{Style, find, styles};
use crate::commits::{Point, Trend};
use crate::error::ReportError;

/// Title of the figure.
const TITLE: &str = "Errors and processor seconds over commits";

/// Figure of the report, `None` without a history.
pub(super) fn figure(trends: &[Trend]) -> Option<Figure> {
    (!trends.is_empty()).then(|| Figure {
        name: "over-commits".into(),
        title: TITLE.into(),
        caption: "Ratios to the first commit: the geometric mean of all errors, and the processor seconds of one pass \
                  over all runs, with the shortest repeat of each run. Changes outside noise are marked"
            .into(),
        drawing: over_commits(trends),
        data: Data::Rows(csv(trends)),
    })
}

/// Draws errors and times of trends over commits as SVG.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn svg(trends: &[Trend]) -> Result<String, ReportError> {
    over_commits(trends).svg("history", TITLE)
}

fn csv(trends: &[Trend]) -> String {
    let head = [
        "trend",
        "number",
        "commit",
        "label",
        "errors over the first",
        "processor seconds over the first",
        "outside noise",
    ];
    let mut out = csv_line(&head);
    for (trend, point) in trends.iter().flat_map(|trend| trend.points.iter().map(move |point| (trend, point)))
    {
        let ratio = |ratio: Option<f64>| ratio.map(|ratio| format!("{ratio:e}")).unwrap_or_default();
        let (number, moved) = (point.number.to_string(), point.moved());
        let (errors, times) = (ratio(point.error_ratio), ratio(point.seconds_ratio));
        out.push_str(&csv_line(&[
            &trend.label(),
            &number,
            &point.commit,
            &point.label,
            &errors,
            &times,
            &moved,
        ]));
    }
    out
}

/// Largest number of commits labelled on an axis.
const NAMED: usize = 6;

/// Draws two panels over the commits of each trend, as ratios to the first commit: errors and CPU seconds.
/// Only steps outside of the noise have markers.
fn over_commits(trends: &[Trend]) -> Drawing {
    let labels: Vec<(String, Family)> = trends.iter().map(|trend| (trend.label(), Family::Fem)).collect();
    let styles = styles(&labels);
    let errors = |point: &Point| point.error_ratio;
    let seconds = |point: &Point| point.seconds_ratio;
    let panels = vec![
        panel("Errors", "mean error over the first [1]", trends, &styles, errors, Point::errors_moved),
        panel("Times", "processor seconds over the first [1]", trends, &styles, seconds, Point::times_moved),
    ];
    multiples(panels, &styles, "Marked: changes outside noise.")
}

fn panel<'a>(
    title: &str,
    y: &str,
    trends: &'a [Trend],
    styles: &'a [Style],
    value: impl Fn(&Point) -> Option<f64> + Copy + 'a,
    marked: impl Fn(&Point) -> bool + Copy + 'a,
) -> Content<'a> {
    let points = move |trend: &'a Trend| {
        let each = trend.points.iter().enumerate();
        each.filter_map(move |(at, point)| Some((at as f64, value(point)?, marked(point))))
    };
    let longest = trends.iter().max_by_key(|trend| trend.points.len());
    let names: Vec<(f64, String)> = longest.map_or(Vec::new(), |trend| {
        let every = trend.points.len().div_ceil(NAMED).max(1);
        // Seven digits identify a commit.
        let digits = |point: &Point| if point.label.is_empty() { 7 } else { 16 };
        let name = |point: &Point| point.name().chars().take(digits(point)).collect();
        trend.points.iter().enumerate().step_by(every).map(|(at, point)| (at as f64, name(point))).collect()
    });
    let last = longest.map_or(0, |trend| trend.points.len().saturating_sub(1)) as f64;
    Content {
        title: title.into(),
        x: Axis::linear("commit", [0.0, last].into_iter(), true).with_ticks(names),
        y: Axis::linear(y, trends.iter().flat_map(points).map(|p| p.1).chain([1.0]), false),
        series: Box::new(move |chart| {
            for trend in trends {
                let Some(style) = find(styles, &trend.label()) else { continue };
                chart.draw_series([style.line(points(trend).map(|p| (p.0, p.1)).collect())])?;
                style.marks(chart, points(trend).filter(|p| p.2).map(|p| (p.0, p.1)))?;
            }
            Ok(())
        }),
    }
}
