//! One run: prepare, assemble, factor, solve (timed apart, repeated), then errors, probes and transfers.

use std::time::Instant;

use geometry::{Matrix3, Point3, Vector3};
use interp::Scheme;
use mechanics::{Body, Law, SolveInfo, assemble};

use crate::Failure;
use crate::discretise::Discretisation;
use crate::explicit;
use crate::in_time;
use crate::mean_pressure::cauchy;
use crate::motion::Motion;
use crate::norms::{self, difference, exact_at, norms};
use crate::outcome::{Identity, LoadStep, Metric, Outcome, Probe, Size, Stage, of_tool};
use crate::picture::{State, picture};
use crate::prepare::{Prepared, prepare};
use crate::relaxation;
use crate::setup::Setup;
use crate::statics::{self, Path};
use crate::timing::Timings;
use crate::transfer::transfers;
use crate::way;
use crate::work::Work;

/// How often a run is repeated for its timings: at least once, until `seconds` are spent or `most` is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// Most repeats.
    pub most: usize,
    /// Time to spend, s.
    pub seconds: f64,
}

/// Displacement (m) of a finished run at any points (m).
pub type Evaluate = Box<dyn Fn(&[Point3]) -> Result<Vec<Vector3>, Failure> + Send + Sync>;

/// The displacement that errors are measured against where no exact solution is known.
pub struct Reference {
    /// Which method made it.
    pub method: String,
    /// Its nodes.
    pub nodes: usize,
    /// Displacement at the scene's target points, m.
    pub targets: Vec<Vector3>,
    /// Its load steps, where the procedure has some.
    pub steps: Vec<LoadStep>,
    /// Whether it carried the whole load; if not, only its steps are compared with.
    pub finished: bool,
    /// Evaluates the reference at any point, m; a stored one knows only the targets.
    pub at: Option<Evaluate>,
}

/// What a scene wants of every run.
#[derive(Clone, Copy)]
pub struct Asks<'a> {
    /// Probe positions, m.
    pub probes: &'a [Point3],
    /// Points where displacements are compared; the method's own nodes if empty.
    pub targets: &'a [Point3],
    /// Schemes that carry a cloud's displacement to the targets.
    pub schemes: &'a [(String, Scheme)],
    /// Whether the surface displacement is kept for pictures.
    pub picture: bool,
    /// Repeats of the timed part.
    pub repeats: Repeats,
    /// The reference, where one is known.
    pub reference: Option<&'a Reference>,
    /// The method that every run is compared with beside the reference, if the scene names one.
    pub beside: Option<&'a Reference>,
}

/// A finished run with its nodal parameters.
pub struct Solved {
    /// Identity, numbers, times.
    pub outcome: Outcome,
    /// Tables of the run.
    pub prepared: Prepared,
    /// Nodal parameters, m.
    pub u: Vec<Vector3>,
}

/// What a procedure came to.
struct Solution {
    /// Nodal parameters at the end, m.
    u: Vec<Vector3>,
    dofs: usize,
    /// Relative residual at the end.
    residual: f64,
    /// Of a linear procedure.
    info: Option<SolveInfo>,
    /// Of a static procedure.
    path: Option<Path>,
    /// Of dynamics.
    motion: Option<Motion>,
}

