//! Solves a problem in files with this program.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use catalogue::{Value, Values};
use fem::VolumeRule;
use geometry::{CellKind, Mesh, Point3, Vector3};
use material::{LAWS, Law, LinearElastic};
use shape::FixedDof;
use statics::{Body, Dilation, LinearProblem, Load, NewtonParams, Solid, StaticParams, StaticProblem};

use crate::adapter::npy;
use crate::procedure::external::problem::{MaterialText, Text};

/// Smallest fraction of a load step before its reduction is given up.
const SMALLEST: f64 = 1.0 / 64.0;

/// A displacement, and the cost of computing it.
pub(super) struct Solved {
    /// Displacement of the nodes, m.
    pub(super) u: Vec<Vector3>,
    /// Time by phase, s.
    pub(super) phases: BTreeMap<&'static str, f64>,
    pub(super) counts: BTreeMap<&'static str, f64>,
}

/// Reads the arrays and solves the problem.
pub(super) fn solve(folder: &Path, text: &Text) -> Result<Solved, String> {
    let mut phases = BTreeMap::new();
    let mut lap = Instant::now();
    let mut book = |phase| {
        phases.insert(phase, lap.elapsed().as_secs_f64());
        lap = Instant::now();
    };
    let mesh = mesh(folder, text)?;
    let (fixed, forces) = (fixed(folder)?, vectors(folder, "force.npy")?);
    let laws = text.materials.iter().map(law).collect::<Result<Vec<Law>, String>>()?;
    book("read");
    let rule = VolumeRule::STANDARD;
    let volume = fem::volume_rows(&mesh, &rule).map_err(|bad| bad.to_string())?;
    let region = if laws.len() > 1 { fem::regions(&mesh, &rule) } else { Vec::new() };
    book("prepare");
    let mut counts = BTreeMap::new();
    let u = if text.procedure.kind == "linear" {
        let moduli = |m: &MaterialText| LinearElastic::new(m.young, m.poisson);
        let materials: Vec<LinearElastic> =
            text.materials.iter().map(moduli).collect::<Result<_, _>>().map_err(|bad| bad.to_string())?;
        let body = Body {
            nodes: mesh.points(),
            volume: &volume,
            materials: &materials,
            region: &region,
            dilation: None,
        };
        let problem = LinearProblem { body, loads: &[], fixed: &fixed, constraints: &[], weak: &[] };
        let assembled = statics::assemble(&problem).map_err(|bad| bad.to_string())?;
        book("assemble");
        let factored = assembled.factor().map_err(|bad| bad.to_string())?;
        book("factor");
        factored.solve_forces(&forces, 1.0).map_err(|bad| bad.to_string())?.u
    } else {
        let solid = Solid { volume: &volume, laws: &laws, region: &region, dilation: Dilation::Standard };
        let problem = StaticProblem {
            nodes: mesh.points(),
            solid,
            loads: &[Load::Nodal { forces }],
            fixed: &fixed,
            penalties: &[],
            contact: None,
            tools: &[],
        };
        let (tolerance, iterations) = (text.procedure.tolerance, text.procedure.iterations);
        let newton = NewtonParams { tolerance, iterations, chords: true, keeps: f64::INFINITY };
        let steps = text.procedure.steps;
        let params = StaticParams { steps, smallest: SMALLEST, newton, augmentations: 0, limit_within: None };
        let path = statics::solve_static(&problem, &params, |_, _| {}).map_err(|bad| bad.to_string())?;
        if let Some(failure) = path.failure {
            return Err(failure.to_string());
        }
        counts.insert("iterations", path.work.solves as f64);
        path.u
    };
    book("solve");
    Ok(Solved { u, phases, counts })
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
