//! A cloud that follows an error: solve, see where gradients differ from recovered ones, place as many nodes anew, solve again.

use std::sync::Arc;

use cases::scene::ErrorKind;
use efg::gradient_error;
use geometry::shapes::Shape;
use geometry::{CloudError, Sizes, cloud_of_sizes};

use crate::Failure;
use crate::discretise::{Discretisation, Efg};
use crate::error::Key;
use crate::prepare::prepare;
use crate::run::solve_linear;
use crate::setup::Setup;
use crate::timing::Timings;
use crate::work::Work;

/// Clouds after the first, and what they are placed by.
#[derive(Clone)]
pub struct Refine {
    /// How many.
    pub steps: usize,
    /// Coarsest over finest spacing at most.
    pub ratio: f64,
    /// Seed of the generator.
    pub seed: u64,
    /// The body they fill.
    pub shape: Arc<dyn Shape + Send + Sync>,
}

/// The method on the last of its clouds; nothing where the cloud is to stay.
pub fn refined(
    method: &Discretisation,
    setup: &Setup,
    work: &mut Work,
) -> Result<Option<Discretisation>, Failure> {
    let Discretisation::Efg(Efg { refine: Some(refine), .. }) = method else { return Ok(None) };
    let mut current = method.clone();
    for _ in 0..refine.steps {
        let mut done = Work::default();
        let prepared = prepare(&current, setup, &mut done)?;
        let solution = solve_linear(&current, setup, &prepared, &mut Timings::default(), &mut done)?;
        let Discretisation::Efg(efg) = &mut current else { return Ok(None) };
        let error = gradient_error(&prepared.volume.rows, &solution.u, &efg.cloud.points);
        let none = |bad: CloudError| {
            Failure::at(ErrorKind::NotRun, Key::Method("cloud"), format!("makes no cloud: {bad}"), "")
        };
        let sizes = Sizes::new(&efg.cloud, &error, refine.ratio).map_err(|bad| none(bad.into()))?;
        efg.cloud = cloud_of_sizes(&*refine.shape, error.len(), refine.seed, &sizes).map_err(none)?;
        work.refinements += 1;
    }
    Ok(Some(current))
}
