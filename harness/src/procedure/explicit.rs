//! Explicit dynamics: time steps by central differences with contact, and the results of each recorded state.

use std::collections::BTreeSet;

use cases::scene::Explicit;
use cases::scene::Precision::{Double, Single};
use catalogue::metric;
use contact::{ContactSurface, Drive};
use explicit::{
    Balance, Contraction, CriticalStep, Dynamics, DynamicsParams, ExplicitBody, ExplicitError, External,
    InternalForce, LanczosParams, Lumping, MovingTool, Precision, Prescribed, Springs, Tools,
    critical_step_touching, lumped_mass, point_masses,
};
use geometry::{Point3, Vector3};
use lanes::LanePath;
use shape::{Resultant, VolumeRows};

use super::loading::Loading;
use super::problem::Problem;
use super::solution::{Solution, StepHistory};
use super::stages::Stages;
use crate::error::{Failure, Key};
use crate::outcome::timing::Meters;
use crate::outcome::{Counters, LoadStep, Metric, ToolStep, Watch};
use crate::prepare::{ConditionForces, Prepared};
use crate::scenario::setup::Setup;

/// Lanczos steps for the critical time step, and the safety factor. Lanczos steps approach the largest
/// eigenvalue from below.
const LANCZOS: LanczosParams = LanczosParams { steps: 15, safety: 0.95 };

/// Most time steps between two estimates of the critical step. An estimate takes 30 evaluations of the
/// internal forces, 3 % of these steps.
const RECHECK: usize = 1000;
/// Largest number of time steps of a run, which takes hours for a body of ten thousand cells. Usual runs take
/// a thousand to a million.
const MOST_STEPS: f64 = 1e7;

pub(super) fn stages(setup: &Setup, asked: &Explicit) -> Stages {
    let duration = asked.ramp.duration;
    let steps = match asked.step {
        Some(step) => format!("{duration} s in steps of {step:e} s"),
        None => format!("{duration} s in steps of {} of the critical step", asked.safety),
    };
    Stages {
        mass: (true, "lumped".into()),
        stiffness: (false, "explicit: only forces are evaluated".into()),
        time_steps: (true, steps + &setup.pressures() + &setup.springs() + &setup.curves()),
        factorisation: (false, "explicit: the mass is diagonal".into()),
        newton: (false, "explicit".into()),
        ..Stages::linear()
    }
}

/// Integrates the motion from the undeformed body at rest. A run that ends early keeps its results, or those
/// of the start if no state was recorded.
pub(super) fn solve(problem: &Problem, asked: &Explicit, meters: &mut Meters) -> Result<Solution, Failure> {
    let Meters { timings, counters, .. } = meters;
    timings.time("solve", || motion(problem, asked, counters))
}

