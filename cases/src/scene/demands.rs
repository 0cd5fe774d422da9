//! Mutual demands of the procedure and the other parts of a scene.

use super::field::{Prescribed, ScalarField};
use super::method::{Cloud, Dilation, Efg, Element, Essential, Family, Regions};
use super::model::Scene;
use super::output::Reference;
use super::procedure::{Procedure, ProcedureKind};
use super::report::Report;
use super::tool::Drive;
use catalogue::Problem;
use material::Material as _;

/// Reports every contradiction.
pub(crate) fn scene(scene: &Scene, report: &mut Report) {
    laws(scene, report);
    tools(scene, report);
    mixed(scene, report);
    held(scene, report);
    unsolved(scene, report);
    parted(scene, report);
    refined(scene, report);
    vibrating(scene, report);
    if scene.output.repeated.is_some() {
        let at_rest = matches!(scene.procedure.kind(), ProcedureKind::Linear | ProcedureKind::Static);
        let help = "take [procedure] kind = \"linear\" or \"static\", or leave it out";
        report.require(
            at_rest || scene.procedure.kind() == ProcedureKind::Prepare,
            "output.repeated",
            "is of solutions at rest, not of motion",
            help,
        );
    }
    if let Some(ramp) = scene.procedure.ramp() {
        let massless = matches!(&scene.procedure, Procedure::ImplicitDynamic(implicit) if !implicit.inertia);
        for (key, material) in scene.materials().filter(|m| !massless && m.1.density.is_none()) {
            let help =
                format!("the {} law needs its mass in dynamics: density = \"1000 kg/m^3\"", material.name());
            report.missing(&format!("{key}.density"), &help);
        }
        let moves = |p: &Prescribed| !matches!(p, Prescribed::Field(ScalarField::Constant(0.0)));
        let led = scene.supports.iter().position(|s| s.motion.iter().flatten().any(moves));
        if let (Some(i), false, Some(0.0)) = (led, massless, ramp.over) {
            let help = "a mass can't jump: give the time it takes";
            let problem = format!("is no time for support[{i}] to move in");
            report.add("procedure.over", Problem::new(problem).help(help));
        }
    }
}

/// The problem if the procedure does not support this essential condition of a cloud; `None` if it does.
pub(super) fn unheld(essential: &Essential, kind: ProcedureKind) -> Option<Problem> {
    let linear = matches!(kind, ProcedureKind::Linear | ProcedureKind::Modes | ProcedureKind::Prepare);
    let (Essential::Nitsche { .. } | Essential::Multipliers | Essential::Elimination { .. }) = essential
    else {
        return None;
    };
    let problem = format!("serves linear procedures and modes, not kind = \"{}\"", kind.name());
    (!linear).then(|| Problem::new(problem).help("take \"penalty\" or \"coupling\""))
}

/// Checks the essential conditions of clouds.
fn held(scene: &Scene, report: &mut Report) {
    let kind = scene.procedure.kind();
    // A cloud in explicit dynamics is refused elsewhere.
    for (i, method) in scene.methods.iter().enumerate().filter(|_| kind != ProcedureKind::Explicit) {
        let Family::Efg(efg) = &method.family else { continue };
        if let Some(problem) = unheld(&efg.essential, kind) {
            let table = format!("method[{i}].essential.method");
            let key = if report.origin().has(&table) { table } else { format!("method[{i}].essential") };
            report.add(&key, problem);
        }
    }
}

/// Refuses separate regions in a scene with one material, which has no borders.
fn parted(scene: &Scene, report: &mut Report) {
    for (i, method) in scene.methods.iter().enumerate() {
        let Family::Efg(Efg { regions: Regions::Separate, .. }) = &method.family else { continue };
        report.require(
            !scene.regions.is_empty(),
            &format!("method[{i}].regions"),
            "is of the borders between material regions, and the scene has no [[region]]",
            "leave it out",
        );
    }
}

/// Refuses clouds refined by their error in nonlinear procedures: each refinement needs another solution.
fn refined(scene: &Scene, report: &mut Report) {
    for (i, method) in scene.methods.iter().enumerate() {
        let Family::Efg(Efg { cloud: Cloud::Refined { .. }, .. }) = &method.family else { continue };
        report.require(
            scene.procedure.kind() == ProcedureKind::Linear,
            &format!("method[{i}].cloud.refine"),
            "wants a solution at every step, which only a linear procedure is cheap enough for",
            "take [procedure] kind = \"linear\", or leave refine out",
        );
    }
}

/// Refuses output of displacements if nothing is solved.
fn unsolved(scene: &Scene, report: &mut Report) {
    if scene.procedure.kind() != ProcedureKind::Prepare {
        return;
    }
    let output = &scene.output;
    for (key, given) in [
        ("reference", scene.reference.is_some()),
        ("output.probes", !output.probes.is_empty()),
        ("output.means", !output.means.is_empty()),
        ("output.transfer", !output.transfers.is_empty()),
        ("output.beside", output.beside.is_some()),
        ("output.repeated", output.repeated.is_some()),
    ] {
        let help = "leave it out, or take [procedure] kind = \"linear\"";
        report.require(!given, key, "is of a displacement, and kind = \"prepare\" solves for none", help);
    }
}

