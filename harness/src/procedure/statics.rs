//! The static procedure: load steps by Newton's method, with contact, and the results of each step.

use std::time::Instant;

use cases::scene::{Newton, OnStall, Static};
use catalogue::metric;
use contact::{ContactHistory, ContactSurface, DrivenTool};
use geometry::Vector3;
use material::Material as _;
use shape::{Coarser, Resultant};
use statics::{
    Active, Curves, Frames, LinearSystems, Nearby, NewtonParams, Predicted, Rest, Solid, SolidDilation,
    StaticError, StaticParams, StaticPath, StaticProblem, Step, predict, solve_static,
};

use super::linear_solver::tangents;
use super::problem::Problem;
use super::relaxation::{self, Relaxed, Start};
use super::solution::{Carried, Solution, StepHistory};
use super::stages::Stages;
use crate::discretise::{Discretisation, Volume};
use crate::error::Failure;
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, LoadStep, Metric, StageName, ToolStep, push};
use crate::prepare::{ConditionForces, Prepared};
use crate::scenario::setup::Setup;

/// Smallest fraction of a load step to which the step is cut back: six halvings.
pub(super) const SMALLEST: f64 = 1.0 / 64.0;

/// Relative residual of a predicted equilibrium, for an estimate of errors.
const PREDICTED: f64 = 1e-3;

/// Parameters of the static solver.
fn static_params(asked: &Static) -> StaticParams {
    StaticParams {
        steps: asked.steps,
        smallest: SMALLEST,
        newton: newton_params(&asked.newton),
        augmentations: asked.newton.augmentations,
        limit_within: asked.limit_within,
    }
}

/// Calls `work` with the frames of a load path from its start. `tolerance` is the relative residual of a
/// frame; `None` for that of the path.
pub(crate) fn in_frames<T>(
    problem: &Problem,
    asked: &Static,
    tolerance: Option<f64>,
    work: impl FnOnce(&mut Frames) -> T,
) -> Result<T, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let params = static_params(asked);
    let tolerance = tolerance.unwrap_or(params.newton.tolerance);
    // Factors are reused only for elements, as on a load path.
    let keeps = if method.interpolates { NewtonParams::KEEPS_FRAMES } else { params.newton.keeps };
    let newton = NewtonParams { tolerance, keeps, loosest: Some(NewtonParams::LOOSEST), ..params.newton };
    let params = StaticParams { newton, ..params };
    let contact = prepared.contact();
    let usual = Curves::proportional();
    with_static_problem(method, setup, prepared, contact.as_ref(), usual, |problem| {
        Ok(work(&mut Frames::new(problem, &params)?))
    })
}

/// Parameters of Newton's method that factor every tangent.
pub(super) fn newton_params(newton: &Newton) -> NewtonParams {
    let Newton { tolerance, iterations, .. } = *newton;
    NewtonParams { tolerance, iterations, chords: true, keeps: f64::INFINITY, loosest: None }
}

pub(super) fn stages(method: &Discretisation, setup: &Setup, asked: &Static) -> Stages {
    let (relaxes, why) = match asked.on_stall {
        OnStall::Stop => (false, "the load path ends if the solver stalls (on_stall = \"stop\")"),
        OnStall::Relax => relaxation::possible(method, setup),
    };
    let (iterates, tangents) = tangents(method, setup, Some(asked));
    Stages {
        stiffness: (true, "the tangent of every iteration".into()),
        factorisation: (true, tangents),
        iterates,
        newton: (true, newton_reason(setup, asked.steps, "load")),
        relaxation: (relaxes, why.into()),
        ..Stages::linear()
    }
}

/// Last stable step: the step before the first loss of stability or the first unstable equilibrium. If
/// Newton's method finds no further equilibrium, it is the last converged step.
#[derive(Default)]
struct Limit {
    step: Option<LoadStep>,
    /// Time to reach the step, s.
    seconds: f64,
}

