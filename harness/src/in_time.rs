//! Implicit dynamics and relaxation: time steps by Newton's method with contact, and what each recorded state left.

use std::collections::BTreeSet;

use contact::ContactSurface;
use geometry::Vector3;
use material::Prony;
use statics::{Inertia, Mass, Ramp, Ramps, TimeError, TimeParams, TimeProblem, TimeStep, solve_in_time};

use crate::Failure;
use crate::discretise::Discretisation;
use crate::motion::Motion;
use crate::outcome::{LoadStep, Metric, ToolStep};
use crate::prepare::Prepared;
use crate::setup::Setup;
use crate::statics::{solves, with_problem};
use crate::work::Work;

/// How implicit dynamics is stepped.
#[derive(Clone, Debug, PartialEq)]
pub struct InTimeParams {
    /// Steps and their solution; its steps end at the recorded states.
    pub time: TimeParams,
    /// Density by region, kg/m^3; none without inertia.
    pub density: Option<Vec<f64>>,
    /// Mass-proportional damping, 1/s.
    pub damping: f64,
    /// Ramp of loads and prescribed displacements, s; 0 is at once.
    pub ramp: f64,
    /// Ramp of the tools, s.
    pub over: f64,
    /// Relaxation by region; empty in an elastic body.
    pub relaxation: Vec<Option<Prony>>,
}

/// Runs the motion, from rest and undeformed. One that made no step is an error, one that ended early is not.
pub fn solve(
    method: &Discretisation,
    setup: &Setup,
    params: &InTimeParams,
    prepared: &Prepared,
    work: &mut Work,
) -> Result<Motion, Failure> {
    let contact = prepared.contact.as_ref().map(ContactSurface::new);
    // The points of the forces need not give a regular mass: four of a tet10 have rank 4.
    let mass = match &params.density {
        Some(density) => {
            let (fine, region) = method.error_rows(&prepared.volume)?;
            work.mass_nodes += method.nodes().len() as u64;
            Some(Mass::consistent(&fine, density, &region)?)
        }
        None => None,
    };
    let duration = params.time.end;
    let linear = if params.ramp > 0.0 { Ramp::Linear { over: params.ramp } } else { Ramp::AtOnce };
    let (mut steps, mut fields) = (Vec::new(), Vec::new());
    let path = with_problem(method, setup, prepared, contact.as_ref(), |body| {
        let problem = TimeProblem {
            body,
            ramps: Ramps {
                loads: linear,
                // A mass that is led starts from rest.
                supports: match (&mass, linear) {
                    (Some(_), Ramp::Linear { over }) => Ramp::Smooth { over },
                    _ => linear,
                },
                tools: Ramp::Linear { over: params.over },
            },
            inertia: mass.as_ref().map(|mass| Inertia {
                mass,
                damping: params.damping,
                displacement: &[],
                velocity: &[],
            }),
            relaxation: &params.relaxation,
        };
        solve_in_time(&problem, &params.time, |done, motion, _| {
            if done.step.wanted {
                steps.push(told(done, setup, duration));
                fields.push(motion.u.clone());
            }
        })
    })?;
    let iterations: u64 = path.steps.iter().map(|s| solves(&s.step)).sum();
    work.time_steps += path.steps.len() as u64;
    work.newton_iterations += iterations;
    work.assemblies += path.work.assemblies;
    work.factorisations += path.work.factorisations;
    work.solves += path.work.solves;
    work.contact_evaluations += path.counts.evaluations;
    work.contact_skips += path.counts.skipped;
    let last = match (path.steps.last(), path.failure.clone()) {
        (Some(last), _) => told(last, setup, duration),
        (None, Some(TimeError::Stalled { cause, .. })) => return Err((*cause).into()),
        (None, Some(failure)) => return Err(failure.into()),
        (None, None) => return Err(Failure::Run("the motion has no step".into())),
    };
    let metric = |name: &str, value, unit| Metric { name: name.into(), value, unit };
    let largest = path.steps.iter().map(|s| s.error).fold(0.0, f64::max);
    let mut metrics = vec![
        metric("time-steps", path.steps.len() as f64, "1"),
        metric("time-reached", path.time(), "s"),
        metric("newton-iterations", iterations as f64, "1"),
        metric("cut-backs", path.cut_back as f64, "1"),
    ];
    let residual = path.steps.last().and_then(|s| s.step.iterations.last()).map(|i| i.residual);
    metrics.extend(residual.map(|value| metric("residual", value, "1")));
    if mass.is_some() {
        metrics.push(metric("step-error", largest, "m"));
        metrics.push(metric("energy-drift", drift(&path.steps), "1"));
    }
    let held: BTreeSet<(u32, u8)> = prepared.fixed().iter().map(|f| (f.node, f.axis)).collect();
    Ok(Motion {
        dofs: 3 * method.nodes().len() - held.len() + path.pressure.len(),
        u: path.motion.u,
        pressure: path.pressure,
        steps,
        fields,
        last,
        metrics,
        forces: None,
        failure: path.failure.map(Failure::from),
    })
}

/// Largest energy that the balance lacks or has too much, over the largest of its terms so far.
fn drift(steps: &[TimeStep]) -> f64 {
    let (mut drift, mut scale) = (0.0f64, 0.0f64);
    for TimeStep { energy, .. } in steps {
        let terms = [energy.kinetic, energy.internal, energy.external, energy.damped];
        scale = terms.iter().fold(scale, |scale, term| scale.max(term.abs()));
        if scale > 0.0 {
            drift = drift.max(energy.lost().abs() / scale);
        }
    }
    drift
}

fn told(done: &TimeStep, setup: &Setup, duration: f64) -> LoadStep {
    let TimeStep { step, energy, .. } = done;
    let tools = step.tools.iter().zip(&setup.tools).map(|(state, set)| ToolStep::of(state, &set.tool));
    // What contact springs store and friction takes is outside the body, and so is the tools' own work.
    let mut more = vec![
        ("time", step.time, "s"),
        ("kinetic-energy", energy.kinetic, "J"),
        ("work-on-body", energy.external, "J"),
        ("damping-dissipation", energy.damped, "J"),
        ("scheme-dissipation", energy.lost(), "J"),
    ];
    // What relaxing tissue stores of it is not known.
    let strain_energy = if setup.relaxes() {
        more.push(("internal-work", energy.internal, "J"));
        None
    } else {
        Some(energy.internal)
    };
    LoadStep {
        load: step.time / duration,
        tools: tools.collect(),
        strain_energy,
        smallest_j: step.smallest,
        iterations: solves(step),
        probes: Vec::<Vector3>::new(),
        against: Vec::new(),
        more: more.into_iter().map(|(name, value, unit)| Metric { name: name.into(), value, unit }).collect(),
    }
}
