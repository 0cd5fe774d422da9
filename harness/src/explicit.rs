//! Explicit dynamics: time steps of central differences with contact, and what each recorded state left.

use std::collections::{BTreeMap, BTreeSet};

use contact::{ContactSurface, Drive};
use explicit::{
    Balance, Dynamics, DynamicsParams, ExplicitBody, ExplicitError, External, InternalForce, LanczosParams,
    Lumping, MovingTool, Prescribed, Springs, Tools, critical_step_touching, lumped_mass,
};
use geometry::Vector3;
use lanes::LanePath;
use shape::Matrix3;
use statics::{SolveError, nodal_forces};

use crate::Failure;
use crate::motion::Motion;
use crate::outcome::{LoadStep, Metric, ToolStep};
use crate::prepare::Prepared;
use crate::setup::Setup;
use crate::work::Work;

/// Lanczos steps of the critical step, and the factor for what they miss from below.
const LANCZOS: LanczosParams = LanczosParams { steps: 15, safety: 0.95 };

/// Most time steps between two estimates of the critical step: 30 evaluations of the internal forces each, 3 % of these steps.
const RECHECK: usize = 1000;

/// How explicit dynamics is stepped.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplicitParams {
    /// End, s.
    pub duration: f64,
    /// Time over which loads and prescribed displacements grow in proportion to it, s; 0 is at once.
    pub ramp: f64,
    /// Equal parts of the duration at whose ends the state is recorded.
    pub states: usize,
    /// Mass-proportional damping of body and tools, 1/s.
    pub damping: f64,
    /// Time step over the critical one.
    pub safety: f64,
    /// Time step, s, at most; from the critical one if not given.
    pub step: Option<f64>,
    /// Mass of a tool driven by force over the body's.
    pub tool_mass: f64,
    /// Density by region, kg/m^3.
    pub density: Vec<f64>,
    /// Ramp of each tool, s.
    pub over: Vec<f64>,
}

