//! Problem files for external solvers: a description in JSON, and arrays of nodes, cells, supports and
//! forces. All numbers are in SI units.

use std::collections::BTreeMap;
use std::path::Path;

use cases::scene::{Procedure, Setting};
use contact::ToolShape;
use geometry::Point3;
use material::{Law, Material as _};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::adapter::{About, npy};
use crate::error::{Failure, Foreign, ForeignStatus};
use crate::procedure::problem::Problem;

/// Version of the problem files. A reader refuses versions that it does not know.
pub(crate) const SCHEMA: u32 = 1;
/// Name of the description.
pub(crate) const TEXT: &str = "problem.json";
/// Name of the file of rigid tools, if there are any.
pub(crate) const TOOLS: &str = "tools.json";
/// Names of the arrays, in the order in which they enter the problem's id.
pub(crate) const ARRAYS: [&str; 6] =
    ["nodes.npy", "cells.npy", "regions.npy", "fixed.npy", "force.npy", "probes.npy"];
/// Meshes for programs that read no arrays.
pub(crate) const MESHES: [&str; 2] = ["mesh.inp", "mesh.vtu"];

/// Contents of `problem.json`.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Text {
    /// Version of the problem files.
    pub(crate) schema: u32,
    /// Hash of the contents of all files, which an answer may repeat.
    pub(crate) id: String,
    pub(crate) case: String,
    pub(crate) method: String,
    /// Name of the element: rows of `cells.npy` have the node order of Abaqus.
    pub(crate) element: String,
    /// Quadrature points per cell in this program. On curved cells the results depend on the number.
    pub(crate) points_per_cell: usize,
    /// Material of each region number in `regions.npy`.
    pub(crate) materials: Vec<MaterialText>,
    pub(crate) procedure: ProcedureText,
    pub(crate) limits: LimitsText,
    pub(crate) threads: usize,
    /// Settings of the adapter in the scene.
    pub(crate) settings: BTreeMap<String, Setting>,
}