/// Checks scenes of free vibrations: they need mass and stiffness only, and report no displacements.
fn vibrating(scene: &Scene, report: &mut Report) {
    let vibrates = scene.procedure.kind() == ProcedureKind::Modes;
    for (i, method) in scene.methods.iter().enumerate() {
        let key = format!("method[{i}].mass");
        let ours = !matches!(method.family, Family::External(_));
        if vibrates && method.mass.is_none() && ours {
            report.missing(&key, "add mass = \"consistent\", \"lumped\" or \"transformed\"");
        }
        let help = "leave it out, or take [procedure] kind = \"modes\"";
        report.require(vibrates || method.mass.is_none(), &key, "is of vibrations alone", help);
    }
    if !vibrates {
        return;
    }
    for (key, _) in scene.materials().filter(|m| m.1.density.is_none()) {
        report.missing(&format!("{key}.density"), "vibrations need a mass: density = \"1000 kg/m^3\"");
    }
    let still = |p: &Prescribed| matches!(p, Prescribed::Field(ScalarField::Constant(0.0)));
    for (i, support) in scene.supports.iter().enumerate() {
        let holds = support.motion.iter().flatten().all(still);
        let help = "hold it: fix = \"xyz\"";
        report.require(holds, &format!("support[{i}].move"), "moves what vibrates freely", help);
    }
    let output = &scene.output;
    for (key, given) in [
        ("load[0]", !scene.loads.is_empty()),
        ("output.probes", !output.probes.is_empty()),
        ("output.means", !output.means.is_empty()),
        ("output.transfer", !output.transfers.is_empty()),
        ("output.beside", output.beside.is_some()),
        ("reference", matches!(scene.reference, Some(Reference::Method { .. } | Reference::Record(_)))),
    ] {
        let help = "leave it out: vibrations are compared with an exact solution of them, or with none";
        report.require(!given, key, "has no part in free vibrations", help);
    }
}

fn laws(scene: &Scene, report: &mut Report) {
    for (key, material) in scene.materials() {
        let small = matches!(scene.procedure.kind(), ProcedureKind::Linear | ProcedureKind::Modes);
        if small && !material.law().is_small_strain() {
            let problem = Problem::new("is a law of large strain, but the procedure is linear");
            let help = "add [procedure] kind = \"static\" and steps = 10, or take law = \"linear\"";
            report.add(&format!("{key}.law"), problem.found(material.name()).help(help));
        }
        if !material.prony.is_empty() && scene.procedure.ramp().is_none() {
            let problem =
                format!("relaxes over time, which a {} procedure has not", scene.procedure.kind().name());
            let help = "leave it out: young and poisson are then the moduli of the load's own duration";
            report.add(&format!("{key}.prony"), Problem::new(problem).help(help));
        }
    }
}

fn tools(scene: &Scene, report: &mut Report) {
    for (i, tool) in scene.tools.iter().enumerate() {
        let at = |name: &str| format!("tool[{i}].{name}");
        if matches!(scene.procedure.kind(), ProcedureKind::Linear | ProcedureKind::Modes) {
            let problem =
                Problem::new(format!("'{}' touches the body, but the procedure is linear", tool.name));
            let help = "contact is not linear: add [procedure] kind = \"static\" and steps = 10";
            report.add(&format!("tool[{i}]"), problem.help(help));
        }
        if scene.tools[..i].iter().any(|other| other.name == tool.name) {
            report.add(&at("name"), Problem::new("is the name of another tool").help("names are unique"));
        }
        if tool.over.is_some() && scene.procedure.ramp().is_none() {
            let help =
                format!("a {} procedure has no time axis: leave it out", scene.procedure.kind().name());
            report.add(&at("drive.over"), Problem::new("is the time of a ramp").help(help));
        }
        if matches!(tool.drive, Drive::Pressure(_)) && tool.shape.face_area(&tool.along.into()).is_none() {
            let help =
                "only a rounded-box that closes along x, y or z has a face of a known area; give force";
            report.add(&at("drive.pressure"), Problem::new("has no face to act on").help(help));
        }
    }
}

/// Requires elements of second order for a mixed pressure field: linear between corners, it is stable with
/// these only.
fn mixed(scene: &Scene, report: &mut Report) {
    for (i, method) in scene.methods.iter().enumerate() {
        let Family::Fem(fem) = &method.family else { continue };
        if fem.dilation == Dilation::Mixed && matches!(fem.element, Element::Tet4 | Element::Hex8) {
            let problem = format!("has no stable pressure field with {}", fem.element.name());
            let help = "take tet10 or hex20, or \"nodal-mean\" (tet4) or \"element-mean\" (hex8)";
            report.add(&format!("method[{i}].dilation"), Problem::new(problem).found("mixed").help(help));
        }
    }
}