fn motion(problem: &Problem, asked: &Explicit, counters: &mut Counters) -> Result<Solution, Failure> {
    let Problem { setup, prepared, watch, .. } = *problem;
    let (volume, rows) = (&prepared.volume, &prepared.volume.rows);
    let density = setup.density()?;
    let mass = lumped_mass(rows, &density, &volume.region, Lumping::for_table(rows))?;
    let mut force = InternalForce::of_precision(body(setup, prepared), LanePath::best(), precision(asked))?;
    let kernel = force.info();
    counters.mass_nodes += mass.len() as u64;

    let loading = Loading::new(problem, &asked.ramp)?;
    let mut load = |t: f64, u: &[Vector3], v: &[Vector3], f: &mut [Vector3]| {
        for (curve, forces) in &loading.loads {
            let part = curve.value(t);
            forces.iter().for_each(|(i, force)| f[*i] += force * part);
        }
        for (index, pressure) in prepared.following().iter().enumerate() {
            pressure.add_force(u, loading.curves.following.of(index).value(t), f);
        }
        prepared.add_foundation_forces(u, v, f);
    };
    let loading = &loading;
    let motions = loading.motions();
    let prescribed: Vec<Prescribed> = (loading.led.keys().zip(&motions))
        .map(|(&(node, axis), motion)| Prescribed { node, axis, motion: motion.as_ref() })
        .collect();

    let zeros = vec![Vector3::zeros(); mass.len()];
    let surface = prepared.contact();
    let tool_mass = asked.tool_mass * mass.iter().sum::<f64>();
    let moving = moving_tools(setup, asked, tool_mass);
    let tools = surface.as_ref().map(|surface| Tools::new(surface, &moving, &zeros)).transpose()?;
    let springs = springs(setup, prepared, surface.as_ref());
    let stress = |time: f64| loading.active(setup, time);
    let contraction = contraction(setup, loading, &stress);
    let first = first_critical(&mut force, &mass, loading, &springs, contraction.as_ref())?;
    let beta = asked.ramp.stiffness_damping;
    let first = if beta > 0.0 { first.with_stiffness_damping(beta) } else { first };
    let interval = asked.ramp.duration / asked.ramp.steps as f64;
    let dt = first_step(asked, interval, first.dt)?;
    let params =
        DynamicsParams { dt, damping: asked.ramp.damping, critical: LANCZOS, recheck: 0, known: Some(first) };
    let motion =
        Dynamics::new(&mut force, &mass, &prescribed, params, zeros.clone(), zeros).and_then(|motion| {
            let motion = contraction.into_iter().fold(motion, Dynamics::contracting);
            let motion = motion.with_stiffness_damping(beta)?;
            tools.into_iter().try_fold(motion.on_ground(prepared.ground()), Dynamics::with_tools)
        });
    let mut states = States { critical: first.dt, ..States::default() };
    let mut made = 0;
    let failure = match motion {
        Err(failure @ ExplicitError::StepTooLarge { .. }) => Some(failure),
        Err(failure) => return Err(failure.into()),
        Ok(motion) => {
            let (nodes, led) = (problem.method.nodes(), loading.ends());
            let points = (!problem.method.interpolates).then(|| point_masses(rows, &density, &volume.region));
            let masses = points.transpose()?.map(|points| Masses { points, lumped: &mass });
            let mut run = Run { motion, asked, setup, prepared, nodes, led, masses, states, watch };
            let failure = run.march(&mut load, interval).err();
            made = run.motion.steps() as u64;
            counters.time_steps += made;
            if let Some(tools) = run.motion.tools() {
                counters.contact_evaluations += tools.counts().evaluations;
                counters.contact_skips += tools.counts().skipped;
            }
            Run { states, .. } = run;
            failure
        }
    };
    let spurious_motion = (!problem.method.interpolates).then(|| states.spurious_motion());
    let tool_mass = if moving.iter().any(|t| matches!(t.drive, Drive::Force(_))) { tool_mass } else { 0.0 };
    let u = states.fields.last().cloned();
    Ok(Solution {
        dofs: 3 * mass.len() - loading.led.len(),
        u: u.unwrap_or_else(|| vec![Vector3::zeros(); mass.len()]),
        history: Some(states.history(problem, asked, made, [mass.iter().sum(), tool_mass], failure)),
        forces: Some(kernel),
        spurious_motion,
        ..Solution::default()
    })
}

/// Critical step of the undeformed body at rest, without stiffness-proportional damping.
fn first_critical(
    force: &mut InternalForce,
    mass: &[f64],
    loading: &Loading,
    springs: &[Springs],
    contraction: Option<&Contraction>,
) -> Result<CriticalStep, ExplicitError> {
    let constrained: BTreeSet<usize> =
        loading.led.keys().map(|&(node, axis)| 3 * node as usize + axis as usize).collect();
    let zeros = vec![Vector3::zeros(); mass.len()];
    force.contract(contraction.map_or(&[], |contraction| &contraction.largest));
    let found = critical_step_touching(force, mass, &zeros, |k| !constrained.contains(&k), springs, LANCZOS);
    force.contract(&[]);
    found
}

/// Active stress of the regions over time; `None` if none contracts.
fn contraction<'a>(
    setup: &Setup,
    loading: &Loading,
    stress: &'a (dyn Fn(f64) -> Vec<f64> + Sync),
) -> Option<Contraction<'a>> {
    let largest = |(region, full): (usize, &f64)| {
        let factors = loading.curves.active.of(region).points().iter().map(|[_, factor]| factor * full);
        factors.fold(0.0, f64::max)
    };
    let largest: Vec<f64> = setup.active.iter().enumerate().map(largest).collect();
    (!largest.is_empty()).then_some(Contraction { stress, largest })
}

