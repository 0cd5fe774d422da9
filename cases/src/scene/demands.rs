//! Contradictions between the parts of a scene, and between its checks and the scene.

use catalogue::metric::{self, Address, Needs};
use catalogue::{Problem, Values};
use material::Material as _;

use super::body::Body;
use super::check::{Bound, Check};
use super::condition::LoadKind;
use super::goal::Goal;
use super::material::medium;
use super::method::{Family, Fem, Method, Size};
use super::output::Output;
use super::procedure::{Procedure, ProcedureKind};
use super::purpose::Purpose;
use super::reference::Reference;
use super::report::{Report, which};
use super::scene::Scene;
use super::{condition, foundation, material as materials, method, timing, tool, training};
use crate::exact::{Exact, SolutionEntry};

/// Reports every contradiction.
pub(crate) fn scene(scene: &Scene, report: &Report) {
    let (procedure, kind) = (&scene.procedure, scene.procedure.kind());
    let reference = scene.reference.as_ref();
    for (key, material) in scene.materials() {
        material.demands(&scene.body, procedure, &report.at(&key));
    }
    materials::unique(&scene.regions, report);
    let has_exact = matches!(reference, Some(Reference::Exact { .. }));
    foundation::demands(&scene.foundations, procedure, report);
    condition::demands((&scene.supports, &scene.loads), procedure, has_exact, report);
    tool::demands(&scene.tools, procedure, report);
    timing::demands(scene, report);
    method::demands(&scene.methods, kind, !scene.regions.is_empty(), report);
    if let Some(id) = &scene.output.beside {
        known_methods(std::slice::from_ref(id), scene, "output.beside", report);
    }
    let regions = scene.regions.iter().map(|region| region.name.as_str());
    scene.output.check_regions(std::iter::once("body").chain(regions), &report.at("output"));
    scene.output.demands(kind, reference, &report.at("output"));
    if let Some(real_time) = &scene.real_time {
        real_time.demands(procedure, scene.staged().next(), &report.at("loop"));
    }
    if scene.output.bounds {
        bounds(scene, report);
    }
    goals(scene, report);
    training::demands(&scene.training, &scene.methods, &scene.supports, &scene.output, report);
    if let Some(reference) = reference {
        self::reference(reference, scene, report);
    }
    if scene.purpose == Purpose::Published && scene.published.is_none() {
        report.missing("published", "name the published comparison: published = \"saghaei-2016\"");
    }
    for (i, check) in scene.checks.iter().enumerate() {
        let report = report.at(&format!("check[{i}]"));
        self::check(check, scene, &report);
        let (problem, help) = match check.address.metric.needs {
            Needs::Levels => ("needs several levels", "checks of orders belong in a study"),
            Needs::Seeds => ("needs many clouds", "checks of fractions belong in a study with seeds"),
            _ => continue,
        };
        report.add("metric", Problem::new(problem).help(help));
    }
}

/// Reports numbers whose error can't be traced in the scene, and bodies whose meshes can't be refined.
fn goals(scene: &Scene, report: &Report) {
    let goal = |goal: &Goal, key: &str, report: &Report| {
        let count = [scene.output.means.len(), scene.output.probes.len()];
        goal.demands((&scene.supports, &scene.tools), count, key, report);
        if let Some(staged) = scene.staged().next() {
            let problem = format!("is not available with supports of a part of the loading, as {staged}");
            report.add(key, Problem::new(problem).help("leave one of them out"));
        }
    };
    if let Some(of) = &scene.output.error_of {
        goal(of, "error_of", &report.at("output"));
    }
    for (i, method) in scene.methods.iter().enumerate() {
        let Family::Fem(Fem { adapt: Some(adapt), .. }) = &method.family else { continue };
        let report = report.at(&format!("method[{i}].refine"));
        goal(&adapt.by, "by", &report);
        let at_rest = [ProcedureKind::Linear, ProcedureKind::Static].contains(&scene.procedure.kind());
        let help = "take [procedure] kind = \"linear\" or \"static\", or leave refine out";
        report.require(at_rest, "", "is for solutions at rest", help);
        let sound = matches!(scene.body, Body::Box { .. } | Body::File(_))
            || matches!(method.size(), Some(Size::File(_)));
        let problem =
            format!("refines boxes, bodies of files and meshes of files, not a {}", scene.body.name());
        report.require(sound, "", &problem, "leave refine out");
    }
}

