//! Training of a reduced model: the scene's training runs of the full method, whose states give the modes and
//! the cells in which forces are evaluated.

use cases::scene::{Pod, Procedure};
use geometry::Vector3;
use statics::{Active, Basis, Solid};

use super::problem::Problem;
use super::statics::{solid, solve};
use crate::discretise::Discretisation;
use crate::error::{Failure, Key};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, Plan};
use crate::prepare::{Prepared, Reduced, chosen, prepare};
use crate::scenario::setup::Setup;

/// States of one training run.
struct Run {
    prepared: Prepared,
    states: Vec<Vec<Vector3>>,
    /// Load fraction of each state.
    times: Vec<f64>,
}

/// Learns the reduced model of a method from the training runs of its setup.
///
/// # Errors
/// A training run fails or ends before its whole load, or the states are combinations of fewer modes.
pub(crate) fn reduced(
    method: &Discretisation,
    setup: &Setup,
    pod: &Pod,
    plan: &Plan,
    counters: &mut Counters,
) -> Result<Reduced, Failure> {
    let runs: Vec<Run> = (setup.training.iter().enumerate())
        .map(|(index, training)| run(method, training, plan).map_err(|failure| of(index, failure)))
        .collect::<Result<_, _>>()?;
    let states: Vec<Vec<Vector3>> = runs.iter().flat_map(|run| run.states.iter().cloned()).collect();
    counters.training_states += states.len() as u64;
    let volume = &runs.first().expect("a reduced model has training").prepared.volume;
    let basis = Basis::of_states(&volume.rows, &states, pod.modes);
    if basis.len() < pod.modes {
        let problem = format!(
            "asks for {} modes, but the {} states of the training are combinations of {}",
            pod.modes,
            states.len(),
            basis.len()
        );
        let help = "ask for fewer modes, or add [[training]] or steps of the procedure";
        return Err(Failure::unavailable(Key::Method("pod.modes"), problem, help));
    }
    let coefficients = states.iter().map(|u| basis.project(u)).collect();
    let all = Reduced { basis, volume: None, states: coefficients, cells: 1.0, error: 0.0 };
    let Some(part) = pod.cells else { return Ok(all) };
    let mut works = Vec::new();
    for (run, training) in runs.iter().zip(&setup.training) {
        for (u, &time) in run.states.iter().zip(&run.times) {
            // The stress of the reduced model belongs to the nearest displacement that it can have.
            let mut near = vec![Vector3::zeros(); u.len()];
            all.basis.add_to(&all.basis.project(u), 1.0, &mut near);
            let works_at = |active: &[f64]| {
                let whole = solid(training, &run.prepared.volume);
                let solid = Solid { active: Active::new(active), ..whole };
                all.basis.works(&solid, &near)
            };
            let active = run.prepared.active(training, time);
            // Active and passive stress of a body that nothing loads balance each other. Their sum says
            // nothing of the cells that each of them needs.
            works.push(works_at(&vec![0.0; active.len()])?);
            if !active.is_empty() {
                works.push(works_at(&active)?);
            }
        }
    }
    let (volume, [taken, count], error) = chosen(volume, &works, part)?;
    Ok(Reduced { volume: Some(volume), cells: taken as f64 / count as f64, error, ..all })
}

/// Solves one training run.
fn run(method: &Discretisation, training: &Setup, plan: &Plan) -> Result<Run, Failure> {
    let Procedure::Static(asked) = &training.procedure else { unreachable!("reduced models are static") };
    let mut meters = Meters::default();
    let prepared = prepare(method, training, plan, &mut meters.counters)?;
    let problem = Problem { method, setup: training, prepared: &prepared, plan, watch: None, probes: &[] };
    let solution = solve(&problem, asked, &mut meters)?;
    let history = solution.history.expect("a static solution has steps");
    match history.failure {
        Some(failure) => Err(failure),
        None => {
            let times = history.steps.iter().map(|step| step.load).collect();
            Ok(Run { prepared, states: history.fields, times })
        }
    }
}

/// Names the training run that failed.
fn of(index: usize, failure: Failure) -> Failure {
    let help = "train on loads and places that the full method reaches";
    Failure::unavailable(
        Key::Scene(format!("training[{index}]")),
        format!("can't be run to its end: {failure}"),
        help,
    )
}