/// Springs for the critical step: those of possible contact, and of surfaces on springs and dampers.
fn springs<'a>(
    setup: &Setup,
    prepared: &'a Prepared,
    surface: Option<&'a ContactSurface<'_>>,
) -> Vec<Springs<'a>> {
    let modulus = stiffest(setup);
    let contact = surface.map(|surface| Springs { surface: surface.rows(), modulus, damping: 0.0 });
    contact.into_iter().chain(prepared.ground()).collect()
}

fn precision(asked: &Explicit) -> Precision {
    match asked.precision {
        Double => Precision::Double,
        Single => Precision::Single,
    }
}

/// The body for the kernels of internal forces.
pub(super) fn body<'a>(setup: &'a Setup, prepared: &'a Prepared) -> ExplicitBody<'a> {
    let volume = &prepared.volume;
    ExplicitBody {
        volume: &volume.rows,
        laws: &setup.laws,
        region: &volume.region,
        axes: &volume.axes,
        groups: volume.groups.as_ref(),
    }
}

/// Length of the first time step, s. A run with more than [`MOST_STEPS`] time steps is refused.
fn first_step(asked: &Explicit, interval: f64, critical: f64) -> Result<f64, Failure> {
    let (dt, _) = divided(interval, asked.step.unwrap_or(asked.safety * critical));
    let count = asked.ramp.duration / dt;
    if count <= MOST_STEPS {
        return Ok(dt);
    }
    let problem = format!(
        "needs {count:.2e} time steps of {dt:.2e} s; at most {MOST_STEPS:.0e} are supported, and the critical step is \
         {critical:.2e} s"
    );
    let (key, help) = match asked.step {
        Some(_) => ("step", "take a longer step, or leave the key out"),
        None => ("duration", "take a shorter duration, larger cells, or a softer or denser tissue"),
    };
    Err(Failure::input(Key::Scene(format!("procedure.{key}")), problem, help))
}

fn moving_tools<'a>(setup: &'a Setup, asked: &Explicit, mass: f64) -> Vec<MovingTool<'a>> {
    let moving = setup.tools.iter().map(|placed| MovingTool {
        tool: &placed.tool,
        drive: placed.drive,
        over: placed.over.unwrap_or(asked.ramp.duration),
        curve: placed.curve.as_deref(),
        mass,
        damping: asked.ramp.damping,
    });
    moving.collect()
}

/// Largest contact stiffness per area, Pa/m.
fn stiffest(setup: &Setup) -> f64 {
    setup.tools.iter().map(|t| t.tool.law().penalty().max(t.tool.law().stick())).fold(0.0, f64::max)
}

/// Smallest volume ratio of all quadrature points.
pub(crate) fn smallest_j(prepared: &Prepared, u: &[Vector3]) -> f64 {
    prepared.volume.rows.at().smallest_volume_ratio(u)
}

/// Divides an interval into equal steps no longer than `longest`; returns their length and number.
fn divided(interval: f64, longest: f64) -> (f64, usize) {
    // Rounding must not add a step.
    let count = (interval / longest * (1.0 - 1e-12)).ceil().max(1.0);
    (interval / count, count as usize)
}

/// Masses of a cloud: those of its points and those lumped on its parameters, kg.
struct Masses<'a> {
    points: Vec<f64>,
    lumped: &'a [f64],
}

impl Masses<'_> {
    /// Kinetic energies of parameters with these velocities (m/s), J: of the lumped mass, and of the
    /// displacement.
    fn energies(&self, volume: &VolumeRows, velocities: &[Vector3]) -> [f64; 2] {
        let sum = |masses: &[f64], velocities: &[Vector3]| -> f64 {
            masses.iter().zip(velocities).map(|(m, v)| 0.5 * m * v.norm_squared()).sum()
        };
        [sum(self.lumped, velocities), sum(&self.points, &volume.rows().apply(velocities))]
    }
}

