//! Conversion of the keys of a file into the types used by the program; every finding is reported at its key.

mod condition;
mod material;
mod method;
mod output;
mod tool;

use super::keys::{BodyKeys, LoadKeys, MaterialKeys, Names, SceneKeys, SupportKeys};
use super::method::{MeshFile, Method};
use super::model::{Body, Load, MaterialRegion, Scene, Support};
use super::procedure::procedure;
use super::purpose::Purpose;
use super::report::Report;
use super::units::{Dim, Q};
use super::validate::surfaces;
use catalogue::Problem;
use condition::{load, place, support};
use geometry::files::is_surface;
use material::material;
use method::method;
pub(crate) use method::{essential, integration, jitter, size};
pub(crate) use output::checks;
use output::{output, reference};
use serde::Deserialize;
use tool::tool;

/// Default unit of a mesh file's numbers, which CAD programs and Gmsh models of organs use, in metres.
const MILLIMETRE: f64 = 1e-3;

/// Converts a scene; returns `None` only if there are findings.
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
    let (supports, loads) = conditions(body.as_ref(), keys.support, keys.load, report);
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
        purpose: keys.purpose.unwrap_or(Purpose::Smooth),
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
        varied: None,
        origin: report.origin().clone(),
    })
}

/// Converts supports and loads; checks the names of surfaces if the body is known.
fn conditions(
    body: Option<&Body>,
    supports: Vec<SupportKeys>,
    loads: Vec<LoadKeys>,
    report: &mut Report,
) -> (Vec<Support>, Vec<Load>) {
    let supports: Vec<Support> =
        supports.into_iter().enumerate().map(|(i, s)| support(s, i, report)).collect();
    let loads: Vec<Option<Load>> = loads.into_iter().enumerate().map(|(i, l)| load(l, i, report)).collect();
    if let Some(body) = body {
        surfaces(body, &supports, &loads, report);
    }
    (supports, loads.into_iter().flatten().collect())
}

/// The parts of a scene with valid keys, if the keys of other parts are not valid.
#[derive(Deserialize)]
pub(crate) struct SoundParts {
    body: Option<BodyKeys>,
    material: Option<MaterialKeys>,
    #[serde(default)]
    support: Vec<SupportKeys>,
    #[serde(default)]
    load: Vec<LoadKeys>,
}

/// Reports errors in these parts, so that an error in one part hides none in another.
pub(crate) fn parts(keys: SoundParts, report: &mut Report) {
    let body = keys.body.and_then(|keys| body(keys, report));
    keys.material.and_then(|keys| material(keys, "material", report));
    conditions(body.as_ref(), keys.support, keys.load, report);
}

pub(super) fn raw<D: Dim>(q: [Q<D>; 3]) -> [f64; 3] {
    q.map(|q| q.0)
}

pub(crate) fn positive(value: f64, key: &str, report: &mut Report) -> f64 {
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
    let path = report.path(path, key);
    if !path.is_file() {
        let help = format!(
            "no file at {}; paths are relative to the folder of the file they are in",
            path.display()
        );
        report.add(key, Problem::new("can't be found").help(help));
    }
    MeshFile { path, unit, join: false }
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
        BodyKeys::Kidney { half, mildly_graded } => {
            let help = "leave it out, or add half = true: cells of the whole kidney are not drawn together";
            report.require(half || !mildly_graded, "body.mildly_graded", "is for the half alone", help);
            Body::Kidney { half, mildly_graded }
        }
        BodyKeys::File { path, unit, join } => {
            let file = mesh_file(&path, unit.0, "body.path", report);
            let help = "leave it out: a closed surface has no nodes to join";
            report.require(!join || !is_surface(&file.path), "body.join", "is for meshes", help);
            Body::File(MeshFile { join, ..file })
        }
    })
}