/// Material law with its constants. The moduli are those at small strain.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct MaterialText {
    pub(crate) region: String,
    /// Name of the law in scenes.
    pub(crate) law: String,
    pub(crate) young: f64,
    pub(crate) poisson: f64,
    pub(crate) mu: f64,
    pub(crate) lambda: f64,
    pub(crate) bulk: f64,
    /// Density, kg/m^3.
    pub(crate) density: Option<f64>,
    /// Other constants of the law.
    pub(crate) constants: Value,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct ProcedureText {
    /// `linear` or `static`.
    pub(crate) kind: String,
    /// Number of equal load steps; 0 for a linear procedure.
    pub(crate) steps: usize,
    /// Relative residual at which a step has converged.
    pub(crate) tolerance: f64,
    /// Largest number of iterations of a step.
    pub(crate) iterations: usize,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct LimitsText {
    pub(crate) seconds: f64,
    pub(crate) bytes: u64,
}

/// Writes the files of a problem, with the named meshes, and returns the problem's id.
pub(crate) fn write(
    problem: &Problem,
    about: &About,
    folder: &Path,
    meshes: &[String],
) -> Result<String, Failure> {
    let written = || -> Result<String, String> {
        arrays(problem, folder)?;
        if !problem.setup.tools.is_empty() {
            let text = serde_json::to_string_pretty(&tools(problem)).map_err(|bad| bad.to_string())?;
            save(&folder.join(TOOLS), text.as_bytes())?;
        }
        for name in meshes {
            mesh_files::write(problem.method.mesh(), &folder.join(name), 1.0)
                .map_err(|bad| bad.to_string())?;
        }
        let mut text = text(problem, about);
        text.id = id(&text, folder)?;
        let json = serde_json::to_string_pretty(&text).map_err(|bad| bad.to_string())?;
        save(&folder.join(TEXT), json.as_bytes())?;
        Ok(text.id)
    };
    written().map_err(|reason| Foreign::new(ForeignStatus::Failed, reason).into())
}

fn save(path: &Path, bytes: &[u8]) -> Result<(), String> {
    disk::write(path, bytes).map_err(|bad| format!("{}: can't be written: {bad}", path.display()))
}

/// Hash of the description without limits and threads, which do not change a solution, and of all arrays.
fn id(text: &Text, folder: &Path) -> Result<String, String> {
    let mut hasher = blake3::Hasher::new();
    let Text { schema, element, materials, procedure, settings, .. } = text;
    let what = json!([schema, element, materials, procedure, settings]);
    hasher.update(what.to_string().as_bytes());
    for name in ARRAYS.into_iter().chain([TOOLS]) {
        hasher.update(&disk::read(&folder.join(name), disk::Kind::ARRAY).unwrap_or_default());
    }
    Ok(hasher.finalize().to_hex()[..16].to_string())
}

fn arrays(problem: &Problem, folder: &Path) -> Result<(), String> {
    let Problem { method, prepared, .. } = *problem;
    let mesh = method.mesh();
    let points = |name: &str, points: &[Point3]| {
        npy::write_floats(&folder.join(name), 3, points.iter().flat_map(|p| [p.x, p.y, p.z]))
    };
    points("nodes.npy", method.nodes())?;
    points("probes.npy", problem.probes)?;
    let kind = mesh.uniform_kind().ok_or("cells of several kinds do not fit in one array of nodes")?;
    let nodes = (0..mesh.cell_count()).flat_map(|cell| mesh.cell(cell)).map(|&node| i64::from(node));
    npy::write_integers(&folder.join("cells.npy"), kind.node_count(), nodes)?;
    let regions = (0..mesh.cell_count()).map(|cell| i64::from(mesh.region(cell)));
    npy::write_integers(&folder.join("regions.npy"), 1, regions)?;
    // A corner between two supports is prescribed twice, to the same value.
    let fixed: BTreeMap<(u32, u8), f64> =
        prepared.fixed().iter().map(|dof| ((dof.node, dof.axis), dof.value)).collect();
    let rows = fixed.iter().flat_map(|(&(node, axis), &value)| [f64::from(node), f64::from(axis), value]);
    npy::write_floats(&folder.join("fixed.npy"), 3, rows)?;
    let force =
        statics::nodal_forces(&prepared.volume.rows, &prepared.loads()).map_err(|bad| bad.to_string())?;
    npy::write_floats(&folder.join("force.npy"), 3, force.iter().flat_map(|f| [f.x, f.y, f.z]))
}

fn text(problem: &Problem, about: &About) -> Text {
    let Problem { method, setup, prepared, .. } = *problem;
    let materials = setup.laws.iter().zip(&setup.materials).zip(&setup.densities).enumerate();
    let procedure = match &setup.procedure {
        Procedure::Static(asked) => ProcedureText {
            kind: "static".into(),
            steps: asked.steps,
            tolerance: asked.newton.tolerance,
            iterations: asked.newton.iterations,
        },
        _ => ProcedureText { kind: "linear".into(), steps: 0, tolerance: 1e-10, iterations: 1 },
    };
    Text {
        schema: SCHEMA,
        id: String::new(),
        case: about.case.clone(),
        method: about.method.clone(),
        element: about.element.into(),
        points_per_cell: prepared.source.cell_points().map_or(0, |starts| starts[1]),
        materials: materials
            .map(|(region, ((law, linear), &density))| MaterialText {
                region: method.mesh().region_names()[region].clone(),
                law: law.name().into(),
                young: linear.young(),
                poisson: linear.poisson(),
                mu: law.mu(),
                lambda: law.lambda(),
                bulk: law.bulk(),
                density,
                constants: constants(law),
            })
            .collect(),
        procedure,
        limits: LimitsText { seconds: about.limits.time.as_secs_f64(), bytes: about.limits.memory },
        threads: rayon::current_num_threads(),
        settings: about.settings.clone(),
    }
}

/// Constants of a law other than its moduli.
fn constants(law: &Law) -> Value {
    match law {
        Law::NeoHookeanIsochoric(law) => json!({ "c10": law.c10(), "d1": law.d1() }),
        Law::MooneyRivlin(law) => json!({ "c10": law.c10(), "c01": law.c01(), "bulk": law.bulk() }),
        Law::Ogden(law) => {
            let terms = law.terms().iter().map(|(mu, alpha)| json!({ "mu": mu, "alpha": alpha }));
            json!({ "terms": terms.collect::<Vec<_>>(), "bulk": law.bulk() })
        }
        _ => json!({}),
    }
}

/// Tools with their frames and drives. Their surfaces are those of the scene's shapes.
fn tools(problem: &Problem) -> Value {
    let one = |placed: &crate::scenario::PlacedTool| {
        let tool = &placed.tool;
        let law = tool.law();
        let at = tool.place(0.0);
        let drive = match placed.drive {
            contact::Drive::Closure(closure) => json!({ "closure": closure }),
            contact::Drive::Force(force) => json!({ "force": force }),
        };
        let axes: Vec<[f64; 3]> = placed.turned.row_iter().map(|row| [row[0], row[1], row[2]]).collect();
        json!({
            "name": placed.name,
            "shape": shape(tool.shape()),
            "at": [at.x, at.y, at.z],
            "along": <[f64; 3]>::from(tool.along()),
            "axes": axes,
            "drive": drive,
            "penalty": law.penalty(),
            "friction": law.friction(),
        })
    };
    Value::Array(problem.setup.tools.iter().map(one).collect())
}

/// Shape in its own frame, centred at the origin, lengths in m. The axis of a cylinder or capsule is z. A
/// plate is the plane z = 0 with the tool below.
fn shape(shape: &ToolShape) -> Value {
    let name = shape.name();
    match shape {
        ToolShape::RoundedBox(of) => json!({ "name": name, "half": of.half, "radius": of.radius }),
        ToolShape::Sphere(of) => json!({ "name": name, "radius": of.radius }),
        ToolShape::Cylinder(of) => {
            json!({ "name": name, "radius": of.radius, "half-length": of.half_length })
        }
        ToolShape::Capsule(of) => json!({ "name": name, "radius": of.radius, "half-length": of.half_length }),
        ToolShape::Plate(_) | ToolShape::RoundedSurface(_) => json!({ "name": name }),
    }
}
