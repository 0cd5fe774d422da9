//! A problem that a solver outside this program solves: written to files, asked, and its answer taken for the solution.

pub(crate) mod problem;

use std::time::Instant;

use cases::scene::Procedure;
use catalogue::metric;
use geometry::{Matrix3, Vector3};
use material::Material as _;

use super::{Problem, Solution, Stages, StepHistory};
use crate::Failure;
use crate::adapter::{self, Answered, Folder, Outside, Question};
use crate::error::{Foreign, ForeignStatus};
use crate::outcome::{LoadStep, Meters, Metric, push};
use crate::scenario::setup::Setup;

/// What is known of the program that solved.
#[derive(Clone, Debug, Default)]
pub(crate) struct OfProgram {
    /// Most bytes that its processes had together.
    pub(crate) memory: u64,
    /// Its name and version, as far as it says.
    pub(crate) version: Option<String>,
}

/// The phases that a solver reports of itself.
const OWN_PHASES: [(&str, &str); 6] = [
    ("read", "own-read"),
    ("prepare", "own-prepare"),
    ("assemble", "own-assemble"),
    ("factor", "own-factor"),
    ("solve", "own-solve"),
    ("write", "own-write"),
];
/// Any other.
const OTHER_PHASE: &str = "own-other";

/// What is left for this program to do.
pub(super) fn stages(outside: &Outside) -> Stages {
    let by = || (false, format!("{} solves it", outside.adapter.manifest.name));
    Stages {
        mass: by(),
        stiffness: by(),
        time_steps: by(),
        factorisation: by(),
        newton: by(),
        relaxation: by(),
        ..Stages::linear()
    }
}

/// Writes, asks and reads. Only the time of the program's own processes is the solution's.
pub(super) fn solve(problem: &Problem, outside: &Outside, meters: &mut Meters) -> Result<Solution, Failure> {
    let failed = |reason| Failure::from(Foreign::new(ForeignStatus::Failed, reason));
    let began = Instant::now();
    let work = Folder::new().map_err(failed)?;
    let folder = work.inside("problem").map_err(failed)?;
    let id = problem::write(problem, outside, &folder, &outside.adapter.manifest.reads)?;
    let steps = steps(problem.setup);
    let answered = adapter::ask(&Question {
        adapter: &outside.adapter,
        work: &work,
        problem: &folder,
        id: &id,
        nodes: problem.method.nodes().len(),
        steps,
        limits: outside.limits,
        threads: rayon::current_num_threads(),
    })?;
    drop(work);
    let Answered { call, answer, .. } = &answered;
    meters.timings.book_both("solve", call.wall, call.cpu);
    meters.timings.book("exchange", began.elapsed().as_secs_f64() - call.wall);
    for (name, &seconds) in answer.phases.iter().filter(|(_, seconds)| seconds.is_finite()) {
        let known = OWN_PHASES.iter().find(|(own, _)| own == name);
        meters.timings.book(known.map_or(OTHER_PHASE, |(_, phase)| phase), seconds);
    }
    let said = Some(answer.version.clone()).filter(|version| !version.is_empty());
    let version = said.or_else(|| adapter::version(&outside.adapter));
    let program = OfProgram { memory: call.memory, version };
    let history = (steps > 0).then(|| history(problem, &answered));
    let u = answered.fields.into_iter().next_back().unwrap_or_default();
    Ok(Solution { u, dofs: problem.free_dofs(), program: Some(program), history, ..Solution::default() })
}

/// Load steps of a procedure that has some.
pub(super) fn steps(setup: &Setup) -> usize {
    match &setup.procedure {
        Procedure::Static(asked) => asked.steps,
        _ => 0,
    }
}

/// The steps of an answer, or its end alone, with energies and volume ratios of our own elements.
fn history(problem: &Problem, answered: &Answered) -> StepHistory {
    let end = answered.answer.load.filter(|_| answered.stalled.is_some()).unwrap_or(1.0);
    let count = answered.fields.len() as f64;
    let iterations = answered.answer.counts.get("iterations").copied().filter(|n| *n >= 0.0 && *n < 1e9);
    let steps: Vec<LoadStep> = (1..)
        .zip(&answered.fields)
        .map(|(step, u)| {
            let (energy, smallest_j) = energy(problem, u);
            LoadStep {
                load: end * f64::from(step) / count,
                strain_energy: Some(energy).filter(|energy| energy.is_finite()),
                smallest_j,
                ..LoadStep::at_start(0)
            }
        })
        .collect();
    let mut metrics: Vec<Metric> = Vec::new();
    iterations.into_iter().for_each(|count| push(&mut metrics, &metric::NEWTON_ITERATIONS, count));
    StepHistory {
        last: steps.last().cloned().unwrap_or_else(|| LoadStep::at_start(0)),
        steps,
        fields: answered.fields.clone(),
        metrics,
        failure: answered.stalled.clone().map(Failure::from),
    }
}

/// Strain energy (J) by our quadrature, and the smallest volume ratio at its points.
fn energy(problem: &Problem, u: &[Vector3]) -> (f64, f64) {
    let volume = &problem.prepared.volume;
    let gradients = volume.rows.at().displacement_gradients(u);
    let (mut energy, mut smallest) = (0.0, f64::INFINITY);
    for (q, (h, w)) in gradients.iter().zip(volume.rows.weights()).enumerate() {
        let law = &problem.setup.laws[volume.region.get(q).map_or(0, |&region| usize::from(region))];
        energy += w * law.energy(h);
        smallest = (Matrix3::identity() + h).determinant().min(smallest);
    }
    (energy, smallest)
}
