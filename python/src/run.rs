//! A finished run.

use std::sync::Arc;

use cases::scene::Scene;
use harness::outcome::Outcome;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::rows_of;
use crate::error::{input, of_failure};
use crate::mesh::Mesh;
use crate::table::Table;

/// Result of a method. All numbers are SI.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Run {
    pub(crate) scene: Arc<Scene>,
    pub(crate) outcome: Arc<Outcome>,
}

impl Run {
    /// Returns the name of the method and, if the user's own solver solved it, of that solver.
    pub(crate) fn label(&self) -> String {
        let identity = &self.outcome.identity;
        match &identity.adapter {
            Some(solver) => format!("{} by {solver}", identity.method),
            None => identity.method.clone(),
        }
    }
}

#[pymethods]
impl Run {
    #[getter]
    fn case(&self) -> &str {
        &self.outcome.identity.case
    }

    #[getter]
    fn method(&self) -> &str {
        &self.outcome.identity.method
    }

    /// `ok`, or the kind of early end.
    #[getter]
    fn status(&self) -> &'static str {
        self.outcome.status
    }

    #[getter]
    fn nodes(&self) -> u64 {
        self.outcome.size.nodes
    }

    #[getter]
    fn dofs(&self) -> u64 {
        self.outcome.size.dofs
    }

    /// Reason of an early end, or none; the results are then those at the load reached.
    #[getter]
    fn failure<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyAny>> {
        self.outcome
            .stalled
            .as_ref()
            .map(|failure| of_failure(py, failure).into_value(py).into_bound(py).into_any())
    }

    /// Median time of a pass, s.
    #[getter]
    fn seconds(&self) -> Option<f64> {
        let total = self.outcome.phases.iter().find(|timed| timed.phase == "total");
        total.map(|timed| timed.summary().median)
    }

    #[getter]
    fn metrics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        self.outcome.metrics.iter().try_for_each(|m| all.set_item(m.name(), m.value))?;
        Ok(all)
    }

    /// Returns a metric by its name.
    fn __getitem__(&self, name: &str) -> PyResult<f64> {
        self.outcome.metric(name).ok_or_else(|| PyKeyError::new_err(name.to_string()))
    }

    fn __contains__(&self, name: &str) -> bool {
        self.outcome.metric(name).is_some()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.outcome
            .warning_rows()
            .into_iter()
            .map(|warning| format!("{}: {}", warning.code, warning.message))
            .collect()
    }

    #[getter]
    fn records(&self, py: Python<'_>) -> PyResult<Table> {
        Table::of(py, &self.outcome.records())
    }

    /// Displacement at the scene's probes, m, (probes, 3).
    #[getter]
    fn probes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows_of(py, self.outcome.probes.iter().map(|probe| probe.u.into()))
    }

    /// The undeformed body, if states were requested.
    #[getter]
    fn mesh(&self, py: Python<'_>) -> PyResult<Mesh> {
        let states = self.outcome.states.as_ref().ok_or_else(|| no_states(py))?;
        Ok(Mesh::from(states.mesh().clone()))
    }

    /// Time, load fraction or number of each state.
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let states = self.outcome.states.as_ref().ok_or_else(|| no_states(py))?;
        Ok(PyArray1::from_iter(py, states.displacements().map(|(time, _)| time)))
    }

    /// Displacement of the points of the mesh at each state, m, (states, points, 3).
    #[getter]
    fn displacements<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let states = self.outcome.states.as_ref().ok_or_else(|| no_states(py))?;
        let count = states.displacements().len();
        let points = states.mesh().points().len();
        let all = states.displacements().flat_map(|(_, u)| u.iter().flat_map(|u| [u.x, u.y, u.z])).collect();
        PyArray1::from_vec(py, all).reshape([count, points, 3])
    }

    /// Displacement of the points of the mesh at the last state, m, (points, 3).
    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let states = self.outcome.states.as_ref().ok_or_else(|| no_states(py))?;
        let last = states.displacements().last().map_or(&[][..], |(_, u)| u);
        rows_of(py, last.iter().map(|&u| u.into()))
    }

    fn __repr__(&self) -> String {
        format!(
            "<tissuebench.Run: {} {}, {} nodes, {}>",
            self.case(),
            self.method(),
            self.nodes(),
            self.status()
        )
    }
}

fn no_states(py: Python<'_>) -> PyErr {
    input(py, "the run kept no states; give states=True to run")
}