/// Runs the motion, from rest and undeformed. One that ends early keeps its numbers, those of the start if no state was
/// recorded.
pub fn solve(
    setup: &Setup,
    params: &ExplicitParams,
    prepared: &Prepared,
    work: &mut Work,
) -> Result<Motion, Failure> {
    let volume = &prepared.volume;
    let rows = &volume.rows;
    let mass = lumped_mass(rows, &params.density, &volume.region, Lumping::for_table(rows))?;
    let body = ExplicitBody {
        volume: rows,
        laws: &setup.laws,
        region: &volume.region,
        groups: volume.groups.as_ref(),
    };
    let mut force = InternalForce::new(body, LanePath::best())?;
    let kernel = force.info();
    work.mass_nodes += mass.len() as u64;

    let ramp = |t: f64| if t < params.ramp { t / params.ramp } else { 1.0 };
    let loads = nodal_forces(rows, &prepared.loads())?;
    let loaded: Vec<usize> = (0..loads.len()).filter(|&i| loads[i] != Vector3::zeros()).collect();
    let mut load = |t: f64, _: &[Vector3], _: &[Vector3], f: &mut [Vector3]| {
        loaded.iter().for_each(|&i| f[i] += loads[i] * ramp(t));
    };
    let led = led(prepared)?;
    let motions: Vec<Box<dyn Fn(f64) -> f64 + Sync>> =
        led.values().map(|&value| Box::new(move |t: f64| value * ramp(t)) as Box<_>).collect();
    let prescribed: Vec<Prescribed> = led
        .keys()
        .zip(&motions)
        .map(|(&(node, axis), motion)| Prescribed { node, axis, motion: motion.as_ref() })
        .collect();

    let zeros = vec![Vector3::zeros(); mass.len()];
    let surface = prepared.contact.as_ref().map(ContactSurface::new);
    let tool_mass = params.tool_mass * mass.iter().sum::<f64>();
    let moving: Vec<MovingTool> = setup
        .tools
        .iter()
        .zip(&params.over)
        .map(|(set, &over)| MovingTool {
            tool: &set.tool,
            drive: set.drive,
            over,
            mass: tool_mass,
            damping: params.damping,
        })
        .collect();
    let tools = match &surface {
        Some(surface) => Some(Tools::new(surface, &moving, &zeros)?),
        None => None,
    };
    let held: BTreeSet<usize> = led.keys().map(|&(node, axis)| 3 * node as usize + axis as usize).collect();
    let springs = |modulus: f64| prepared.contact.as_ref().map(|surface| Springs { surface, modulus });
    let stiffest =
        setup.tools.iter().map(|t| t.tool.law().penalty().max(t.tool.law().stick())).fold(0.0, f64::max);
    let first = critical_step_touching(
        &mut force,
        &mass,
        &zeros,
        |k| !held.contains(&k),
        springs(stiffest),
        LANCZOS,
    )?;
    let first_step = params.step.unwrap_or(params.safety * first.dt);
    let interval = params.duration / params.states as f64;
    let dynamics = DynamicsParams {
        dt: divided(interval, first_step).0,
        damping: params.damping,
        critical: LANCZOS,
        recheck: 0,
    };
    let motion =
        Dynamics::new(&mut force, &mass, &prescribed, dynamics, zeros.clone(), zeros).and_then(|motion| {
            match tools {
                Some(tools) => motion.with_tools(tools),
                None => Ok(motion),
            }
        });
    let (mut steps, mut fields, mut made) = (Vec::new(), Vec::new(), 0);
    let (mut critical, mut drift) = (first.dt, 0.0);
    let failure = match motion {
        Err(failure @ ExplicitError::StepTooLarge { .. }) => Some(failure),
        Err(failure) => return Err(failure.into()),
        Ok(motion) => {
            let mut run = Run { motion, params, setup, prepared, steps, fields, critical, drift };
            let failure = run.march(&mut load, interval).err();
            made = run.motion.steps() as u64;
            if let Some(tools) = run.motion.tools() {
                work.contact_evaluations += tools.counts().evaluations;
                work.contact_skips += tools.counts().skipped;
            }
            Run { steps, fields, critical, drift, .. } = run;
            failure
        }
    };
    work.time_steps += made;
    let last = steps.last().cloned().unwrap_or_else(|| LoadStep::at_start(setup.tools.len()));
    let tool_mass = if moving.iter().any(|t| matches!(t.drive, Drive::Force(_))) { tool_mass } else { 0.0 };
    let metric = |name: &str, value, unit| Metric { name: name.into(), value, unit };
    let metrics = vec![
        metric("time-steps", made as f64, "1"),
        metric("time-reached", last.load * params.duration, "s"),
        metric("critical-step", critical, "s"),
        metric("mass", mass.iter().sum(), "kg"),
        metric("tool-mass", tool_mass, "kg"),
        metric("energy-drift", drift, "1"),
    ];
    Ok(Motion {
        dofs: 3 * mass.len() - led.len(),
        u: fields.last().cloned().unwrap_or_else(|| vec![Vector3::zeros(); mass.len()]),
        steps,
        fields,
        pressure: Vec::new(),
        last,
        metrics,
        forces: Some(kernel),
        failure: failure.map(Failure::from),
    })
}

/// Degrees of freedom held, with their displacement (m) at the end. A node on two supports has one value or none.
pub(crate) fn led(prepared: &Prepared) -> Result<BTreeMap<(u32, u8), f64>, Failure> {
    let mut led = BTreeMap::new();
    for fixed in prepared.fixed() {
        let first = *led.entry((fixed.node, fixed.axis)).or_insert(fixed.value);
        if (first - fixed.value).abs() > 1e-12 * first.abs().max(fixed.value.abs()) {
            let (node, axis, second) = (fixed.node as usize, fixed.axis, fixed.value);
            return Err(SolveError::Conflict { node, axis, first, second }.into());
        }
    }
    Ok(led)
}