/// Solves the static problem. A load path that reached no load is an error; a path that ended early is not.
pub(super) fn solve(problem: &Problem, asked: &Static, meters: &mut Meters) -> Result<Solution, Failure> {
    let Meters { timings, counters, .. } = meters;
    let (solution, limit) = timings.time("solve", || path(problem, asked, counters))?;
    if limit.step.is_some() {
        timings.book("solve-to-limit", limit.seconds);
    }
    Ok(solution)
}

fn path(problem: &Problem, asked: &Static, counters: &mut Counters) -> Result<(Solution, Limit), Failure> {
    let Problem { method, setup, prepared, plan, watch, .. } = *problem;
    let contact = prepared.contact();
    let (mut steps, mut fields) = (Vec::new(), Vec::new());
    let (mut supports, mut points, mut reaction) = (Vec::new(), Vec::new(), Vec::new());
    let start = Instant::now();
    let (mut limit, mut before) = (Limit::default(), LoadStep::at_start(setup.tools.len()));
    let mut params = static_params(asked);
    params.newton.keeps = NewtonParams::KEEPS;
    // A cloud on which tools slide may reach another equilibrium by inexact steps, as the kidney between jaws
    // with 1331 nodes did.
    params.newton.loosest = method.interpolates.then_some(NewtonParams::LOOSEST);
    let tangents = Tangents::new(problem)?;
    let (usual, mut inverted) = (Curves::proportional(), None);
    let path = with_static_problem(method, setup, prepared, contact.as_ref(), usual, |problem| {
        let systems = tangents.systems().unwrap_or(problem.systems);
        solve_static(&StaticProblem { systems, ..problem.clone() }, &params, |step, rest| {
            match whole_reaction(setup, prepared, &rest, step.time) {
                Ok(whole) => reaction = whole,
                Err(error) => inverted = Some(error),
            }
            supports = support_forces(method, prepared, &Rest { reaction: &reaction, ..rest }, step.time);
            points = prepared.foundation_forces(rest.u, &[]);
            let reported = |step| with_forces(reported(step, setup), &supports, &points);
            if let Some(watch) = watch {
                watch.step(&reported(step));
            }
            if (step.gave_way || !step.stable) && limit.step.is_none() {
                limit.step = Some(before.clone());
            }
            if limit.step.is_none() {
                (limit.seconds, before) = (start.elapsed().as_secs_f64(), reported(step));
            }
            if step.wanted {
                steps.push(reported(step));
                fields.push(rest.u.to_vec());
            }
        })
    })?;
    inverted.map_or(Ok(()), Err)?;
    let iterations = count(&path, counters);
    let relaxes = plan.runs(StageName::Relaxation);
    let last = LoadStep { supports, points, ..last(&path, setup, relaxes)? };
    let residual = path.steps.last().and_then(|s| s.iterations.last()).map_or(0.0, |i| i.residual);
    let mut end = last.clone();
    let mut u = path.u;
    let mut relaxed = None;
    if path.failure.is_some() && relaxes {
        let closures = last.tools.iter().map(|tool| tool.closure).collect();
        let from = Start { load: last.load, u: u.clone(), closures, history: path.history.clone() };
        let done = relaxation::continue_from((method.nodes(), setup), asked.steps, prepared, from, counters)?;
        steps.extend(done.steps.iter().cloned());
        fields.extend(done.fields.iter().cloned());
        if let (Some(step), Some(field)) = (done.steps.last(), done.fields.last()) {
            (end, u) = (step.clone(), field.clone());
        }
        relaxed = Some(done);
    }
    if path.failure.is_some() && limit.step.is_none() {
        limit.step = Some(last);
    }
    let metrics = metrics(limit.step.as_ref(), iterations, path.cut_back, relaxed.as_ref());
    let forces = relaxed.as_ref().map(|relaxed| relaxed.forces);
    let (failure, relaxed) = endings(path.failure.map(Failure::from), relaxed);
    let solution = Solution {
        dofs: problem.free_dofs() + path.pressure.len(),
        u,
        pressure: path.pressure,
        contact: path.history,
        reaction: if forces.is_none() { reaction } else { Vec::new() },
        residual: Some(residual),
        tangents: path.solver.map(|solver| solver.name()),
        history: Some(StepHistory { steps, fields, last: end, metrics, failure }),
        forces,
        relaxed,
        ..Solution::default()
    };
    Ok((solution, limit))
}

