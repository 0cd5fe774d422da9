//! A problem that a solver outside this program solves: written to files, asked, and its answer taken for the solution.

pub(crate) mod problem;

use std::time::Instant;

use cases::scene::Procedure;
use catalogue::metric;
use geometry::{Matrix3, Vector3};
use material::{Law, Material as _};

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
    // Asked once for all runs: no part of any.
    let known_version =
        adapter::ready(&outside.adapter).ok().and_then(|()| adapter::version(&outside.adapter));
    let began = Instant::now();
    let work = Folder::new().map_err(failed)?;
    let (folder, to) = (work.inside("problem").map_err(failed)?, work.inside("answer").map_err(failed)?);
    let id = problem::write(problem, &outside.about, &folder, &outside.adapter.manifest.reads)?;
    let steps = steps(problem.setup);
    let answered = adapter::ask(&Question {
        adapter: &outside.adapter,
        work: &work,
        problem: &folder,
        answer: &to,
        id: &id,
        nodes: problem.method.nodes().len(),
        steps,
        limits: outside.about.limits,
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
    let version = said.or(known_version);
    let program = OfProgram { memory: call.memory, version };
    let history = (steps > 0).then(|| history(problem, &answered));
    let load = history.as_ref().map_or(1.0, |history| history.last.load);
    let u = answered.fields.into_iter().next_back().unwrap_or_default();
    let residual = Some(residual(problem, &u, load)?);
    let dofs = problem.free_dofs();
    Ok(Solution { u, dofs, residual, program: Some(program), history, ..Solution::default() })
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

/// Forces that our elements leave unbalanced at free nodes, over the larger of inner forces and loads.
fn residual(problem: &Problem, u: &[Vector3], load: f64) -> Result<f64, Failure> {
    let volume = &problem.prepared.volume;
    let outer = statics::nodal_forces(&volume.rows, &problem.prepared.loads())?;
    let mut inner = vec![Vector3::zeros(); outer.len()];
    for (q, (h, w)) in
        volume.rows.at().displacement_gradients(u).iter().zip(volume.rows.weights()).enumerate()
    {
        let stress = law(problem, q).stress(h) * *w;
        let (nodes, gradients) = volume.rows.row(q);
        nodes.iter().zip(gradients).for_each(|(&node, g)| inner[node as usize] += stress * g);
    }
    let size = |forces: &[Vector3]| forces.iter().map(Vector3::norm_squared).sum::<f64>().sqrt();
    let largest = size(&inner).max(load * size(&outer));
    let mut left: Vec<Vector3> =
        inner.iter().zip(&outer).map(|(inner, outer)| outer * load - inner).collect();
    for fixed in problem.prepared.fixed() {
        left[fixed.node as usize][usize::from(fixed.axis)] = 0.0;
    }
    Ok(if largest > 0.0 { size(&left) / largest } else { 0.0 })
}

/// The law of a quadrature point.
fn law<'a>(problem: &'a Problem, q: usize) -> &'a Law {
    &problem.setup.laws[problem.prepared.volume.region.get(q).map_or(0, |&region| usize::from(region))]
}

/// Strain energy (J) by our quadrature, and the smallest volume ratio at its points.
fn energy(problem: &Problem, u: &[Vector3]) -> (f64, f64) {
    let volume = &problem.prepared.volume;
    let gradients = volume.rows.at().displacement_gradients(u);
    let (mut energy, mut smallest) = (0.0, f64::INFINITY);
    for (q, (h, w)) in gradients.iter().zip(volume.rows.weights()).enumerate() {
        energy += w * law(problem, q).energy(h);
        smallest = (Matrix3::identity() + h).determinant().min(smallest);
    }
    (energy, smallest)
}
