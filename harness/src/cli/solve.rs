//! The hidden command `solve`: solves a problem in files as the run of a scene does. The adapter
//! `tissuebench` calls it, to measure the overhead of the protocol.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use cases::scene::{Dilation, LinearSolver, Newton, OnStall, Output, Procedure, Static};
use catalogue::{Value, Values};
use clap::Args;
use geometry::{CellKind, Mesh, Point3, Vector3};
use material::{LAWS, Law, LinearElastic};
use serde_json::json;
use shape::FixedDof;

use crate::adapter::{RESULT, npy};
use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::outcome::timing::Meters;
use crate::prepare::prepare;
use crate::procedure::external::problem::{MaterialText, ProcedureText, SCHEMA, TEXT, Text};
use crate::procedure::{Problem, Wanted, plan};
use crate::scenario::setup::Setup;

/// Arguments of the hidden command `solve`.
#[derive(Args)]
pub struct SolveArgs {
    /// Folder of the problem
    pub problem: PathBuf,
    /// Folder for the answer
    pub answer: PathBuf,
}

/// Solves, answers and returns the exit code.
pub(super) fn solve(args: &SolveArgs) -> u8 {
    let (code, result) = match answer(&args.problem, &args.answer) {
        Ok(result) => (0, result),
        Err(reason) => {
            eprintln!("tissuebench solve: {reason}");
            (3, json!({ "status": "failed", "message": reason }))
        }
    };
    match disk::write(&args.answer.join(RESULT), result.to_string()) {
        Ok(()) => code,
        Err(bad) => {
            eprintln!("tissuebench solve: {}: can't be written: {bad}", args.answer.join(RESULT).display());
            3
        }
    }
}

/// Reads the problem, solves it, and writes the displacement; returns the contents of the result file.
fn answer(folder: &Path, to: &Path) -> Result<serde_json::Value, String> {
    let path = folder.join(TEXT);
    let at = |bad: String| format!("{}: {bad}", path.display());
    let text = disk::read_text(&path, disk::Kind::MESSAGE).map_err(|bad| at(bad.to_string()))?;
    let text: Text = serde_json::from_str(&text).map_err(|bad| at(bad.to_string()))?;
    if text.schema != SCHEMA {
        let known = format!("schema {} is not known; the supported schema is {SCHEMA}", text.schema);
        return Err(at(known));
    }
    let start = Instant::now();
    let mesh = Arc::new(mesh(folder, &text)?);
    let fixed = fixed(folder)?;
    let forces = vectors(folder, "force.npy")?;
    let setup = setup(&text)?;
    // The calling program measures how far the answer can be trusted.
    let mut meters = Meters { digits: Some(f64::INFINITY), ..Meters::default() };
    meters.timings.book("read", start.elapsed().as_secs_f64());
    let u = displacement(mesh, &setup, fixed, forces, &mut meters).map_err(|failure| failure.to_string())?;
    npy::write_floats(&to.join("displacement.npy"), 3, u.iter().flat_map(|u| [u.x, u.y, u.z]))?;
    let phases = meters.timings.phases().iter().map(|timed| (timed.phase, timed.wall.iter().sum::<f64>()));
    let iterations = Some(meters.counters.newton_iterations).filter(|&count| count > 0);
    Ok(json!({
        "status": "ok",
        "version": format!("tissuebench {}", env!("CARGO_PKG_VERSION")),
        "problem": text.id,
        "phases": BTreeMap::from_iter(phases),
        "counts": BTreeMap::from_iter(iterations.map(|count| ("iterations", count))),
    }))
}

fn displacement(
    mesh: Arc<Mesh>,
    setup: &Setup,
    fixed: Vec<FixedDof>,
    forces: Vec<Vector3>,
    meters: &mut Meters,
) -> Result<Vec<Vector3>, Failure> {
    let order = mesh.uniform_kind().map_or(1, CellKind::order);
    let method = Discretisation::of_elements(mesh, order, false, Dilation::Standard);
    let plan = plan(&method, setup, Wanted::default());
    let start = Instant::now();
    let prepared = prepare(&method, setup, &plan, &mut meters.counters)?.under(fixed, forces);
    meters.timings.book("prepare", start.elapsed().as_secs_f64());
    let problem =
        Problem { method: &method, setup, prepared: &prepared, plan: &plan, watch: None, probes: &[] };
    let solution = crate::procedure::solve(&problem, meters)?;
    match solution.history.and_then(|history| history.failure) {
        Some(failure) => Err(failure),
        None => Ok(solution.u),
    }
}