/// Runs one method.
pub fn run(
    identity: Identity,
    plan: Vec<Stage>,
    method: &Discretisation,
    setup: &Setup,
    asks: &Asks,
) -> Result<Solved, Failure> {
    crate::memory::reset_peak();
    let mut timings = Timings::default();
    let start = Instant::now();
    let (mut prepared, mut solution, mut work) = solve_once(method, setup, &mut timings)?;
    for _ in 1..asks.repeats.most {
        if start.elapsed().as_secs_f64() > asks.repeats.seconds {
            break;
        }
        (prepared, solution, work) = solve_once(method, setup, &mut timings)?;
    }
    let memory = crate::memory::peak();
    let field = displacement(method, &prepared, &solution.u, asks, &mut timings, &mut work)?;
    let mut phases = timings.summaries();
    phases.push(("total", timings.total()));
    if let (true, Some((_, solve))) =
        (setup.explicit.is_some() && work.time_steps > 0, phases.iter().find(|(name, _)| *name == "solve"))
    {
        let each = 1.0 / (work.time_steps as f64 * method.mesh().cell_count() as f64);
        phases.push(("element-step", solve.times(each)));
    }

    let size = Size {
        nodes: method.nodes().len() as u64,
        elements: method.mesh().cell_count() as u64,
        points: prepared.volume.rows.weights().len() as u64,
        dofs: solution.dofs as u64,
        spacing: prepared.spacing,
    };
    let u = solution.u.clone();
    let pressure = match (&mut solution.path, &mut solution.motion) {
        (Some(path), _) => std::mem::take(&mut path.pressure),
        (_, Some(motion)) => std::mem::take(&mut motion.pressure),
        (None, None) => Vec::new(),
    };
    let mut metrics = Vec::new();
    // A path that ended early is compared with the reference step by step, not at its end.
    let finished = solution.path.as_ref().is_none_or(Path::whole)
        && solution.motion.as_ref().is_none_or(|motion| motion.failure.is_none());
    let at_end = Asks {
        reference: asks.reference.filter(|r| finished && r.finished),
        beside: asks.beside.filter(|r| finished && r.finished),
        ..*asks
    };
    measure(&mut metrics, method, setup, &prepared, &solution, field, &at_end)?;
    let relaxed_from = (solution.path.as_ref())
        .filter(|path| path.whole())
        .and_then(|path| path.failure.clone().map(Failure::from));
    let (last, steps, stalled) = match (solution.path, solution.motion) {
        (Some(path), _) => history(&mut metrics, method, &prepared, path.into(), asks)?,
        (None, Some(motion)) => {
            let told = history(&mut metrics, method, &prepared, motion.into(), asks)?;
            if told.2.is_none() {
                metrics.extend(way::metrics(&told.1, setup.exact.as_deref(), asks.probes));
            }
            told
        }
        (None, None) => (None, Vec::new(), None),
    };
    let status = match (&stalled, &relaxed_from) {
        (Some(failure), _) => failure.early_status(),
        (None, Some(_)) => "relaxed",
        (None, None) => "ok",
    };
    let mut plan = plan;
    relaxation::conclude(&mut plan, &work);
    let tools = setup.tools.iter().map(|t| t.name.clone()).collect();
    let probes = probes(method, setup, &prepared, &u, asks.probes)?;
    if let (Some(exact), Some(probe)) = (&setup.exact, probes.first()) {
        let e = exact.displacement(&probe.x);
        if e.norm() > 0.0 {
            push(&mut metrics, "tip", probe.u.dot(&e) / e.norm_squared(), "1");
        }
        let error = |p: &Probe| {
            let e = exact.displacement(&p.x);
            (e.norm() > 0.0).then(|| (p.u - e).norm() / e.norm())
        };
        if let Some(worst) = probes.iter().filter_map(error).reduce(f64::max) {
            push(&mut metrics, "probe-error", worst, "1");
        }
    }
    let transfers = match method {
        Discretisation::Efg(_) => transfers(method, &prepared, &u, &at_end, &mut work)?,
        Discretisation::Fem(_) => Vec::new(),
    };
    let state = State { u: &u, pressure: &pressure, last: last.as_ref() };
    let field = if asks.picture { Some(picture(&identity, method, setup, &prepared, state)?) } else { None };
    let outcome = Outcome {
        identity,
        size,
        metrics,
        phases,
        memory,
        probes,
        plan,
        transfers,
        field,
        work,
        tools,
        last,
        steps,
        status,
        stalled,
        relaxed: relaxed_from,
    };
    Ok(Solved { outcome, prepared, u })
}

fn solve_once(
    method: &Discretisation,
    setup: &Setup,
    timings: &mut Timings,
) -> Result<(Prepared, Solution, Work), Failure> {
    let mut work = Work::default();
    let prepared = timings.time("prepare", || prepare(method, setup, &mut work))?;
    if let Some(params) = &setup.statics {
        let path = timings.time("solve", || statics::solve(method, setup, params, &prepared, &mut work))?;
        if path.limit.is_some() {
            timings.book("solve-to-limit", path.to_limit);
        }
        let (u, dofs, residual) = (path.u.clone(), path.dofs, path.residual);
        let solution = Solution { u, dofs, residual, info: None, path: Some(path), motion: None };
        return Ok((prepared, solution, work));
    }
    let motion = match (&setup.explicit, &setup.in_time) {
        (Some(params), _) => {
            Some(timings.time("solve", || explicit::solve(setup, params, &prepared, &mut work))?)
        }
        (_, Some(params)) => {
            Some(timings.time("solve", || in_time::solve(method, setup, params, &prepared, &mut work))?)
        }
        (None, None) => None,
    };
    if let Some(motion) = motion {
        let (u, dofs) = (motion.u.clone(), motion.dofs);
        let solution = Solution { u, dofs, residual: 0.0, info: None, path: None, motion: Some(motion) };
        return Ok((prepared, solution, work));
    }
    let solution = {
        let (loads, weak) = (prepared.loads(), prepared.weak());
        let problem = prepared.problem(method.nodes(), setup, &loads, &weak);
        let assembled = timings.time("assemble", || assemble(&problem))?;
        work.assemblies += 1;
        let factored = timings.time("factor", || assembled.factor())?;
        work.factorisations += 1;
        let mechanics::Solution { u, info, .. } = timings.time("solve", || factored.solve(1.0))?;
        work.solves += 1;
        Solution { u, dofs: info.dofs, residual: info.residual, info: Some(info), path: None, motion: None }
    };
    Ok((prepared, solution, work))
}