/// Calls `work` with the static problem of a richer method, parameters of Newton's method with this
/// tolerance, and the state near its equilibrium that another method's solution gives.
pub(super) fn near<T>(
    problem: &Problem,
    carried: &Carried,
    tolerance: f64,
    work: impl FnOnce(&StaticProblem, &NewtonParams, Nearby) -> T,
) -> Result<T, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let Carried { from, u, pressure, nearest } = *carried;
    let last = from.history.as_ref().map(|history| &history.last);
    let closures: Vec<f64> = last.iter().flat_map(|last| &last.tools).map(|tool| tool.closure).collect();
    let (contact, tangents) = (prepared.contact(), Tangents::new(problem)?);
    let each = from.contact.iter().zip(&setup.tools).zip(&closures);
    let history: Vec<ContactHistory> = (contact.iter().flat_map(|surface| {
        each.clone()
            .map(move |((history, set), &closure)| history.carried(nearest, surface, &set.tool, closure, u))
    }))
    .collect();
    let time = carried.load();
    let near = Nearby { time, u, pressure, closures: &closures, history: &history };
    let mut params = newton_params(&Newton { tolerance, iterations: 10, augmentations: 0 });
    params.keeps = NewtonParams::KEEPS;
    let usual = Curves::proportional();
    Ok(with_static_problem(method, setup, prepared, contact.as_ref(), usual, |problem| {
        let systems = tangents.systems().unwrap_or(problem.systems);
        work(&StaticProblem { systems, ..problem.clone() }, &params, near)
    }))
}

/// Predicts the equilibrium near the end of another method's solution.
pub(super) fn predicted(problem: &Problem, carried: &Carried) -> Result<Solution, Failure> {
    let Problem { method, setup, prepared, .. } = *problem;
    let load = carried.load();
    let found = near(problem, carried, PREDICTED, predict)??;
    let Predicted { u, reaction, penalties, tools, energy, linear } = found;
    let rest = Rest { u: &u, pressure: &[], reaction: &reaction, penalties: &penalties };
    let tools = tools.iter().zip(&setup.tools).map(|(state, set)| ToolStep::of(state, &set.tool));
    let last = LoadStep {
        load,
        tools: tools.collect(),
        supports: support_forces(method, prepared, &rest, load),
        strain_energy: Some(energy),
        ..LoadStep::at_start(0)
    };
    let history =
        StepHistory { steps: Vec::new(), fields: Vec::new(), last, metrics: Vec::new(), failure: None };
    Ok(Solution {
        dofs: problem.free_dofs(),
        u,
        history: Some(history),
        linearised: linear,
        ..Solution::default()
    })
}

/// Returns the failure that ended a path early, and that of Newton's method which relaxation overcame.
fn endings(stalled: Option<Failure>, relaxed: Option<Relaxed>) -> (Option<Failure>, Option<Failure>) {
    match relaxed.map(|relaxed| relaxed.failure) {
        None => (stalled, None),
        Some(None) => (None, stalled),
        Some(Some(failure)) => (Some(failure.into()), None),
    }
}

