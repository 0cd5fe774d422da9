//! External solvers: the problem is written to files, the solver is called, and its answer is read as the
//! solution.

pub(crate) mod problem;

use std::time::Instant;

use cases::scene::Procedure;
use catalogue::metric;
use geometry::{Matrix3, Vector3};
use material::{Law, Material as _};
use shape::Resultant;

use super::problem::Problem;
use super::solution::{OfProgram, Solution, StepHistory};
use super::stages::Stages;
use crate::adapter::{self, Answered, Folder, Outside, Question};
use crate::error::{Failure, Foreign, ForeignStatus};
use crate::outcome::timing::Meters;
use crate::outcome::{LoadStep, Metric};
use crate::prepare::ConditionForces;
use crate::scenario::setup::Setup;

/// Phases that a solver may report, with their names in records.
const OWN_PHASES: [(&str, &str); 6] = [
    ("read", "own-read"),
    ("prepare", "own-prepare"),
    ("assemble", "own-assemble"),
    ("factor", "own-factor"),
    ("solve", "own-solve"),
    ("write", "own-write"),
];
/// Name in records of any other phase.
const OTHER_PHASE: &str = "own-other";

/// Stages of a run with an external solver.
pub(super) fn stages(outside: &Outside) -> Stages {
    let by = || (false, format!("solved by {}", outside.adapter.manifest.name));
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

/// Writes the problem, calls the solver and reads its answer. Only the time of the solver's own processes
/// counts as solution time.
pub(super) fn solve(problem: &Problem, outside: &Outside, meters: &mut Meters) -> Result<Solution, Failure> {
    let failed = |reason| Failure::from(Foreign::new(ForeignStatus::Failed, reason));
    // The version is queried once for all runs and belongs to none of them.
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

/// Builds a solution from displacements (m). `fields` has one displacement for each of the equal steps up to
/// the load fraction `end`, or only that at the end. Energies, volume ratios, support forces and residuals
/// are those of this program's own elements.
pub(crate) fn taken(problem: &Problem, fields: Vec<Vec<Vector3>>, end: f64) -> Result<Solution, Failure> {
    let outer = statics::nodal_forces(&problem.prepared.volume.rows, &problem.prepared.loads())?;
    let history = (steps(problem.setup) > 0).then(|| history(problem, &outer, &fields, end));
    let load = history.as_ref().map_or(1.0, |history| history.last.load);
    let u = fields.into_iter().next_back().unwrap_or_default();
    let inner = is_of_nodes(problem).then(|| inner_forces(problem, &u));
    let residual = inner.as_ref().map(|inner| residual(problem, &outer, inner, load));
    let supports = inner.map_or_else(Vec::new, |inner| supports(problem, &u, &outer, &inner, load));
    Ok(Solution { u, supports, dofs: problem.free_dofs(), residual, history, ..Solution::default() })
}

/// Whether every quadrature point has its own dilation. With a projection, the stress and energy at the
/// points alone are neither in balance nor the energy of the body.
fn is_plain(problem: &Problem) -> bool {
    problem.prepared.volume.groups.is_none() && problem.prepared.volume.pressure.is_none()
}

/// Whether only internal forces, loads and support forces act on the nodes: without contact, and with all
/// supports at nodes.
fn is_of_nodes(problem: &Problem) -> bool {
    is_plain(problem) && problem.prepared.holds_nodes_alone() && problem.prepared.contact().is_none()
}

/// Number of load steps of a static procedure; 0 for others.
pub(crate) fn steps(setup: &Setup) -> usize {
    match &setup.procedure {
        Procedure::Static(asked) => asked.steps,
        _ => 0,
    }
}

/// Load steps of an answer, or only its end, with energies and volume ratios of this program's own elements.
fn history(problem: &Problem, outer: &[Vector3], fields: &[Vec<Vector3>], end: f64) -> StepHistory {
    let count = fields.len() as f64;
    let plain = is_plain(problem);
    let of_nodes = is_of_nodes(problem);
    let steps: Vec<LoadStep> = (1..)
        .zip(fields)
        .map(|(step, u)| {
            let (energy, smallest_j) = energy(problem, u);
            let load = end * f64::from(step) / count;
            let supported = of_nodes.then(|| supports(problem, u, outer, &inner_forces(problem, u), load));
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

/// Residual forces at free nodes by this program's own elements, relative to the larger of the internal
/// forces and the loads.
fn residual(problem: &Problem, outer: &[Vector3], inner: &[Vector3], load: f64) -> f64 {
    let size = |forces: &[Vector3]| forces.iter().map(Vector3::norm_squared).sum::<f64>().sqrt();
    let largest = size(inner).max(load * size(outer));
    let mut left: Vec<Vector3> = inner.iter().zip(outer).map(|(inner, outer)| outer * load - inner).collect();
    for fixed in problem.prepared.fixed() {
        left[fixed.node as usize][usize::from(fixed.axis)] = 0.0;
    }
    if largest > 0.0 { size(&left) / largest } else { 0.0 }
}

/// Resultant of each support's forces on the body from the internal forces at this load fraction; empty if a
/// force is not finite.
fn supports(
    problem: &Problem,
    u: &[Vector3],
    outer: &[Vector3],
    inner: &[Vector3],
    load: f64,
) -> Vec<Resultant> {
    let nodes: Vec<Vector3> = inner.iter().zip(outer).map(|(inner, outer)| inner - outer * load).collect();
    let at = |i: usize| problem.method.nodes()[i] + u[i];
    let forces = ConditionForces { at: &at, nodes: &nodes, rows: &[], weak: &[], time: None };
    let found = problem.prepared.support_forces(&forces);
    if found.iter().all(|sum| sum.force.iter().all(|f| f.is_finite())) { found } else { Vec::new() }
}

/// Internal nodal forces by this program's own elements, N.
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

/// Material law of a quadrature point.
fn law<'a>(problem: &'a Problem, q: usize) -> &'a Law {
    &problem.setup.laws[problem.prepared.volume.region(q)]
}

/// Strain energy (J) by this program's own quadrature, and the smallest volume ratio at its points.
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
