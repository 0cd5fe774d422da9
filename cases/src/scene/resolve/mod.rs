//! From the keys of a file to the types the program works with; every finding is noted at its key.

mod condition;
mod material;
mod method;
mod output;
mod tool;

use super::keys::{BodyKeys, Names, ProcedureKeys, SceneKeys};
use super::method::{MeshFile, Method};
use super::model::{Body, MaterialRegion, Scene};
use super::procedure::{Explicit, Implicit, MODES, Newton, OnStall, Procedure, ProcedureKind};
use super::report::Report;
use super::units::{Dim, Q};
use catalogue::Problem;
use condition::{load, place, support};
use material::material;
use method::method;
pub(crate) use method::{essential, integration};
pub(crate) use output::checks;
use output::{output, reference};
use tool::tool;

/// Unit of a mesh file's numbers unless the scene gives another: what CAD programs and Gmsh models of organs are in.
const MILLIMETRE: f64 = 1e-3;

/// `None` only together with findings.
pub(crate) fn scene(keys: SceneKeys, report: &mut Report) -> Option<Scene> {
    let body = body(keys.body, report);
    let material = material(keys.material, "material", report);
    let regions = keys.region.into_iter().enumerate().map(|(i, r)| {
        let key = format!("region[{i}]");
        let place = place(r.on, r.place, &key, report, true);
        let material = self::material(r.material, &format!("{key}.material"), report);
        Some(MaterialRegion { name: r.name, place, material: material? })
    });
    let regions: Vec<Option<MaterialRegion>> = regions.collect();
    let supports = keys.support.into_iter().enumerate().map(|(i, s)| support(s, i, report)).collect();
    let loads = keys.load.into_iter().enumerate().filter_map(|(i, l)| load(l, i, report)).collect();
    let procedure = procedure(keys.procedure, !keys.tool.is_empty(), report);
    let tools = keys.tool.into_iter().enumerate().filter_map(|(i, t)| tool(t, i, report)).collect();
    let methods: Vec<Method> =
        keys.method.into_iter().enumerate().filter_map(|(i, m)| method(m, i, report)).collect();
    let output = output(keys.output, report);
    let reference = keys.reference.and_then(|r| reference(r, report));
    let checks = checks(keys.check, "check", report);
    report.require(!keys.title.trim().is_empty(), "title", "is empty", "say in one line what the scene is");
    Some(Scene {
        title: keys.title,
        source: keys.source,
        purpose: keys.purpose,
        published: keys.published,
        body: body?,
        material: material?,
        regions: regions.into_iter().collect::<Option<_>>()?,
        supports,
        loads,
        tools,
        procedure,
        methods,
        output,
        reference,
        checks,
        origin: report.origin().clone(),
    })
}

pub(super) fn raw<D: Dim>(q: [Q<D>; 3]) -> [f64; 3] {
    q.map(|q| q.0)
}

pub(super) fn positive(value: f64, key: &str, report: &mut Report) -> f64 {
    report.require(value > 0.0, key, "is not positive", "give a value above zero");
    value
}

pub(super) fn names(names: Names) -> Vec<String> {
    match names {
        Names::One(name) => vec![name],
        Names::Several(names) => names,
    }
}

pub(super) fn mesh_file(path: &str, unit: f64, key: &str, report: &mut Report) -> MeshFile {
    let path = report.path(path);
    if !path.is_file() {
        let help = format!("no file at {}; paths are relative to the scene's folder", path.display());
        report.add(key, Problem::new("can't be found").help(help));
    }
    MeshFile { path, unit }
}

fn body(keys: BodyKeys, report: &mut Report) -> Option<Body> {
    Some(match keys {
        BodyKeys::Box { min, max, size } => {
            let (min, max) = match (min, max, size) {
                (Some(min), Some(max), None) => (raw(min), raw(max)),
                (min, None, Some(size)) => {
                    let (min, size) = (min.map_or([0.0; 3], raw), raw(size));
                    (min, std::array::from_fn(|a| min[a] + size[a]))
                }
                (_, Some(_), Some(_)) => {
                    let help = "give min and max, or size alone (with a corner at the origin, or at min)";
                    report.add("body.size", Problem::new("stands beside max").help(help));
                    return None;
                }
                _ => {
                    report.missing(
                        "body.size",
                        "give size = [\"40 mm\", \"40 mm\", \"20 mm\"], or min and max",
                    );
                    return None;
                }
            };
            let holds = (0..3).all(|a| max[a] > min[a]);
            report.require(holds, "body", "has no volume", "every extent must be above zero");
            Body::Box { min, max }
        }
        BodyKeys::Cylinder { radius, height } => Body::Cylinder {
            radius: positive(radius.0, "body.radius", report),
            height: positive(height.0, "body.height", report),
        },
        BodyKeys::Ball { radius } => Body::Ball { radius: positive(radius.0, "body.radius", report) },
        BodyKeys::SphereShell { inner, outer, octant } => {
            let (inner, outer) =
                (positive(inner.0, "body.inner", report), positive(outer.0, "body.outer", report));
            report.require(outer > inner, "body.outer", "is not above inner", "the wall needs a thickness");
            Body::SphereShell { inner, outer, octant }
        }
        BodyKeys::Kidney { half } => Body::Kidney { half },
        BodyKeys::File { path, unit } => Body::File(mesh_file(&path, unit.0, "body.path", report)),
    })
}

