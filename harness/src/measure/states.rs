//! States of a run for visualisation programs: displacement, stress and tools at every recorded state.

use contact::Tool;
use geometry::{Mesh, Point3, Search, Vector3};
use shape::{Matrix3, PointRows};

use super::solved::Solved;
use super::stress::own_stress;
use crate::discretise::Volume;
use crate::error::Failure;
use crate::outcome::{LoadStep, Moved, State, States, Tensors, ToolSkin};
use crate::scenario::PlacedTool;

/// A recorded state of a run.
pub(super) struct Recorded<'a> {
    /// Time (s) in dynamics, fraction of the load in statics, 1 for a linear solution, or number of a mode.
    pub(super) time: f64,
    /// Nodal parameters, m.
    pub(super) u: &'a [Vector3],
    /// Parameters of a pressure field, Pa; `None` if the stress is unknown.
    pub(super) parameters: Option<&'a [f64]>,
    step: Option<&'a LoadStep>,
}

/// Recorded states of a procedure with steps, the end of a procedure without, or the vibration modes. At most
/// `most` of them are returned, evenly spaced and including the last.
pub(super) fn recorded<'a>(run: &Solved<'a>, most: usize) -> Vec<Recorded<'a>> {
    let Solved { prepared, solution, .. } = *run;
    // The parameters of a pressure field are known only at the end.
    let mixed = prepared.volume.pressure.is_some();
    match (&solution.history, &solution.vibration) {
        (Some(history), _) => {
            let last = history.steps.len().saturating_sub(1);
            let each = history.steps.iter().zip(&history.fields).enumerate();
            each.filter(|(k, _)| is_kept(*k, history.steps.len(), most))
                .map(|(k, (step, u))| {
                    let is_end = k == last && history.last.load == step.load;
                    let parameters = (!mixed || is_end).then_some(&solution.pressure[..]);
                    Recorded { time: step.time().unwrap_or(step.load), u, parameters, step: Some(step) }
                })
                .collect()
        }
        (None, Some(vibration)) => {
            let shapes = vibration.modes.shapes.iter().take(vibration.count).enumerate();
            let mode = |(k, u): (usize, &'a Vec<Vector3>)| Recorded {
                time: (k + 1) as f64,
                u,
                parameters: None,
                step: None,
            };
            shapes.map(mode).collect()
        }
        (None, None) if solution.u.is_empty() => Vec::new(),
        (None, None) => {
            let parameters = Some(&solution.pressure[..]);
            vec![Recorded { time: 1.0, u: &solution.u, parameters, step: None }]
        }
    }
}

/// Rows of the method's shape functions at the points of its mesh; `None` if these are the nodes.
pub(super) fn at_mesh(run: &Solved) -> Result<Option<PointRows>, Failure> {
    let Solved { method, prepared, .. } = *run;
    Ok(match method.interpolates {
        true => None,
        false => Some(prepared.source.at_points(method.mesh().points())?.0),
    })
}

/// Converts the states of [`recorded`] for visualisation programs.
pub(crate) fn states(run: &Solved, most: usize) -> Result<States, Failure> {
    let Solved { method, setup, prepared, solution } = *run;
    let mesh = method.mesh();
    let to_mesh = at_mesh(run)?;
    let at_nodes = |u: &[Vector3]| to_mesh.as_ref().map_or_else(|| u.to_vec(), |rows| rows.rows().apply(u));
    let cells = (solution.vibration.is_none() && !setup.relaxes())
        .then(|| Averages::new(mesh, &prepared.volume, prepared.source.cell_points()));
    let contact = prepared.contact();
    let state = |at: Recorded| {
        let Recorded { time, u, parameters, step } = at;
        let displacement = at_nodes(u);
        let closures: Vec<f64> =
            step.map_or(Vec::new(), |step| step.tools.iter().map(|tool| tool.closure).collect());
        let tools = || setup.tools.iter().map(|placed| &placed.tool).zip(&closures);
        let deformed = || mesh.points().iter().zip(&displacement).map(|(x, u)| x + u);
        State {
            time,
            tensors: cells
                .as_ref()
                .zip(parameters)
                .map(|(cells, parameters)| tensors(run, cells, u, parameters, time)),
            touching: tools()
                .flat_map(|(tool, closure)| contact.iter().flat_map(|at| at.within(tool, *closure, u)))
                .collect(),
            gap: tools()
                .flat_map(|(tool, closure)| deformed().map(|x| tool.gap(*closure, &x)))
                .fold(f64::INFINITY, f64::min),
            displacement,
            tools: tools().map(|(tool, closure)| moved(tool, *closure)).collect(),
        }
    };
    let states: Vec<State> = recorded(run, most).into_iter().map(state).collect();
    let tools = if solution.history.is_some() {
        setup.tools.iter().map(|tool| skin(tool, mesh)).collect()
    } else {
        Vec::new()
    };
    let recorded = solution.history.as_ref().map_or(0, |history| history.steps.len());
    let left_out = recorded.saturating_sub(states.len());
    let reaction = if to_mesh.is_none() { solution.reaction.clone() } else { Vec::new() };
    let (numbers, error_source) = Default::default();
    Ok(States { mesh: mesh.clone(), states, tools, reaction, numbers, error_source, left_out })
}

