//! What a scene's parts demand of each other.

use super::error::{Problem, suggest};
use super::field::{Prescribed, VectorField};
use super::metric::Needs;
use super::model::{LoadKind, Place, Scene};
use super::output::{Reference, Target};
use super::report::{Report, which};

/// Notes every contradiction.
pub(crate) fn scene(scene: &Scene, report: &mut Report) {
    if scene.methods.is_empty() {
        report.add("method", Problem::new("is missing").help("add a [[method]] with id, family and size"));
    }
    let ids = || scene.methods.iter().map(|m| m.id.as_str());
    for (i, method) in scene.methods.iter().enumerate() {
        if scene.methods[..i].iter().any(|other| other.id == method.id) {
            let problem = Problem::new("is the id of another method").found(&method.id);
            report.add(&format!("method[{i}].id"), problem.help("ids are unique"));
        }
    }
    for (i, check) in scene.checks.iter().enumerate() {
        for id in check.methods.iter().filter(|id| scene.method(id).is_none()) {
            let problem = Problem::new("is not a method of this scene").found(id).help(which(id, ids()));
            report.add(&format!("check[{i}].method"), problem);
        }
        let lacks = match check.metric.needs {
            Needs::Run => None,
            Needs::Reference if scene.reference.is_none() => Some("needs a [reference]"),
            Needs::Probes if scene.reference.is_none() || scene.output.probes.is_empty() => {
                Some("needs a [reference] and output.probes")
            }
            Needs::Transfer if scene.output.transfers.is_empty() => Some("needs output.transfer"),
            Needs::Levels => Some("needs several levels: it belongs into a study"),
            _ => None,
        };
        if let Some(lack) = lacks {
            report.add(&format!("check[{i}].metric"), Problem::new(lack).found(check.metric.name));
        }
    }
    match &scene.reference {
        Some(Reference::Method { id, .. }) if scene.method(id).is_none() => {
            let problem = Problem::new("is not a method of this scene").found(id).help(which(id, ids()));
            report.add("reference.method", problem);
        }
        Some(Reference::Exact { name, .. }) => {
            let known: Vec<&str> = crate::exact::exact_names().collect();
            if !known.contains(&name.as_str()) {
                let problem =
                    Problem::new("is not an exact solution").found(name).help(suggest(name, &known));
                report.add("reference.exact", problem);
            }
        }
        _ => {}
    }
    exact_words(scene, report);
    surfaces(scene, report);
    let to_nodes = scene.output.transfers.iter().any(|t| t.to == Target::ReferenceNodes);
    if to_nodes && !matches!(scene.reference, Some(Reference::Method { .. })) {
        let help = "add [reference] method = \"...\", or transfer to { file = \"...\" }";
        report.add(
            "output.transfer",
            Problem::new("goes to the reference's nodes, and there are none").help(help),
        );
    }
    if scene.output.transfers.iter().any(|t| t.to == Target::Probes) && scene.output.probes.is_empty() {
        report.add(
            "output.transfer",
            Problem::new("goes to probes, and there are none").help("add output.probes"),
        );
    }
}

/// "exact" needs an exact solution.
fn exact_words(scene: &Scene, report: &mut Report) {
    if matches!(scene.reference, Some(Reference::Exact { .. })) {
        return;
    }
    let help = "add [reference] exact = \"...\"";
    for (i, support) in scene.supports.iter().enumerate() {
        if support.motion.iter().flatten().any(|m| matches!(m, Prescribed::Exact)) {
            report.add(
                &format!("support[{i}].move"),
                Problem::new("has no exact solution to follow").help(help),
            );
        }
    }
    for (i, load) in scene.loads.iter().enumerate() {
        if let LoadKind::Traction(VectorField::Exact) | LoadKind::Body(VectorField::Exact) = load.kind {
            report.add(&format!("load[{i}]"), Problem::new("has no exact solution to follow").help(help));
        }
    }
}

/// Names of surfaces are those of the shape.
fn surfaces(scene: &Scene, report: &mut Report) {
    let Some(known) = scene.body.surfaces() else { return };
    let supports = scene.supports.iter().enumerate().map(|(i, s)| (format!("support[{i}].on"), &s.place));
    let loads = scene.loads.iter().enumerate().map(|(i, l)| (format!("load[{i}].on"), &l.place));
    for (key, place) in supports.chain(loads) {
        let Place::On(names) = place else { continue };
        for name in names.iter().filter(|n| !known.contains(&n.as_str())) {
            let problem = format!("is not a surface of a {}", scene.body.name());
            report.add(&key, Problem::new(problem).found(name).help(suggest(name, known)));
        }
    }
}
