//! Time stepping with cut-back and regrowth of steps, each solved by Newton's method.

use contact::Drive;
use shape::Vector3;

use super::energy::Energy;
use super::error::TimeError;
use super::problem::{Motion, TimeParams, TimePath, TimeProblem, TimeStep};
use super::scheme::{Scheme, Update};
use crate::nonlinear::{
    Attempt, Descent, Ended, InertiaTerms, Memory, Newton, Rate, Stages, State, Step, Stepper,
    StiffnessDamping, TimeTerms, Totals, near, shortest_travel,
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
    let relaxes = problem.relaxation.iter().any(Option::is_some);
    let mut memory = relaxes.then(|| Memory::new(problem.body.solid, problem.relaxation));
    let mut stages = Stages::new(problem.body, params.end);
    let mut course = Course::new(problem, params);
    let mut totals = Totals::default();
    loop {
        let stage = stages.stage(&course.state.u);
        let staged = stage.as_ref().map(|stage| stage.problem(problem.body));
        let problem = &TimeProblem { body: staged.as_ref().unwrap_or(problem.body), ..problem.clone() };
        let newton = Newton::with_mass(problem.body, &params.newton, mass)?.continuing(&totals);
        let scheme = params.alpha.map_or_else(|| Scheme::new(params.rho_inf), Scheme::hilber);
        let mut march =
            March { problem, params, scheme, newton, memory: memory.as_mut(), course: &mut course };
        if stages.is_first() {
            march.start(&mut observe)?;
        } else if problem.inertia.is_some() {
            march.accelerate()?;
        }
        march.follow(stages.until(), &mut observe);
        totals = march.newton.totals();
        // Without inertia, the force of a support that ends would leave the body without an equilibrium nearby.
        let gone = problem.inertia.is_none().then(|| course.stepper.next_output());
        let Course { state, motion, failure, .. } = &course;
        if failure.is_some() || !stages.advance(&state.u, &motion.reaction, gone) {
            break;
        }
    }
    let Course { steps, motion, state: State { pressure, .. }, stepper, failure, .. } = course;
    let Totals { counts, work, .. } = totals;
    Ok(TimePath { steps, motion, pressure, cut_back: stepper.cut_back, counts, work, failure })
}

/// Ratio of the next step to the last step for the given local error, which grows as the third power of the
/// step.
fn following(allowed: f64, error: f64) -> f64 {
    if error > 0.0 { 0.9 * (allowed / error).cbrt() } else { f64::INFINITY }
}

/// State of the motion.
struct Course {
    stepper: Stepper,
    /// Smallest part of a step for tools that travel too far.
    shortest: f64,
    state: State,
    /// State before the last step of the current stage.
    before: Option<State>,
    motion: Motion,
    /// Forces at the end of the last step.
    forces: Ended,
    energy: Energy,
    steps: Vec<TimeStep>,
    failure: Option<TimeError>,
}

impl Course {
    fn new(problem: &TimeProblem, params: &TimeParams) -> Course {
        let zeros = vec![Vector3::zeros(); problem.body.nodes.len()];
        Course {
            stepper: Stepper::new(params.end, params.steps, params.smallest, problem.body.stops()),
            // The peak speed of a smooth curve is less than twice its mean speed.
            shortest: shortest_travel(problem.body),
            state: State::start(problem.body),
            before: None,
            forces: Ended { external: zeros.clone(), internal: zeros.clone(), deviator: Vec::new() },
            motion: Motion {
                u: zeros.clone(),
                v: zeros.clone(),
                a: zeros.clone(),
                reaction: zeros,
                penalties: Vec::new(),
            },
            energy: Energy::default(),
            steps: Vec::new(),
            failure: None,
        }
    }
}

/// The time stepping in a stage.
struct March<'a, 'm> {
    problem: &'a TimeProblem<'a>,
    params: &'a TimeParams,
    scheme: Scheme,
    newton: Newton<'a>,
    memory: Option<&'a mut Memory<'m>>,
    course: &'a mut Course,
}

