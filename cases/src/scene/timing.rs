//! Contradictions between curves, the parts of the scene that follow them, and the procedure.

use std::sync::Arc;

use catalogue::Problem;
use shape::Curve;

use super::curve::NamedCurve;
use super::procedure::ProcedureKind;
use super::report::Report;
use super::scene::Scene;
use super::tool::Drive;

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
        let help = "leave it out: a support can't be released, and holds throughout";
        report.require(sound, &format!("support[{i}].curve"), "has no motion that follows it", help);
    }
    if scene.output.repeated.is_some() && scene.curved().next().is_some() {
        let problem = Problem::new("repeats a load that grows in proportion, and this scene has curves");
        report.add("output.repeated", problem.help("leave the curves out, or this key"));
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
