//! Adaptive clouds: solve, compare the gradients with recovered gradients, place the same number of nodes
//! again, and solve again.

use cases::scene::{ErrorKind, LinearSolver, Procedure};
use efg::gradient_error;
use geometry::{CloudError, Sizes, cloud_of_sizes};

use super::linear;
use super::problem::Problem;
use crate::discretise::Discretisation;
use crate::error::{Failure, Key};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, Plan};
use crate::prepare::prepare;
use crate::scenario::setup::Setup;

/// Returns the method on the last of its refined clouds; `None` if the cloud is not refined.
pub(crate) fn refined(
    method: &Discretisation,
    setup: &Setup,
    plan: &Plan,
    counters: &mut Counters,
) -> Result<Option<Discretisation>, Failure> {
    let Some(first) = &method.refine else { return Ok(None) };
    let mut current = method.clone();
    let mut refine = first.clone();
    for _ in 0..first.steps {
        let mut own = Meters::default();
        let prepared = prepare(&current, setup, plan, &mut own.counters)?;
        let problem =
            Problem { method: &current, setup, prepared: &prepared, plan, watch: None, probes: &[] };
        let solver = match setup.procedure {
            Procedure::Linear { solver } => solver,
            _ => LinearSolver::Auto,
        };
        let solution = linear::solve(&problem, solver, &mut own)?;
        let error = gradient_error(&prepared.volume.rows, &solution.u, &refine.cloud.points);
        let none = |bad: CloudError| {
            Failure::at(ErrorKind::NotRun, Key::Method("cloud"), format!("can't be refined: {bad}"), "")
        };
        let sizes = Sizes::new(&refine.cloud, &error, refine.ratio).map_err(|bad| none(bad.into()))?;
        let cloud = cloud_of_sizes(&*refine.shape, error.len(), refine.seed, &sizes).map_err(none)?;
        current = (refine.on)(cloud.clone())?;
        refine.cloud = cloud;
        counters.refinements += 1;
    }
    Ok(Some(current))
}
