//! Warnings about the results of a run, each with the value that triggered it.

use cases::scene::Procedure;
use catalogue::{metric, warning};
use geometry::Point3;
use shape::{length, position};

use super::exact_fit::Misfit;
use super::patch::patch_error;
use super::penetration::{self, narrowest};
use super::solved::Solved;
use super::stress::Recovered;
use super::{dead_pressure, exact_fit, few_cells, hourglass, hourglass_control, large_strain};
use crate::adapter;
use crate::discretise::{Essential, place};
use crate::error::Failure;
use crate::outcome::{LoadStep, Metric, Probe, Warning};
use crate::scenario::setup::Applied;

/// Smallest stress jump that is reported, relative to the norm of the stress. In cases with an exact solution
/// the jump is 0.5 to 0.95 of the energy error if a mesh is fine enough for its order, and at least 0.2 if
/// the mesh locks; displacements are then wrong by 5 to 50 %. On a bonded punch, whose edge is singular, it
/// is 0.07 to 0.4 of the root of the force's error.
const ROUGH_STRESS: f64 = 0.2;
/// Smallest ratio of Nitsche's factor to the needed factor without a warning. At a ratio of 2, three tenths
/// of the energy are left.
const FACTOR_TO_SPARE: f64 = 2.0;
/// Largest gap at a support without a warning, relative to the largest displacement.
const GIVING_SUPPORT: f64 = 0.01;
/// Largest `sqrt(leaked energy / strain energy)` without a warning. In a patch test at a Poisson's ratio of
/// 0.4999 the root is 0.19 for an energy error of 0.21. In a patch test of a body 10,000 times as long as
/// thick it is 0.18 for an error of 0.16.
const LEAK: f64 = 0.1;
/// Largest misfit of an exact solution without a warning, relative to the largest root-mean-square
/// displacement or traction on a surface. The effect of flat facets on a curved surface is allowed in
/// addition: on a sphere it is 1.2 times their turn.
const MISFIT: f64 = 0.01;
/// Largest patch-test error without a warning, relative to the gradient of a linear field.
const UNBALANCED: f64 = 0.05;
/// Relative rounding of the largest displacement and of the body's size.
const ROUNDING: f64 = 1e-12;
/// Limit relative to the body's narrowest extent, for a tool's initial overlap and for the time-step error of
/// a motion that comes to rest.
const DEEP: f64 = 0.01;
/// Fraction of the largest kinetic energy below which the body is at rest.
const AT_REST: f64 = 1e-3;
/// Largest error of one time step without a warning, relative to the largest displacement.
const LONG_STEP: f64 = 0.01;
/// Fewest reliable digits of the largest displacement without a warning. Usually two or three more are
/// correct, and as many fewer of strains. Strains are then accurate to 0.01 %, less than the errors by which
/// methods are compared.
const DIGITS: f64 = 4.0;
/// Largest part of the kinetic energy that the displacement of a cloud may lack without a warning.
const UNSEEN: f64 = 0.1;
/// Fewest integration points per node without a warning. A cloud on the vertices of its tetrahedra has two to
/// six cells per node, and one point in each cell detects all motions of the cloud. At 1.7 points per node,
/// some clouds already have motions without strain at their points.
const POINTS_PER_NODE: f64 = 2.0;