/// Reports contradictions of the reference with the scene.
fn reference(reference: &Reference, scene: &Scene, report: &Report) {
    let at = report.at("reference");
    reference.demands(scene.procedure.kind(), &at);
    match reference {
        Reference::Exact { entry, values } => match exact(scene, entry, values) {
            Err(bad) => at.add(bad.parameter.unwrap_or(""), bad),
            Ok(exact) => exact_fits(scene, entry.name, exact.as_ref(), report),
        },
        Reference::Method { id, .. } => known_methods(std::slice::from_ref(id), scene, "method", &at),
        Reference::Record(_) => {}
    }
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

/// Reports demands of an exact solution that the scene does not meet.
fn exact_fits(scene: &Scene, name: &str, exact: &dyn Exact, report: &Report) {
    let kind = scene.procedure.kind();
    let add = |problem: String, help: &str| {
        report.add("reference.exact", Problem::new(problem).found(name).help(help));
    };
    if kind == ProcedureKind::Modes {
        if exact.vibrations().is_none() {
            let help = "take \"lame-cube\" or \"roller-box\", or leave the reference out";
            add("is not available for vibrations".into(), help);
        }
    } else if exact.at(0.0).is_some() && scene.procedure.ramp().is_none() {
        let help = "take kind = \"explicit\" or \"implicit-dynamic\", or a solution at rest";
        add(format!("depends on time, but a {} procedure has no time", kind.name()), help);
    }
    if exact.contact().is_some() && scene.tools.len() != 1 {
        add("needs exactly one tool".into(), "add a [[tool]], the only one");
    }
    let large = scene.materials().map(|(_, material)| material).find(|m| !m.law().is_small_strain());
    let Some(large) = large.filter(|_| !exact.is_large_strain()) else { return };
    for (i, _) in scene.loads.iter().enumerate().filter(|(_, load)| load.kind.is_exact()) {
        let large = large.name();
        let problem = format!("takes the load of {name}, a solution of small strain, but the law is {large}");
        report.add(&format!("load[{i}]"), Problem::new(problem).help("take law = \"linear\""));
    }
}

/// Whether the exact solution describes a contact.
fn presses(scene: &Scene) -> bool {
    let Some(Reference::Exact { entry, values }) = &scene.reference else { return false };
    exact(scene, entry, values).is_ok_and(|exact| exact.contact().is_some())
}

/// Reports demands of a check, in the scene or in a study, that the scene does not meet.
pub(crate) fn check(check: &Check, scene: &Scene, report: &Report) {
    known_methods(&check.methods, scene, "method", report);
    if [&metric::TIME, &metric::CPU_TIME].contains(&check.address.metric) {
        let problem = Problem::new("is recorded by phase").found(check.address.to_string());
        return report.add("metric", problem.help("take \"time-total\" or the time of another phase"));
    }
    match check.address.metric.needs {
        Needs::Run | Needs::Seeds => {}
        needs => match met(needs, scene) {
            (true, _) => number(check, scene, report),
            (false, missing) => {
                report.add("metric", Problem::new(missing).found(check.address.to_string()));
            }
        },
    }
}

/// Whether a scene meets a demand, and the words for what is missing if not.
fn met(needs: Needs, scene: &Scene) -> (bool, &'static str) {
    let (kind, reference) = (scene.procedure.kind(), scene.reference.as_ref());
    let (compared, solved) = (reference.is_some(), reference.is_some_and(Reference::is_solved));
    let (stepped, moves) = (!kind.has_no_steps(), scene.procedure.ramp().is_some());
    let vibrates = kind == ProcedureKind::Modes;
    let (touched, probed) = (!scene.tools.is_empty(), !scene.output.probes.is_empty());
    match needs {
        Needs::Run | Needs::Seeds => (true, ""),
        Needs::Axis => (false, "is a metric of a [run.axis] of a study; check the metric there"),
        Needs::Reference | Needs::Levels => (compared, "needs a [reference] in the scene"),
        Needs::Probes => (compared && probed, "needs a [reference] and output.probes in the scene"),
        Needs::Steps => (stepped, "needs [procedure] kind = \"static\" or dynamics in the scene"),
        Needs::Dynamics => {
            (moves, "needs a [procedure] of dynamics, such as kind = \"explicit\", in the scene")
        }
        Needs::Explicit => {
            (kind == ProcedureKind::Explicit, "needs [procedure] kind = \"explicit\" in the scene")
        }
        Needs::Frames => (
            scene.procedure.has_frames(),
            "needs [procedure] kind = \"vbd\", \"xpbd\" or \"implicit-cg\" in the scene",
        ),
        Needs::Reduced => (scene.methods.iter().any(|of| of.pod.is_some()), "needs a method with pod"),
        Needs::ToolLoop | Needs::PointLoop => in_real_time(needs, scene),
        Needs::Newton => (
            matches!(kind, ProcedureKind::Static | ProcedureKind::ImplicitDynamic),
            "needs [procedure] kind = \"static\" or \"implicit-dynamic\" in the scene",
        ),
        Needs::Modes => (vibrates, "needs [procedure] kind = \"modes\" in the scene"),
        Needs::ModesReference => (
            vibrates && compared,
            "needs [procedure] kind = \"modes\" and [reference] exact = \"...\" in the scene",
        ),
        Needs::Support => (!scene.supports.is_empty(), "needs a [[support]] in the scene"),
        Needs::Foundation => (!scene.foundations.is_empty(), "needs a [[foundation]] in the scene"),
        Needs::SupportMoment => (
            !scene.supports.is_empty() && scene.output.moments_about.is_some(),
            "needs a [[support]] and output.moments_about in the scene",
        ),
        Needs::ToolMoment => (
            touched && scene.output.moments_about.is_some(),
            "needs a [[tool]] and output.moments_about in the scene",
        ),
        Needs::Tool => (touched, "needs a [[tool]] in the scene"),
        Needs::ToolReference => (
            touched && (solved || presses(scene)),
            "needs a [[tool]] and [reference] method or record, or exact = \"hertz\", in the scene",
        ),
        Needs::ExactContact => {
            (presses(scene), "needs a [[tool]] and [reference] exact = \"hertz\" in the scene")
        }
        Needs::ProbesReference => {
            (probed && solved, "needs output.probes and [reference] method or record in the scene")
        }
        Needs::StepsReference => (
            stepped && matches!(reference, Some(Reference::Method { .. })),
            "needs [procedure] kind = \"static\" or dynamics, and [reference] method in the scene",
        ),
        Needs::Exact => (
            moves && probed && matches!(reference, Some(Reference::Exact { .. })),
            "needs output.probes and dynamics with [reference] exact = \"...\" in the scene",
        ),
        Needs::Motion => (moves && probed, "needs output.probes and dynamics in the scene"),
        Needs::Estimate
        | Needs::ToolEstimate
        | Needs::PointEstimate
        | Needs::SupportEstimate
        | Needs::ModeEstimate => estimated(needs, scene),
        Needs::Point
        | Needs::Stretch
        | Needs::Enclosed
        | Needs::RegionEnergy
        | Needs::Transfer
        | Needs::Trace
        | Needs::Mean
        | Needs::Bounds
        | Needs::MeanBounds => of_output(needs, scene),
    }
}

/// Whether the scene has what a metric of its loop in real time needs, and what that is.
fn in_real_time(needs: Needs, scene: &Scene) -> (bool, &'static str) {
    let plays = scene.real_time.is_some();
    match needs {
        Needs::ToolLoop => (plays && !scene.tools.is_empty(), "needs a [[tool]] and a [loop] in the scene"),
        _ => (plays && !scene.output.probes.is_empty(), "needs output.probes and a [loop] in the scene"),
    }
}

/// Reports a metric of uncertain inputs that a run of the scene does not give.
pub(crate) fn varied(address: Address, scene: &Scene, report: &Report) {
    if matches!(address.metric.needs, Needs::Levels | Needs::Seeds) {
        return report.add(
            "",
            Problem::new("is of several runs").found(address.to_string()).help("name a metric of one run"),
        );
    }
    if matches!(address.metric.kind, metric::Kind::Phase(_)) {
        let problem = Problem::new("depends on the machine").found(address.to_string());
        return report.add("", problem.help("name a metric of the solution"));
    }
    let bound = Bound::Within { at_least: None, at_most: None };
    check(&Check { address, methods: Vec::new(), bound, at: String::new() }, scene, report);
}

/// Reports the parts of a scene for which no strict bounds are known.
fn bounds(scene: &Scene, report: &Report) {
    let refuse = |sound: bool, key: &str, problem: &str, help: &str| {
        if !sound {
            report.add(key, Problem::new(problem).help(help));
        }
    };
    let own = "output.bounds";
    let kind = scene.procedure.kind();
    let problem = format!("is for linear elasticity, not for a {} procedure", kind.name());
    let help = "take [procedure] kind = \"linear\", or leave it out";
    refuse(kind == ProcedureKind::Linear, own, &problem, help);
    let is_file = |method: &Method| matches!(method.size(), Some(Size::File(_)));
    let filled = match &scene.body {
        Body::Box { .. } => true,
        Body::File(_) => scene.methods.iter().all(is_file),
        _ => false,
    };
    let problem = format!("needs a body that tetrahedra fill exactly, not a {}", scene.body.name());
    refuse(filled, own, &problem, "take a box, or a mesh file as the body and as the size of each method");
    refuse(scene.tools.is_empty(), own, "is not available with tools", "move a support instead");
    refuse(
        scene.foundations.is_empty(),
        own,
        "is not available with a [[foundation]]",
        "leave one of them out",
    );
    let staged = scene.supports.iter().any(|support| support.during.is_some());
    refuse(!staged, own, "is not available with supports of a part of the loading", "leave one of them out");
    for (key, material) in scene.materials() {
        let elastic = material.prony.is_empty() && material.active == 0.0;
        let problem = format!("is for elastic tissue at rest, and {key} is viscous or active");
        refuse(elastic, own, &problem, "leave one of them out");
    }
    for (i, load) in scene.loads.iter().enumerate() {
        let problem = match load.kind {
            LoadKind::Body(_) => "has no strict bounds: the stress of the bounds balances no body force",
            LoadKind::Points { .. } => {
                "has no strict bounds: the exact energy of a force at a point is infinite"
            }
            _ => continue,
        };
        refuse(false, &format!("load[{i}]"), problem, "load a surface, or leave output.bounds out");
    }
}

/// Whether the scene has what a metric of an estimate needs, and what it needs.
fn estimated(needs: Needs, scene: &Scene) -> (bool, &'static str) {
    let (has, needs) = match needs {
        Needs::ToolEstimate => {
            (!scene.tools.is_empty(), "needs output.estimate = true and a [[tool]] in the scene")
        }
        Needs::PointEstimate => {
            (!scene.output.probes.is_empty(), "needs output.estimate = true and output.probes in the scene")
        }
        Needs::SupportEstimate => {
            (!scene.supports.is_empty(), "needs output.estimate = true and a [[support]] in the scene")
        }
        Needs::ModeEstimate => (
            matches!(scene.procedure, Procedure::Modes { .. }),
            "needs output.estimate = true and [procedure] kind = \"modes\" in the scene",
        ),
        _ => (
            !matches!(scene.procedure, Procedure::Modes { .. }),
            "needs output.estimate = true and displacements in the scene",
        ),
    };
    (has && scene.output.estimate, needs)
}

/// Whether the scene has what a metric of means or strict bounds needs, and what it needs.
fn of_output(needs: Needs, scene: &Scene) -> (bool, &'static str) {
    let Output { bounds, means, .. } = &scene.output;
    match needs {
        Needs::Point => (!scene.output.probes.is_empty(), "needs output.probes in the scene"),
        Needs::Stretch => (!scene.output.stretches.is_empty(), "needs output.stretches in the scene"),
        Needs::Enclosed => (!scene.output.volumes.is_empty(), "needs output.volumes in the scene"),
        Needs::RegionEnergy => (!scene.output.energies.is_empty(), "needs output.energies in the scene"),
        Needs::Transfer => (!scene.output.transfers.is_empty(), "needs output.transfer in the scene"),
        Needs::Trace => (scene.output.error_of.is_some(), "needs output.error_of in the scene"),
        Needs::MeanBounds => {
            (*bounds && !means.is_empty(), "needs output.bounds = true and output.means in the scene")
        }
        Needs::Mean => (!means.is_empty(), "needs output.means in the scene"),
        _ => (*bounds, "needs output.bounds = true in the scene"),
    }
}

/// Reports a number of a support, point, tool and the like that the scene does not have.
fn number(check: &Check, scene: &Scene, report: &Report) {
    let (count, what) = numbered(check.address.metric.needs, scene);
    if let Some(index) = check.address.index.filter(|index| *index > count as u64) {
        let problem = Problem::new(format!("needs {what} number {index}, but the scene has {count}"));
        report.add("metric", problem.found(check.address.to_string()));
    }
}

/// Number of the things in the scene that a metric's number counts, and what they are.
fn numbered(needs: Needs, scene: &Scene) -> (usize, &'static str) {
    match needs {
        Needs::Support | Needs::SupportMoment | Needs::SupportEstimate => (scene.supports.len(), "support"),
        Needs::Foundation => (scene.foundations.len(), "foundation"),
        Needs::ModeEstimate => match scene.procedure {
            Procedure::Modes { count } => (count, "mode"),
            _ => (0, "mode"),
        },
        Needs::Mean | Needs::MeanBounds => (scene.output.means.len(), "face in output.means"),
        Needs::Point | Needs::Motion | Needs::PointEstimate => {
            (scene.output.probes.len(), "point in output.probes")
        }
        Needs::Stretch => (scene.output.stretches.len(), "entry of output.stretches"),
        Needs::RegionEnergy => (scene.output.energies.len(), "region in output.energies"),
        Needs::Enclosed => (scene.output.volumes.len(), "surface in output.volumes"),
        Needs::ToolLoop | Needs::PointLoop => {
            (scene.real_time.as_ref().map_or(0, |of| of.rates.len()), "rate in loop.rates")
        }
        _ => (scene.tools.len(), "tool"),
    }
}

/// Reports ids that are not ids of methods in the scene.
pub(crate) fn known_methods(ids: &[String], scene: &Scene, key: &str, report: &Report) {
    for id in ids.iter().filter(|id| scene.method(id).is_none()) {
        let help = which(id, scene.methods.iter().map(|m| m.id.as_str()));
        report.add(key, Problem::new("is not a method of this scene").found(id).help(help));
    }
}
