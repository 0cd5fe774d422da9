//! One run: prepare, assemble, factor, solve (timed apart, repeated), then errors, probes and transfers.

use std::time::Instant;

use ::statics::{SolveInfo, assemble};
use cases::scene::Repeated;
use geometry::{Point3, Vector3};
use interp::Scheme;

use crate::Failure;
use crate::course::history;
use crate::discretise::{Discretisation, Efg};
use crate::explicit;
use crate::in_time;
use crate::measure::{measure, of_tables, probes, push};
use crate::memory::Baseline;
use crate::modes::{self, Told};
use crate::motion::Motion;
use crate::outcome::{Identity, LoadStep, Outcome, Probe, SchemeSettings, Size, Stage, of_tool};
use crate::picture::{State, picture};
use crate::plan;
use crate::prepare::{Prepared, prepare};
use crate::refine::refined;
use crate::relaxation;
use crate::repeated::repeated;
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
    pub schemes: &'a [(SchemeSettings, Scheme)],
    /// Whether the surface displacement is kept for pictures.
    pub picture: bool,
    /// Repeats of the timed part.
    pub repeats: Repeats,
    /// The reference, where one is known.
    pub reference: Option<&'a Reference>,
    /// The method that every run is compared with beside the reference, if the scene names one.
    pub beside: Option<&'a Reference>,
    /// The same cloud integrated by another rule, which errors of integration are measured from.
    pub integrated: Option<&'a Reference>,
    /// The loop of frames after the first solution, if it is to run.
    pub repeated: Option<&'a Repeated>,
}

/// A finished run with its nodal parameters.
pub struct Solved {
    /// Identity, numbers, times.
    pub outcome: Outcome,
    /// Tables of the run.
    pub prepared: Prepared,
    /// Nodal parameters, m.
    pub u: Vec<Vector3>,
    /// The method on the cloud that it ended with, where that follows an error.
    pub refined: Option<Discretisation>,
}

/// What a procedure came to.
#[derive(Default)]
pub(crate) struct Solution {
    /// Nodal parameters at the end, m.
    pub(crate) u: Vec<Vector3>,
    dofs: usize,
    /// Relative residual at the end.
    pub(crate) residual: f64,
    /// Of a linear procedure.
    pub(crate) info: Option<SolveInfo>,
    /// Of a static procedure.
    pub(crate) path: Option<Path>,
    /// Of dynamics.
    pub(crate) motion: Option<Motion>,
    /// Of vibrations.
    modes: Option<modes::Found>,
}

/// Runs one method.
///
/// All of it runs on a thread of the pool: from outside, whatever is done in parallel is handed over and waited for, which takes
/// 0.03 to 0.1 ms each time, as long as the forces of 6000 elements.
pub fn run(
    identity: Identity,
    plan: Vec<Stage>,
    method: &Discretisation,
    setup: &Setup,
    asks: &Asks,
) -> Result<Solved, Failure> {
    rayon::scope(|_| on_pool(identity, plan, method, setup, asks))
}

