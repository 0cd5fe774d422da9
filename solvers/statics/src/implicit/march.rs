//! Time stepping with cut-back and regrowth of steps, each solved by Newton's method.

use contact::Drive;
use shape::Vector3;

use super::energy::Energy;
use super::error::TimeError;
use super::problem::{Motion, TimeParams, TimePath, TimeProblem, TimeStep};
use super::scheme::{Scheme, Update};
use crate::nonlinear::{
    Attempt, Descent, Ended, InertiaTerms, Memory, Newton, Rate, State, Step, Stepper, TimeTerms, near,
    shortest_travel,
};

/// Solves a problem of implicit dynamics. `observe` is called after every converged step with the step, the
/// motion and the pressures.
///
/// # Errors
/// Errors of the problem itself. A solution that ends early is a [`TimePath`] with its `failure`.
pub fn solve_in_time(
    problem: &TimeProblem,
    params: &TimeParams,
    mut observe: impl FnMut(&TimeStep, &Motion, &[f64]),
) -> Result<TimePath, TimeError> {
    problem.check(params)?;
    let mass = problem.inertia.map(|i| i.mass.table());
    let newton = Newton::with_mass(problem.body, &params.newton, mass)?;
    let (mut march, first) = March::start(problem, params, newton)?;
    let (mut steps, mut failure) = (Vec::new(), None);
    if let Some(done) = first {
        observe(&done, &march.motion, &march.state.pressure);
        steps.push(done);
    }
    let mut stepper = Stepper::new(params.end, params.steps, params.smallest, problem.body.curves.points());
    // The peak speed of a smooth curve is less than twice its mean speed.
    let shortest = shortest_travel(problem.body);
    while let Some(attempt) = stepper.attempt() {
        match march.step(attempt) {
            Ok(mut done) => {
                done.step.wanted = attempt.output.is_some();
                let growth = params.accuracy.map_or(2.0, |allowed| following(allowed, done.error).min(2.0));
                stepper.accept(attempt, if done.step.is_quick() { growth } else { 1.0 });
                observe(&done, &march.motion, &march.state.pressure);
                steps.push(done);
            }
            Err(cause) => {
                let (part, finest) = match &cause {
                    TimeError::Inaccurate { error, allowed } => {
                        (following(*allowed, *error).clamp(0.2, 0.8), stepper.smallest)
                    }
                    TimeError::Static(cause) => (0.5, cause.finest(stepper.smallest, shortest)),
                    _ => (0.5, stepper.smallest),
                };
                if !stepper.cut(attempt, part, finest) {
                    let (time, step) = (stepper.time, attempt.length);
                    failure = Some(TimeError::Stalled { time, step, cause: Box::new(cause) });
                    break;
                }
            }
        }
    }
    let counts = march.newton.counts();
    let work = march.newton.work();
    let cut_back = stepper.cut_back;
    let March { motion, state: State { pressure, .. }, .. } = march;
    Ok(TimePath { steps, motion, pressure, cut_back, counts, work, failure })
}

/// Ratio of the next step to the last step for the given local error, which grows as the third power of the
/// step.
fn following(allowed: f64, error: f64) -> f64 {
    if error > 0.0 { 0.9 * (allowed / error).cbrt() } else { f64::INFINITY }
}

/// State of the time stepping.
struct March<'a> {
    problem: &'a TimeProblem<'a>,
    params: &'a TimeParams,
    scheme: Scheme,
    newton: Newton<'a>,
    memory: Option<Memory<'a>>,
    state: State,
    before: Option<State>,
    motion: Motion,
    /// Forces at the end of the last step.
    forces: Ended,
    energy: Energy,
}

impl<'a> March<'a> {
    /// Starts at time 0. A quasi-static body that is loaded at once returns the step to that state as well.
    fn start(
        problem: &'a TimeProblem<'a>,
        params: &'a TimeParams,
        newton: Newton<'a>,
    ) -> Result<(March<'a>, Option<TimeStep>), TimeError> {
        let zeros = vec![Vector3::zeros(); problem.body.nodes.len()];
        let relaxes = problem.relaxation.iter().any(Option::is_some);
        let forces = Ended { external: zeros.clone(), internal: zeros.clone(), deviator: Vec::new() };
        let mut march = March {
            problem,
            params,
            scheme: Scheme::new(params.rho_inf),
            newton,
            memory: relaxes.then(|| Memory::new(problem.body.solid, problem.relaxation)),
            state: State::start(problem.body),
            before: None,
            motion: Motion { u: zeros.clone(), v: zeros.clone(), a: zeros.clone(), reaction: zeros },
            forces,
            energy: Energy::default(),
        };
        if problem.inertia.is_some() {
            march.start_moving()?;
            return Ok((march, None));
        }
        // Dampers resist every sudden motion, so their body starts from rest.
        let loaded = problem.body.curves.act_at(0.0) && !march.has_dampers();
        let at_once = Attempt { time: 0.0, length: 0.0, output: None };
        let first = if loaded { Some(march.step(at_once)?) } else { None };
        march.before = None;
        Ok((march, first))
    }

