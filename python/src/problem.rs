//! A method's problem for a solver of one's own: its arrays, and a displacement judged in a line.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use cases::scene;
use harness::run::{Found, Group, Posed, Repeats};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Floats, Floats2, fields, points, rows_of};
use crate::error::{input, of_failure};
use crate::mesh::{Mesh, cells_of};
use crate::rows::ShapeTable;
use crate::run::Run;
use crate::worker::wait;

/// A problem with its tables, not solved.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Problem {
    scene: Arc<scene::Scene>,
    method: String,
    posed: Arc<Posed>,
    /// With the reference, which is made when something is first compared.
    group: Mutex<Option<Arc<Group<'static>>>>,
}

impl Problem {
    pub(crate) fn new(py: Python<'_>, scene: Arc<scene::Scene>, method: scene::Method) -> PyResult<Problem> {
        let (from, id) = (scene.clone(), method.id.clone());
        let posed = wait(py, None, move |_, _| {
            let group = Group::unreferenced(&from, Repeats::ONCE)?;
            group.pose(&group.scenario(method, 0))
        })?;
        let posed = Arc::new(posed.map_err(|failure| of_failure(py, &failure))?);
        Ok(Problem { scene, method: id, posed, group: Mutex::default() })
    }

    /// The scene with its reference.
    fn group(&self, py: Python<'_>) -> PyResult<Arc<Group<'static>>> {
        if let Some(group) = &*self.group.lock().expect("no thread panicked") {
            return Ok(group.clone());
        }
        let scene = (*self.scene).clone();
        let made = wait(py, None, move |watch, _| {
            let group = Group::watched(Cow::Owned(scene), None, Repeats::ONCE, Some(watch.clone()))?;
            match group.reference_stalled() {
                Some(stalled) => Err(stalled.clone()),
                None => Ok(Arc::new(group)),
            }
        })?;
        let group = made.map_err(|failure| of_failure(py, &failure))?;
        *self.group.lock().expect("no thread panicked") = Some(group.clone());
        Ok(group)
    }

    /// Forces of the tools along their ways: numbers, or nodal forces (tools, nodes, 3) that they exert on the body.
    fn pushed(&self, py: Python<'_>, given: Floats<'_>) -> PyResult<Vec<f64>> {
        let given = given.as_array();
        match given.ndim() {
            1 => Ok(given.iter().copied().collect()),
            3 => {
                let along = |(forces, tool): (Vec<geometry::Vector3>, harness::run::PosedTool)| {
                    forces.iter().sum::<geometry::Vector3>().dot(&tool.along)
                };
                let (count, tools) = (given.shape()[0], self.posed.tools());
                if count != tools.len() {
                    let problem = format!("tool_forces: of {count} tools; the scene has {}", tools.len());
                    return Err(input(py, &problem));
                }
                Ok(fields(py, "tool_forces", given)?.into_iter().zip(tools).map(along).collect())
            }
            _ => Err(input(py, "tool_forces: give (tools,) or (tools, nodes, 3)")),
        }
    }
}

#[pymethods]
impl Problem {
    #[getter]
    fn method(&self) -> &str {
        &self.method
    }

    /// Positions that parameters belong to, m.
    #[getter]
    fn nodes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows_of(py, self.posed.nodes().iter().map(|x| x.coords.into()))
    }

    /// Elements, or the background cells of a cloud.
    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        cells_of(py, self.posed.mesh())
    }

    #[getter]
    fn mesh(&self) -> Mesh {
        Mesh { mesh: Arc::new(self.posed.mesh().clone()) }
    }

    /// Whether nodal parameters are displacements, as on a mesh.
    #[getter]
    fn interpolates(&self) -> bool {
        self.posed.interpolates()
    }

    #[getter]
    fn steps(&self) -> usize {
        self.posed.steps()
    }

    /// Prescribed components by their number `3 node + axis`, and their values, m.
    #[getter]
    fn fixed<'py>(&self, py: Python<'py>) -> (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<f64>>) {
        // A corner of two supports is fixed twice, to the same value.
        let fixed: BTreeMap<i64, f64> = self
            .posed
            .fixed()
            .iter()
            .map(|dof| (3 * i64::from(dof.node) + i64::from(dof.axis), dof.value))
            .collect();
        (PyArray1::from_iter(py, fixed.keys().copied()), PyArray1::from_iter(py, fixed.values().copied()))
    }

    /// Consistent nodal forces of all loads, N.
    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let force = self.posed.force().map_err(|failure| of_failure(py, &failure))?;
        rows_of(py, force.into_iter().map(Into::into))
    }

    #[getter]
    fn tools<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |tool: harness::run::PosedTool| {
            let about = PyDict::new(py);
            about.set_item("name", tool.name)?;
            about.set_item("along", <[f64; 3]>::from(tool.along))?;
            about.set_item("closure", tool.closure)?;
            Ok(about)
        };
        self.posed.tools().into_iter().map(one).collect()
    }

    /// The quadrature: values, gradients and weights.
    #[getter]
    fn quadrature(&self) -> ShapeTable {
        let volume = self.posed.volume();
        ShapeTable {
            rows: Arc::new(volume.rows().clone()),
            points: volume.points().to_vec(),
            gradients: Some(volume.at().clone()),
            weights: Some(volume.weights().to_vec()),
            outside: None,
        }
    }

    /// The shape functions at points (m, 3) of the body.
    #[pyo3(signature = (points, *, gradients = false))]
    fn table(&self, py: Python<'_>, points: Floats2<'_>, gradients: bool) -> PyResult<ShapeTable> {
        let targets = self::points(py, "points", points.as_array())?;
        let (posed, at) = (self.posed.clone(), targets.clone());
        let found = wait(py, None, move |_, _| {
            let (rows, outside) = posed.at_points(&at)?;
            let gradients = if gradients { Some(posed.gradients_at(&at)?) } else { None };
            Ok((rows.rows().clone(), gradients, outside))
        })?;
        let (rows, gradients, outside) = found.map_err(|failure| of_failure(py, &failure))?;
        Ok(ShapeTable {
            rows: Arc::new(rows),
            points: targets,
            gradients,
            weights: None,
            outside: Some(outside),
        })
    }

    /// Compares a displacement, (nodes, 3) at the end or (steps, nodes, 3), with the scene's reference.
    #[pyo3(signature = (u, *, tool_forces = None, seconds = None, solver = "own"))]
    fn compare(
        &self,
        py: Python<'_>,
        u: Floats<'_>,
        tool_forces: Option<Floats<'_>>,
        seconds: Option<f64>,
        solver: &str,
    ) -> PyResult<Run> {
        let found = Found {
            solver: solver.into(),
            fields: fields(py, "u", u.as_array())?,
            pushed: tool_forces.map(|given| self.pushed(py, given)).transpose()?,
            seconds,
        };
        let (group, posed) = (self.group(py)?, self.posed.clone());
        let outcome = wait(py, None, move |_, _| group.compare(&posed, found))?;
        let outcome = outcome.map_err(|failure| of_failure(py, &failure))?;
        Ok(Run { outcome: Arc::new(outcome) })
    }

    fn __repr__(&self) -> String {
        format!("<tissuebench.Problem: {}, {} nodes>", self.method, self.posed.nodes().len())
    }
}