impl March<'_, '_> {
    /// Starts at time 0. A quasi-static body that is loaded at once is observed in that state as well.
    fn start(&mut self, observe: &mut impl FnMut(&TimeStep, &Motion, &[f64])) -> Result<(), TimeError> {
        if self.problem.inertia.is_some() {
            return self.start_moving();
        }
        // Dampers resist every sudden motion, so their body starts from rest.
        if self.problem.body.curves.act_at(0.0) && !self.has_dampers() {
            let done = self.step(Attempt { time: 0.0, length: 0.0, output: None })?;
            observe(&done, &self.course.motion, &self.course.state.pressure);
            self.course.steps.push(done);
        }
        Ok(())
    }

    /// Makes the steps until the time `until`, or until one fails for good.
    fn follow(&mut self, until: f64, observe: &mut impl FnMut(&TimeStep, &Motion, &[f64])) {
        self.course.before = None;
        while self.course.failure.is_none() && self.course.stepper.is_before(until) {
            let Some(attempt) = self.course.stepper.attempt() else { return };
            match self.step(attempt) {
                Ok(mut done) => {
                    let Course { stepper, motion, state, steps, .. } = &mut *self.course;
                    done.step.wanted = attempt.output.is_some();
                    let growth =
                        self.params.accuracy.map_or(2.0, |allowed| following(allowed, done.error).min(2.0));
                    stepper.accept(attempt, if done.step.is_quick() { growth } else { 1.0 });
                    observe(&done, motion, &state.pressure);
                    steps.push(done);
                }
                Err(cause) => {
                    let Course { stepper, shortest, failure, .. } = &mut *self.course;
                    let (part, finest) = match &cause {
                        TimeError::Inaccurate { error, allowed } => {
                            (following(*allowed, *error).clamp(0.2, 0.8), stepper.smallest)
                        }
                        TimeError::Static(cause) => (0.5, cause.finest(stepper.smallest, *shortest)),
                        _ => (0.5, stepper.smallest),
                    };
                    if !stepper.cut(attempt, part, finest) {
                        let (time, step) = (stepper.time, attempt.length);
                        *failure = Some(TimeError::Stalled { time, step, cause: Box::new(cause) });
                    }
                }
            }
        }
    }

    /// Computes forces and accelerations at time 0.
    fn start_moving(&mut self) -> Result<(), TimeError> {
        let inertia = self.problem.inertia.expect("asked for with inertia only");
        if !inertia.displacement.is_empty() {
            self.course.state.u.copy_from_slice(inertia.displacement);
        }
        if !inertia.velocity.is_empty() {
            self.course.motion.v.copy_from_slice(inertia.velocity);
        }
        let prescribed = self.newton.prescribed_at(0.0);
        for (i, u) in self.course.state.u.iter_mut().enumerate() {
            for axis in 0..3 {
                if let Some([value, speed, acceleration]) = prescribed(3 * i + axis) {
                    u[axis] = value;
                    self.course.motion.v[i][axis] = speed;
                    self.course.motion.a[i][axis] = acceleration;
                }
            }
        }
        drop(prescribed);
        let body = self.problem.body;
        for (k, (closure, driven)) in self.course.state.closures.iter_mut().zip(body.tools).enumerate() {
            if let Drive::Closure(full) = driven.drive {
                *closure = full * body.curves.tools.of(k).value(0.0);
            }
        }
        let strain = self.accelerate()?;
        if let Some(memory) = &mut self.memory {
            memory.advance(0.0, self.course.forces.deviator.clone());
        }
        self.course.motion.u.clone_from(&self.course.state.u);
        self.course.energy.kinetic = self.kinetic(&self.course.motion);
        self.course.energy.internal = strain;
        self.course.energy.start = self.course.energy.kinetic + strain;
        Ok(())
    }