/// Displacement (m) at the targets, and how many of these lie outside; at the method's own nodes without targets. There
/// the parameters of elements are displacements already, and nothing is evaluated.
fn displacement(
    method: &Discretisation,
    prepared: &Prepared,
    u: &[Vector3],
    asks: &Asks,
    timings: &mut Timings,
    work: &mut Work,
) -> Result<(Vec<Vector3>, usize), Failure> {
    let points = match (method, asks.targets.is_empty()) {
        (Discretisation::Fem(_), true) => return Ok((u.to_vec(), 0)),
        (Discretisation::Efg(_), true) => method.nodes(),
        (_, false) => asks.targets,
    };
    let once = || -> Result<_, Failure> {
        let (rows, outside) = method.at_points(&prepared.volume, points)?;
        Ok((rows.rows().apply(u), outside))
    };
    work.transfer_rows += points.len() as u64;
    let timed = matches!(method, Discretisation::Efg(_)) && !asks.targets.is_empty();
    if !timed {
        return once();
    }
    let mut field = timings.time("transfer", once)?;
    for _ in 1..asks.repeats.most {
        field = timings.time("transfer", once)?;
    }
    Ok(field)
}

pub(crate) fn push(metrics: &mut Vec<Metric>, name: &str, value: f64, unit: &'static str) {
    metrics.push(Metric { name: name.into(), value, unit });
}