fn on_pool(
    mut identity: Identity,
    mut plan: Vec<Stage>,
    method: &Discretisation,
    setup: &Setup,
    asks: &Asks,
) -> Result<Solved, Failure> {
    let baseline = Baseline::new();
    let mut timings = Timings::default();
    let start = Instant::now();
    let mut once = solve_once(method, setup, &mut timings)?;
    for _ in 1..asks.repeats.most {
        if start.elapsed().as_secs_f64() > asks.repeats.seconds {
            break;
        }
        // Two at once would take twice the memory.
        drop(once);
        once = solve_once(method, setup, &mut timings)?;
    }
    let Once { refined, prepared, mut solution, mut work } = once;
    let method = refined.as_ref().unwrap_or(method);
    let memory = baseline.peak();
    if setup.prepare_only {
        let told = Told { metrics: Vec::new(), dofs: 0, modes: Vec::new() };
        return Ok(unloaded(identity, plan, method, prepared, told, (timings, memory, work)));
    }
    if let Some(found) = solution.modes.take() {
        let told = modes::told(method, setup, &prepared, &found)?;
        return Ok(unloaded(identity, plan, method, prepared, told, (timings, memory, work)));
    }
    let field = displacement(method, &prepared, &solution.u, asks, &mut timings, &mut work)?;
    let mut phases = timings.phases().to_vec();
    phases.push(timings.total());
    if let (true, Some(solve)) =
        (setup.explicit.is_some() && work.time_steps > 0, phases.iter().find(|timed| timed.phase == "solve"))
    {
        let each = 1.0 / (work.time_steps as f64 * method.mesh().cell_count() as f64);
        phases.push(solve.part("element-step", each));
    }

    let relaxed = || solution.path.as_ref().and_then(|path| Some(path.relaxed.as_ref()?.forces));
    if let Some(forces) = solution.motion.as_ref().and_then(|motion| motion.forces).or_else(relaxed) {
        identity.force_kernel = Some(forces.kernel.name().into());
        identity.lane_path = forces.path.map(|path| path.name().into());
        plan::say_what_ran(&mut plan, forces);
    }
    identity.linear_solver = solution.info.as_ref().map(|info| info.path.name().into());
    let size = size(method, &prepared, solution.dofs);
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
        integrated: asks.integrated.filter(|r| finished && r.finished),
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
    if let (Some(contact), Some(last), None) = (setup.contact, &last, &stalled) {
        let pushed = last.tools.first().map_or(0.0, |tool| tool.pushed);
        push(&mut metrics, &of_tool("tool-force-error", 0), (pushed / contact.force - 1.0).abs(), "1");
    }
    let status = match (&stalled, &relaxed_from) {
        (Some(failure), _) => failure.early_status(),
        (None, Some(_)) => "relaxed",
        (None, None) => "ok",
    };
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
    // A path that ended early has no loop.
    let latencies = match asks.repeated.filter(|_| finished) {
        Some(ask) => repeated(ask, method, setup, &prepared, (&u, last.as_ref()), asks, &mut metrics)?,
        None => Vec::new(),
    };
    let state = State { u: &u, pressure: &pressure, last: last.as_ref() };
    let field = if asks.picture { Some(picture(&identity, method, setup, &prepared, state)?) } else { None };
    let outcome = Outcome {
        identity,
        size,
        metrics,
        phases,
        latencies,
        memory,
        probes,
        plan,
        transfers,
        field,
        work,
        tools,
        last,
        steps,
        modes: Vec::new(),
        status,
        stalled,
        relaxed: relaxed_from,
    };
    Ok(Solved { outcome, prepared, u, refined })
}

fn size(method: &Discretisation, prepared: &Prepared, dofs: usize) -> Size {
    Size {
        nodes: method.nodes().len() as u64,
        elements: method.mesh().cell_count() as u64,
        points: prepared.volume.rows.weights().len() as u64,
        dofs: dofs as u64,
        spacing: prepared.spacing,
    }
}

/// What a run without a displacement leaves, one that ends before anything is solved or has modes: times, memory, and what its
/// tables are like.
fn unloaded(
    identity: Identity,
    plan: Vec<Stage>,
    method: &Discretisation,
    prepared: Prepared,
    Told { mut metrics, dofs, modes }: Told,
    (timings, memory, work): (Timings, u64, Work),
) -> Solved {
    of_tables(&mut metrics, &prepared);
    let mut phases = timings.phases().to_vec();
    phases.push(timings.total());
    let outcome = Outcome {
        identity,
        size: size(method, &prepared, dofs),
        metrics,
        phases,
        latencies: Vec::new(),
        memory,
        probes: Vec::new(),
        plan,
        transfers: Vec::new(),
        field: None,
        work,
        tools: Vec::new(),
        last: None,
        steps: Vec::new(),
        modes,
        status: "ok",
        stalled: None,
        relaxed: None,
    };
    Solved { outcome, prepared, u: Vec::new(), refined: None }
}

