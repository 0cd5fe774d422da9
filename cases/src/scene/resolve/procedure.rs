//! The procedure, each kind with its own keys.

use super::super::keys::ProcedureKeys;
use super::super::procedure::{
    Explicit, Implicit, MODES, Newton, Procedure, ProcedureKind, Ramp, SAFETY, Static, TOOL_MASS,
    spectral_radius,
};
use super::super::report::Report;
use super::positive;
use catalogue::Problem;

/// Without a table it is linear.
pub(super) fn procedure(keys: Option<ProcedureKeys>, tools: bool, report: &mut Report) -> Procedure {
    let Some(keys) = keys else { return Procedure::Linear };
    strangers(&keys, report);
    let steps = steps(&keys, report);
    match keys.kind {
        ProcedureKind::Prepare => Procedure::Prepare,
        ProcedureKind::Linear => Procedure::Linear,
        ProcedureKind::Modes => Procedure::Modes { count: modes(&keys, report) },
        ProcedureKind::Static => Procedure::Static(load_steps(&keys, steps, report)),
        ProcedureKind::Explicit => Procedure::Explicit(explicit(&keys, steps, report)),
        ProcedureKind::ImplicitDynamic => Procedure::ImplicitDynamic(implicit(&keys, steps, tools, report)),
    }
}

/// Notes keys of another kind of procedure.
fn strangers(keys: &ProcedureKeys, report: &mut Report) {
    use ProcedureKind::{Explicit, ImplicitDynamic, Modes, Static};
    let (newton, dynamics) = (&[Static, ImplicitDynamic][..], &[Explicit, ImplicitDynamic][..]);
    let given = [
        ("tolerance", keys.tolerance.is_some(), newton),
        ("iterations", keys.iterations.is_some(), newton),
        ("augmentations", keys.augmentations.is_some(), newton),
        ("limit-within", keys.limit_within.is_some(), &[Static]),
        ("on-stall", keys.on_stall.is_some(), &[Static]),
        ("modes", keys.modes.is_some(), &[Modes]),
        ("damping", keys.damping.is_some(), dynamics),
        ("over", keys.over.is_some(), dynamics),
        ("inertia", keys.inertia.is_some(), &[ImplicitDynamic]),
        ("spectral-radius", keys.spectral_radius.is_some(), &[ImplicitDynamic]),
        ("accuracy", keys.accuracy.is_some(), &[ImplicitDynamic]),
        ("safety", keys.safety.is_some(), &[Explicit]),
        ("step", keys.step.is_some(), &[Explicit]),
        ("tool-mass", keys.tool_mass.is_some(), &[Explicit]),
    ];
    let name = keys.kind.name();
    for (key, _, kinds) in given.into_iter().filter(|(_, given, kinds)| *given && !kinds.contains(&keys.kind))
    {
        let help = format!("a {name} procedure takes none: leave it out");
        let kinds = kinds.iter().map(|kind| format!("\"{}\"", kind.name())).collect::<Vec<_>>().join(" or ");
        let problem = Problem::new(format!("goes with kind = {kinds} only")).help(help);
        report.add(&format!("procedure.{key}"), problem);
    }
    if keys.duration.is_some() && !dynamics.contains(&keys.kind) {
        let help = format!("a {name} procedure has no time axis: leave it out");
        report.add("procedure.duration", Problem::new("has nothing to last").help(help));
    }
}

fn modes(keys: &ProcedureKeys, report: &mut Report) -> usize {
    let modes = keys.modes.map_or(MODES, |n| n as usize);
    let sound = (1..=1000).contains(&modes);
    report.require(sound, "procedure.modes", "is no number of modes", "give 1 to 1000; 24 is usual");
    modes
}

fn load_steps(keys: &ProcedureKeys, steps: usize, report: &mut Report) -> Static {
    let limit_within = keys.limit_within;
    let sound = limit_within.is_none_or(|part| (1e-4..=1.0).contains(&part));
    let help = "give 1e-4 to 1; 0.02 is usual";
    report.require(sound, "procedure.limit-within", "is no part of the load", help);
    Static { steps, newton: newton(keys, report), limit_within, on_stall: keys.on_stall.unwrap_or_default() }
}

fn steps(keys: &ProcedureKeys, report: &mut Report) -> usize {
    let steps = keys.steps.unwrap_or(1);
    report.require(steps > 0, "procedure.steps", "is zero", "give 1 or more");
    steps as usize
}

fn newton(keys: &ProcedureKeys, report: &mut Report) -> Newton {
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

fn ramp(keys: &ProcedureKeys, steps: usize, report: &mut Report) -> Ramp {
    let duration = match &keys.duration {
        Some(time) => positive(time.0, "procedure.duration", report),
        None => {
            report.missing("procedure.duration", "dynamics needs an end: duration = \"2 s\"");
            f64::NAN
        }
    };
    let over = keys.over.as_ref().map(|q| q.0);
    let sound = over.is_none_or(|t| t >= 0.0);
    report.require(sound, "procedure.over", "is negative", "give \"0 s\" for at once, or leave it out");
    let damping = keys.damping.as_ref().map_or(0.0, |q| q.0);
    report.require(damping >= 0.0, "procedure.damping", "is negative", "give 0 /s or more, or leave it out");
    Ramp { duration, over, steps, damping }
}

fn explicit(keys: &ProcedureKeys, steps: usize, report: &mut Report) -> Explicit {
    let explicit = Explicit {
        ramp: ramp(keys, steps, report),
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

fn implicit(keys: &ProcedureKeys, steps: usize, tools: bool, report: &mut Report) -> Implicit {
    let implicit = Implicit {
        ramp: ramp(keys, steps, report),
        newton: newton(keys, report),
        inertia: keys.inertia.unwrap_or(true),
        spectral_radius: keys.spectral_radius.unwrap_or(spectral_radius(tools)),
        accuracy: keys.accuracy.as_ref().map(|q| positive(q.0, "procedure.accuracy", report)),
    };
    let sound = (0.0..=1.0).contains(&implicit.spectral_radius);
    let help = "1 dissipates nothing, 0 kills in one step what a step cannot resolve; 0.8 is usual";
    report.require(sound, "procedure.spectral-radius", "is not in [0, 1]", help);
    let moving = [
        ("damping", keys.damping.is_some()),
        ("spectral-radius", keys.spectral_radius.is_some()),
        ("accuracy", keys.accuracy.is_some()),
    ];
    for (name, _) in moving.into_iter().filter(|(_, given)| *given && !implicit.inertia) {
        let problem = Problem::new("is of a motion, and inertia = false has none").help("leave it out");
        report.add(&format!("procedure.{name}"), problem);
    }
    implicit
}
