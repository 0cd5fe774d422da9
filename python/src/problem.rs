//! The problem of a method for a solver written in Python: its arrays, and the comparison of a displacement.

use std::collections::BTreeMap;
use std::sync::Arc;

use cases::scene;
use geometry::Vector3;
use harness::run::{Found, Group, Posed, Repeats};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use shape::FixedDof;

use crate::arrays::{Floats, Floats2, fields, points, rows_of};
use crate::error::{input, of_failure};
use crate::mesh::{Mesh, cells_of};
use crate::reference::Referenced;
use crate::rows::ShapeTable;
use crate::run::Run;
use crate::worker::wait;

/// A problem with its tables, without a solution.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Problem {
    scene: Arc<scene::Scene>,
    method: String,
    posed: Arc<Posed>,
    reference: Arc<Referenced>,
}

/// Largest allowed error of a prescribed displacement, relative to the largest displacement; it leaves room
/// for a penalty method.
const OFF_SUPPORTS: f64 = 0.01;

/// Characters of the longest name of a solver, as of a method.
const NAME: usize = 64;

impl Problem {
    pub(crate) fn new(
        py: Python<'_>,
        scene: Arc<scene::Scene>,
        reference: Arc<Referenced>,
        method: scene::Method,
    ) -> PyResult<Problem> {
        let from = scene.clone();
        let id = method.id.clone();
        let posed = wait(py, None, move |_, _| {
            let group = Group::unreferenced(&from, Repeats::ONCE)?;
            group.pose(&group.scenario(method, 0))
        })?;
        let posed = Arc::new(posed.map_err(|failure| of_failure(py, &failure))?);
        Ok(Problem { scene, method: id, posed, reference })
    }

    /// Refuses a displacement that differs from the prescribed values of the supports.
    fn on_supports(&self, py: Python<'_>, u: &[Vector3]) -> PyResult<()> {
        if u.len() != self.posed.nodes().len() {
            return Ok(()); // The comparison reports this error.
        }
        let missed = |dof: &&FixedDof| (u[dof.node as usize][dof.axis as usize] - dof.value).abs();
        let Some(worst) = self.posed.fixed().iter().max_by(|a, b| missed(a).total_cmp(&missed(b))) else {
            return Ok(());
        };
        let prescribed = self.posed.fixed().iter().map(|dof| dof.value.abs());
        let largest = u.iter().map(|u| u.norm()).chain(prescribed).fold(0.0, f64::max);
        let gap = missed(&worst);
        if gap > OFF_SUPPORTS * largest {
            let node = worst.node;
            let axis = ["x", "y", "z"][worst.axis as usize];
            let value = worst.value;
            let percent = 100.0 * OFF_SUPPORTS;
            return Err(input(
                py,
                &format!(
                    "u: node {node} differs by {gap:e} m along {axis} from the {value:e} m of its support; at most \
                     {percent} % of the largest displacement, {largest:e} m, is allowed"
                ),
            ));
        }
        Ok(())
    }

    /// Returns the forces of the tools along their directions, given as numbers or as nodal forces (tools,
    /// nodes, 3) on the body.
    fn pushed(&self, py: Python<'_>, given: Floats<'_>) -> PyResult<Vec<f64>> {
        let given = given.as_array();
        match given.ndim() {
            1 => Ok(given.iter().copied().collect()),
            3 => {
                let along = |(forces, tool): (Vec<Vector3>, harness::run::PosedTool)| {
                    forces.iter().sum::<Vector3>().dot(&tool.along)
                };
                let count = given.shape()[0];
                let tools = self.posed.tools();
                if count != tools.len() {
                    let problem = format!("tool_forces: {count} tools given; the scene has {}", tools.len());
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

    /// Positions of the nodes, to which the parameters belong, m.
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
        Mesh::from(self.posed.mesh().clone())
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
        // A corner with two supports is fixed twice, to the same value.
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

    /// Quadrature: shape values, gradients and weights.
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

    /// Computes the shape functions at points (m, 3) of the body.
    #[pyo3(signature = (points, *, gradients = false))]
    fn table(&self, py: Python<'_>, points: Floats2<'_>, gradients: bool) -> PyResult<ShapeTable> {
        let targets = self::points(py, "points", points.as_array())?;
        let posed = self.posed.clone();
        let at = targets.clone();
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
        if let Some(seconds) = seconds.filter(|s| !(*s >= 0.0 && s.is_finite())) {
            return Err(input(py, &format!("seconds: {seconds}; give a finite number from 0 on")));
        }
        let is_name = (1..=NAME).contains(&solver.chars().count()) && !solver.chars().any(char::is_control);
        if !is_name {
            let found = solver.escape_debug();
            return Err(input(
                py,
                &format!("solver: '{found}'; give 1 to {NAME} characters, without control characters"),
            ));
        }
        let fields = fields(py, "u", u.as_array())?;
        fields.last().map_or(Ok(()), |last| self.on_supports(py, last))?;
        let found = Found {
            solver: solver.into(),
            fields,
            pushed: tool_forces.map(|given| self.pushed(py, given)).transpose()?,
            seconds,
        };
        let (reference, posed) = (self.reference.clone(), self.posed.clone());
        let outcome = wait(py, None, move |watch, _| {
            reference.with(Repeats::ONCE, watch, |group| group.compare(&posed, found))?
        })?;
        let outcome = outcome.map_err(|failure| of_failure(py, &failure))?;
        if let Some(bad) = outcome.records().iter().find(|record| !record.value.is_finite()) {
            return Err(input(py, &format!("u: is too large: {} is not finite", bad.quantity)));
        }
        Ok(Run { scene: self.scene.clone(), outcome: Arc::new(outcome) })
    }

    fn __repr__(&self) -> String {
        format!("<tissuebench.Problem: {}, {} nodes>", self.method, self.posed.nodes().len())
    }
}
