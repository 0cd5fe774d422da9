//! Mutual demands of the parts of a scene.

use crate::exact::{Exact, SolutionEntry};
use catalogue::{Values, suggest};
use material::Material as _;

use super::field::{Prescribed, VectorField};
use super::material::medium;
use super::model::{Body, Load, LoadKind, Place, Scene, Support};
use super::output::{Check, Reference, Target};
use super::procedure::ProcedureKind;
use super::purpose::Purpose;
use super::report::{Report, which};
use catalogue::Problem;
use catalogue::metric::Needs;

/// Longest id of a method, characters: the id is part of file names.
const LONGEST_ID: usize = 64;

/// Reports every contradiction.
pub(crate) fn scene(scene: &Scene, report: &mut Report) {
    if scene.methods.is_empty() {
        report.add("method", Problem::new("is missing").help("add a [[method]] with id, family and size"));
    }
    for (i, method) in scene.methods.iter().enumerate() {
        if scene.methods[..i].iter().any(|other| other.id == method.id) {
            let problem = Problem::new("is the id of another method").found(&method.id);
            report.add(&format!("method[{i}].id"), problem.help("ids are unique"));
        }
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        // The id names files and folders, for which one or two dots have another meaning.
        let dots = method.id.chars().all(|c| c == '.');
        if dots || method.id.len() > LONGEST_ID || !method.id.chars().all(plain) {
            let help = format!("use up to {LONGEST_ID} letters, digits, '-', '_' and '.', not dots alone");
            let problem = Problem::new("is no id").help(help);
            report.add(&format!("method[{i}].id"), problem);
        }
    }
    if scene.purpose == Purpose::Published && scene.published.is_none() {
        report.missing("published", "name the published comparison: published = \"saghaei-2016\"");
    }
    for (i, region) in scene.regions.iter().enumerate() {
        if scene.regions[..i].iter().any(|other| other.name == region.name) {
            let problem = Problem::new("is the name of another region").help("names are unique");
            report.add(&format!("region[{i}].name"), problem);
        }
    }
    for (i, check) in scene.checks.iter().enumerate() {
        let key = format!("check[{i}]");
        self::check(check, scene, &key, report);
        if check.metric.needs == Needs::Levels {
            let problem = Problem::new("needs several levels").help("checks of orders belong into a study");
            report.add(&format!("{key}.metric"), problem);
        }
        if check.metric.needs == Needs::Seeds {
            let problem =
                Problem::new("needs many clouds").help("checks of shares belong into a study with seeds");
            report.add(&format!("{key}.metric"), problem);
        }
    }
    if let Some(id) = &scene.output.beside {
        known_methods(std::slice::from_ref(id), scene, "output.beside", report);
        if scene.output.transfers.is_empty() && !matches!(scene.reference, Some(Reference::Method { .. })) {
            let problem = Problem::new("has no points to be compared at");
            report
                .add("output.beside", problem.help("add output.transfer = { to = { file = \"...\" }, ... }"));
        }
    }
    match &scene.reference {
        Some(Reference::Method { id, .. }) => {
            known_methods(std::slice::from_ref(id), scene, "reference.method", report);
        }
        Some(Reference::Exact { entry, values }) => match exact(scene, entry, values) {
            Err(bad) => {
                let key = bad.parameter.map_or("reference".to_string(), |p| format!("reference.{p}"));
                report.add(&key, bad);
            }
            Ok(exact) => exact_fits(scene, entry.name, exact.as_ref(), report),
        },
        _ => {}
    }
    exact_words(scene, report);
    targets(scene, report);
}

/// The exact solution for the scene's own material.
fn exact(scene: &Scene, entry: &SolutionEntry, values: &Values) -> Result<Box<dyn Exact>, Problem> {
    let law = scene.material.law();
    let (lambda, mu) = (law.lambda(), law.mu());
    let own = |name: &str, limit: f64| scene.material.constant(name).unwrap_or(limit);
    let young = own("young", mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu));
    let poisson = own("poisson", 0.5 * lambda / (lambda + mu));
    (entry.build)(&medium(law, young, poisson)?, values)
}

