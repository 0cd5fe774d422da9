//! Implicit dynamics: time steps by Newton's method with contact, inertia and viscoelastic tissue, and the
//! results of each recorded state.

use cases::scene::Implicit;
use catalogue::metric;
use geometry::Vector3;
use shape::Curve;
use statics::{Curves, Inertia, Mass, TimeError, TimeParams, TimePath, TimeProblem, TimeStep, solve_in_time};

use super::problem::Problem;
use super::solution::{Solution, StepHistory};
use super::stages::Stages;
use super::statics::{SMALLEST, newton_params, newton_reason, solves, with_static_problem};
use crate::error::Failure;
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, LoadStep, Metric, ToolStep, push};
use crate::prepare::ConditionForces;
use crate::scenario::setup::Setup;

/// Parameters of the solver. If the scene sets an accuracy, the time step may shrink almost without limit.
fn params(asked: &Implicit) -> TimeParams {
    TimeParams {
        end: asked.ramp.duration,
        steps: asked.ramp.steps,
        smallest: if asked.accuracy.is_some() { 1e-6 } else { SMALLEST },
        accuracy: asked.accuracy,
        rho_inf: asked.spectral_radius,
        alpha: asked.alpha,
        newton: newton_params(&asked.newton),
        augmentations: asked.newton.augmentations,
    }
}

pub(super) fn stages(setup: &Setup, asked: &Implicit) -> Stages {
    let (duration, steps) = (asked.ramp.duration, asked.ramp.steps);
    Stages {
        mass: if asked.inertia { (true, "consistent".into()) } else { (false, "without inertia".into()) },
        stiffness: (true, "the tangent of every iteration".into()),
        time_steps: (true, format!("{duration} s in at least {steps} steps")),
        factorisation: (true, "one for each iteration, analysed once".into()),
        newton: (true, newton_reason(setup, steps, "time")),
        ..Stages::linear()
    }
}

/// Integrates the motion from the undeformed body at rest. A run that made no step is an error; a run that
/// ended early is not.
pub(super) fn solve(problem: &Problem, asked: &Implicit, meters: &mut Meters) -> Result<Solution, Failure> {
    let Meters { timings, counters, .. } = meters;
    timings.time("solve", || motion(problem, asked, counters))
}

/// Growth of loads, supports and tools over time.
fn growth(setup: &Setup, asked: &Implicit) -> Curves<'static> {
    let over = asked.ramp.growth();
    let loads = if over > 0.0 { Curve::growth(over) } else { Curve::at_once() };
    // With inertia, prescribed displacements must start with zero velocity.
    let supports = if asked.inertia && over > 0.0 { Curve::smooth_growth(over) } else { loads.clone() };
    let tools = setup
        .tools
        .iter()
        .find(|tool| tool.curve.is_none())
        .and_then(|tool| tool.over)
        .unwrap_or(asked.ramp.duration);
    Curves::new(loads, supports, Curve::growth(tools))
}

fn motion(problem: &Problem, asked: &Implicit, counters: &mut Counters) -> Result<Solution, Failure> {
    let Problem { method, setup, prepared, watch, .. } = *problem;
    let contact = prepared.contact();
    // The quadrature of the forces may give a singular mass matrix: four points of a tet10 have rank 4.
    let mass = if asked.inertia {
        let (fine, region) = prepared.fine_volume()?;
        counters.mass_nodes += method.nodes().len() as u64;
        Some(Mass::consistent(&fine, &setup.density()?, &region)?)
    } else {
        None
    };
    let duration = asked.ramp.duration;
    let (mut steps, mut fields, mut supports) = (Vec::new(), Vec::new(), Vec::new());
    let mut points = Vec::new();
    let usual = growth(setup, asked);
    let path = with_static_problem(method, setup, prepared, contact.as_ref(), usual, |body| {
        let problem = TimeProblem {
            body,
            inertia: mass.as_ref().map(|mass| Inertia {
                mass,
                damping: asked.ramp.damping,
                stiffness_damping: asked.ramp.stiffness_damping,
                displacement: &[],
                velocity: &[],
            }),
            relaxation: &setup.relaxation,
        };
        solve_in_time(&problem, &params(asked), |done, motion, _| {
            supports = prepared.support_forces(&ConditionForces {
                at: &|i| method.nodes()[i] + motion.u[i],
                nodes: &motion.reaction,
                rows: &[],
                weak: &motion.penalties,
                time: Some(done.step.time),
            });
            points = prepared.foundation_forces(&motion.u, &motion.v);
            if let Some(watch) = watch {
                watch.step(&reported(done, setup, duration));
            }
            if done.step.wanted {
                let (supports, points) = (supports.clone(), points.clone());
                steps.push(LoadStep { supports, points, ..reported(done, setup, duration) });
                fields.push(motion.u.clone());
            }
        })
    })?;
    let iterations = count(&path, counters);
    let last = match (path.steps.last(), path.failure.clone()) {
        (Some(last), _) => LoadStep { supports, points, ..reported(last, setup, duration) },
        (None, Some(TimeError::Stalled { cause, .. })) => return Err((*cause).into()),
        (None, Some(failure)) => return Err(failure.into()),
        (None, None) => return Err(Failure::Run("the motion has no step".into())),
    };
    let metrics = metrics(&path, iterations, asked.inertia);
    Ok(Solution {
        dofs: problem.free_dofs() + path.pressure.len(),
        u: path.motion.u,
        pressure: path.pressure,
        reaction: path.motion.reaction,
        history: Some(StepHistory { steps, fields, last, metrics, failure: path.failure.map(Failure::from) }),
        ..Solution::default()
    })
}

