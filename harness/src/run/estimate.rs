//! Estimate of a run's error: its solution is carried to more shape functions on the same body, where
//! Newton's method finds the equilibrium nearby, and one linear system that of a linear problem.
//!
//! The distance from this equilibrium is the error of the run, apart from the error of the richer method,
//! which is of higher order. Points of contact take the friction of the run's next point.

use cases::scene::Dilation;
use catalogue::warning;
use geometry::{Point3, Search};

use crate::error::Failure;
use crate::measure::{self, Field, Request, mean_pressure};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, Estimates, Outcome, Warning};
use crate::prepare::{Prepared, prepare};
use crate::procedure::{Carried, Problem, Vibration, Wanted, plan, predict, predict_modes};
use crate::scenario::setup::Setup;

/// Most nodes of elements with a pressure field, whose systems are always factored: each of 45,000 nodes
/// takes 15 s.
const MOST_MIXED: usize = 50_000;

/// Estimates the errors of a run.
///
/// # Errors
/// Errors of the richer method's tables or of its linear system.
pub(super) fn estimate(
    outcome: &mut Outcome,
    run: &measure::Solved,
    field: &Field,
    request: &Request,
    counters: &mut Counters,
) -> Result<Estimates, Failure> {
    let measure::Solved { method, setup, prepared, solution } = *run;
    let finer = method.enriched(poisson(setup));
    if finer.dilation == Dilation::Mixed && finer.nodes().len() > MOST_MIXED {
        return Err(Failure::Run(format!(
            "it takes a factored system of {} nodes with pressures; at most {MOST_MIXED} are supported",
            finer.nodes().len()
        )));
    }
    let plan = plan(&finer, setup, Wanted::default());
    let mut own = Meters::default();
    let tables = prepare(&finer, setup, &plan, &mut own.counters)?;
    let start = prepared.source.at_points(finer.nodes())?.0.rows().apply(&solution.u);
    let problem = Problem {
        method: &finer,
        setup,
        prepared: &tables,
        plan: &plan,
        watch: None,
        probes: request.probes,
    };
    let pressure = pressure(run, &tables)?;
    let nearest = nearest(prepared.contact_points(), tables.contact_points())?;
    let carried = Carried { from: solution, u: &start, pressure: &pressure, nearest: &nearest };
    let predicted = predict(&problem, &carried, &mut own)?;
    counters.predicted_dofs += predicted.dofs as u64;
    let linearised = predicted.linearised;
    let predicted = measure::Solved { method: &finer, setup, prepared: &tables, solution: &predicted };
    let estimates = measure::estimates(run, &predicted, field, request)?;
    if linearised {
        let error = estimates.of_displacement();
        let message = format!(
            "no equilibrium with more shape functions was found near this one, so that the errors are estimated from the \
             linearised problem ({:.0} % of the displacement): expect too large ones; take a finer mesh or a smaller load",
            100.0 * error
        );
        outcome.warnings.push(Warning::new(&warning::ROUGH_ESTIMATE, error, "output.estimate", message));
    }
    Ok(estimates)
}

/// Estimates the errors of the reported frequencies, by the frequencies of the richer method with the same
/// numbers.
///
/// # Errors
/// Errors of the richer method's tables or modes, and of a body that needs a pressure field.
pub(super) fn estimate_modes(run: &measure::Solved, own: &Vibration) -> Result<Estimates, Failure> {
    let setup = run.setup;
    let finer = run.method.enriched(poisson(setup));
    if finer.dilation == Dilation::Mixed {
        let problem = "its elements would need a pressure field, with which no vibrations are solved";
        return Err(Failure::Run(problem.into()));
    }
    let plan = plan(&finer, setup, Wanted::default());
    let mut meters = Meters::default();
    let tables = prepare(&finer, setup, &plan, &mut meters.counters)?;
    let problem = Problem { method: &finer, setup, prepared: &tables, plan: &plan, watch: None, probes: &[] };
    let solution = predict_modes(&problem, &mut meters)?;
    Ok(measure::frequencies(own, solution.vibration.as_ref()))
}

/// The largest Poisson's ratio of a body.
fn poisson(setup: &Setup) -> f64 {
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
fn pressure(run: &measure::Solved, tables: &Prepared) -> Result<Vec<f64>, Failure> {
    let Some(rows) = &tables.volume.pressure else { return Ok(Vec::new()) };
    let mut sums = vec![[0.0; 2]; rows.node_count()];
    let Prepared { source, volume, .. } = run.prepared;
    if let (Some(cells), Some(parts)) = (source.cell_dilation()?, tables.source.cell_dilation()?) {
        let gradients = volume.rows.at().displacement_gradients(&run.solution.u);
        let at = mean_pressure::at_points(&run.setup.laws, volume, &gradients, &run.solution.pressure);
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