    /// Computes the forces of the current supports in the present state, and with them the accelerations of free
    /// degrees of freedom and the reactions. Returns the strain energy, J.
    fn accelerate(&mut self) -> Result<f64, TimeError> {
        let inertia = self.problem.inertia.expect("asked for with inertia only");
        let Course { state, motion, .. } = &*self.course;
        let relaxing = self.memory.as_ref().map(|m| m.relaxing(0.0));
        let still = || Rate { factor: 0.0, from: state.u.clone(), still: motion.v.clone() };
        let rate = self.has_dampers().then(still);
        self.newton.set_terms(TimeTerms { inertia: None, relaxing, rate, damping: None });
        let (forces, strain) = self.newton.forces_at(state)?;
        let damping = inertia.mass.times(&motion.v);
        let force: Vec<Vector3> = (0..state.u.len())
            .map(|i| forces.external[i] - forces.internal[i] - damping[i] * inertia.damping)
            .collect();
        let prescribed = self.newton.prescribed();
        let constrained = |i: usize, axis: usize| prescribed[3 * i + axis].is_some();
        inertia.mass.accelerate(&force, constrained, &mut self.course.motion.a)?;
        self.course.motion.reaction = self.reaction(&forces, &self.course.motion);
        self.course.forces = forces;
        Ok(strain)
    }