/// Adds the motion's operations to the counters, and returns the number of linear systems solved in converged
/// steps.
fn count(path: &TimePath, counters: &mut Counters) -> u64 {
    let iterations = path.steps.iter().map(|s| solves(&s.step)).sum();
    counters.time_steps += path.steps.len() as u64;
    counters.newton_iterations += iterations;
    counters.assemblies += path.work.assemblies;
    counters.factorisations += path.work.factorisations;
    counters.solves += path.work.solves;
    counters.inner_iterations += path.work.inner;
    counters.contact_evaluations += path.counts.evaluations;
    counters.contact_skips += path.counts.skipped;
    iterations
}

/// Metrics of the whole motion.
fn metrics(path: &TimePath, iterations: u64, inertia: bool) -> Vec<Metric> {
    let mut metrics = Vec::new();
    push(&mut metrics, &metric::TIME_STEPS, path.steps.len() as f64);
    push(&mut metrics, &metric::TIME_REACHED, path.time());
    push(&mut metrics, &metric::NEWTON_ITERATIONS, iterations as f64);
    push(&mut metrics, &metric::CUT_BACKS, path.cut_back as f64);
    if let Some(last) = path.steps.last().and_then(|s| s.step.iterations.last()) {
        push(&mut metrics, &metric::RESIDUAL, last.residual);
    }
    if inertia {
        let largest = path.steps.iter().map(|s| s.error).fold(0.0, f64::max);
        push(&mut metrics, &metric::STEP_ERROR, largest);
        push(&mut metrics, &metric::ENERGY_DRIFT, drift(&path.steps));
    }
    metrics
}

/// Fraction of the motion's largest energy below which differences are rounding.
const ROUNDING: f64 = 1e-9;

/// Largest error of the energy balance, relative to the largest of its terms so far. Differences that are
/// rounding of the largest energy of the whole motion do not count.
fn drift(steps: &[TimeStep]) -> f64 {
    let largest = |TimeStep { energy, .. }: &TimeStep| {
        let terms = [energy.kinetic, energy.internal, energy.external, energy.damped];
        terms.iter().fold(0.0f64, |largest, term| largest.max(term.abs()))
    };
    let mut drift = 0.0f64;
    let mut scale = ROUNDING * steps.iter().map(largest).fold(0.0, f64::max);
    for step in steps {
        let energy = &step.energy;
        scale = scale.max(largest(step));
        if scale > 0.0 {
            drift = drift.max(energy.lost().abs() / scale);
        }
    }
    drift
}

fn reported(done: &TimeStep, setup: &Setup, duration: f64) -> LoadStep {
    let TimeStep { step, energy, .. } = done;
    let tools = step.tools.iter().zip(&setup.tools).map(|(state, set)| ToolStep::of(state, &set.tool));
    // The energy of contact springs, the dissipation by friction and the work of the tools lie outside the
    // body.
    let mut more = vec![
        Metric::new(&metric::TIME, step.time),
        Metric::new(&metric::KINETIC_ENERGY, energy.kinetic),
        Metric::new(&metric::WORK_ON_BODY, energy.external),
        Metric::new(&metric::DAMPING_DISSIPATION, energy.damped),
        Metric::new(&metric::SCHEME_DISSIPATION, energy.lost()),
    ];
    // For viscoelastic tissue the stored part of the internal work is unknown.
    let strain_energy = if setup.relaxes() {
        push(&mut more, &metric::INTERNAL_WORK, energy.internal);
        None
    } else {
        Some(energy.internal)
    };
    LoadStep {
        load: step.time / duration,
        tools: tools.collect(),
        supports: Vec::new(),
        means: Vec::new(),
        strain_energy,
        smallest_j: step.smallest,
        iterations: solves(step),
        probes: Vec::<Vector3>::new(),
        points: Vec::new(),
        against: Vec::new(),
        more,
    }
}
