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
use crate::outcome::{LoadStep, Meters, Metric};
use crate::prepare::ConditionForces;
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
    let end = answer.load.filter(|_| answered.stalled.is_some()).unwrap_or(1.0);
    let iterations = answer.counts.get("iterations").copied().filter(|n| *n >= 0.0 && *n < 1e9);
    let stalled = answered.stalled.clone().map(Failure::from);
    let solution = taken(problem, answered.fields, end)?;
    let history = solution.history.map(|history| {
        let metrics = iterations.map(|count| Metric::new(&metric::NEWTON_ITERATIONS, count));
        StepHistory { metrics: metrics.into_iter().collect(), failure: stalled, ..history }
    });
    Ok(Solution { program: Some(program), history, ..solution })
}

/// What a displacement (m) makes of a solution, given at the end of each of equal steps up to the part `end` of the load, or at the end alone: its
/// energies, volume ratios, forces of supports and forces out of balance are those of our own elements.
pub(crate) fn taken(problem: &Problem, fields: Vec<Vec<Vector3>>, end: f64) -> Result<Solution, Failure> {
    let outer = statics::nodal_forces(&problem.prepared.volume.rows, &problem.prepared.loads())?;
    let history = (steps(problem.setup) > 0).then(|| history(problem, &outer, &fields, end));
    let load = history.as_ref().map_or(1.0, |history| history.last.load);
    let u = fields.into_iter().next_back().unwrap_or_default();
    let inner = is_of_nodes(problem).then(|| inner_forces(problem, &u));
    let residual = inner.as_ref().map(|inner| residual(problem, &outer, inner, load));
    let supports = inner.map_or_else(Vec::new, |inner| supports(problem, &outer, &inner, load));
    Ok(Solution { u, supports, dofs: problem.free_dofs(), residual, history, ..Solution::default() })
}

/// Whether every point has its own dilation. With a projection, what the points have by themselves is neither in balance nor the energy.
fn is_plain(problem: &Problem) -> bool {
    problem.prepared.volume.groups.is_none() && problem.prepared.volume.pressure.is_none()
}

/// Whether inner forces, loads and forces of supports at nodes are all that acts: no tool touches, and supports hold nodes.
fn is_of_nodes(problem: &Problem) -> bool {
    is_plain(problem) && problem.prepared.holds_nodes_alone() && problem.prepared.contact().is_none()
}

/// Load steps of a procedure that has some.
pub(crate) fn steps(setup: &Setup) -> usize {
    match &setup.procedure {
        Procedure::Static(asked) => asked.steps,
        _ => 0,
    }
}

/// The steps of an answer, or its end alone, with energies and volume ratios of our own elements.
fn history(problem: &Problem, outer: &[Vector3], fields: &[Vec<Vector3>], end: f64) -> StepHistory {
    let count = fields.len() as f64;
    let (plain, of_nodes) = (is_plain(problem), is_of_nodes(problem));
    let steps: Vec<LoadStep> = (1..)
        .zip(fields)
        .map(|(step, u)| {
            let (energy, smallest_j) = energy(problem, u);
            let load = end * f64::from(step) / count;
            let supported = of_nodes.then(|| supports(problem, outer, &inner_forces(problem, u), load));
            LoadStep {
                load,
                strain_energy: Some(energy).filter(|energy| plain && energy.is_finite()),
                smallest_j,
                supports: supported.unwrap_or_default(),
                ..LoadStep::at_start(0)
            }
        })
        .collect();
    StepHistory {
        last: steps.last().cloned().unwrap_or_else(|| LoadStep::at_start(0)),
        steps,
        fields: fields.to_vec(),
        metrics: Vec::new(),
        failure: None,
    }
}

/// Forces that our elements leave unbalanced at free nodes, over the larger of inner forces and loads.
fn residual(problem: &Problem, outer: &[Vector3], inner: &[Vector3], load: f64) -> f64 {
    let size = |forces: &[Vector3]| forces.iter().map(Vector3::norm_squared).sum::<f64>().sqrt();
    let largest = size(inner).max(load * size(outer));
    let mut left: Vec<Vector3> = inner.iter().zip(outer).map(|(inner, outer)| outer * load - inner).collect();
    for fixed in problem.prepared.fixed() {
        left[fixed.node as usize][usize::from(fixed.axis)] = 0.0;
    }
    if largest > 0.0 { size(&left) / largest } else { 0.0 }
}

/// Force (N) of each support on the body, of the inner forces at this part of the load; none where a field is none of ours.
fn supports(problem: &Problem, outer: &[Vector3], inner: &[Vector3], load: f64) -> Vec<Vector3> {
    let nodes: Vec<Vector3> = inner.iter().zip(outer).map(|(inner, outer)| inner - outer * load).collect();
    let forces = ConditionForces { nodes: &nodes, rows: &[], weak: &[] };
    let found = problem.prepared.support_forces(&forces);
    if found.iter().all(|force| force.iter().all(|f| f.is_finite())) { found } else { Vec::new() }
}

/// Internal nodal forces of our elements, N.
fn inner_forces(problem: &Problem, u: &[Vector3]) -> Vec<Vector3> {
    let volume = &problem.prepared.volume;
    let mut inner = vec![Vector3::zeros(); u.len()];
    for (q, (h, w)) in
        volume.rows.at().displacement_gradients(u).iter().zip(volume.rows.weights()).enumerate()
    {
        let stress = law(problem, q).stress(h) * *w;
        let (nodes, gradients) = volume.rows.row(q);
        nodes.iter().zip(gradients).for_each(|(&node, g)| inner[node as usize] += stress * g);
    }
    inner
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