/// Whether the `k`-th of `count` states is among the `most` states that end equal parts of the history.
fn is_kept(k: usize, count: usize, most: usize) -> bool {
    count <= most || (k + 1) * most / count > k * most / count
}

/// Motion of a tool from its start to a closure (m).
fn moved(tool: &Tool, closure: f64) -> Moved {
    if !tool.turns() {
        return Moved { rotation: None, by: tool.displacement(closure) };
    }
    let (start, now) = (tool.pose(0.0), tool.pose(closure));
    let rotation = now.rotation * start.rotation.transpose();
    Moved { rotation: Some(rotation), by: now.place - rotation * start.place }
}

/// Surface of a tool at its start.
fn skin(set: &PlacedTool, mesh: &Mesh) -> ToolSkin {
    let first = mesh.points()[0].coords;
    let (low, high) =
        mesh.points().iter().fold((first, first), |(low, high), p| (low.inf(&p.coords), high.sup(&p.coords)));
    let (points, quads) = set.tool.shape().skin((high - low).max());
    let place = set.tool.place(0.0);
    ToolSkin {
        points: points.iter().map(|p| place + set.turned * p).collect(),
        quads,
        along: set.tool.along(),
    }
}

fn tensors(run: &Solved, cells: &Averages, u: &[Vector3], parameters: &[f64], time: f64) -> Tensors {
    let gradients = run.prepared.volume.rows.at().displacement_gradients(u);
    let of_points = own_stress(run, u, parameters, time);
    let j: Vec<f64> = gradients.iter().map(|h| (Matrix3::identity() + h).determinant()).collect();
    Tensors {
        stress: cells.of(|q| of_points[q]),
        det_f: cells.of(|q| Matrix3::identity() * j[q]).iter().map(|mean| mean[(0, 0)]).collect(),
    }
}

/// Quadrature points that represent each cell of the mesh, with their volumes.
struct Averages<'a> {
    weights: &'a [f64],
    /// First quadrature point of each cell and the number of all, or the point nearest to the centre of each
    /// cell.
    points: Result<Vec<usize>, Vec<usize>>,
    count: usize,
}

impl<'a> Averages<'a> {
    fn new(mesh: &Mesh, volume: &'a Volume, starts: Option<Vec<usize>>) -> Averages<'a> {
        let at = volume.rows.at().points();
        let points = starts.ok_or_else(|| {
            let search = Search::new(at).expect("quadrature points are finite");
            let middle = |cell| {
                let corners: Vec<&Point3> = mesh.cell_points(cell).collect();
                Point3::from(corners.iter().map(|p| p.coords).sum::<Vector3>() / corners.len() as f64)
            };
            (0..mesh.cell_count()).map(|cell| search.nearest(&middle(cell), 1)[0].index as usize).collect()
        });
        Averages { weights: volume.rows.weights(), points, count: mesh.cell_count() }
    }

    /// Volume-weighted means over each cell's points, or the value at the nearest point.
    fn of(&self, value: impl Fn(usize) -> Matrix3) -> Vec<Matrix3> {
        let mean = |cell: usize| match &self.points {
            Err(nearest) => value(nearest[cell]),
            Ok(starts) => {
                let points = starts[cell]..starts[cell + 1];
                let volume: f64 = self.weights[points.clone()].iter().sum();
                points.map(|q| value(q) * self.weights[q]).sum::<Matrix3>() / volume
            }
        };
        (0..self.count).map(mean).collect()
    }
}