fn procedure(keys: Option<ProcedureKeys>, tools: bool, report: &mut Report) -> Procedure {
    let (newton, standard) = (Newton::STANDARD, Explicit::STANDARD);
    let Some(keys) = keys else {
        let kind = ProcedureKind::Linear;
        let on_stall = OnStall::default();
        let (explicit, implicit) = (standard, Implicit::standard(tools));
        return Procedure {
            kind,
            steps: 1,
            duration: None,
            over: None,
            newton,
            limit_within: None,
            modes: MODES,
            on_stall,
            damping: 0.0,
            explicit,
            implicit,
        };
    };
    let implicit = implicit(&keys, tools, report);
    let steps = keys.steps.unwrap_or(1);
    report.require(steps > 0, "procedure.steps", "is zero", "give 1 or more");
    let duration = keys.duration.map(|q| positive(q.0, "procedure.duration", report));
    let tolerance = keys.tolerance.unwrap_or(newton.tolerance);
    // Rounding leaves about 1e-13 of the forces of a nearly incompressible body.
    let sound = (1e-12..=1e-2).contains(&tolerance);
    report.require(sound, "procedure.tolerance", "is no tolerance", "give 1e-12 to 1e-2; 1e-8 is usual");
    let iterations = keys.iterations.map_or(newton.iterations, |n| n as usize);
    report.require(iterations > 0, "procedure.iterations", "is zero", "give 1 or more; 25 is usual");
    let augmentations = keys.augmentations.map_or(newton.augmentations, |n| n as usize);
    use ProcedureKind::{
        Explicit as OfExplicit, ImplicitDynamic as OfImplicit, Modes as OfModes, Static as OfStatic,
    };
    let (newtons, dynamics) = (&[OfStatic, OfImplicit][..], &[OfExplicit, OfImplicit][..]);
    let given = [
        ("tolerance", keys.tolerance.is_some(), newtons),
        ("iterations", keys.iterations.is_some(), newtons),
        ("augmentations", keys.augmentations.is_some(), newtons),
        ("limit-within", keys.limit_within.is_some(), &[OfStatic]),
        ("on-stall", keys.on_stall.is_some(), &[OfStatic]),
        ("modes", keys.modes.is_some(), &[OfModes]),
        ("damping", keys.damping.is_some(), dynamics),
        ("over", keys.over.is_some(), dynamics),
        ("inertia", keys.inertia.is_some(), &[OfImplicit]),
        ("spectral-radius", keys.spectral_radius.is_some(), &[OfImplicit]),
        ("accuracy", keys.accuracy.is_some(), &[OfImplicit]),
        ("safety", keys.safety.is_some(), &[OfExplicit]),
        ("step", keys.step.is_some(), &[OfExplicit]),
        ("tool-mass", keys.tool_mass.is_some(), &[OfExplicit]),
    ];
    for (name, _, kinds) in
        given.into_iter().filter(|(_, given, kinds)| *given && !kinds.contains(&keys.kind))
    {
        let help = format!("a {} procedure takes none: leave it out", keys.kind.name());
        let kinds = kinds.iter().map(|kind| format!("\"{}\"", kind.name())).collect::<Vec<_>>().join(" or ");
        let problem = Problem::new(format!("goes with kind = {kinds} only")).help(help);
        report.add(&format!("procedure.{name}"), problem);
    }
    let damping = keys.damping.map_or(0.0, |q| q.0);
    let over = keys.over.map(|q| q.0);
    let sound = over.is_none_or(|t| t >= 0.0);
    report.require(sound, "procedure.over", "is negative", "give \"0 s\" for at once, or leave it out");
    let explicit = Explicit {
        safety: keys.safety.unwrap_or(standard.safety),
        step: keys.step.map(|q| positive(q.0, "procedure.step", report)),
        tool_mass: keys.tool_mass.map_or(standard.tool_mass, |m| positive(m, "procedure.tool-mass", report)),
    };
    let sound = damping >= 0.0;
    report.require(sound, "procedure.damping", "is negative", "give 0 /s or more, or leave it out");
    let sound = explicit.safety > 0.0 && explicit.safety <= 1.0;
    report.require(sound, "procedure.safety", "is not in (0, 1]", "0.9 is usual");
    let both = keys.safety.is_some() && explicit.step.is_some();
    report.require(!both, "procedure.safety", "has no step to shorten", "give step or safety, not both");
    let newton = Newton { tolerance, iterations, augmentations };
    let limit_within = keys.limit_within;
    let sound = limit_within.is_none_or(|part| (1e-4..=1.0).contains(&part));
    report.require(
        sound,
        "procedure.limit-within",
        "is no part of the load",
        "give 1e-4 to 1; 0.02 is usual",
    );
    let modes = keys.modes.map_or(MODES, |n| n as usize);
    let sound = (1..=1000).contains(&modes);
    report.require(sound, "procedure.modes", "is no number of modes", "give 1 to 1000; 24 is usual");
    let on_stall = keys.on_stall.unwrap_or_default();
    let (kind, steps) = (keys.kind, steps as usize);
    Procedure {
        kind,
        steps,
        duration,
        over,
        newton,
        limit_within,
        modes,
        on_stall,
        damping,
        explicit,
        implicit,
    }
}

fn implicit(keys: &ProcedureKeys, tools: bool, report: &mut Report) -> Implicit {
    let standard = Implicit::standard(tools);
    let implicit = Implicit {
        inertia: keys.inertia.unwrap_or(standard.inertia),
        spectral_radius: keys.spectral_radius.unwrap_or(standard.spectral_radius),
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