/// Recorded states so far.
#[derive(Default)]
struct States {
    steps: Vec<LoadStep>,
    fields: Vec<Vec<Vector3>>,
    /// Smallest estimate of the critical step, s.
    critical: f64,
    /// Largest relative error of the energy balance.
    drift: f64,
    /// Largest relative rounding of the internal forces in single precision.
    rounding: f64,
    /// Largest kinetic energy of the lumped mass, and largest part of it that the displacement does not have,
    /// J.
    kinetic: f64,
    unseen: f64,
}

impl States {
    fn spurious_motion(&self) -> f64 {
        if self.kinetic > 0.0 { self.unseen / self.kinetic } else { 0.0 }
    }

    /// Returns the history of a run with `made` steps and the masses of the body and of a tool (kg).
    fn history(
        self,
        problem: &Problem,
        asked: &Explicit,
        made: u64,
        [mass, tool_mass]: [f64; 2],
        failure: Option<ExplicitError>,
    ) -> StepHistory {
        let States { steps, fields, critical, drift, rounding, .. } = self;
        let last = steps.last().cloned();
        let last = last.unwrap_or_else(|| LoadStep::at_start(problem.setup.tools.len()));
        let mut metrics = vec![
            Metric::new(&metric::TIME_STEPS, made as f64),
            Metric::new(&metric::TIME_REACHED, last.load * asked.ramp.duration),
            Metric::new(&metric::CRITICAL_STEP, critical),
            Metric::new(&metric::MASS, mass),
            Metric::new(&metric::TOOL_MASS, tool_mass),
            Metric::new(&metric::ENERGY_DRIFT, drift),
        ];
        if asked.precision == Single {
            metrics.push(Metric::new(&metric::FORCE_ROUNDING, rounding));
        }
        StepHistory { steps, fields, last, metrics, failure: failure.map(Failure::from) }
    }
}

struct Run<'a, 'b> {
    motion: Dynamics<'a, 'b>,
    asked: &'b Explicit,
    setup: &'b Setup,
    prepared: &'b Prepared,
    /// Undeformed positions, m.
    nodes: &'b [Point3],
    /// Prescribed degrees of freedom, in the order of the integrator, and the time at which each is let go,
    /// s.
    led: Vec<((u32, u8), f64)>,
    /// Masses of a cloud; `None` for elements.
    masses: Option<Masses<'b>>,
    states: States,
    watch: Option<&'b Watch>,
}

impl Run<'_, '_> {
    /// Integrates up to the end and records the states. Unless the scene sets the time step, it follows the
    /// critical step as the body deforms.
    fn march(&mut self, load: &mut External<'_>, interval: f64) -> Result<(), ExplicitError> {
        for state in 0..=self.asked.ramp.steps {
            let next = (state + 1) as f64 * interval;
            let mut left = 1;
            if state < self.asked.ramp.steps {
                left = self.choose_step(next)?;
            }
            // The energy balance at a state is known after the next step. The last state takes an additional
            // step for it.
            let mut seen: Option<(Balance, Vec<Vector3>)> = None;
            self.motion.run(1, 1, load, &mut |balance, u| seen = Some((*balance, u.to_vec())))?;
            let (balance, u) = seen.expect("every step is recorded");
            if state > 0 {
                if let Some(tools) = self.motion.tools() {
                    let step = self.motion.steps() - 1;
                    let time = state as f64 * interval;
                    tools.check_overlap(step, time, &u)?;
                    if state == self.asked.ramp.steps {
                        tools.check_end(step, time, &u)?;
                    }
                }
                self.states.drift = self.states.drift.max(balance.drift.abs());
                self.states.rounding = self.states.rounding.max(self.motion.rounding(&u)?);
                if let Some(masses) = &self.masses {
                    let [lumped, seen] =
                        masses.energies(&self.prepared.volume.rows, self.motion.velocities());
                    self.states.kinetic = self.states.kinetic.max(lumped);
                    self.states.unseen = self.states.unseen.max(lumped - seen);
                }
                let step = self.reported(&balance, &u, state as f64 * interval);
                if let Some(watch) = self.watch {
                    watch.step(&step);
                }
                self.states.steps.push(step);
                self.states.fields.push(u);
            }
            if state == self.asked.ramp.steps {
                break;
            }
            left -= 1;
            if self.let_go(next) {
                left = self.choose_step(next)?;
            }
            while left > 0 {
                let now = left.min(RECHECK);
                self.motion.run(now, 0, load, &mut |_, _| ())?;
                left -= now;
                if self.let_go(next) || left > 0 {
                    left = self.choose_step(next)?;
                }
            }
        }
        Ok(())
    }