/// Errors, maxima, energies, counts.
fn measure(
    metrics: &mut Vec<Metric>,
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    solution: &Solution,
    (field, outside): (Vec<Vector3>, usize),
    asks: &Asks,
) -> Result<(), Failure> {
    let body = Body {
        nodes: method.nodes(),
        volume: &prepared.volume.rows,
        materials: &setup.materials,
        region: &prepared.volume.region,
        dilation: prepared.volume.groups.as_ref(),
    };
    // Stresses are compared with Hooke's; a pressure field of its own is another stress than the displacement's.
    let hooke =
        setup.laws.iter().all(Law::is_small_strain) && prepared.volume.pressure.is_none() && !setup.relaxes();
    if let (Some(exact), false) = (&setup.exact, hooke) {
        let (fine, _) = method.error_rows(&prepared.volume)?;
        if let Some(value) = norms::l2(&fine, &solution.u, exact.as_ref()) {
            push(metrics, "l2", value, "1");
        }
    }
    if let (Some(exact), true) = (&setup.exact, hooke) {
        let (fine, region) = method.error_rows(&prepared.volume)?;
        let n = norms(&body, &fine, &region, &solution.u, exact.as_ref())?;
        for (name, value) in
            [("l2", n.l2), ("energy", n.energy), ("pressure", n.pressure), ("stress", n.stress)]
        {
            if let Some(value) = value {
                push(metrics, name, value, "1");
            }
        }
    }
    let points = if asks.targets.is_empty() { method.nodes() } else { asks.targets };
    let against = match (&setup.exact, asks.reference) {
        (Some(exact), _) => Some(exact_at(exact.as_ref(), points)),
        (None, Some(reference)) => Some(reference.targets.clone()),
        (None, None) => None,
    };
    if let Some(against) = against {
        push_difference(metrics, "rms", &field, &against);
        push(metrics, "max-error", difference(&field, &against).max, "m");
        let largest = against.iter().fold(0.0, |m: f64, u| m.max(u.norm()));
        if largest > 0.0 {
            push(metrics, "relative-max", difference(&field, &against).max / largest, "1");
        }
    }
    if let Some(beside) = asks.beside {
        push_difference(metrics, "beside-rms", &field, &beside.targets);
    }
    for (axis, name) in ["max-x", "max-y", "max-z"].into_iter().enumerate() {
        push(metrics, name, field.iter().fold(0.0, |m: f64, u| m.max(u[axis].abs())), "m");
    }
    push(metrics, "max", field.iter().fold(0.0, |m: f64, u| m.max(u.norm())), "m");
    push(metrics, "targets-outside", outside as f64, "1");
    let energy = match (&solution.path, &solution.motion) {
        (Some(path), _) => path.last.strain_energy,
        (_, Some(motion)) => motion.last.strain_energy,
        (None, None) => Some(mechanics::strain_energy(&body, &solution.u)?),
    };
    if let Some(energy) = energy {
        push(metrics, "strain-energy", energy, "J");
    }
    push(metrics, "volume", prepared.volume.rows.weights().iter().sum(), "m^3");
    if solution.motion.is_none() {
        push(metrics, "residual", solution.residual, "1");
    }
    if let Some(info) = &solution.info {
        push(metrics, "factor-nonzeros", info.factor_nonzeros as f64, "1");
    }
    let resultant = prepared.resultant();
    for (axis, name) in ["load-x", "load-y", "load-z"].into_iter().enumerate() {
        push(metrics, name, resultant[axis], "N");
    }
    if let Some(mls) = &prepared.volume.mls {
        push(metrics, "neighbours-min", mls.neighbours_min as f64, "1");
        push(metrics, "neighbours-mean", mls.neighbours_mean, "1");
        push(metrics, "neighbours-max", mls.neighbours_max as f64, "1");
        push(metrics, "condition-median", mls.condition_median, "1");
        push(metrics, "condition-max", mls.condition_max, "1");
        push(metrics, "fallbacks", mls.fallbacks() as f64, "1");
        push(metrics, "fallbacks-enlarged", mls.enlarged as f64, "1");
        push(metrics, "fallbacks-regularised", mls.regularised as f64, "1");
        push(metrics, "fallbacks-reduced", mls.reduced as f64, "1");
    }
    if let Some(error) = prepared.volume.volume_error {
        push(metrics, "volume-error", error, "1");
    }
    Ok(())
}

/// A procedure in steps, as it came out of its solver.
struct Course {
    steps: Vec<LoadStep>,
    fields: Vec<Vec<Vector3>>,
    last: LoadStep,
    metrics: Vec<Metric>,
    failure: Option<Failure>,
}

impl From<Path> for Course {
    fn from(path: Path) -> Course {
        let Path { steps, fields, last, iterations, cut_backs, limit, failure, relaxed, .. } = path;
        let mut metrics = Vec::new();
        if let Some(limit) = &limit {
            push(&mut metrics, "limit-load", limit.load, "1");
            for (index, tool) in limit.tools.iter().enumerate() {
                push(&mut metrics, &of_tool("limit-closure", index), tool.closure, "m");
                push(&mut metrics, &of_tool("limit-tool-force", index), tool.pushed, "N");
            }
        }
        push(&mut metrics, "newton-iterations", iterations as f64, "1");
        push(&mut metrics, "cut-backs", cut_backs as f64, "1");
        let failure = match relaxed {
            None => failure.map(Failure::from),
            Some(relaxed) => {
                push(&mut metrics, "relaxation-steps", relaxed.made as f64, "1");
                relaxed.failure.map(Failure::from)
            }
        };
        Course { steps, fields, last, metrics, failure }
    }
}

impl From<Motion> for Course {
    fn from(motion: Motion) -> Course {
        let Motion { steps, fields, last, metrics, failure, .. } = motion;
        Course { steps, fields, last, metrics, failure }
    }
}

/// What a procedure in steps left: its last state, its load steps with their errors against the reference's, and why it ended
/// early.
type History = (Option<LoadStep>, Vec<LoadStep>, Option<Failure>);