/// Checks the demands of an exact solution on the scene.
fn exact_fits(scene: &Scene, name: &str, exact: &dyn Exact, report: &mut Report) {
    let kind = scene.procedure.kind();
    let mut add = |problem: String, help: &str| {
        report.add("reference.exact", Problem::new(problem).found(name).help(help));
    };
    if kind == ProcedureKind::Modes {
        if exact.vibrations().is_none() {
            let help = "take \"lame-cube\" or \"roller-box\", or leave the reference out";
            add("knows no vibrations".into(), help);
        }
    } else if exact.at(0.0).is_some() && scene.procedure.ramp().is_none() {
        let help = "take kind = \"explicit\" or \"implicit-dynamic\", or a solution at rest";
        add(format!("moves in time, which a {} procedure has not", kind.name()), help);
    }
    if exact.contact().is_some() && scene.tools.len() != 1 {
        add("is of one tool that presses".into(), "add a [[tool]], the only one");
    }
    let Some((_, large)) = scene.materials().find(|m| !m.1.law().is_small_strain()) else { return };
    if exact.is_large_strain() {
        return;
    }
    for (i, load) in scene.loads.iter().enumerate() {
        if let LoadKind::Traction(VectorField::Exact) | LoadKind::Body(VectorField::Exact) = load.kind {
            let problem =
                format!("takes the load of {name}, a solution at small strain, for the {} law", large.name());
            report.add(&format!("load[{i}]"), Problem::new(problem).help("take law = \"linear\""));
        }
    }
}

/// Checks that the target points of transfers exist.
fn targets(scene: &Scene, report: &mut Report) {
    let solved = is_solved(scene);
    for (i, transfer) in scene.output.transfers.iter().enumerate() {
        let (problem, help) = match transfer.to {
            Target::ReferenceNodes if !solved => (
                "has no nodes to go to",
                "add [reference] method = \"...\" or record = \"...\", or transfer to { file = \"...\" }",
            ),
            Target::Probes if scene.output.probes.is_empty() => {
                ("has no probes to go to", "add output.probes")
            }
            _ => continue,
        };
        let listed = format!("output.transfer[{i}]");
        let key = if report.origin().has(&listed) { listed } else { "output.transfer".into() };
        report.add(&format!("{key}.to"), Problem::new(problem).help(help));
    }
}

/// Whether probes can be compared with an exact solution over time.
fn moves(scene: &Scene) -> bool {
    scene.procedure.ramp().is_some()
        && !scene.output.probes.is_empty()
        && matches!(scene.reference, Some(Reference::Exact { .. }))
}

/// Whether the exact solution describes a contact.
fn presses(scene: &Scene) -> bool {
    let Some(Reference::Exact { entry, values }) = &scene.reference else { return false };
    exact(scene, entry, values).is_ok_and(|exact| exact.contact().is_some())
}

/// Whether the reference is a numerical solution, run or stored.
fn is_solved(scene: &Scene) -> bool {
    matches!(scene.reference, Some(Reference::Method { .. } | Reference::Record(_)))
}

