//! From the keys of a file to the types the program works with; every finding is noted at its key.

mod condition;
mod method;
mod output;

use super::error::Problem;
use super::keys::{BodyKeys, MaterialKeys, Names, ProcedureKeys, SceneKeys};
use super::method::{MeshFile, Method};
use super::model::{Body, Elastic, Material, MaterialRegion, Scene};
use super::report::Report;
use super::tool::{Procedure, ProcedureKind};
use super::units::{Dim, Q};
use condition::{load, place, support, tool};
use method::method;
pub(crate) use output::checks;
use output::{output, reference};

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
        MaterialRegion { name: r.name, place, material }
    });
    let regions = regions.collect();
    let supports = keys.support.into_iter().enumerate().map(|(i, s)| support(s, i, report)).collect();
    let loads = keys.load.into_iter().enumerate().filter_map(|(i, l)| load(l, i, report)).collect();
    let tools = keys.tool.into_iter().enumerate().filter_map(|(i, t)| tool(t, i, report)).collect();
    let methods: Vec<Method> =
        keys.method.into_iter().enumerate().filter_map(|(i, m)| method(m, i, report)).collect();
    let output = output(keys.output, report);
    let reference = keys.reference.and_then(|r| reference(r, report));
    let checks = checks(keys.check, "check", report);
    let procedure = procedure(keys.procedure, report);
    report.require(!keys.title.trim().is_empty(), "title", "is empty", "say in one line what the scene is");
    Some(Scene {
        title: keys.title,
        source: keys.source,
        body: body?,
        material,
        regions,
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
        BodyKeys::Kidney {} => Body::Kidney,
        BodyKeys::File { path, unit } => Body::File(mesh_file(&path, unit.0, "body.path", report)),
    })
}

fn elastic(young: f64, poisson: f64, density: Option<f64>, key: &str, report: &mut Report) -> Elastic {
    report.require(young > 0.0, &format!("{key}.young"), "is not positive", "soft tissue has 1 to 100 kPa");
    let help = "give a ratio above -1 and below 0.5; for nearly incompressible tissue 0.49 to 0.4999";
    let holds = poisson > -1.0 && poisson < 0.5;
    report.require(
        holds,
        &format!("{key}.poisson"),
        "is not a Poisson's ratio of a compressible solid",
        help,
    );
    if let Some(density) = density {
        positive(density, &format!("{key}.density"), report);
    }
    Elastic { young, poisson, density }
}

fn material(keys: MaterialKeys, key: &str, report: &mut Report) -> Material {
    type E = MaterialKeys;
    match keys {
        E::Linear { young, poisson, density } => {
            Material::Linear(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::SaintVenantKirchhoff { young, poisson, density } => {
            Material::SaintVenantKirchhoff(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::NeoHookean { young, poisson, density } => {
            Material::NeoHookean(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::Hencky { young, poisson, density } => {
            Material::Hencky(elastic(young.0, poisson, density.map(|d| d.0), key, report))
        }
        E::MooneyRivlin { c10, c01, bulk, density } => Material::MooneyRivlin {
            c10: c10.0,
            c01: c01.0,
            bulk: positive(bulk.0, &format!("{key}.bulk"), report),
            density: density.map(|d| positive(d.0, &format!("{key}.density"), report)),
        },
        E::Ogden { mu, alpha, bulk, density } => {
            let holds = mu.len() == alpha.len() && !mu.is_empty();
            report.require(holds, &format!("{key}.alpha"), "does not match mu", "give one alpha for each mu");
            Material::Ogden {
                terms: mu.iter().map(|m| m.0).zip(alpha).collect(),
                bulk: positive(bulk.0, &format!("{key}.bulk"), report),
                density: density.map(|d| positive(d.0, &format!("{key}.density"), report)),
            }
        }
    }
}

fn procedure(keys: Option<ProcedureKeys>, report: &mut Report) -> Procedure {
    let Some(keys) = keys else { return Procedure { kind: ProcedureKind::Linear, steps: 1, duration: None } };
    let steps = keys.steps.unwrap_or(1);
    report.require(steps > 0, "procedure.steps", "is zero", "give 1 or more");
    let duration = keys.duration.map(|q| positive(q.0, "procedure.duration", report));
    Procedure { kind: keys.kind, steps: steps as usize, duration }
}
