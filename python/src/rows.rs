//! Shape tables and transfer schemes as operators: nodal values to values at points, and forces back to the
//! nodes.

use std::sync::Arc;

use catalogue::{Value, Values, find};
use geometry::{Point3, Vector3};
use interp::SCHEMES;
use numpy::ndarray::ArrayViewD;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, ToPyArray};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use shape::{GradRows, Rows};

use crate::arrays::{Floats, Floats2, points, rows_of};
use crate::error::{input, not_run};
use crate::mesh::Mesh;
use crate::worker::{unforked, wait};

type Array1<'py, T> = Bound<'py, PyArray1<T>>;

/// Shape values at points, optionally with gradients and weights.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct ShapeTable {
    pub(crate) rows: Arc<Rows>,
    pub(crate) points: Vec<Point3>,
    pub(crate) gradients: Option<GradRows>,
    pub(crate) weights: Option<Vec<f64>>,
    pub(crate) outside: Option<usize>,
}

/// A transposed table, from forces at points to nodal forces.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Transposed {
    rows: Arc<Rows>,
}

/// Applies rows to every column of a field, three independent columns at a time.
fn product<'py>(
    py: Python<'py>,
    field: ArrayViewD<'_, f64>,
    length: usize,
    apply: impl Fn(&[Vector3]) -> Vec<Vector3>,
) -> PyResult<Bound<'py, PyAny>> {
    unforked(py)?;
    let shape = field.shape().to_vec();
    if shape.first() != Some(&length) || shape.len() > 2 {
        return Err(input(py, &format!("has the shape {shape:?}; give ({length},) or ({length}, k)")));
    }
    let columns = shape.get(1).copied().unwrap_or(1);
    let at = |row: usize, column: usize| match (column < columns, shape.len()) {
        (false, _) => 0.0,
        (true, 1) => field[[row].as_slice()],
        (true, _) => field[[row, column].as_slice()],
    };
    let mut out: Vec<f64> = Vec::new();
    let mut rows = 0;
    for first in (0..columns).step_by(3) {
        let three: Vec<Vector3> = (0..length)
            .map(|row| Vector3::new(at(row, first), at(row, first + 1), at(row, first + 2)))
            .collect();
        let found = apply(&three);
        rows = found.len();
        out.resize(rows * columns, 0.0);
        for (row, value) in found.iter().enumerate() {
            (first..columns.min(first + 3))
                .for_each(|column| out[row * columns + column] = value[column - first]);
        }
    }
    let flat = PyArray1::from_vec(py, out);
    Ok(if shape.len() == 1 { flat.into_any() } else { flat.reshape([rows, columns])?.into_any() })
}

#[pymethods]
impl ShapeTable {
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.rows.len(), self.rows.node_count())
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows_of(py, self.points.iter().map(|x| x.coords.into()))
    }

    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.weights.as_ref().map(|weights| weights.to_pyarray(py))
    }

    #[getter]
    fn outside(&self) -> Option<usize> {
        self.outside
    }

    /// Returns the values of a nodal field, (nodes,) or (nodes, k), at the points.
    fn values<'py>(&self, py: Python<'py>, u: Floats<'py>) -> PyResult<Bound<'py, PyAny>> {
        product(py, u.as_array(), self.rows.node_count(), |u| self.rows.apply(u))
    }

    fn __matmul__<'py>(&self, py: Python<'py>, u: Floats<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.values(py, u)
    }

    /// Returns `du_i / dX_j` at the points, (points, 3, 3), for a nodal displacement (nodes, 3).
    fn gradients<'py>(&self, py: Python<'py>, u: Floats2<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        unforked(py)?;
        let rows = self.gradients.as_ref().ok_or_else(|| input(py, "the table has no gradients"))?;
        let u = crate::arrays::vectors(py, "u", u.as_array())?;
        if u.len() != self.rows.node_count() {
            return Err(input(
                py,
                &format!("u: {} nodes; the table has {}", u.len(), self.rows.node_count()),
            ));
        }
        let all = rows.displacement_gradients(&u);
        let numbers: Vec<f64> =
            all.iter().flat_map(|h| h.transpose().iter().copied().collect::<Vec<_>>()).collect();
        PyArray1::from_vec(py, numbers).reshape([all.len(), 3, 3])
    }

    #[getter(T)]
    fn transposed(&self) -> Transposed {
        Transposed { rows: self.rows.clone() }
    }

    /// `(data, indices, indptr)` in the format of `scipy.sparse.csr_matrix`.
    #[getter]
    fn csr<'py>(&self, py: Python<'py>) -> (Array1<'py, f64>, Array1<'py, u32>, Array1<'py, i64>) {
        let offsets = self.rows.offsets().iter().map(|&at| at as i64);
        (
            self.rows.values().to_pyarray(py),
            self.rows.nodes().to_pyarray(py),
            PyArray1::from_iter(py, offsets),
        )
    }

    fn __repr__(&self) -> String {
        format!("<tissuebench.ShapeTable: {} points, {} nodes>", self.rows.len(), self.rows.node_count())
    }
}

#[pymethods]
impl Transposed {
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.rows.node_count(), self.rows.len())
    }

    /// Returns the nodal forces that do the same work as forces at the points, (points,) or (points, k).
    fn __matmul__<'py>(&self, py: Python<'py>, forces: Floats<'py>) -> PyResult<Bound<'py, PyAny>> {
        product(py, forces.as_array(), self.rows.len(), |forces| self.rows.apply_transposed(forces))
    }
}

/// Names of the transfer schemes.
#[pyfunction]
pub(crate) fn schemes() -> Vec<&'static str> {
    SCHEMES.iter().map(|entry| entry.name).collect()
}

/// Builds the table of a transfer scheme from nodes (n, 3) to targets (m, 3); schemes over a mesh need
/// `mesh`.
#[pyfunction]
#[pyo3(signature = (scheme, nodes, targets, *, mesh = None, **parameters))]
pub(crate) fn transfer(
    py: Python<'_>,
    scheme: &str,
    nodes: Floats2<'_>,
    targets: Floats2<'_>,
    mesh: Option<&Mesh>,
    parameters: Option<&Bound<'_, PyDict>>,
) -> PyResult<ShapeTable> {
    let problem = |bad: catalogue::Problem| input(py, &bad.to_string());
    let entry = find(SCHEMES, scheme).map_err(problem)?;
    let mut values = Values::new(entry.parameters);
    for (name, value) in parameters.into_iter().flatten() {
        let value = match value.cast::<PyBool>() {
            Ok(flag) => Value::Flag(flag.is_true()),
            Err(_) => Value::Number(value.extract()?),
        };
        values.give(&name.extract::<String>()?, value).map_err(problem)?;
    }
    let scheme = (entry.build)(&values).map_err(problem)?;
    let (nodes, targets) =
        (points(py, "nodes", nodes.as_array())?, points(py, "targets", targets.as_array())?);
    let mesh = mesh.map(|mesh| mesh.mesh.clone());
    let at = targets.clone();
    let found = wait(py, None, move |_, _| scheme.rows(&nodes, mesh.as_deref(), &at))?;
    let (rows, info) = found.map_err(|bad| not_run(py, bad))?;
    Ok(ShapeTable {
        rows: Arc::new(rows.rows().clone()),
        points: targets,
        gradients: None,
        weights: None,
        outside: Some(info.outside),
    })
}
