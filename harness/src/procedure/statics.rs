//! The static procedure: load steps by Newton's method, with contact, and what each of them left.

use std::time::Instant;

use cases::scene::{Newton, OnStall, Static};
use catalogue::metric;
use contact::{ContactSurface, DrivenTool};
use statics::{
    Dilation, NewtonParams, Solid, StaticError, StaticParams, StaticPath, StaticProblem, Step, solve_static,
};

use super::relaxation::{self, Relaxed, Start};
use super::{Problem, Solution, Stages, StepHistory, newton_reason};
use crate::Failure;
use crate::discretise::Discretisation;
use crate::outcome::{Counters, LoadStep, Meters, Metric, StageName, ToolStep, push, push_numbered};
use crate::prepare::{ConditionForces, Prepared};
use crate::scenario::setup::Setup;

/// Part of a load step below which cutting it back is given up: six halvings.
pub(super) const SMALLEST: f64 = 1.0 / 64.0;

/// What the solver takes.
pub(crate) fn static_params(asked: &Static) -> StaticParams {
    StaticParams {
        steps: asked.steps,
        smallest: SMALLEST,
        newton: newton_params(&asked.newton),
        augmentations: asked.newton.augmentations,
        limit_within: asked.limit_within,
    }
}

/// A factor for every tangent.
pub(super) fn newton_params(newton: &Newton) -> NewtonParams {
    let Newton { tolerance, iterations, .. } = *newton;
    NewtonParams { tolerance, iterations, chords: true, keeps: f64::INFINITY }
}

pub(super) fn stages(method: &Discretisation, setup: &Setup, asked: &Static) -> Stages {
    let (relaxes, why) = match asked.on_stall {
        OnStall::Stop => (false, "a path that stalls ends there (on-stall = \"stop\")"),
        OnStall::Relax => relaxation::possible(method),
    };
    Stages {
        stiffness: (true, "the tangent of every iteration".into()),
        factorisation: (true, "one for each iteration, analysed once".into()),
        newton: (true, newton_reason(setup, asked.steps, "load")),
        relaxation: (relaxes, why.into()),
        ..Stages::linear()
    }
}

/// The last step in a stable equilibrium: before the first that ends in none or on which none was near, or the last one where
/// Newton's method found none at all further on.
#[derive(Default)]
struct Limit {
    step: Option<LoadStep>,
    /// Seconds to get there.
    seconds: f64,
}

/// Solves. A path that reached no load is an error, one that ended early is not.
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
    let (mut steps, mut fields, mut supports) = (Vec::new(), Vec::new(), Vec::new());
    let start = Instant::now();
    let (mut limit, mut before) = (Limit::default(), LoadStep::at_start(setup.tools.len()));
    let mut params = static_params(asked);
    if method.interpolates {
        // A cloud on which tools slide may come to rest elsewhere by inexact steps: the kidney between jaws, 1331 nodes, did.
        params.newton.keeps = NewtonParams::KEEPS;
    }
    let path = with_static_problem(method, setup, prepared, contact.as_ref(), |problem| {
        solve_static(problem, &params, |step, rest| {
            supports = prepared.support_forces(&ConditionForces {
                nodes: rest.reaction,
                rows: &[],
                weak: &prepared.penalty_forces(rest.u, step.time),
            });
            let reported = |step| LoadStep { supports: supports.clone(), ..reported(step, setup) };
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
    let iterations = count(&path, counters);
    let relaxes = plan.runs(StageName::Relaxation);
    let last = LoadStep { supports, ..last(&path, setup, relaxes)? };
    let residual = path.steps.last().and_then(|s| s.iterations.last()).map_or(0.0, |i| i.residual);
    let (mut end, mut u, mut relaxed) = (last.clone(), path.u, None);
    if path.failure.is_some() && relaxes {
        let closures = last.tools.iter().map(|tool| tool.closure).collect();
        let from = Start { load: last.load, u: u.clone(), closures, history: path.history };
        let done = relaxation::continue_from(setup, asked.steps, prepared, from, counters)?;
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
    let (forces, stalled) = (relaxed.as_ref().map(|relaxed| relaxed.forces), path.failure.map(Failure::from));
    let (failure, relaxed) = match relaxed.map(|relaxed| relaxed.failure) {
        None => (stalled, None),
        Some(None) => (None, stalled),
        Some(Some(failure)) => (Some(failure.into()), None),
    };
    let solution = Solution {
        dofs: problem.free_dofs() + path.pressure.len(),
        u,
        pressure: path.pressure,
        residual: Some(residual),
        history: Some(StepHistory { steps, fields, last: end, metrics, failure }),
        forces,
        relaxed,
        ..Solution::default()
    };
    Ok((solution, limit))
}

/// Counts what the path took; returns the linear systems solved on the way to converged steps.
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

/// The last converged step; the start where relaxation may continue from it.
fn last(path: &StaticPath, setup: &Setup, relaxes: bool) -> Result<LoadStep, Failure> {
    match (path.steps.last(), &path.failure) {
        (Some(last), _) => Ok(reported(last, setup)),
        // A matrix that has no solution is about the problem, and has none at rest either.
        (None, Some(StaticError::Stalled { cause, .. })) if matches!(**cause, StaticError::Solve(_)) => {
            Err((**cause).clone().into())
        }
        (None, Some(StaticError::Stalled { .. })) if relaxes => Ok(LoadStep::at_start(setup.tools.len())),
        // No load was reached: what stopped it is about the problem, not about how far it went.
        (None, Some(failure)) => Err(failure.clone().into()),
        (None, None) => Err(Failure::Run("the static solution has no step".into())),
    }
}

/// Numbers of the whole path.
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
            push_numbered(&mut metrics, &metric::LIMIT_CLOSURE, index, tool.closure);
            push_numbered(&mut metrics, &metric::LIMIT_TOOL_FORCE, index, tool.pushed);
        }
    }
    push(&mut metrics, &metric::NEWTON_ITERATIONS, iterations as f64);
    push(&mut metrics, &metric::CUT_BACKS, cut_backs as f64);
    if let Some(relaxed) = relaxed {
        push(&mut metrics, &metric::RELAXATION_STEPS, relaxed.made as f64);
    }
    metrics
}

/// Hands the full problem, of tables and loads that it borrows, to what solves it.
pub(crate) fn with_static_problem<T>(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    contact: Option<&ContactSurface>,
    solve: impl FnOnce(&StaticProblem) -> T,
) -> T {
    let volume = &prepared.volume;
    let dilation = match (&volume.groups, &volume.pressure) {
        (_, Some(rows)) => Dilation::Mixed(rows),
        (Some(groups), None) => Dilation::Groups(groups),
        (None, None) => Dilation::Standard,
    };
    let tools: Vec<DrivenTool> =
        setup.tools.iter().map(|t| DrivenTool { tool: &t.tool, drive: t.drive }).collect();
    solve(&StaticProblem {
        nodes: method.nodes(),
        solid: Solid { volume: &volume.rows, laws: &setup.laws, region: &volume.region, dilation },
        loads: &prepared.loads(),
        fixed: prepared.fixed(),
        penalties: &prepared.penalties(),
        contact,
        tools: &tools,
    })
}

/// Linear systems solved in a step: an iteration of no length only found that it had converged.
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
        against: Vec::new(),
        more: Vec::new(),
    }
}
