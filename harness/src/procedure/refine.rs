//! A cloud that follows an error: solve, see where gradients differ from recovered ones, place as many nodes anew, solve again.

use cases::scene::ErrorKind;
use efg::gradient_error;
use geometry::{CloudError, Sizes, cloud_of_sizes};

use super::{Problem, linear};
use crate::Failure;
use crate::discretise::{Discretisation, Efg};
use crate::error::Key;
use crate::outcome::{Counters, Meters, Plan};
use crate::prepare::prepare;
use crate::scenario::setup::Setup;

/// The method on the last of its clouds; nothing where the cloud is to stay.
pub(crate) fn refined(
    method: &Discretisation,
    setup: &Setup,
    plan: &Plan,
    counters: &mut Counters,
) -> Result<Option<Discretisation>, Failure> {
    let Discretisation::Efg(Efg { refine: Some(refine), .. }) = method else { return Ok(None) };
    let mut current = method.clone();
    for _ in 0..refine.steps {
        let mut own = Meters::default();
        let prepared = prepare(&current, setup, &mut own.counters)?;
        let problem = Problem { method: &current, setup, prepared: &prepared, plan, watch: None };
        let solution = linear::solve(&problem, &mut own)?;
        let Discretisation::Efg(efg) = &mut current else { return Ok(None) };
        let error = gradient_error(&prepared.volume.rows, &solution.u, &efg.cloud.points);
        let none = |bad: CloudError| {
            Failure::at(ErrorKind::NotRun, Key::Method("cloud"), format!("makes no cloud: {bad}"), "")
        };
        let sizes = Sizes::new(&efg.cloud, &error, refine.ratio).map_err(|bad| none(bad.into()))?;
        efg.cloud = cloud_of_sizes(&*refine.shape, error.len(), refine.seed, &sizes).map_err(none)?;
        counters.refinements += 1;
    }
    Ok(Some(current))
}
