//! Penetration of tools into the surface because of a small penalty.

use catalogue::warning;
use geometry::Point3;
use shape::length;

use super::solved::Solved;
use crate::outcome::{LoadStep, Warning};

/// Fraction of the tools' closure above which a penetration is too deep.
const DEEP: f64 = 0.05;
/// Fraction of the closure to which the suggested penalty reduces the penetration.
const GOOD: f64 = 0.01;

/// Warns of tools whose penetration in any recorded state is deep enough to change their force. The closure
/// counts from the initial gaps and is summed over all tools, because the body between them may lean on
/// another tool. A tool whose penetration exceeds the closure is a floor, onto which loads press the body:
/// its penetration is compared with the body's narrowest extent.
pub(super) fn warnings(run: &Solved) -> Vec<Warning> {
    let points = run.prepared.contact_points();
    let tools = &run.setup.tools;
    let Some(history) = run.solution.history.as_ref().filter(|_| !points.is_empty()) else {
        return Vec::new();
    };
    let gap = |index: usize| {
        points.iter().map(|x| tools[index].tool.gap(0.0, x)).fold(f64::INFINITY, f64::min).max(0.0)
    };
    let gaps: Vec<f64> = (0..tools.len()).map(gap).collect();
    let steps = || history.steps.iter().chain([&history.last]);
    let closed = |step: &LoadStep| -> f64 {
        step.tools.iter().zip(&gaps).map(|(tool, gap)| (tool.closure - gap).max(0.0)).sum()
    };
    let closed = steps().map(closed).fold(0.0, f64::max);
    let each = tools.iter().enumerate().filter_map(|(index, placed)| {
        let of_tool = steps().filter_map(|step| step.tools.get(index));
        let deepest = of_tool.map(|tool| tool.penetration).fold(0.0, f64::max);
        let floor = deepest > closed;
        let way = if floor { narrowest(points) } else { closed };
        let part = deepest / way;
        (part > DEEP).then(|| {
            let of = if floor { "of the body's narrowest extent" } else { "by which the tools close" };
            let penalty = placed.tool.law().penalty();
            let enough = penalty * part / (1.0 - part).max(DEEP) / GOOD;
            let message = format!(
                "sinks {} into the surface, {:.1} % of the {} {of}, because its penalty of {:.3e} MPa/mm \
                 is too small: forces and displacements have errors of that size; a penalty of about {:.1e} MPa/mm \
                 reduces the penetration to 1 %",
                length(deepest),
                100.0 * part,
                length(way),
                1e-9 * penalty,
                1e-9 * enough
            );
            Warning::new(&warning::DEEP_PENETRATION, part, format!("tool[{index}].penalty"), message)
        })
    });
    each.collect()
}

/// Smallest extent along an axis, m.
pub(super) fn narrowest(points: &[Point3]) -> f64 {
    let extents = (0..3).map(|axis| {
        let along = || points.iter().map(|x| x[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    });
    extents.fold(f64::INFINITY, f64::min)
}