    /// Computes forces and accelerations at time 0.
    fn start_moving(&mut self) -> Result<(), TimeError> {
        let inertia = self.problem.inertia.expect("asked for with inertia only");
        if !inertia.displacement.is_empty() {
            self.state.u.copy_from_slice(inertia.displacement);
        }
        if !inertia.velocity.is_empty() {
            self.motion.v.copy_from_slice(inertia.velocity);
        }
        let prescribed = self.newton.prescribed_at(0.0);
        for (i, u) in self.state.u.iter_mut().enumerate() {
            for axis in 0..3 {
                if let Some([value, speed, acceleration]) = prescribed(3 * i + axis) {
                    u[axis] = value;
                    self.motion.v[i][axis] = speed;
                    self.motion.a[i][axis] = acceleration;
                }
            }
        }
        drop(prescribed);
        let body = self.problem.body;
        for (k, (closure, driven)) in self.state.closures.iter_mut().zip(body.tools).enumerate() {
            if let Drive::Closure(full) = driven.drive {
                *closure = full * body.curves.tools.of(k).value(0.0);
            }
        }
        let relaxing = self.memory.as_ref().map(|m| m.relaxing(0.0));
        let rate = self.has_dampers().then(|| Rate {
            factor: 0.0,
            from: self.state.u.clone(),
            still: self.motion.v.clone(),
        });
        self.newton.set_terms(TimeTerms { inertia: None, relaxing, rate });
        let (forces, strain) = self.newton.forces_at(&self.state)?;
        let damping = inertia.mass.times(&self.motion.v);
        let force: Vec<Vector3> = (0..self.state.u.len())
            .map(|i| forces.external[i] - forces.internal[i] - damping[i] * inertia.damping)
            .collect();
        let prescribed = self.newton.prescribed();
        let constrained = |i: usize, axis: usize| prescribed[3 * i + axis].is_some();
        inertia.mass.accelerate(&force, constrained, &mut self.motion.a)?;
        if let Some(memory) = &mut self.memory {
            memory.advance(0.0, forces.deviator.clone());
        }
        self.motion.u.clone_from(&self.state.u);
        self.motion.reaction = self.reaction(&forces, &self.motion);
        self.forces = forces;
        self.energy.kinetic = self.kinetic(&self.motion);
        self.energy.internal = strain;
        self.energy.start = self.energy.kinetic + strain;
        Ok(())
    }

    /// Takes a step; a failure leaves the state unchanged.
    fn step(&mut self, Attempt { time, length: dt, output }: Attempt) -> Result<TimeStep, TimeError> {
        let relaxing = self.memory.as_ref().map(|m| m.relaxing(dt));
        let inertia = self.problem.inertia.map(|i| self.inertia(time, self.scheme.over(dt), i.damping));
        let rate = self.has_dampers().then(|| self.rate(time, dt));
        let moving = rate.clone().filter(|_| self.problem.inertia.is_none());
        self.newton.set_terms(TimeTerms { inertia, relaxing, rate });
        let before = self.before.as_ref();
        let augmentations = self.params.augmentations;
        let mut to = |descent| self.newton.step(&self.state, before, time, augmentations, descent);
        let (state, step) = near(!self.state.pressure.is_empty(), &mut to)
            .or_else(|_| to(Descent::Down))
            .and_then(|reached| self.newton.checked(&self.state, reached))?;
        if let Some(ends) = output {
            self.newton.check_overlap(&state, &step, ends)?;
        }
        let mut motion = self.motion_at(time, dt, &state.u);
        if let Some(rate) = moving {
            motion.v = rate.velocities(&state.u, self.newton.prescribed());
        }
        let mut error = 0.0f64;
        if self.problem.inertia.is_some() {
            let update = self.scheme.over(dt);
            for (a, new) in self.motion.a.iter().zip(&motion.a) {
                error = error.max(update.error(a, new));
            }
        }
        if let Some(allowed) = self.params.accuracy.filter(|allowed| error > *allowed) {
            return Err(TimeError::Inaccurate { error, allowed });
        }
        let forces = self.newton.ended();
        motion.reaction = self.reaction(&forces, &motion);
        self.balance_energy(&motion, &forces, &step);
        if let Some(memory) = &mut self.memory {
            memory.advance(dt, forces.deviator.clone());
        }
        self.before = Some(std::mem::replace(&mut self.state, state));
        (self.motion, self.forces) = (motion, forces);
        Ok(TimeStep { step, energy: self.energy, error })
    }

    /// Sets value, velocity or acceleration (`order` 0, 1, 2) of constrained degrees of freedom at `time`.
    fn prescribe(&self, field: &mut [Vector3], time: f64, order: usize) {
        let prescribed = self.newton.prescribed_at(time);
        for (i, value) in field.iter_mut().enumerate() {
            for axis in 0..3 {
                if let Some(each) = prescribed(3 * i + axis) {
                    value[axis] = each[order];
                }
            }
        }
    }