    /// Lets go of the degrees of freedom whose supports have ended, and returns whether there were any.
    /// Those that end at `next`, the time (s) of the next state, still hold it.
    fn let_go(&mut self, next: f64) -> bool {
        let ended =
            |until: f64| until < next - self.rounding() && until < self.motion.time() + self.rounding();
        let gone: Vec<bool> = self.led.iter().map(|&(_, until)| ended(until)).collect();
        self.led.iter_mut().zip(&gone).filter(|(_, gone)| **gone).for_each(|(led, _)| led.1 = f64::INFINITY);
        let any = gone.contains(&true);
        if any {
            self.motion.release(|k| gone[k]);
        }
        any
    }

    /// Times closer than this are one, s.
    fn rounding(&self) -> f64 {
        1e-9 * self.asked.ramp.duration
    }

    /// Sets the time step up to `end` (s), or to the end of a support before it, and returns the number of
    /// steps.
    fn choose_step(&mut self, end: f64) -> Result<usize, ExplicitError> {
        let now = self.motion.time() + self.rounding();
        let end = self.led.iter().map(|&(_, until)| until).filter(|until| *until > now).fold(end, f64::min);
        if end < now {
            return Ok(0);
        }
        let critical = self.motion.critical_step()?.dt;
        self.states.critical = self.states.critical.min(critical);
        let longest = self.asked.step.unwrap_or(self.asked.safety * critical);
        let (dt, count) = divided(end - self.motion.time(), longest);
        self.motion.set_step(dt)?;
        Ok(count)
    }

    /// Resultant of each support's forces on the body at the last step, at a time in s with
    /// displacements `u` (m).
    fn supports(&self, u: &[Vector3], time: f64) -> Vec<Resultant> {
        let mut forces = vec![Vector3::zeros(); u.len()];
        for (&((node, axis), _), force) in self.led.iter().zip(self.motion.reactions()) {
            forces[node as usize][usize::from(axis)] = *force;
        }
        let at = |i: usize| self.nodes[i] + u[i];
        self.prepared.support_forces(&ConditionForces {
            at: &at,
            nodes: &forces,
            rows: &[],
            weak: &[],
            time: Some(time),
        })
    }

    fn reported(&self, balance: &Balance, u: &[Vector3], time: f64) -> LoadStep {
        let states = self.motion.tools().into_iter().flat_map(Tools::motions);
        let tools = states.zip(&self.setup.tools).map(|(motion, set)| ToolStep::of(&motion.state, &set.tool));
        let t = &balance.tools;
        let more = [
            (&metric::TIME, time),
            (&metric::KINETIC_ENERGY, balance.kinetic + t.kinetic),
            (&metric::EXTERNAL_WORK, balance.external + balance.support + t.work),
            (&metric::CONTACT_ENERGY, t.stored),
            (&metric::FRICTION_DISSIPATION, t.friction),
            (&metric::DAMPING_DISSIPATION, balance.damping + t.damping),
            (&metric::ENERGY_DRIFT, balance.drift),
        ];
        LoadStep {
            load: time / self.asked.ramp.duration,
            tools: tools.collect(),
            supports: self.supports(u, time),
            means: Vec::new(),
            strain_energy: Some(balance.strain),
            smallest_j: smallest_j(self.prepared, u),
            iterations: 0,
            probes: Vec::new(),
            points: self.prepared.foundation_forces(u, self.motion.velocities()),
            against: Vec::new(),
            more: more.map(|(entry, value)| Metric::new(entry, value)).to_vec(),
        }
    }
}
