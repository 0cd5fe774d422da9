//! Contradictions between curves, the parts of the scene that follow them, and the procedure.

use std::sync::Arc;

use catalogue::Problem;
use shape::Curve;

use super::condition::Span;
use super::curve::NamedCurve;
use super::drive::Drive;
use super::procedure::ProcedureKind;
use super::report::Report;
use super::scene::Scene;

/// Reports contradictions of the curves with each other, with the conditions that name them, and with the
/// procedure.
pub(crate) fn demands(scene: &Scene, report: &Report) {
    let kind = scene.procedure.kind();
    for (i, NamedCurve { name, curve, in_time }) in scene.curves.iter().enumerate() {
        let report = report.at(&format!("curve[{i}]"));
        if scene.curves[..i].iter().any(|other| other.name == *name) {
            report.add("name", Problem::new("is the name of another curve").help("names are unique"));
        }
        if !scene.curved().any(|(_, used)| Arc::ptr_eq(used, curve)) {
            let help = format!("give curve = \"{name}\" to a load, support or drive, or leave it out");
            report.add("name", Problem::new("is named by no load, support or tool").help(&help));
        }
        let dynamic = scene.procedure.ramp().is_some();
        match (kind, in_time) {
            (ProcedureKind::Static, true) => {
                let help = "give part, the fractions of the loading from 0 to 1";
                report.add("time", Problem::new("is a time, but a static procedure has none").help(help));
            }
            (ProcedureKind::Static, false) => parts(curve, &report),
            (_, false) if dynamic => {
                let help = "give time, such as time = [\"0 s\", \"1 s\"]";
                report.add("part", Problem::new("belongs to a static procedure").help(help));
            }
            (_, true) if dynamic => {}
            _ => {
                let problem = format!("is a course in time, but a {} procedure has none", kind.name());
                report.add("", Problem::new(problem).help("take kind = \"static\" and steps = 10"));
            }
        }
    }
    if scene.procedure.has_inertia() {
        from_rest(scene, report);
    }
    for (i, support) in scene.supports.iter().enumerate() {
        let sound = support.curve.is_none() || support.moves();
        let help = "leave it out; for a support that begins late or ends early, give during";
        report.require(sound, &format!("support[{i}].curve"), "has no motion that follows it", help);
        if let Some(span) = support.during {
            during(span, scene, &report.at(&format!("support[{i}]")));
        }
    }
    let courses = scene.curved().map(|(key, _)| key).chain(scene.staged());
    if let (true, Some(key)) = (scene.output.repeated.is_some(), courses.into_iter().next()) {
        let problem = format!("repeats a load that grows in proportion, and this scene has {key}");
        report.add("output.repeated", Problem::new(problem).help("leave one of them out"));
    }
    if let (true, Some(key)) = (scene.output.estimate, scene.staged().next()) {
        let problem = format!("is not available with supports of a part of the loading, as {key}");
        report.add("output.estimate", Problem::new(problem).help("leave one of them out"));
    }
    for (i, tool) in scene.tools.iter().enumerate() {
        let pulls = |curve: &Arc<Curve>| curve.points().iter().any(|point| point[1] < 0.0);
        let forced = !matches!(tool.drive, Drive::Closure(_));
        if forced && tool.curve.as_ref().is_some_and(pulls) {
            let help = "give factors of 0 or more";
            let problem = Problem::new("turns the force around, and a tool can't pull").help(help);
            report.add(&format!("tool[{i}].drive.curve"), problem);
        }
    }
}

/// Requires a part of the loading of a procedure in which supports may begin or end.
fn during(span: Span, scene: &Scene, report: &Report) {
    let kind = scene.procedure.kind();
    let end = match kind {
        ProcedureKind::Static => 1.0,
        ProcedureKind::ImplicitDynamic | ProcedureKind::Explicit => scene.procedure.duration().unwrap_or(0.0),
        _ => {
            let problem = format!("is not available in a {} procedure", kind.name());
            let help = "take kind = \"static\", \"implicit-dynamic\" or \"explicit\", or leave it out";
            return report.add("during", Problem::new(problem).help(help));
        }
    };
    let is_timed = kind != ProcedureKind::Static;
    if span.in_time != is_timed {
        let (problem, help) = match is_timed {
            true => {
                ("has fractions, but the procedure goes on in time", "give times, such as [\"0 s\", \"2 s\"]")
            }
            false => ("has times, but a static procedure has none", "give fractions, such as [0.4, 1]"),
        };
        return report.add("during", Problem::new(problem).help(help));
    }
    let Span { from, until, .. } = span;
    if !(0.0 <= from && from < until && until <= end) {
        let unit = if is_timed { " s" } else { "" };
        let problem =
            format!("goes from {from}{unit} to {until}{unit}, and the loading from 0{unit} to {end}{unit}");
        let help = "give a start and a later end within the loading";
        report.add("during", Problem::new(problem).help(help));
    } else if scene.procedure.has_inertia() && from > 0.0 {
        let help = "let it start at \"0 s\", or take inertia = false";
        report.add("during", Problem::new("begins late, and a moving mass can't stop at once").help(help));
    }
}

/// Requires fractions of the loading.
fn parts(curve: &Curve, report: &Report) {
    let mut parts = curve.points().iter().map(|point| point[0]);
    if let Some(part) = parts.find(|part| !(0.0..=1.0).contains(part)) {
        let problem = format!("has the fraction {part}, and the loading goes from 0 to 1");
        report.add("part", Problem::new(problem).help("give fractions from 0 to 1"));
    }
}

/// Requires that curves of a body with mass start without a jump, and that those of its supports are smooth.
fn from_rest(scene: &Scene, report: &Report) {
    let implicit = scene.procedure.kind() == ProcedureKind::ImplicitDynamic;
    for (i, support) in scene.supports.iter().enumerate().filter(|(_, support)| support.moves()) {
        let Some(curve) = &support.curve else { continue };
        let key = format!("support[{i}].curve");
        let help = "let its factor be 0 at the start";
        report.require(curve.value(0.0) == 0.0, &key, "starts with a jump, and a mass can't jump", help);
        let help = "add smooth = true to the curve";
        let sound = !implicit || curve.is_smooth();
        report.require(sound, &key, "has kinks, at which the acceleration of a mass is infinite", help);
    }
    for (i, tool) in scene.tools.iter().enumerate() {
        let (Some(curve), Drive::Closure(_)) = (&tool.curve, tool.drive) else { continue };
        let help = "let its factor be 0 at the start";
        let key = format!("tool[{i}].drive.curve");
        report.require(curve.value(0.0) == 0.0, &key, "starts with a jump into the body", help);
    }
}
