//! The second level of an estimate: the same method on a coarser mesh, with its own prediction, shows which
//! part of the error the prediction shares with the run.

use catalogue::warning;
use geometry::Point3;

use super::run;
use super::witness::coarser_version;
use crate::error::Failure;
use crate::measure::Request;
use crate::outcome::{Estimates, Outcome, SATURATED, Warning};
use crate::procedure::{Wanted, plan};
use crate::scenario::Scenario;

/// Corrects the estimates of a run, which must have them, by those on a coarser mesh, and adds them to its
/// metrics. `probes`, m.
pub(super) fn report_estimates(outcome: &mut Outcome, scenario: &Scenario, probes: &[Point3]) {
    let Some(mut estimates) = outcome.estimates.take() else { return };
    match coarser(scenario, outcome.size.nodes as usize, probes, &estimates.points) {
        Ok(coarser) => {
            let most = estimates.correct(&coarser).filter(|(_, saturation)| *saturation > SATURATED);
            if let Some((of, saturation)) = most {
                let message = format!(
                    "{of} is {saturation:.2}: from a coarser mesh to this one, the prediction changed by more than half of the \
                     change of the run, so that the estimated errors are uncertain by a factor of 2 or more; take a finer \
                     mesh, above all at the edges of supports, loads and tools"
                );
                outcome.warnings.push(Warning::new(
                    &warning::LEVELS_DISAGREE,
                    saturation,
                    "output.estimate",
                    message,
                ));
            }
        }
        Err(failure) => {
            let message = format!("no coarser mesh confirms the estimated errors: {failure}");
            outcome.warnings.push(Warning::new(&warning::SINGLE_ESTIMATE, 0.0, "output.estimate", message));
        }
    }
    outcome.metrics.extend(estimates.metrics());
}

/// Estimates of a method with twice the spacing. `probes` and `points`, m.
fn coarser(
    scenario: &Scenario,
    nodes: usize,
    probes: &[Point3],
    points: &[Point3],
) -> Result<Estimates, Failure> {
    let method = coarser_version(&scenario.method, nodes).map_err(Failure::Run)?;
    let scenario = Scenario { method, ..scenario.clone() };
    let discretisation = scenario.discretise()?;
    let own = discretisation.nodes().len();
    if own >= nodes {
        return Err(Failure::Run(format!("no mesh with fewer than {nodes} nodes can be made")));
    }
    let setup = scenario.setup()?;
    let plan = plan(&discretisation, &setup, Wanted { targets: true, ..Wanted::default() });
    let done = run(scenario.identity(), plan, &discretisation, &setup, &Request::alone(probes, points))?;
    let Outcome { stalled, estimates, warnings, .. } = done.outcome;
    if let Some(failure) = stalled {
        return Err(failure);
    }
    let without = || warnings.iter().find(|w| *w.kind == warning::NO_ESTIMATE).map(Warning::text);
    estimates.ok_or_else(|| Failure::Run(without().unwrap_or_else(|| "it has no estimate".into())))
}