fn history(
    metrics: &mut Vec<Metric>,
    method: &Discretisation,
    prepared: &Prepared,
    course: Course,
    asks: &Asks,
) -> Result<History, Failure> {
    let Course { mut steps, fields, last, metrics: of_procedure, failure } = course;
    push(metrics, "load-carried", last.load, "1");
    push(metrics, "smallest-j", last.smallest_j, "1");
    push(metrics, "load-steps", steps.len() as f64, "1");
    metrics.extend(of_procedure);
    for (index, tool) in last.tools.iter().enumerate() {
        push(metrics, &of_tool("closure", index), tool.closure, "m");
        push(metrics, &of_tool("tool-force", index), tool.pushed, "N");
        push(metrics, &of_tool("contact-points", index), tool.active as f64, "1");
    }
    if let Some(deepest) = last.tools.iter().map(|t| t.penetration).reduce(f64::max) {
        push(metrics, "penetration", deepest, "m");
    }
    if !asks.probes.is_empty() {
        let (rows, _) = method.at_points(&prepared.volume, asks.probes)?;
        for (step, u) in steps.iter_mut().zip(&fields) {
            step.probes = rows.rows().apply(u);
        }
    }
    if let Some(reference) = asks.reference {
        for step in &mut steps {
            let same = |other: &&LoadStep| (other.load - step.load).abs() < 1e-9;
            if let Some(of_reference) = reference.steps.iter().find(same) {
                step.against = against(step, of_reference);
            }
        }
        if let (Some(end), None, true) = (steps.last(), &failure, reference.finished) {
            metrics.extend(end.against.iter().cloned());
        }
    }
    Ok((Some(last), steps, failure))
}

/// Errors of one step against the reference's at the same part of the load: of every tool's force and of the strain energy,
/// relative, and the largest of the displacements at the probes.
fn against(step: &LoadStep, reference: &LoadStep) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for (index, (tool, other)) in step.tools.iter().zip(&reference.tools).enumerate() {
        if other.pushed != 0.0 {
            push(
                &mut metrics,
                &of_tool("tool-force-error", index),
                (tool.pushed / other.pushed - 1.0).abs(),
                "1",
            );
        }
    }
    if let (Some(energy), Some(other)) = (step.strain_energy, reference.strain_energy.filter(|e| *e > 0.0)) {
        push(&mut metrics, "strain-energy-error", (energy / other - 1.0).abs(), "1");
    }
    let distances = step.probes.iter().zip(&reference.probes).map(|(u, v)| (u - v).norm());
    if let Some(largest) = distances.reduce(f64::max) {
        push(&mut metrics, "probe-difference", largest, "m");
    }
    metrics
}

/// RMS of a difference per direction (`NAME-x` and so on) and of the magnitude (`NAME`).
pub(crate) fn push_difference(metrics: &mut Vec<Metric>, name: &str, field: &[Vector3], against: &[Vector3]) {
    let d = difference(field, against);
    for (axis, value) in ["x", "y", "z"].into_iter().zip(d.rms) {
        push(metrics, &format!("{name}-{axis}"), value, "m");
    }
    push(metrics, name, d.rms_magnitude, "m");
}

fn probes(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    u: &[Vector3],
    points: &[Point3],
) -> Result<Vec<Probe>, Failure> {
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let rows = method.gradients_at(&prepared.volume, points)?;
    // Stresses at probes are pointwise, of the first region's law unless the body has one only. What relaxes has them of
    // its past, which is followed at quadrature points only.
    let stress: Vec<Option<Matrix3>> = if setup.is_linear() {
        mechanics::stress(&rows, u, &setup.materials, &[])?.into_iter().map(Some).collect()
    } else {
        let known = |h: &Matrix3| (!setup.relaxes()).then(|| cauchy(&setup.laws[0], h));
        rows.displacement_gradients(u).iter().map(known).collect()
    };
    let field = rows.rows().apply(u);
    Ok(points.iter().zip(field).zip(stress).map(|((&x, u), stress)| Probe { x, u, stress }).collect())
}

/// A reference that stays alive after its run: evaluates the displacement of `solved` anywhere.
pub fn reference(method: Discretisation, solved: Solved, targets: &[Point3]) -> Result<Reference, Failure> {
    let Solved { outcome, prepared, u } = solved;
    let at = move |points: &[Point3]| -> Result<Vec<Vector3>, Failure> {
        Ok(method.at_points(&prepared.volume, points)?.0.rows().apply(&u))
    };
    let points = if targets.is_empty() { Vec::new() } else { at(targets)? };
    let nodes = outcome.size.nodes as usize;
    let (method, steps, finished) = (outcome.identity.method, outcome.steps, outcome.stalled.is_none());
    Ok(Reference { method, nodes, targets: points, steps, finished, at: Some(Box::new(at)) })
}
