//! Performance profile: the fraction of its cases on which a method is within an error, as a function of its
//! time over the smallest time of any method.

use super::axes::Axis;
use super::figure::{Data, Figure};
use super::grid::{Content, multiples};
use super::style::{find, styles};
use crate::cheapest::{methods, problems, ratios};
use crate::fronts::wanted;
use crate::plot::{self, Curve, Plot, Scale};
use crate::select::Run;

/// Smallest number of cases for a profile of a method.
const CASES: usize = 3;

/// Panel over all cases; `None` if no method ran on enough of them.
pub(super) fn figure(runs: &[Run]) -> Option<Figure> {
    let problems = problems(runs);
    let all: Vec<Curve> = methods(&problems)
        .into_iter()
        .filter_map(|(label, family)| {
            let (ratios, of) = ratios(&problems, &label);
            let points = stairs(&ratios, of);
            (of >= CASES && !ratios.is_empty()).then(|| Curve::new(label, family, points, Vec::new()))
        })
        .collect();
    let last = all.iter().flat_map(|c| &c.points).map(|p| p.0).fold(1.0, f64::max);
    let mut curves = all;
    for curve in &mut curves {
        // The last value holds to the end of the axis.
        curve.points.extend(
            curve.points.last().map(|p| (last, p.1)).filter(|p| p.0 > curve.points[curve.points.len() - 1].0),
        );
    }
    if curves.is_empty() {
        return None;
    }
    let plot = Plot {
        case: String::new(),
        title: format!("Within {}", wanted()),
        x: Scale::log("time over that of the fastest method", "1"),
        y: Scale::linear("share of its cases", "1"),
        curves,
    };
    let styles = styles(&plot::labels(std::slice::from_ref(&plot)));
    let content = content(&plot, &styles);
    let note = format!(
        "Methods that were run on at least {CASES} of the cases that any method reaches. Up and to the left is better."
    );
    Some(Figure {
        name: "profile".into(),
        title: format!("Performance profile: within {}", wanted()),
        caption: format!(
            "Share of its cases in which a method is within {} of the tool force (or of the displacement if no force \
             is known), against the ratio of its time to the time of the fastest method (Dolan and More 2002)",
            wanted()
        ),
        drawing: multiples(vec![content], &styles, &note),
        data: Data::Plots(vec![plot]),
    })
}

/// Both corners of every step.
fn stairs(ratios: &[f64], of: usize) -> Vec<(f64, f64)> {
    let share = |solved: usize| solved as f64 / of as f64;
    let corners =
        ratios.iter().enumerate().flat_map(|(k, &ratio)| [(ratio, share(k)), (ratio, share(k + 1))]);
    corners.collect()
}

fn content<'a>(plot: &'a Plot, styles: &'a [super::style::Style]) -> Content<'a> {
    let shares = plot.curves.iter().flat_map(|c| &c.points).map(|p| p.1);
    Content {
        y: Axis::of(&plot.y, shares.chain([1.0])),
        series: Box::new(move |chart| {
            for curve in &plot.curves {
                let Some(style) = find(styles, &curve.label) else { continue };
                chart.draw_series([style.line(curve.points.clone())])?;
                // The upper corner of each step has a marker.
                style.marks(chart, curve.points.iter().copied().skip(1).step_by(2))?;
            }
            Ok(())
        }),
        ..Content::of(plot, styles)
    }
}

#[cfg(test)]
mod tests {
    use super::stairs;

    #[test]
    fn a_profile_rises_at_each_case_that_is_reached() {
        assert_eq!(stairs(&[1.0, 3.0], 4), [(1.0, 0.0), (1.0, 0.25), (3.0, 0.25), (3.0, 0.5)]);
    }
}