/// Returns the reaction of the nodal supports, N. A reduced model gives it from the forces in all cells: a
/// cell that is not chosen gives its part of a support's force, too.
///
/// # Errors
/// A point of a cell that is not chosen is inverted.
fn whole_reaction(
    setup: &Setup,
    prepared: &Prepared,
    rest: &Rest,
    time: f64,
) -> Result<Vec<Vector3>, StaticError> {
    let mut reaction = rest.reaction.to_vec();
    let Some(chosen) = prepared.reduced.as_ref().and_then(|reduced| reduced.volume.as_ref()) else {
        return Ok(reaction);
    };
    let active = prepared.active(setup, time);
    let at_time = |volume| Solid { active: Active::new(&active), ..solid(setup, volume) };
    let [all, part] = [&prepared.volume, chosen].map(|volume| at_time(volume).nodal_forces(rest.u));
    let (all, part) = (all?, part?);
    for held in prepared.fixed() {
        let (node, axis) = (held.node as usize, held.axis as usize);
        reaction[node][axis] += all[node][axis] - part[node][axis];
    }
    Ok(reaction)
}

/// Forces of the supports on the body at an equilibrium.
fn support_forces(method: &Discretisation, prepared: &Prepared, rest: &Rest, time: f64) -> Vec<Resultant> {
    prepared.support_forces(&ConditionForces {
        at: &|i| method.nodes()[i] + rest.u[i],
        nodes: rest.reaction,
        rows: &[],
        weak: rest.penalties,
        time: Some(time),
    })
}

/// Adds the forces of supports and of springs to a step.
fn with_forces(step: LoadStep, supports: &[Resultant], points: &[Metric]) -> LoadStep {
    LoadStep { supports: supports.to_vec(), points: points.to_vec(), ..step }
}

/// Solver of the tangents.
enum Tangents {
    Factored,
    /// Iterations, with the linear mesh of a quadratic mesh.
    Iterated(Option<Coarser>),
}

impl Tangents {
    fn new(problem: &Problem) -> Result<Tangents, Failure> {
        if !problem.plan.iterates {
            return Ok(Tangents::Factored);
        }
        Ok(Tangents::Iterated(problem.prepared.source.coarser()?))
    }

    /// The solver of the plan; `None` for that of the problem.
    fn systems(&self) -> Option<LinearSystems<'_>> {
        match self {
            Tangents::Factored => None,
            Tangents::Iterated(linear) => Some(LinearSystems::Iterated { linear: linear.as_ref() }),
        }
    }
}

/// Adds the path's operations to the counters, and returns the number of linear systems solved in converged
/// steps.
fn count(path: &StaticPath, counters: &mut Counters) -> u64 {
    let iterations = path.steps.iter().map(solves).sum();
    counters.newton_iterations += iterations;
    counters.assemblies += path.work.assemblies;
    counters.factorisations += path.work.factorisations;
    counters.solves += path.work.solves;
    counters.inner_iterations += path.work.inner;
    counters.contact_evaluations += path.counts.evaluations;
    counters.contact_skips += path.counts.skipped;
    iterations
}

/// Last converged step; the start if relaxation may continue from there.
fn last(path: &StaticPath, setup: &Setup, relaxes: bool) -> Result<LoadStep, Failure> {
    match (path.steps.last(), &path.failure) {
        (Some(last), _) => Ok(reported(last, setup)),
        // A singular matrix is a fault of the problem, which then has no solution by relaxation either.
        (None, Some(StaticError::Stalled { cause, .. })) if matches!(**cause, StaticError::Solve(_)) => {
            Err((**cause).clone().into())
        }
        (None, Some(StaticError::Stalled { .. })) if relaxes => Ok(LoadStep::at_start(setup.tools.len())),
        // If no load was reached, the failure concerns the problem, not the reached load.
        (None, Some(failure)) => Err(failure.clone().into()),
        (None, None) => Err(Failure::Run("the static solution has no step".into())),
    }
}