/// What a pass over a run leaves.
struct Once {
    refined: Option<Discretisation>,
    prepared: Prepared,
    solution: Solution,
    work: Work,
}

fn solve_once(method: &Discretisation, setup: &Setup, timings: &mut Timings) -> Result<Once, Failure> {
    let mut work = Work::default();
    let refined = match method {
        Discretisation::Efg(Efg { refine: Some(_), .. }) => {
            timings.time("refine", || refined(method, setup, &mut work))?
        }
        _ => None,
    };
    let (prepared, solution) = solve(refined.as_ref().unwrap_or(method), setup, timings, &mut work)?;
    Ok(Once { refined, prepared, solution, work })
}

fn solve(
    method: &Discretisation,
    setup: &Setup,
    timings: &mut Timings,
    work: &mut Work,
) -> Result<(Prepared, Solution), Failure> {
    let prepared = timings.time("prepare", || prepare(method, setup, work))?;
    if setup.prepare_only {
        return Ok((prepared, Solution::default()));
    }
    if let Some(params) = &setup.modes {
        let found = modes::solve(method, setup, params, &prepared, timings, work)?;
        return Ok((prepared, Solution { modes: Some(found), ..Solution::default() }));
    }
    if let Some(params) = &setup.statics {
        let path = timings.time("solve", || statics::solve(method, setup, params, &prepared, work))?;
        if path.limit.is_some() {
            timings.book("solve-to-limit", path.to_limit);
        }
        let (u, dofs, residual) = (path.u.clone(), path.dofs, path.residual);
        let solution = Solution { u, dofs, residual, path: Some(path), ..Solution::default() };
        return Ok((prepared, solution));
    }
    let motion = match (&setup.explicit, &setup.in_time) {
        (Some(params), _) => Some(timings.time("solve", || explicit::solve(setup, params, &prepared, work))?),
        (_, Some(params)) => {
            Some(timings.time("solve", || in_time::solve(method, setup, params, &prepared, work))?)
        }
        (None, None) => None,
    };
    if let Some(motion) = motion {
        let (u, dofs) = (motion.u.clone(), motion.dofs);
        let solution = Solution { u, dofs, motion: Some(motion), ..Solution::default() };
        return Ok((prepared, solution));
    }
    let ::statics::Solution { u, info, .. } = solve_linear(method, setup, &prepared, timings, work)?;
    let (dofs, residual) = (info.dofs, info.residual);
    Ok((prepared, Solution { u, dofs, residual, info: Some(info), ..Solution::default() }))
}

/// Assembles, factors and solves once.
pub(crate) fn solve_linear(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    timings: &mut Timings,
    work: &mut Work,
) -> Result<::statics::Solution, Failure> {
    let (loads, weak) = (prepared.loads(), prepared.weak());
    let problem = prepared.problem(method.nodes(), setup, &loads, &weak);
    let assembled = timings.time("assemble", || assemble(&problem))?;
    work.assemblies += 1;
    let factored = timings.time("factor", || prepared.factor(assembled))?;
    work.factorisations += 1;
    let solution = timings.time("solve", || factored.solve(1.0))?;
    work.solves += 1;
    Ok(solution)
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

/// A reference that stays alive after its run: evaluates the displacement of `solved` anywhere.
pub fn reference(method: Discretisation, solved: Solved, targets: &[Point3]) -> Result<Reference, Failure> {
    let Solved { outcome, prepared, u, refined } = solved;
    let method = refined.unwrap_or(method);
    let at = move |points: &[Point3]| -> Result<Vec<Vector3>, Failure> {
        Ok(method.at_points(&prepared.volume, points)?.0.rows().apply(&u))
    };
    let points = if targets.is_empty() { Vec::new() } else { at(targets)? };
    let nodes = outcome.size.nodes as usize;
    let (method, steps, finished) = (outcome.identity.method, outcome.steps, outcome.stalled.is_none());
    Ok(Reference { method, nodes, targets: points, steps, finished, at: Some(Box::new(at)) })
}