    /// Returns velocities and accelerations for the displacement `u` at `time`. Constrained degrees of
    /// freedom take their prescribed values.
    fn motion_at(&self, time: f64, dt: f64, u: &[Vector3]) -> Motion {
        let Motion { u: from, v, a, .. } = &self.motion;
        let zeros = || vec![Vector3::zeros(); u.len()];
        if self.problem.inertia.is_none() {
            return Motion { u: u.to_vec(), v: zeros(), a: zeros(), reaction: zeros() };
        }
        let update = self.scheme.over(dt);
        let mut new_a: Vec<Vector3> =
            (0..u.len()).map(|i| update.acceleration(&(u[i] - from[i]), &v[i], &a[i])).collect();
        let mut new_v: Vec<Vector3> =
            (0..u.len()).map(|i| update.velocity(&v[i], &a[i], &new_a[i])).collect();
        self.prescribe(&mut new_v, time, 1);
        self.prescribe(&mut new_a, time, 2);
        Motion { u: u.to_vec(), v: new_v, a: new_a, reaction: zeros() }
    }

    /// Returns the inertia terms in the balance of the step to `time`.
    fn inertia(&self, time: f64, update: Update, damping: f64) -> InertiaTerms {
        let Motion { u, v, a, .. } = &self.motion;
        let dt = time - self.state.time;
        let still = self.motion_at(time, dt, u);
        let settled =
            (0..u.len()).map(|i| update.rate(damping, [&a[i], &still.a[i]], [&v[i], &still.v[i]])).collect();
        let weight = self.scheme.alpha_f / (1.0 - self.scheme.alpha_f);
        let carried = (self.forces.external.iter().zip(&self.forces.internal))
            .map(|(external, internal)| (external - internal) * weight)
            .collect();
        // The acceleration at the end of the last step makes the guess exact for a body in free fall.
        let guess = (0..u.len()).map(|i| u[i] + (v[i] + a[i] * (0.5 * dt)) * dt).collect();
        InertiaTerms { factor: update.factor(damping), from: u.clone(), settled, carried, guess }
    }

    fn has_dampers(&self) -> bool {
        self.problem.body.penalties.iter().any(|surface| surface.damping > 0.0)
    }

    /// Returns the velocities at the end of the step of length `dt` to `time`: those of the scheme, or backward
    /// differences without inertia. A step of no length, to a body that is loaded at once, has none.
    fn rate(&self, time: f64, dt: f64) -> Rate {
        let from = self.state.u.clone();
        let mut still = self.motion_at(time, dt, &from).v;
        if self.problem.inertia.is_some() {
            return Rate { factor: self.scheme.over(dt).velocity_factor(), from, still };
        }
        let factor = if dt > 0.0 { 1.0 / dt } else { 0.0 };
        let prescribed = self.newton.prescribed_at(time);
        for (i, still) in still.iter_mut().enumerate() {
            for axis in 0..3 {
                if let Some([value, ..]) = prescribed(3 * i + axis) {
                    still[axis] = (value - from[i][axis]) * factor;
                }
            }
        }
        Rate { factor, from, still }
    }

    /// Returns the reaction forces at constrained degrees of freedom; zero at free degrees of freedom.
    fn reaction(&self, forces: &Ended, motion: &Motion) -> Vec<Vector3> {
        let mut inertia = vec![Vector3::zeros(); motion.u.len()];
        if let Some(given) = self.problem.inertia {
            let rate: Vec<Vector3> =
                motion.a.iter().zip(&motion.v).map(|(a, v)| a + v * given.damping).collect();
            inertia = given.mass.times(&rate);
        }
        let prescribed = self.newton.prescribed();
        (0..motion.u.len())
            .map(|i| {
                let lacking = forces.internal[i] - forces.external[i] + inertia[i];
                Vector3::from_fn(
                    |axis, _| if prescribed[3 * i + axis].is_some() { lacking[axis] } else { 0.0 },
                )
            })
            .collect()
    }

    fn kinetic(&self, motion: &Motion) -> f64 {
        let Some(inertia) = self.problem.inertia else { return 0.0 };
        let momentum = inertia.mass.times(&motion.v);
        0.5 * momentum.iter().zip(&motion.v).map(|(p, v)| p.dot(v)).sum::<f64>()
    }

    fn balance_energy(&mut self, motion: &Motion, forces: &Ended, step: &Step) {
        let gain: Vec<Vector3> = motion.u.iter().zip(&self.motion.u).map(|(new, old)| new - old).collect();
        let work = |old: &[Vector3], new: &[Vector3]| -> f64 {
            gain.iter().zip(old.iter().zip(new)).map(|(gain, (old, new))| 0.5 * gain.dot(&(old + new))).sum()
        };
        self.energy.external +=
            work(&self.forces.external, &forces.external) + work(&self.motion.reaction, &motion.reaction);
        if self.memory.is_some() {
            self.energy.internal += work(&self.forces.internal, &forces.internal);
        } else {
            self.energy.internal = step.energy;
        }
        self.energy.kinetic = self.kinetic(motion);
        if let Some(inertia) = self.problem.inertia.filter(|i| i.damping > 0.0) {
            let momentum = inertia.mass.times(&motion.v);
            let before = inertia.mass.times(&self.motion.v);
            self.energy.damped += inertia.damping * work(&before, &momentum);
        }
    }
}
