//! Procedures: their keys with defaults, each value in its range.

use catalogue::Problem;

use crate::scene::keys::{ExplicitKeys, ImplicitKeys, NewtonKeys, ProcedureKeys, RampKeys, StaticKeys};
use crate::scene::procedure::*;
use crate::scene::report::Report;

use super::positive;

/// Without a table it is linear.
pub(super) fn procedure(keys: Option<ProcedureKeys>, tools: bool, report: &mut Report) -> Procedure {
    match keys {
        None => Procedure::Linear,
        Some(ProcedureKeys::Linear { steps: unused }) => {
            steps(unused, report);
            Procedure::Linear
        }
        Some(ProcedureKeys::Prepare { steps: unused }) => {
            steps(unused, report);
            Procedure::Prepare
        }
        Some(ProcedureKeys::Modes { modes: count, steps: unused }) => {
            steps(unused, report);
            Procedure::Modes { count: modes(count, report) }
        }
        Some(ProcedureKeys::Static(keys)) => Procedure::Static(load_steps(&keys, report)),
        Some(ProcedureKeys::Explicit(keys)) => Procedure::Explicit(explicit(&keys, report)),
        Some(ProcedureKeys::ImplicitDynamic(keys)) => {
            Procedure::ImplicitDynamic(implicit(&keys, tools, report))
        }
    }
}

fn modes(modes: Option<u32>, report: &mut Report) -> usize {
    let modes = modes.map_or(MODES, |n| n as usize);
    let sound = (1..=1000).contains(&modes);
    report.require(sound, "procedure.modes", "is no number of modes", "give 1 to 1000; 24 is usual");
    modes
}

fn load_steps(keys: &StaticKeys, report: &mut Report) -> Static {
    let limit_within = keys.limit_within;
    let sound = limit_within.is_none_or(|part| (1e-4..=1.0).contains(&part));
    let help = "give 1e-4 to 1; 0.02 is usual";
    report.require(sound, "procedure.limit-within", "is no part of the load", help);
    Static {
        steps: steps(keys.steps, report),
        newton: newton(&keys.newton, report),
        limit_within,
        on_stall: keys.on_stall.unwrap_or(OnStall::Stop),
    }
}

fn steps(steps: Option<u32>, report: &mut Report) -> usize {
    let steps = steps.unwrap_or(1);
    report.require(steps > 0, "procedure.steps", "is zero", "give 1 or more");
    steps as usize
}

fn newton(keys: &NewtonKeys, report: &mut Report) -> Newton {
    let standard = Newton::STANDARD;
    let tolerance = keys.tolerance.unwrap_or(standard.tolerance);
    // Rounding leaves about 1e-13 of the forces of a nearly incompressible body.
    let sound = (1e-12..=1e-2).contains(&tolerance);
    report.require(sound, "procedure.tolerance", "is no tolerance", "give 1e-12 to 1e-2; 1e-8 is usual");
    let iterations = keys.iterations.map_or(standard.iterations, |n| n as usize);
    report.require(iterations > 0, "procedure.iterations", "is zero", "give 1 or more; 25 is usual");
    let augmentations = keys.augmentations.map_or(standard.augmentations, |n| n as usize);
    Newton { tolerance, iterations, augmentations }
}

fn ramp(keys: &RampKeys, report: &mut Report) -> Ramp {
    let steps = steps(keys.steps, report);
    let duration = positive(keys.duration.0, "procedure.duration", report);
    let over = keys.over.as_ref().map(|q| q.0);
    let sound = over.is_none_or(|t| t >= 0.0);
    report.require(sound, "procedure.over", "is negative", "give \"0 s\" for at once, or leave it out");
    let damping = keys.damping.as_ref().map_or(0.0, |q| q.0);
    report.require(damping >= 0.0, "procedure.damping", "is negative", "give 0 /s or more, or leave it out");
    Ramp { duration, over, steps, damping }
}

fn explicit(keys: &ExplicitKeys, report: &mut Report) -> Explicit {
    let explicit = Explicit {
        ramp: ramp(&keys.ramp, report),
        safety: keys.safety.unwrap_or(SAFETY),
        step: keys.step.as_ref().map(|q| positive(q.0, "procedure.step", report)),
        tool_mass: keys.tool_mass.map_or(TOOL_MASS, |m| positive(m, "procedure.tool-mass", report)),
    };
    let sound = explicit.safety > 0.0 && explicit.safety <= 1.0;
    report.require(sound, "procedure.safety", "is not in (0, 1]", "0.9 is usual");
    let both = keys.safety.is_some() && explicit.step.is_some();
    report.require(!both, "procedure.safety", "has no step to shorten", "give step or safety, not both");
    explicit
}

fn implicit(keys: &ImplicitKeys, tools: bool, report: &mut Report) -> Implicit {
    let implicit = Implicit {
        ramp: ramp(&keys.ramp, report),
        newton: newton(&keys.newton, report),
        inertia: keys.inertia.unwrap_or(true),
        spectral_radius: keys.spectral_radius.unwrap_or(spectral_radius(tools)),
        accuracy: keys.accuracy.as_ref().map(|q| positive(q.0, "procedure.accuracy", report)),
    };
    let sound = (0.0..=1.0).contains(&implicit.spectral_radius);
    let help = "1 dissipates nothing, 0 kills in one step what a step cannot resolve; 0.8 is usual";
    report.require(sound, "procedure.spectral-radius", "is not in [0, 1]", help);
    let moving = [
        ("damping", keys.ramp.damping.is_some()),
        ("spectral-radius", keys.spectral_radius.is_some()),
        ("accuracy", keys.accuracy.is_some()),
    ];
    for (name, _) in moving.into_iter().filter(|(_, given)| *given && !implicit.inertia) {
        let problem = Problem::new("is of a motion, and inertia = false has none").help("leave it out");
        report.add(&format!("procedure.{name}"), problem);
    }
    implicit
}
