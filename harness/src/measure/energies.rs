//! Strain energy of regions, at the end and in every recorded state.

use catalogue::metric;
use geometry::Vector3;
use material::Law;
use statics::{Active, Curves, Solid};

use super::solved::Solved;
use super::states::recorded;
use crate::error::{Failure, Key};
use crate::outcome::{Metric, Outcome, push};
use crate::procedure::with_static_problem;

/// Adds the strain energies (J) of the regions in `output.energies` to the outcome and to its steps, without the
/// work of active stress.
///
/// # Errors
/// Returns an error if a region of the list is none of the method's mesh, or if the energy of a state cannot be
/// computed.
pub(crate) fn energies(outcome: &mut Outcome, run: &Solved) -> Result<(), Failure> {
    let names = &run.setup.output.energies;
    // The stored part of the work on viscoelastic tissue is unknown.
    if names.is_empty() || run.setup.relaxes() {
        return Ok(());
    }
    let regions = regions(run, names)?;
    let laws: Vec<Law> = match run.setup.is_linear() {
        true => run.setup.materials.iter().map(|&law| law.into()).collect(),
        false => run.setup.laws.clone(),
    };
    let usual = Curves::proportional();
    with_static_problem(run.method, run.setup, run.prepared, None, usual, |problem| {
        let solid = Solid { laws: &laws, active: Active::default(), ..problem.solid };
        let of = |u: &[Vector3], pressure: &[f64]| -> Result<Vec<Metric>, Failure> {
            let mut sums = vec![0.0; names.len()];
            for (q, energy) in solid.energies(u, pressure)?.into_iter().enumerate() {
                let region = run.prepared.volume.region(q);
                sums.iter_mut()
                    .zip(&regions)
                    .filter(|(_, of)| **of == region)
                    .for_each(|(sum, _)| *sum += energy);
            }
            let mut metrics = Vec::new();
            for (index, sum) in sums.into_iter().enumerate() {
                push(&mut metrics, metric::REGION_ENERGY.at(index), sum);
            }
            Ok(metrics)
        };
        let Solved { solution, .. } = *run;
        outcome.metrics.extend(of(&solution.u, &solution.pressure)?);
        if solution.history.is_some() {
            for (step, state) in outcome.steps.iter_mut().zip(recorded(run, usize::MAX)) {
                if let Some(pressure) = state.parameters {
                    step.points.extend(of(state.u, pressure)?);
                }
            }
        }
        Ok(())
    })
}

/// Indices of the regions with these names.
fn regions(run: &Solved, names: &[String]) -> Result<Vec<usize>, Failure> {
    let known = run.method.mesh().region_names();
    let find = |(index, name): (usize, &String)| {
        known.iter().position(|known| known == name).ok_or_else(|| {
            let problem = format!("names '{name}', a region that the mesh does not have");
            let help = format!("the mesh has {}", known.join(", "));
            Failure::input(Key::Scene(format!("output.energies[{index}]")), problem, &help)
        })
    };
    names.iter().enumerate().map(find).collect()
}
