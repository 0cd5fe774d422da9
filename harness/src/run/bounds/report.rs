//! Bounds among the metrics of a run.

use catalogue::metric::{self, Address, Metric};
use catalogue::warning;

use super::enclose::bounds;
use super::result::Bounded;
use crate::error::Failure;
use crate::measure::Solved;
use crate::outcome::{Counters, Outcome, Warning, push};

/// Adds the bounds to the metrics of a run, with a warning if its energy lies outside.
///
/// # Errors
/// A problem whose solution the bounds do not enclose.
pub(crate) fn add_bounds(
    outcome: &mut Outcome,
    run: &Solved,
    counters: &mut Counters,
) -> Result<(), Failure> {
    let bounds = bounds(run.method, run.setup)?;
    counters.bounding_dofs += bounds.dofs.iter().map(|&dofs| dofs as u64).sum::<u64>();
    let whole = |metrics: [&'static Metric; 2]| metrics.map(Address::from);
    for (of, bracket) in &bounds.results {
        let [lower, upper] = match of {
            Bounded::Energy => whole([&metric::STRAIN_ENERGY_LOWER, &metric::STRAIN_ENERGY_UPPER]),
            Bounded::Force { .. } => whole([&metric::SUPPORT_FORCE_LOWER, &metric::SUPPORT_FORCE_UPPER]),
            Bounded::Displacement => {
                whole([&metric::LOAD_DISPLACEMENT_LOWER, &metric::LOAD_DISPLACEMENT_UPPER])
            }
            Bounded::Mean { index, axis } => {
                [&metric::MEAN_LOWER, &metric::MEAN_UPPER].map(|metric| metric.components()[*axis].at(*index))
            }
        };
        push(&mut outcome.metrics, lower, bracket.lower);
        push(&mut outcome.metrics, upper, bracket.upper);
    }
    let bracket = bounds.results[0].1;
    push(&mut outcome.metrics, &metric::BOUNDS_HALF_WIDTH, bracket.half_width());
    let Some(energy) = outcome.value(&metric::STRAIN_ENERGY) else { return Ok(()) };
    let excess = bracket.excess(energy);
    push(&mut outcome.metrics, &metric::BOUNDS_EXCESS, excess);
    if excess != 0.0 {
        let message = format!(
            "the strain energy of {energy:.4e} J can't be that of the exact solution, which lies between {:.4e} J and \
             {:.4e} J: it is {:.2} % too {}; take a finer mesh or a better method",
            bracket.lower,
            bracket.upper,
            100.0 * excess.abs(),
            if excess > 0.0 { "large" } else { "small" }
        );
        outcome.warnings.push(Warning::new(&warning::OUTSIDE_BOUNDS, excess, "output.bounds", message));
    }
    Ok(())
}
