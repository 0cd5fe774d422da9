//! Conversion of meshes between numpy, files and the engine.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use geometry::{CellKind, quality};
use mesh_files::{Format, GmshVersion};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{Floats2, matrix, numbers, points, rows_of};
use crate::error::input;

/// A mesh of tetrahedra or hexahedra. Positions in metres, nodes of a cell in VTK's order.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Mesh {
    pub(crate) mesh: Arc<geometry::Mesh>,
    /// File from which the mesh was read.
    source: Option<disk::Identity>,
}

/// Returns the length of a unit, m.
fn metres(py: Python<'_>, unit: &str) -> PyResult<f64> {
    let known = [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6)];
    let found = known.into_iter().find(|(name, _)| *name == unit);
    found.map(|(_, metres)| metres).ok_or_else(|| input(py, &format!("unit: '{unit}'; give m, cm, mm or um")))
}

/// Returns the output format for a file name; `version` is a version of Gmsh's format.
fn format(py: Python<'_>, path: &Path, version: Option<&str>) -> PyResult<Format> {
    let format = Format::of(path).map_err(|bad| input(py, &bad.to_string()))?;
    let version = match version {
        None => return Ok(format),
        Some("2.2") => GmshVersion::Two,
        Some("4.1") => GmshVersion::FourOne,
        Some(other) => return Err(input(py, &format!("version: '{other}'; give 2.2 or 4.1"))),
    };
    match format {
        Format::Gmsh(_) => Ok(Format::Gmsh(version)),
        _ => Err(input(
            py,
            &format!("{}: version applies to Gmsh's format only; write a .msh file", path.display()),
        )),
    }
}

/// Returns the cells of a mesh with a single kind as an array of their nodes.
pub(crate) fn cells_of<'py>(py: Python<'py>, mesh: &geometry::Mesh) -> PyResult<Bound<'py, PyArray2<u32>>> {
    let kind = mesh.uniform_kind().ok_or_else(|| input(py, "cells: are of several kinds"))?;
    let all = (0..mesh.cell_count()).flat_map(|cell| mesh.cell(cell)).copied().collect();
    matrix(py, all, kind.node_count())
}

impl From<geometry::Mesh> for Mesh {
    fn from(mesh: geometry::Mesh) -> Mesh {
        Mesh { mesh: Arc::new(mesh), source: None }
    }
}

#[pymethods]
impl Mesh {
    /// Builds a mesh from positions (n, 3) and the nodes of cells (m, 4), (m, 10), (m, 8) or (m, 20).
    #[new]
    fn new(py: Python<'_>, points: Floats2<'_>, cells: Floats2<'_>) -> PyResult<Mesh> {
        let positions = self::points(py, "points", points.as_array())?;
        let cells = cells.as_array();
        let kind = CellKind::ALL.into_iter().find(|kind| kind.node_count() == cells.ncols());
        let wrong = || input(py, &format!("cells: have {} nodes each; give 4, 10, 8 or 20", cells.ncols()));
        let kind = kind.ok_or_else(wrong)?;
        let nodes = numbers(py, "cells", cells)?;
        let mesh = geometry::Mesh::from_flat(positions, vec![kind; cells.nrows()], nodes);
        let mesh = mesh.map_err(|bad| input(py, &bad.to_string()))?;
        quality::check(&mesh).map_err(|bad| input(py, &format!("cells: {bad}")))?;
        Ok(Mesh::from(mesh))
    }

    /// Reads a mesh from a file; `unit` is the unit of its numbers.
    #[staticmethod]
    #[pyo3(signature = (path, unit = "mm"))]
    fn read(py: Python<'_>, path: PathBuf, unit: &str) -> PyResult<Mesh> {
        let unit = metres(py, unit)?;
        let read = py.detach(|| mesh_files::read(&path, unit));
        let mesh = read.map_err(|bad| input(py, &bad.to_string()))?;
        Ok(Mesh { source: disk::Identity::of(&path), ..Mesh::from(mesh) })
    }

    /// Writes the mesh to a file: .msh, .inp, .vtu, or the boundary as .stl, according to the file name.
    /// `version` is that of Gmsh's format.
    #[pyo3(signature = (path, unit = "mm", version = None))]
    fn write(&self, py: Python<'_>, path: PathBuf, unit: &str, version: Option<&str>) -> PyResult<()> {
        let unit = metres(py, unit)?;
        let format = format(py, &path, version)?;
        if self.source.is_some() && self.source == disk::Identity::of(&path) {
            let problem = "is the input file of the mesh; give another name";
            return Err(input(py, &format!("{}: {problem}", path.display())));
        }
        let written = py.detach(|| mesh_files::write_as(&self.mesh, &path, unit, format));
        written.map_err(|bad| input(py, &bad.to_string()))
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows_of(py, self.mesh.points().iter().map(|x| x.coords.into()))
    }

    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        cells_of(py, &self.mesh)
    }

    #[getter]
    fn element(&self) -> Option<&'static str> {
        self.mesh.uniform_kind().map(CellKind::name)
    }

    #[getter]
    fn regions<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u16>> {
        PyArray1::from_iter(py, (0..self.mesh.cell_count()).map(|cell| self.mesh.region(cell)))
    }

    #[getter]
    fn region_names(&self) -> Vec<String> {
        self.mesh.region_names().to_vec()
    }

    fn __repr__(&self) -> String {
        let points = self.mesh.points().len();
        let cells = self.mesh.cell_count();
        format!("<tissuebench.Mesh: {points} points, {cells} cells>")
    }
}