/// Smallest volume ratio of all quadrature points.
pub(crate) fn smallest_j(prepared: &Prepared, u: &[Vector3]) -> f64 {
    let gradients = prepared.volume.rows.at().displacement_gradients(u);
    gradients.iter().map(|h| (Matrix3::identity() + h).determinant()).fold(f64::INFINITY, f64::min)
}

/// An interval in equal steps no longer than `longest`: their length and number.
fn divided(interval: f64, longest: f64) -> (f64, usize) {
    // Rounding must not add a step of its own.
    let count = (interval / longest * (1.0 - 1e-12)).ceil().max(1.0);
    (interval / count, count as usize)
}

struct Run<'a, 'b> {
    motion: Dynamics<'a, 'b>,
    params: &'b ExplicitParams,
    setup: &'b Setup,
    prepared: &'b Prepared,
    steps: Vec<LoadStep>,
    fields: Vec<Vec<Vector3>>,
    /// Smallest critical step found, s.
    critical: f64,
    drift: f64,
}

impl Run<'_, '_> {
    /// All recorded states. The step follows the critical one as the body deforms, unless the scene gives it.
    fn march(&mut self, load: &mut External<'_>, interval: f64) -> Result<(), ExplicitError> {
        for state in 0..=self.params.states {
            let mut left = 1;
            if state < self.params.states {
                left = self.choose_step((state + 1) as f64 * interval)?;
            }
            // The balance at a state is known with the step that leaves it; the last state has one for that alone.
            let mut seen: Option<(Balance, Vec<Vector3>)> = None;
            self.motion.run(1, 1, load, &mut |balance, u| seen = Some((*balance, u.to_vec())))?;
            let (balance, u) = seen.expect("every step is recorded");
            if state > 0 {
                self.drift = self.drift.max(balance.drift.abs());
                self.steps.push(self.told(&balance, &u, state as f64 * interval));
                self.fields.push(u);
            }
            left -= 1;
            while left > 0 {
                let now = left.min(RECHECK);
                self.motion.run(now, 0, load, &mut |_, _| ())?;
                left -= now;
                if left > 0 {
                    left = self.choose_step((state + 1) as f64 * interval)?;
                }
            }
        }
        Ok(())
    }

    /// The step for the way to `end` (s); returns how many there are.
    fn choose_step(&mut self, end: f64) -> Result<usize, ExplicitError> {
        let critical = self.motion.critical_step()?.dt;
        self.critical = self.critical.min(critical);
        let longest = self.params.step.unwrap_or(self.params.safety * critical);
        let (dt, count) = divided(end - self.motion.time(), longest);
        self.motion.set_step(dt)?;
        Ok(count)
    }

    fn told(&self, balance: &Balance, u: &[Vector3], time: f64) -> LoadStep {
        let states = self.motion.tools().into_iter().flat_map(Tools::motions);
        let tools = states.zip(&self.setup.tools).map(|(motion, set)| ToolStep::of(&motion.state, &set.tool));
        let t = &balance.tools;
        let more = [
            ("time", time, "s"),
            ("kinetic-energy", balance.kinetic + t.kinetic, "J"),
            ("external-work", balance.external + balance.support + t.work, "J"),
            ("contact-energy", t.stored, "J"),
            ("friction-dissipation", t.friction, "J"),
            ("damping-dissipation", balance.damping + t.damping, "J"),
            ("energy-drift", balance.drift, "1"),
        ];
        LoadStep {
            load: time / self.params.duration,
            tools: tools.collect(),
            strain_energy: Some(balance.strain),
            smallest_j: smallest_j(self.prepared, u),
            iterations: 0,
            probes: Vec::new(),
            against: Vec::new(),
            more: more.map(|(name, value, unit)| Metric { name: name.into(), value, unit }).to_vec(),
        }
    }
}