/// Metrics of the whole load path.
fn metrics(
    limit: Option<&LoadStep>,
    iterations: u64,
    cut_backs: usize,
    relaxed: Option<&Relaxed>,
) -> Vec<Metric> {
    let mut metrics = Vec::new();
    if let Some(limit) = limit {
        push(&mut metrics, &metric::LIMIT_LOAD, limit.load);
        for (index, tool) in limit.tools.iter().enumerate() {
            push(&mut metrics, metric::LIMIT_CLOSURE.at(index), tool.closure);
            push(&mut metrics, metric::LIMIT_TOOL_FORCE.at(index), tool.pushed);
        }
    }
    push(&mut metrics, &metric::NEWTON_ITERATIONS, iterations as f64);
    push(&mut metrics, &metric::CUT_BACKS, cut_backs as f64);
    if let Some(relaxed) = relaxed {
        push(&mut metrics, &metric::RELAXATION_STEPS, relaxed.made as f64);
    }
    metrics
}

/// Builds the static problem from borrowed tables and loads, with the curves `usual` of conditions without
/// their own, and calls `solve` with it.
pub(crate) fn with_static_problem<T>(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    contact: Option<&ContactSurface>,
    usual: Curves<'static>,
    solve: impl FnOnce(&StaticProblem) -> T,
) -> T {
    let reduced = prepared.reduced.as_ref();
    let volume = reduced.and_then(|reduced| reduced.volume.as_ref()).unwrap_or(&prepared.volume);
    let tools: Vec<DrivenTool> =
        setup.tools.iter().map(|t| DrivenTool { tool: &t.tool, drive: t.drive }).collect();
    solve(&StaticProblem {
        nodes: method.nodes(),
        solid: solid(setup, volume),
        loads: &prepared.loads(),
        following: prepared.following(),
        fixed: prepared.fixed(),
        penalties: &prepared.penalties(),
        contact,
        tools: &tools,
        curves: prepared.curves(usual),
        systems: reduced.map_or(LinearSystems::Factored, |reduced| LinearSystems::Modal(&reduced.basis)),
    })
}

/// The body as a quadrature with laws.
pub(super) fn solid<'a>(setup: &'a Setup, volume: &'a Volume) -> Solid<'a> {
    let dilation = match (&volume.groups, &volume.pressure) {
        (_, Some(rows)) => SolidDilation::Mixed(rows),
        (Some(groups), None) => SolidDilation::Groups(groups),
        (None, None) => SolidDilation::Standard,
    };
    Solid {
        volume: &volume.rows,
        laws: &setup.laws,
        region: &volume.region,
        axes: &volume.axes,
        active: Active::new(&setup.active),
        dilation,
    }
}

/// Number of linear systems solved in a step. An iteration of zero length only confirmed convergence.
pub(crate) fn solves(step: &Step) -> u64 {
    step.iterations.iter().filter(|i| i.length > 0.0).count() as u64
}

fn reported(step: &Step, setup: &Setup) -> LoadStep {
    let tools = step.tools.iter().zip(&setup.tools).map(|(state, set)| ToolStep::of(state, &set.tool));
    LoadStep {
        load: step.time,
        tools: tools.collect(),
        supports: Vec::new(),
        means: Vec::new(),
        strain_energy: Some(step.energy),
        smallest_j: step.smallest,
        iterations: solves(step),
        probes: Vec::new(),
        points: Vec::new(),
        against: Vec::new(),
        more: Vec::new(),
    }
}

/// Reason in the plan why Newton's method iterates.
pub(super) fn newton_reason(setup: &Setup, steps: usize, kind: &str) -> String {
    let steps = if steps == 1 { format!("1 {kind} step") } else { format!("{steps} {kind} steps") };
    let pressures = setup.pressures() + &setup.springs() + &setup.curves();
    match (setup.laws.iter().all(|law| law.is_small_strain()), setup.tools.is_empty()) {
        (true, true) => {
            format!("{steps}; law and loads are linear, so one iteration per step would suffice{pressures}")
        }
        (false, true) => format!("{steps} with a law of large strain{pressures}"),
        (_, false) => format!("{steps} with contact{pressures}"),
    }
}