/// Checks the demands of a check, in the scene or in a study, on the scene; `key` is the path of the check.
pub(crate) fn check(check: &Check, scene: &Scene, key: &str, report: &mut Report) {
    known_methods(&check.methods, scene, &format!("{key}.method"), report);
    let solved = is_solved(scene);
    let lacks = match check.metric.needs {
        Needs::Axis => "is counted along a [run.axis] of a study, and checked there",
        Needs::Reference | Needs::Levels if scene.reference.is_none() => "needs a [reference] in the scene",
        Needs::Probes if scene.reference.is_none() || scene.output.probes.is_empty() => {
            "needs a [reference] and output.probes in the scene"
        }
        Needs::Steps
            if matches!(
                scene.procedure.kind(),
                ProcedureKind::Linear | ProcedureKind::Modes | ProcedureKind::Prepare
            ) =>
        {
            "needs [procedure] kind = \"static\", \"explicit\" or \"implicit-dynamic\" in the scene"
        }
        Needs::Dynamics if scene.procedure.ramp().is_none() => {
            "needs [procedure] kind = \"explicit\" or \"implicit-dynamic\" in the scene"
        }
        Needs::Explicit if scene.procedure.kind() != ProcedureKind::Explicit => {
            "needs [procedure] kind = \"explicit\" in the scene"
        }
        Needs::Newton
            if !matches!(scene.procedure.kind(), ProcedureKind::Static | ProcedureKind::ImplicitDynamic) =>
        {
            "needs [procedure] kind = \"static\" or \"implicit-dynamic\" in the scene"
        }
        Needs::Modes if scene.procedure.kind() != ProcedureKind::Modes => {
            "needs [procedure] kind = \"modes\" in the scene"
        }
        Needs::ModesReference
            if scene.procedure.kind() != ProcedureKind::Modes || scene.reference.is_none() =>
        {
            "needs [procedure] kind = \"modes\" and [reference] exact = \"...\" in the scene"
        }
        Needs::Support if scene.supports.is_empty() => "needs a [[support]] in the scene",
        Needs::Mean if scene.output.means.is_empty() => "needs output.means in the scene",
        Needs::Tool if scene.tools.is_empty() => "needs a [[tool]] in the scene",
        Needs::ToolReference if scene.tools.is_empty() || !(solved || presses(scene)) => {
            "needs a [[tool]] and [reference] method or record, or exact = \"hertz\", in the scene"
        }
        Needs::ExactContact if !presses(scene) => {
            "needs a [[tool]] and [reference] exact = \"hertz\" in the scene"
        }
        Needs::ProbesReference if scene.output.probes.is_empty() || !solved => {
            "needs output.probes and [reference] method or record in the scene"
        }
        Needs::StepsReference
            if matches!(
                scene.procedure.kind(),
                ProcedureKind::Linear | ProcedureKind::Modes | ProcedureKind::Prepare
            ) || !matches!(scene.reference, Some(Reference::Method { .. })) =>
        {
            "needs [procedure] kind = \"static\" or dynamics, and [reference] method in the scene"
        }
        Needs::Exact if !moves(scene) => {
            "needs output.probes and dynamics with [reference] exact = \"...\" in the scene"
        }
        Needs::Motion if scene.procedure.ramp().is_none() || scene.output.probes.is_empty() => {
            "needs output.probes and dynamics in the scene"
        }
        Needs::Transfer if scene.output.transfers.is_empty() => "needs output.transfer in the scene",
        _ => return,
    };
    report.add(&format!("{key}.metric"), Problem::new(lacks).found(check.metric.name));
}

/// Checks that every id is the id of a method in the scene.
pub(crate) fn known_methods(ids: &[String], scene: &Scene, key: &str, report: &mut Report) {
    for id in ids.iter().filter(|id| scene.method(id).is_none()) {
        let help = which(id, scene.methods.iter().map(|m| m.id.as_str()));
        report.add(key, Problem::new("is not a method of this scene").found(id).help(help));
    }
}

/// Checks that a scene with the word "exact" has an exact solution.
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

/// Checks names of surfaces against the shape, even if other parts of the scene are not valid.
pub(crate) fn surfaces(body: &Body, supports: &[Support], loads: &[Option<Load>], report: &mut Report) {
    let Some(known) = body.surfaces() else { return };
    let supports = supports.iter().enumerate().map(|(i, s)| (format!("support[{i}].on"), &s.place));
    let loads = loads.iter().enumerate();
    let loads = loads.filter_map(|(i, load)| Some((format!("load[{i}].on"), &load.as_ref()?.place)));
    for (key, place) in supports.chain(loads) {
        let Place::On(names) = place else { continue };
        for name in names.iter().filter(|n| !known.contains(&n.as_str())) {
            let problem = format!("is not a surface of a {}", body.name());
            report.add(&key, Problem::new(problem).found(name).help(suggest(name, &known)));
        }
    }
}