/// All warnings of a measured run.
pub(crate) fn warnings(
    run: &Solved,
    recovered: Option<&Recovered>,
    metrics: &[Metric],
    probes: &[Probe],
    last: Option<&LoadStep>,
) -> Result<Vec<Warning>, Failure> {
    let mut found = Vec::new();
    found.extend(probes.iter().enumerate().filter_map(|(index, probe)| outside(index, probe)));
    found.extend(blended(run));
    found.extend(few_points(run));
    found.extend(point_force(run)?);
    found.extend(unbalanced(run));
    found.extend(another_problem(run));
    let value = |entry: &metric::Metric| metrics.iter().find(|m| m.of.metric == entry).map(|m| m.value);
    let largest = largest_displacement(run);
    found.extend(long_step(run, value(&metric::STEP_ERROR), largest));
    found.extend(giving(value(&metric::SUPPORT_GAP), largest));
    found.extend(leaking(run, largest, value(&metric::STRAIN_ENERGY)));
    found.extend(value(&metric::NITSCHE_FACTOR_NEEDED).and_then(|needed| bare_factor(run, needed)));
    found.extend(value(&metric::SMALLEST_FINE_J).and_then(folded));
    found.extend(last.into_iter().flat_map(few_carriers));
    let at_rest = matches!(run.setup.procedure, Procedure::Static(_));
    found.extend(last.into_iter().filter(|_| at_rest).flat_map(|step| untouched(run, step)));
    found.extend(value(&metric::LIMIT_LOAD).filter(|_| run.solution.is_whole()).map(unstable));
    found.extend(run.solution.spurious_motion.and_then(spurious_motion));
    found.extend(inside(run));
    found.extend(penetration::warnings(run));
    found.extend(dead_pressure::warnings(run)?);
    found.extend(few_cells::warning(run, metrics)?);
    found.extend(hourglass::warning(run, value(&metric::STRAIN_ENERGY), largest)?);
    found.extend(value(&metric::HOURGLASS_ENERGY).and_then(hourglass_control::warning));
    found.extend(run.solution.digits.and_then(few_digits));
    found.extend(unchecked(run));
    found.extend(large_strain(run));
    found.extend(rough_stress(run, recovered, value(&metric::STRESS_JUMP)));
    Ok(found)
}

fn unchecked(run: &Solved) -> Option<Warning> {
    let outside = run.method.outside.as_ref().filter(|outside| !adapter::is_checked(&outside.adapter))?;
    let name = &outside.adapter.manifest.name;
    let message = format!(
        "{name} in its present version has not passed its check on this machine, so its results are shown separately: \
         run tissuebench adapter check {name}"
    );
    Some(Warning::new(&warning::ADAPTER_UNCHECKED, 0.0, "", message))
}

fn outside(index: usize, probe: &Probe) -> Option<Warning> {
    (probe.outside > 0.0).then(|| {
        let message = format!(
            "lies {} outside the mesh: its values are taken at the nearest point of the mesh",
            length(probe.outside)
        );
        Warning::new(&warning::PROBE_OUTSIDE, probe.outside, format!("output.probes[{index}]"), message)
    })
}

