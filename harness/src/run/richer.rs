//! A richer method on the body of a run, to which the run's solution is carried.

use geometry::{Point3, Search, Vector3};

use cases::scene::Dilation;

use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::measure::{Solved, mean_pressure};
use crate::outcome::{Counters, Plan};
use crate::prepare::{Prepared, prepare};
use crate::procedure::{Carried, Problem, Solution, Wanted, plan};
use crate::scenario::setup::Setup;

/// Most nodes of elements with a pressure field, whose systems are always factored: each of 45,000 nodes
/// takes 15 s.
const MOST_MIXED: usize = 50_000;

/// A richer method with its tables, and the solution of a run carried to it.
pub(super) struct Richer<'a> {
    run: &'a Solved<'a>,
    pub(super) method: Discretisation,
    plan: Plan,
    pub(super) tables: Prepared,
    /// Displacement of the nodes, m.
    pub(super) u: Vec<Vector3>,
    /// Parameters of the pressure field, Pa, tension positive.
    pressure: Vec<f64>,
    /// The run's contact point next to each contact point.
    nearest: Vec<u32>,
}

impl<'a> Richer<'a> {
    /// The richer method has the dilation `free` if it would lock otherwise.
    ///
    /// # Errors
    /// Errors of the richer method's tables.
    pub(super) fn new(
        run: &'a Solved<'a>,
        free: Dilation,
        counters: &mut Counters,
    ) -> Result<Richer<'a>, Failure> {
        let Solved { method, setup, prepared, solution } = *run;
        let method = method.enriched(poisson(setup), free);
        let plan = plan(&method, setup, Wanted::default());
        let tables = prepare(&method, setup, &plan, counters)?;
        let u = prepared.source.at_points(method.nodes())?.0.rows().apply(&solution.u);
        let pressure = pressure(run, &tables)?;
        let nearest = nearest(prepared.contact_points(), tables.contact_points())?;
        Ok(Richer { run, method, plan, tables, u, pressure, nearest })
    }

    /// # Errors
    /// Too many nodes with a pressure field.
    pub(super) fn affordable(&self) -> Result<(), Failure> {
        let nodes = self.method.nodes().len();
        if self.method.dilation == Dilation::Mixed && nodes > MOST_MIXED {
            return Err(Failure::Run(format!(
                "it takes a factored system of {nodes} nodes with pressures; at most {MOST_MIXED} are supported"
            )));
        }
        Ok(())
    }

    pub(super) fn problem<'b>(&'b self, probes: &'b [Point3]) -> Problem<'b> {
        let Richer { method, plan, tables: prepared, .. } = self;
        Problem { method, setup: self.run.setup, prepared, plan, watch: None, probes }
    }

    pub(super) fn carried(&self) -> Carried<'_> {
        let Richer { u, pressure, nearest, .. } = self;
        Carried { from: self.run.solution, u, pressure, nearest }
    }

    /// The richer method with a solution.
    pub(super) fn solved<'b>(&'b self, solution: &'b Solution) -> Solved<'b> {
        let Richer { method, tables: prepared, .. } = self;
        Solved { method, setup: self.run.setup, prepared, solution }
    }
}

/// The largest Poisson's ratio of a body.
pub(super) fn poisson(setup: &Setup) -> f64 {
    setup.materials.iter().map(|material| material.poisson()).fold(0.0, f64::max)
}

/// Index of the point of `from` next to each of the points `to`; empty without points.
fn nearest(from: &[Point3], to: &[Point3]) -> Result<Vec<u32>, Failure> {
    if to.is_empty() || from.is_empty() {
        return Ok(Vec::new());
    }
    let search = Search::new(from).map_err(|bad| Failure::Run(bad.to_string()))?;
    Ok(to.iter().map(|at| search.nearest(at, 1)[0].index).collect())
}

/// Pressure of a run, Pa, tension positive, as parameters of the pressure field of `tables`: means over the
/// cells, then over the surroundings of each corner. Empty without such a field, zero if the run's points
/// belong to no cells.
fn pressure(run: &Solved, tables: &Prepared) -> Result<Vec<f64>, Failure> {
    let Some(rows) = &tables.volume.pressure else { return Ok(Vec::new()) };
    let mut sums = vec![[0.0; 2]; rows.node_count()];
    let Prepared { source, volume, .. } = run.prepared;
    if let (Some(cells), Some(parts)) = (source.cell_dilation()?, tables.source.cell_dilation()?) {
        let gradients = volume.rows.at().displacement_gradients(&run.solution.u);
        let active = run.prepared.active(run.setup, run.solution.time());
        let at =
            mean_pressure::at_points((&run.setup.laws, &active), volume, &gradients, &run.solution.pressure);
        let per_cell = parts.len() / cells.len();
        for part in 0..parts.len() {
            let points = cells.group(part / per_cell).0;
            let weight = |q: u32| volume.rows.weights()[q as usize];
            let whole: f64 = points.iter().map(|&q| weight(q)).sum();
            let mean = -points.iter().map(|&q| weight(q) * at[q as usize]).sum::<f64>() / whole;
            for &q in parts.group(part).0 {
                let (corners, values) = rows.row(q as usize);
                for (&corner, value) in corners.iter().zip(values) {
                    let share = value * tables.volume.rows.weights()[q as usize];
                    let [sum, weight] = &mut sums[corner as usize];
                    (*sum, *weight) = (*sum + share * mean, *weight + share);
                }
            }
        }
    }
    Ok(sums.iter().map(|[sum, weight]| if *weight > 0.0 { sum / weight } else { 0.0 }).collect())
}
