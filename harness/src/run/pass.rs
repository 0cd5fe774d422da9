//! One preparation and solution of a problem.

use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::measure::Request;
use crate::outcome::Plan;
use crate::outcome::timing::Meters;
use crate::prepare::{Prepared, prepare};
use crate::procedure::{self, Problem, Solution};
use crate::scenario::setup::Setup;

/// Results of one timed pass.
pub(super) struct Pass {
    /// The method on refined nodes, if they are.
    pub(super) refined: Option<Discretisation>,
    pub(super) prepared: Prepared,
    pub(super) solution: Solution,
}

/// Prepares and solves a problem once.
pub(super) fn pass(
    current: &Discretisation,
    setup: &Setup,
    plan: &Plan,
    request: &Request,
    meters: &mut Meters,
) -> Result<Pass, Failure> {
    let Meters { timings, counters, .. } = meters;
    // The tables that an external solver is compared with do not count as its preparation time.
    let phase = if current.outside.is_some() { "tables" } else { "prepare" };
    let mut prepared = timings.time(phase, || prepare(current, setup, plan, counters))?;
    if let Some(pod) = &setup.pod {
        let reduced = timings.time("train", || procedure::reduced(current, setup, pod, plan, counters))?;
        prepared.reduced = Some(reduced);
    }
    let Request { watch, probes, .. } = *request;
    let problem = Problem { method: current, setup, prepared: &prepared, plan, watch, probes };
    let solution = procedure::solve(&problem, meters)?;
    Ok(Pass { refined: None, prepared, solution })
}