    /// Takes a step; a failure leaves the state unchanged.
    fn step(&mut self, Attempt { time, length: dt, output }: Attempt) -> Result<TimeStep, TimeError> {
        let relaxing = self.memory.as_ref().map(|m| m.relaxing(dt));
        let inertia = self.problem.inertia.map(|i| self.inertia(time, self.scheme.over(dt), i.damping));
        let rate = self.has_dampers().then(|| self.rate(time, dt));
        let moving = rate.clone().filter(|_| self.problem.inertia.is_none());
        let damping = self.stiffness_damping(dt);
        self.newton.set_terms(TimeTerms { inertia, relaxing, rate, damping });
        let before = self.course.before.as_ref();
        let augmentations = self.params.augmentations;
        let mut to = |descent| self.newton.step(&self.course.state, before, time, augmentations, descent);
        let (state, step) = near(!self.course.state.pressure.is_empty(), &mut to)
            .or_else(|_| to(Descent::Down))
            .and_then(|reached| self.newton.checked(&self.course.state, reached))?;
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
            for (a, new) in self.course.motion.a.iter().zip(&motion.a) {
                error = error.max(update.error(a, new));
            }
        }
        if let Some(allowed) = self.params.accuracy.filter(|allowed| error > *allowed) {
            return Err(TimeError::Inaccurate { error, allowed });
        }
        let forces = self.newton.ended();
        motion.reaction = self.reaction(&forces, &motion);
        motion.penalties = self.newton.penalty_forces(&state);
        if let Some(beta) = self.beta() {
            self.damp(beta / dt, &forces, &mut motion);
        }
        self.balance_energy(&motion, &forces, &step);
        if let Some(memory) = &mut self.memory {
            memory.advance(dt, forces.deviator.clone());
        }
        self.course.before = Some(std::mem::replace(&mut self.course.state, state));
        (self.course.motion, self.course.forces) = (motion, forces);
        Ok(TimeStep { step, energy: self.course.energy, error })
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
        let Motion { u: from, v, a, .. } = &self.course.motion;
        let zeros = || vec![Vector3::zeros(); u.len()];
        if self.problem.inertia.is_none() {
            return Motion { u: u.to_vec(), v: zeros(), a: zeros(), ..Motion::default() };
        }
        let update = self.scheme.over(dt);
        let mut new_a: Vec<Vector3> =
            (0..u.len()).map(|i| update.acceleration(&(u[i] - from[i]), &v[i], &a[i])).collect();
        let mut new_v: Vec<Vector3> =
            (0..u.len()).map(|i| update.velocity(&v[i], &a[i], &new_a[i])).collect();
        self.prescribe(&mut new_v, time, 1);
        self.prescribe(&mut new_a, time, 2);
        Motion { u: u.to_vec(), v: new_v, a: new_a, ..Motion::default() }
    }

    /// Returns the inertia terms in the balance of the step to `time`.
    fn inertia(&self, time: f64, update: Update, damping: f64) -> InertiaTerms {
        let Motion { u, v, a, .. } = &self.course.motion;
        let dt = time - self.course.state.time;
        let still = self.motion_at(time, dt, u);
        let settled =
            (0..u.len()).map(|i| update.rate(damping, [&a[i], &still.a[i]], [&v[i], &still.v[i]])).collect();
        let weight = self.scheme.alpha_f / (1.0 - self.scheme.alpha_f);
        let carried = (self.course.forces.external.iter().zip(&self.course.forces.internal))
            .map(|(external, internal)| (external - internal) * weight)
            .collect();
        // The acceleration at the end of the last step makes the guess exact for a body in free fall.
        let guess = (0..u.len()).map(|i| u[i] + (v[i] + a[i] * (0.5 * dt)) * dt).collect();
        InertiaTerms { factor: update.factor(damping), from: u.clone(), settled, carried, guess }
    }

    /// Factor of the stiffness-proportional damping, s; `None` without.
    fn beta(&self) -> Option<f64> {
        self.problem.inertia.map(|inertia| inertia.stiffness_damping).filter(|beta| *beta > 0.0)
    }

    /// Returns the stiffness-proportional damping of a step of length `dt`. Its mean over the step belongs to
    /// the balance, which is divided by `1 - alpha_f`.
    fn stiffness_damping(&self, dt: f64) -> Option<StiffnessDamping> {
        let factor = self.beta()? / (dt * (1.0 - self.scheme.alpha_f));
        Some(StiffnessDamping { factor, from: self.course.forces.internal.clone() })
    }

    /// Adds the mean forces of stiffness-proportional damping over a step, `rate` (1) times the change of the
    /// internal forces, to the reactions, and their loss to the energies.
    fn damp(&mut self, rate: f64, forces: &Ended, motion: &mut Motion) {
        let prescribed = self.newton.prescribed();
        let Course { forces: before, motion: from, energy, .. } = &mut *self.course;
        for i in 0..motion.u.len() {
            let damping = (forces.internal[i] - before.internal[i]) * rate;
            energy.damped += damping.dot(&(motion.u[i] - from.u[i]));
            for axis in 0..3 {
                if prescribed[3 * i + axis].is_some() {
                    motion.reaction[i][axis] += damping[axis];
                }
            }
        }
    }

    fn has_dampers(&self) -> bool {
        self.problem.body.penalties.iter().any(|surface| surface.damping > 0.0)
    }

    /// Returns the velocities at the end of the step of length `dt` to `time`: those of the scheme, or backward
    /// differences without inertia. A step of no length, to a body that is loaded at once, has none.
    fn rate(&self, time: f64, dt: f64) -> Rate {
        let from = self.course.state.u.clone();
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
        let gain: Vec<Vector3> =
            motion.u.iter().zip(&self.course.motion.u).map(|(new, old)| new - old).collect();
        let work = |old: &[Vector3], new: &[Vector3]| -> f64 {
            gain.iter().zip(old.iter().zip(new)).map(|(gain, (old, new))| 0.5 * gain.dot(&(old + new))).sum()
        };
        self.course.energy.external += work(&self.course.forces.external, &forces.external)
            + work(&self.course.motion.reaction, &motion.reaction);
        if self.memory.is_some() {
            self.course.energy.internal += work(&self.course.forces.internal, &forces.internal);
        } else {
            self.course.energy.internal = step.energy;
        }
        self.course.energy.kinetic = self.kinetic(motion);
        if let Some(inertia) = self.problem.inertia.filter(|i| i.damping > 0.0) {
            let momentum = inertia.mass.times(&motion.v);
            let before = inertia.mass.times(&self.course.motion.v);
            self.course.energy.damped += inertia.damping * work(&before, &momentum);
        }
    }
}
