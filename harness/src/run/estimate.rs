//! Estimate of a run's error: its solution is carried to more shape functions on the same body, where
//! Newton's method finds the equilibrium nearby, and one linear system that of a linear problem.
//!
//! The distance from this equilibrium is the error of the run, apart from the error of the richer method,
//! which is of higher order. Points of contact take the friction of the run's next point.

use cases::scene::Dilation;
use catalogue::warning;

use super::richer::{Richer, poisson};
use crate::error::Failure;
use crate::measure::{self, Field, Request};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, Estimates, Outcome, Warning};
use crate::prepare::prepare;
use crate::procedure::{Problem, Vibration, Wanted, plan, predict, predict_modes};

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
    let mut own = Meters::default();
    let richer = Richer::new(run, Dilation::Mixed, &mut own.counters)?;
    richer.affordable()?;
    let predicted = predict(&richer.problem(request.probes), &richer.carried(), &mut own)?;
    counters.predicted_dofs += predicted.dofs as u64;
    let linearised = predicted.linearised;
    let predicted = richer.solved(&predicted);
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
    let finer = run.method.enriched(poisson(setup), Dilation::Mixed);
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