fn blended(run: &Solved) -> Option<Warning> {
    if !run.method.blends || !run.method.has_regions() {
        return None;
    }
    let span = |moduli: Vec<f64>| {
        moduli.iter().copied().fold(0.0, f64::max) / moduli.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let materials = || run.setup.materials.iter();
    let jump = span(materials().map(|m| m.mu()).collect()).max(span(materials().map(|m| m.bulk()).collect()));
    (jump > 1.0).then(|| {
        let message = format!(
            "the shape functions of the cloud reach across the interface of materials with a modulus ratio of \
             {jump:.4} and smooth the jump of the strain there; elements and a cloud with regions = \"separate\" do not"
        );
        Warning::new(&warning::REGIONS_BLENDED, jump, "region", message)
    })
}

fn few_points(run: &Solved) -> Option<Warning> {
    if run.method.interpolates {
        return None;
    }
    let each = run.prepared.volume.rows.weights().len() as f64 / run.method.nodes().len() as f64;
    (each < POINTS_PER_NODE).then(|| {
        let message = format!(
            "{each:.2} integration points per node are too few to resist every deformation of the cloud; \
             {POINTS_PER_NODE} suffice: take finer cells (background) or more points (integration)"
        );
        Warning::new(&warning::FEW_POINTS, each, "", message)
    })
}

/// Smoothing by one point on each face takes the mean gradient of cells. At a corner of a block, under a force
/// at a point, clouds of 225 nodes gave 15 to 25 times the displacement of clouds with Gauss points.
fn point_force(run: &Solved) -> Result<Option<Warning>, Failure> {
    let source = &run.prepared.source;
    if run.method.interpolates || source.face_points() != 1 || source.trace(&[])?.is_none() {
        return Ok(None);
    }
    let each = run.setup.loads.iter().find_map(|load| match &load.applied {
        Applied::Points { at, .. } => Some((load, at.len())),
        _ => None,
    });
    let found = each.map(|(load, count)| {
        let message = format!(
            "acts at {count} points of a cloud whose gradients are smoothed by one point on each face, which hardly resist \
             it at edges and corners: take rule = \"gauss\" or order = 2, or spread the force over a face"
        );
        Warning::new(&warning::POINT_FORCE, count as f64, format!("{}.force", load.key), message)
    });
    Ok(found)
}

fn spurious_motion(part: f64) -> Option<Warning> {
    (part > UNSEEN).then(|| {
        let message = format!(
            "{:.0} % of the kinetic energy belongs to parameters that oscillate almost without displacement, because \
             their mass is lumped: take a smaller support_scale, or kernel = \"regularised-interpolating\"",
            100.0 * part
        );
        Warning::new(&warning::SPURIOUS_MOTION, part, "method.support_scale", message)
    })
}

fn unbalanced(run: &Solved) -> Option<Warning> {
    let error = patch_error(run).filter(|error| *error > UNBALANCED)?;
    let message = format!(
        "the integration fails the patch test: the gradient of a linear field is wrong by {:.1} %. Take more points, \
         rule = \"cell-smoothed\", or supports that follow flat cells (neighbourhood = \"ellipsoid\")",
        100.0 * error
    );
    Some(Warning::new(&warning::PATCH_TEST, error, "method.integration", message))
}

fn another_problem(run: &Solved) -> Option<Warning> {
    let too_far = |misfit: &Misfit| misfit.relative > MISFIT + 2.0 * misfit.turn;
    let misfit = exact_fit::worst(run).ok()?.filter(too_far)?;
    let unit = if misfit.what == "traction" { "Pa" } else { "m" };
    let message = format!(
        "solves a different problem: on {}, the scene prescribes a {} of {:.4e} {unit} (root mean square) and the \
         solution has {:.4e} {unit}; they differ by {:.1} % of the largest value. Errors include the difference of \
         the two problems",
        misfit.surface,
        misfit.what,
        misfit.sizes[0],
        misfit.sizes[1],
        100.0 * misfit.relative
    );
    Some(Warning::new(&warning::EXACT_MISFIT, misfit.relative, "reference.exact", message))
}

/// Largest nodal displacement of all recorded states, m, and at least the rounding of the body's size.
fn largest_displacement(run: &Solved) -> f64 {
    let recorded = run.solution.history.iter().flat_map(|history| &history.fields).chain([&run.solution.u]);
    let size = place::size(run.method.mesh());
    recorded.flatten().map(|u| u.norm()).fold(ROUNDING * size, f64::max)
}

fn long_step(run: &Solved, error: Option<f64>, largest: f64) -> Option<Warning> {
    let error = error?;
    let relative = error / largest;
    // An initial oscillation that has decayed does not change the final state.
    let (low, high) = place::bounds(run.method.mesh());
    if is_at_rest(run) && error < DEEP * (high - low).min() {
        return None;
    }
    (relative > LONG_STEP).then(|| {
        let message = format!(
            "the estimated error of one time step is {:.2} % of the largest displacement: take shorter steps, \
             or give \
             accuracy",
            100.0 * relative
        );
        Warning::new(&warning::STEP_ERROR, relative, "procedure", message)
    })
}

/// Whether the kinetic energy has decayed at the end.
fn is_at_rest(run: &Solved) -> bool {
    let Some(history) = &run.solution.history else { return true };
    let kinetic =
        |step: &LoadStep| step.more.iter().find(|m| *m.of.metric == metric::KINETIC_ENERGY).map(|m| m.value);
    let most = history.steps.iter().filter_map(kinetic).fold(0.0, f64::max);
    kinetic(&history.last).is_some_and(|last| last < AT_REST * most)
}

fn giving(gap: Option<f64>, largest: f64) -> Option<Warning> {
    let relative = gap? / largest;
    (relative > GIVING_SUPPORT).then(|| {
        let message = format!(
            "a weakly imposed support is violated by {:.2} % of the largest displacement: take a larger factor, or \
             another value of essential",
            100.0 * relative
        );
        Warning::new(&warning::SUPPORT_GIVES, relative, "support", message)
    })
}

/// Warning of a weakly imposed support that leaks. The leaked energy is that of the strain `gap A / V`, with
/// the modulus `K + 4 mu / 3` of laterally constrained material. The stress of nearly incompressible tissue
/// and of a thin body is wrong long before the displacement is.
fn leaking(run: &Solved, largest: f64, energy: Option<f64>) -> Option<Warning> {
    let [gap, area] = run.prepared.support_gap(&run.solution.u)?;
    let energy = energy.filter(|e| *e > 0.0)?;
    // In a rigid motion, the gap and the energy are rounding.
    if gap < ROUNDING * largest {
        return None;
    }
    let volume: f64 = run.prepared.volume.rows.weights().iter().sum();
    let modulus = run.setup.materials.iter().map(|m| m.bulk() + 4.0 / 3.0 * m.mu()).fold(0.0, f64::max);
    let strain = gap * area / volume;
    let relative = (0.5 * modulus * strain * strain * volume / energy).sqrt();
    (relative > LEAK).then(|| {
        let message = format!(
            "the gap at a weakly imposed support is large for a body as flat or as incompressible as this, and the \
             stress may be wrong by {:.0} %: take a larger factor, or another value of essential",
            100.0 * relative
        );
        Warning::new(&warning::SUPPORT_LEAKS, relative, "support", message)
    })
}

fn bare_factor(run: &Solved, needed: f64) -> Option<Warning> {
    let Essential::Nitsche(factor) = run.method.essential else { return None };
    let distance = factor / needed;
    (distance < FACTOR_TO_SPARE).then(|| {
        let message = format!(
            "the factor {factor} of Nitsche's method is {distance:.3} times the smallest factor, {needed:.1}, for \
             which the form is definite with these rules and this material: errors grow if this ratio is below \
             {FACTOR_TO_SPARE}; take factor = {:.0}, or another rule",
            4.0 * needed
        );
        Warning::new(&warning::NITSCHE_FACTOR, distance, "method.essential", message)
    })
}

fn folded(smallest: f64) -> Option<Warning> {
    (smallest <= 0.0).then(|| {
        let message = format!(
            "the body is inverted between its integration points (J = {smallest:.3}): the mesh is too coarse, or \
             reduced integration allows folding"
        );
        Warning::new(&warning::FOLDED, smallest, "", message)
    })
}

fn unstable(load: f64) -> Warning {
    let message = format!(
        "the body loses stability at {:.2} % of the load: several equilibria exist beyond this load, and small \
         differences between meshes and methods decide which equilibrium a run follows. Compare runs up to this load \
         (limit-load), or give the body a defined imperfection",
        100.0 * load
    );
    Warning::new(&warning::STABILITY_LOST, load, "procedure", message)
}

fn few_carriers(step: &LoadStep) -> Vec<Warning> {
    let few = step.tools.iter().enumerate().filter(|(_, tool)| tool.is_carried_by_few());
    let each = few.map(|(index, tool)| {
        let message = format!(
            "{:.1} contact points carry the tool's force, so the force depends on the positions of single points: \
             take a finer mesh there",
            tool.carriers
        );
        Warning::new(&warning::FEW_CONTACT_POINTS, tool.carriers, format!("tool[{index}]"), message)
    });
    each.collect()
}

/// Warning of tools that overlap the undeformed body. An intended interference fit is small compared with the
/// limit.
fn inside(run: &Solved) -> Vec<Warning> {
    let points = run.prepared.contact_points();
    if points.is_empty() {
        return Vec::new();
    }
    let narrowest = narrowest(points);
    let each = run.setup.tools.iter().enumerate().filter_map(|(index, placed)| {
        let depth = -points.iter().map(|x| placed.tool.gap(0.0, x)).fold(f64::INFINITY, f64::min);
        let message = || {
            format!(
                "overlaps the undeformed body by {}, which the first step has to push out: place the tool \
                 farther away (at)",
                length(depth)
            )
        };
        (depth > DEEP * narrowest)
            .then(|| Warning::new(&warning::TOOL_INSIDE, depth, format!("tool[{index}]"), message()))
    });
    each.collect()
}

/// Warning of tools without contact at the end. Such a tool misses the body or has slipped off, unless its
/// curve takes it back.
fn untouched(run: &Solved, step: &LoadStep) -> Vec<Warning> {
    let goes_back = |index: usize| {
        let curve = run.setup.tools[index].curve.as_ref();
        curve.is_some_and(|curve| curve.value(1.0) < curve.largest())
    };
    let free = step.tools.iter().enumerate().filter(|(_, tool)| tool.active == 0 && tool.closure != 0.0);
    let each = free.filter(|(index, _)| !goes_back(*index)).map(|(index, _)| {
        let message =
            "is not in contact at the end: its force is 0. Move the tool further (drive), or place it nearer (at)";
        Warning::new(&warning::TOOL_UNTOUCHED, 0.0, format!("tool[{index}]"), message.to_string())
    });
    each.collect()
}

fn few_digits(digits: f64) -> Option<Warning> {
    (digits < DIGITS).then(|| {
        let message = format!(
            "at most {:.1} digits of the largest displacement are reliable, and fewer of strains and stresses, \
             because the matrix is nearly singular",
            digits.max(0.0)
        );
        Warning::new(&warning::FEW_DIGITS, digits, "", message)
    })
}

/// Writes a position (m) of the undeformed body.
fn at(run: &Solved, x: &Point3) -> String {
    position(x, place::size(run.method.mesh()))
}

fn large_strain(run: &Solved) -> Vec<Warning> {
    let Some([strain, turn]) = large_strain::largest(run) else { return Vec::new() };
    let help = "take a law of large strain (law = \"neo-hookean\", kind = \"static\")";
    let strained = (strain.value > large_strain::LARGE).then(|| {
        let message = format!(
            "reaches a strain of {:.1} % at {}, and more than {:.0} % in {:.2} % of the volume, beyond the range of a \
             law of small strain: {help}",
            100.0 * strain.value,
            at(run, &strain.at),
            100.0 * large_strain::LARGE,
            100.0 * strain.share
        );
        Warning::new(&warning::LARGE_STRAIN, strain.value, "material.law", message)
    });
    let turned = (turn.value > large_strain::TURNED).then(|| {
        let message = format!(
            "reaches a rotation of {:.3} rad at {}, and more than {} rad in {:.2} % of the volume, to which a law of \
             small strain assigns a strain of {:.1} %: {help}",
            turn.value,
            at(run, &turn.at),
            large_strain::TURNED,
            100.0 * turn.share,
            50.0 * turn.value * turn.value
        );
        Warning::new(&warning::LARGE_ROTATION, turn.value, "material.law", message)
    });
    strained.into_iter().chain(turned).collect()
}

fn rough_stress(run: &Solved, recovered: Option<&Recovered>, jump: Option<f64>) -> Option<Warning> {
    let value = jump.filter(|value| *value > ROUGH_STRESS)?;
    let (_, at) = recovered?.jump()?;
    let message = format!(
        "the stress is not smooth: jumps between neighbours make up {:.0} % of the stress in the energy norm and are \
         largest at {}. The mesh or cloud is too coarse, or the method locks; the error may be smaller or several \
         times as large",
        100.0 * value,
        self::at(run, &at)
    );
    Some(Warning::new(&warning::STRESS_JUMP, value, "", message))
}