/// The problem without its supports and loads, which are arrays.
fn setup(text: &Text) -> Result<Setup, String> {
    let ProcedureText { steps, tolerance, iterations, .. } = text.procedure;
    let newton = Newton { tolerance, iterations, augmentations: 0 };
    let procedure = match text.procedure.kind.as_str() {
        "linear" => Procedure::Linear { solver: LinearSolver::Auto },
        "static" => Procedure::Static(Static { steps, newton, limit_within: None, on_stall: OnStall::Stop }),
        other => return Err(format!("procedure '{other}': give linear or static")),
    };
    let moduli = |m: &MaterialText| LinearElastic::new(m.young, m.poisson).map_err(|bad| bad.to_string());
    Ok(Setup {
        laws: text.materials.iter().map(law).collect::<Result<_, _>>()?,
        materials: text.materials.iter().map(moduli).collect::<Result<_, _>>()?,
        densities: vec![None; text.materials.len()],
        relaxation: vec![None; text.materials.len()],
        directions: Vec::new(),
        active: Vec::new(),
        active_curves: Vec::new(),
        supports: Vec::new(),
        loads: Vec::new(),
        foundations: Vec::new(),
        output: Output::default(),
        tools: Vec::new(),
        procedure,
        mass: None,
        contact: None,
        exact: None,
        pod: None,
        training: Vec::new(),
    })
}

fn mesh(folder: &Path, text: &Text) -> Result<Mesh, String> {
    let kind = CellKind::ALL.into_iter().find(|kind| kind.name() == text.element);
    let kind = kind.ok_or_else(|| format!("element {} is not known", text.element))?;
    let points = vectors(folder, "nodes.npy")?.into_iter().map(Point3::from).collect();
    let cells = array(folder, "cells.npy", kind.node_count())?;
    let count = cells.len() / kind.node_count();
    let nodes = cells.iter().map(|&node| node as u32).collect();
    let mesh = Mesh::from_flat(points, vec![kind; count], nodes).map_err(|bad| bad.to_string())?;
    let regions: Vec<u16> = array(folder, "regions.npy", 1)?.iter().map(|&region| region as u16).collect();
    let names: Vec<String> = text.materials.iter().map(|material| material.region.clone()).collect();
    if regions.len() != count || regions.iter().any(|&region| usize::from(region) >= names.len()) {
        return Err("regions.npy: does not match the cells and materials".into());
    }
    Ok(mesh.with_regions(regions, names))
}

/// Reads an array with `columns` numbers per row, row by row.
fn array(folder: &Path, name: &str, columns: usize) -> Result<Vec<f64>, String> {
    let array = npy::read(&folder.join(name), disk::Kind::ARRAY).map_err(|bad| format!("{name}: {bad}"))?;
    match array.shape[..] {
        [_] if columns == 1 => Ok(array.values),
        [_, n] if n == columns => Ok(array.values),
        _ => Err(format!("{name}: has the shape {:?}; rows of {columns} numbers are required", array.shape)),
    }
}

fn vectors(folder: &Path, name: &str) -> Result<Vec<Vector3>, String> {
    let values = array(folder, name, 3)?;
    Ok(values.chunks_exact(3).map(|v| Vector3::new(v[0], v[1], v[2])).collect())
}

fn fixed(folder: &Path) -> Result<Vec<FixedDof>, String> {
    let rows = vectors(folder, "fixed.npy")?;
    Ok(rows.iter().map(|row| FixedDof { node: row.x as u32, axis: row.y as u8, value: row.z }).collect())
}

/// Returns a law that is defined by its small-strain moduli.
fn law(of: &MaterialText) -> Result<Law, String> {
    let entry = LAWS.iter().find(|entry| entry.name == of.law);
    let entry = entry.ok_or_else(|| format!("law {} is not known", of.law))?;
    let mut values = Values::new(entry.parameters);
    for (name, value) in [("young", of.young), ("poisson", of.poisson)] {
        values.give(name, Value::Number(value)).map_err(|bad| bad.problem)?;
    }
    (entry.build)(&values).map_err(|bad| bad.problem)
}
