//! A load step: Newton's method with line search on the balance of internal, external and contact forces.

mod direction;
mod drive;
mod equations;
mod factors;
mod iterative;
mod levels;
mod modal;
mod modal_step;
mod policy;
mod predict;
mod rigid;
mod search;
mod state;
mod tangent;
#[cfg(test)]
mod tests;
mod tool_checks;
mod tools;
mod trace;

use algebra::SolverPath;
use contact::{ContactCounts, Drive, ToolState};
use shape::{Resultant, Vector3};

use self::direction::{Direction, Factored};
use self::equations::{Balance, Equations};
use self::factors::Factors;
use self::policy::{Policy, chord_suffices};
use crate::nonlinear::error::StaticError;
use crate::nonlinear::in_time::{Ended, TimeTerms};
use crate::nonlinear::problem::StaticProblem;
use crate::nonlinear::step::{StaticWork, Step};
use crate::nonlinear::system::SurfaceTable;

pub(crate) use self::policy::{Descent, near};
pub(crate) use self::state::State;
pub(crate) use self::tool_checks::shortest_travel;

pub use self::policy::{Iteration, NewtonParams};
pub use self::predict::{Nearby, Predicted, predict};
pub use self::trace::{Goal, Traced, trace, unbalanced};

/// Newton's method for a problem: its equations, the memory of the last tangents, and the rules of a step.
pub(crate) struct Newton<'a> {
    equations: Equations<'a>,
    factors: Factors,
    policy: Policy<'a>,
    /// Forces at the end of the last step of implicit dynamics.
    ended: Option<Ended>,
    /// Force of the nodal supports at the end of the last step, N.
    reaction: Vec<Vector3>,
    /// Norm of the forces at the end of the last step, N.
    reached: f64,
}

/// Sums and extremes over the stages of a solution.
#[derive(Clone, Copy, Default)]
pub(crate) struct Totals {
    /// Counters of the contact search.
    pub counts: ContactCounts,
    /// Counters of the solution, including failed steps and trials.
    pub work: StaticWork,
    /// Iterative solver of tangents, if it has found a step.
    pub solver: Option<SolverPath>,
    /// Largest forces so far, N.
    peak: f64,
    /// Largest forces at the end of a step so far, N.
    largest: f64,
}

impl<'a> Newton<'a> {
    pub fn new(problem: &'a StaticProblem<'a>, params: &'a NewtonParams) -> Result<Newton<'a>, StaticError> {
        Newton::with_mass(problem, params, None)
    }

    /// Prepares a problem with a mass table, for implicit dynamics with inertia.
    pub fn with_mass(
        problem: &'a StaticProblem<'a>,
        params: &'a NewtonParams,
        mass: Option<&SurfaceTable>,
    ) -> Result<Newton<'a>, StaticError> {
        for (what, value) in [("tolerance", params.tolerance), ("iterations", params.iterations as f64)] {
            if !(value > 0.0) {
                return Err(StaticError::Parameter { what, value, need: "it must be positive" });
            }
        }
        let saddle = problem.solid.pressure_count() > 0;
        Ok(Newton {
            equations: Equations::new(problem, mass)?,
            factors: Factors::new(),
            policy: Policy { params, descent: Descent::Nearest, repeats: false, saddle },
            ended: None,
            reaction: Vec::new(),
            reached: 0.0,
        })
    }

    /// Declares the following steps as frames of a simulator's loop.
    pub fn repeat(mut self) -> Newton<'a> {
        self.policy.repeats = true;
        self
    }

    /// Goes on from the method of an earlier stage, whose totals are `before`.
    pub fn continuing(mut self, before: &Totals) -> Newton<'a> {
        self.equations.counts = before.counts;
        self.equations.evaluations = before.work.forces;
        self.equations.peak = before.peak;
        self.equations.largest = before.largest;
        self.factors.work = before.work;
        self.factors.levels.path = before.solver;
        self
    }

    /// Returns what adds up over the whole solution.
    pub fn totals(&self) -> Totals {
        Totals {
            counts: self.equations.counts,
            work: StaticWork { forces: self.equations.evaluations, ..self.factors.work },
            solver: self.factors.levels.path,
            peak: self.equations.peak,
            largest: self.equations.largest,
        }
    }

    /// Sets the terms that the next step adds to the forces of statics.
    pub fn set_terms(&mut self, terms: TimeTerms) {
        self.equations.terms = Some(terms);
    }

    /// Returns the forces at the end of the last time step, which is thereby accepted.
    pub fn ended(&mut self) -> Ended {
        let ended = self.ended.take().expect("a step in real time has ended");
        self.equations.peak = self.equations.peak.max(ended.size());
        ended
    }

    /// Returns the reaction force (N) of the nodal supports on every node at the end of the last step: the
    /// force that statics leaves unbalanced there, zero in free degrees of freedom.
    pub fn reaction(&self) -> &[Vector3] {
        &self.reaction
    }

    /// Returns the force of each surface constrained by penalty on the body in a state, without damping.
    pub fn penalty_forces(&self, state: &State) -> Vec<Resultant> {
        let StaticProblem { penalties, curves, .. } = self.equations.problem;
        let part = |index: usize| curves.penalties.of(index).value(state.time);
        penalties.iter().enumerate().map(|(index, held)| held.resultant(&state.u, part(index))).collect()
    }

    /// Makes the forces at the end of the last step the smallest scale of all following residuals.
    pub fn keep_scale(&mut self) {
        self.equations.peak = self.equations.peak.max(self.reached);
    }

    /// Returns whether each degree of freedom is constrained: its full prescribed value.
    pub fn prescribed(&self) -> &[Option<f64>] {
        &self.equations.prescribed
    }

    /// Returns the prescribed value at `time` of each degree of freedom, with its first and second
    /// derivative.
    pub fn prescribed_at(&self, time: f64) -> impl Fn(usize) -> Option<[f64; 3]> {
        self.equations.prescribed_at(time)
    }

    /// Returns the forces in a state, without inertia, and the strain energy, J.
    pub fn forces_at(&mut self, state: &State) -> Result<(Ended, f64), StaticError> {
        let balance = self.equations.balance(state, state.time)?;
        Ok((balance.ended.expect("terms of real time are set"), balance.internal.energy))
    }

    /// Finds the equilibrium at `time` from `start`; `before` is the state before `start`, for extrapolation.
    pub fn step(
        &mut self,
        start: &State,
        before: Option<&State>,
        time: f64,
        augmentations: usize,
        descent: Descent,
    ) -> Result<(State, Step), StaticError> {
        self.policy.descent = descent;
        let mut state = State { time, ..start.clone() };
        let mut moved = false;
        if let Some(inertia) = self.equations.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
            state.u.clone_from(&inertia.guess);
            self.equations.prescribe(&mut state.u, time);
            moved = true;
        } else if let Some(before) = before {
            moved = self.extrapolate(&mut state, start, before, time);
        }
        for (k, (closure, driven)) in state.closures.iter_mut().zip(self.equations.problem.tools).enumerate()
        {
            if let Drive::Closure(full) = driven.drive {
                *closure = full * self.equations.part(k, time);
            }
        }
        let mut iterations = Vec::new();
        let mut balance = match self.equations.balance(&state, time) {
            Ok(balance) => balance,
            // The guess is invalid; the last converged state is always valid.
            Err(_) if moved => {
                state.u.clone_from(&start.u);
                state.pressure.clone_from(&start.pressure);
                self.equations.balance(&state, time)?
            }
            Err(error) => return Err(error),
        };
        for round in 0..=augmentations {
            balance = self.equilibrate(&mut state, balance, time, &mut iterations)?;
            if round < augmentations {
                for (history, contacts) in state.history.iter_mut().zip(&balance.contacts) {
                    history.augment(contacts.as_ref());
                }
                balance = self.equations.balance(&state, time)?;
            }
        }
        if let Some(surface) = self.equations.problem.contact {
            for (k, (history, contacts)) in state.history.iter_mut().zip(&balance.contacts).enumerate() {
                let tool = self.equations.problem.tools[k].tool;
                let closure = state.closures[k];
                let side = contacts.iter().try_for_each(|c| surface.check_side(c, &state.u));
                side.map_err(|cause| StaticError::Contact { tool: k, cause })?;
                history.commit_all(contacts.as_ref(), surface, tool, closure, &state.u);
            }
        }
        self.reached = balance.scale;
        self.equations.largest = self.equations.largest.max(balance.scale);
        self.reaction = self.equations.held_back(&balance.out);
        self.ended = balance.ended;
        let tools = (balance.contacts.iter().zip(&state.closures))
            .map(|(contacts, &closure)| ToolState::new(closure, contacts.as_ref()))
            .collect();
        let step = Step {
            time,
            wanted: false,
            gave_way: descent == Descent::Down && iterations.iter().any(|i| !i.definite && i.length > 1.0),
            // The tangent of the last iteration belongs to the state one Newton step before the end.
            stable: iterations.iter().rev().find(|i| i.length > 0.0).is_none_or(|i| i.definite),
            iterations,
            tools,
            energy: balance.internal.energy,
            smallest: balance.internal.smallest.1,
        };
        Ok((state, step))
    }

    /// Extrapolates the displacement of the last step, or reverses it if the load reverses. Prescribed values
    /// are set to those at `time`.
    fn extrapolate(&self, state: &mut State, start: &State, before: &State, time: f64) -> bool {
        let ratio = (time - start.time) / (start.time - before.time);
        if !ratio.is_finite() || before.time == 0.0 && !self.equations.problem.tools.is_empty() {
            return false;
        }
        for ((u, a), b) in state.u.iter_mut().zip(&start.u).zip(&before.u) {
            *u += (a - b) * ratio;
        }
        self.equations.prescribe(&mut state.u, time);
        for ((p, a), b) in state.pressure.iter_mut().zip(&start.pressure).zip(&before.pressure) {
            *p += (a - b) * ratio;
        }
        for ((c, a), b) in state.closures.iter_mut().zip(&start.closures).zip(&before.closures) {
            *c += (a - b) * ratio;
        }
        true
    }

    /// Runs Newton's iterations at fixed multipliers.
    fn equilibrate(
        &mut self,
        state: &mut State,
        mut balance: Balance,
        time: f64,
        log: &mut Vec<Iteration>,
    ) -> Result<Balance, StaticError> {
        let first = log.len();
        let tolerance = self.policy.params.tolerance;
        let mut first_energy = 0.0f64;
        let mut best = (0, f64::INFINITY);
        let mut last = self.factors.kept.take().filter(|_| self.policy.descent == Descent::Nearest);
        loop {
            let moves = self.equations.prescribed_move(state, time);
            let residual = self.equations.residual(&balance, &state.u, time, tolerance);
            if moves.is_none() && residual <= tolerance {
                self.settle(last, state, &balance, &mut log[first..])?;
                log.push(Iteration { residual, energy: 0.0, length: 0.0, definite: true, chord: false });
                return Ok(balance);
            }
            let done = log.len() - first;
            // Before constrained degrees of freedom have moved, the forces are those of the last state, hence
            // small.
            if moves.is_some() || residual < 0.9 * best.1 {
                best = (done, if moves.is_some() { f64::INFINITY } else { residual });
            }
            if self.policy.gives_up(&log[first..], best.0) || !residual.is_finite() {
                return Err(self.equations.not_converged(&balance, residual, tolerance, done));
            }
            let chord = self.policy.params.chords
                && last.is_some()
                && moves.is_none()
                && chord_suffices(&log[first..], residual, tolerance);
            self.factors.indefinite = false;
            self.factors.forcing = self.policy.forcing(residual, chord, self.loosest());
            let direction = match last.take().filter(|_| chord) {
                Some(last) => self.again(last, state, &balance, time)?,
                None => self.direction(state, &balance, time, moves.as_deref())?,
            };
            let slope = self.equations.work_along(&direction, &balance, time);
            if first_energy == 0.0 {
                first_energy = slope.abs();
            }
            let (next, length) = self.search(state, &direction, moves.is_some(), slope, &balance, time)?;
            let energy = if first_energy > 0.0 { slope.abs() / first_energy } else { 0.0 };
            log.push(Iteration { residual, energy, length, definite: direction.definite, chord });
            (balance, last) = (next, Some(direction));
        }
    }

    /// Ends a search for an equilibrium whose iterations are `log`: tests whether its last tangent was
    /// definite, if that is open, and keeps this tangent for the next frame of a loop. A frame has no time
    /// for the test: its tangent counts as definite if the last factor was.
    fn settle(
        &mut self,
        mut last: Option<Direction>,
        state: &State,
        balance: &Balance,
        log: &mut [Iteration],
    ) -> Result<(), StaticError> {
        self.factors.levels.settle();
        let repeats = self.policy.repeats;
        if let Some(unproven) = last.as_mut().filter(|last| !last.proven && !repeats) {
            self.prove(unproven, state, balance)?;
            // The proven tangent belongs to the last iteration that was not a chord and to all chords after
            // it.
            let own = log.iter().rposition(|i| !i.chord).unwrap_or(0);
            log[own..].iter_mut().for_each(|i| i.definite = unproven.definite);
        }
        self.factors.kept = last.filter(|last| repeats && last.definite);
        Ok(())
    }

    /// Tests whether the tangent of a direction is definite. If iterations do not prove this of their
    /// tangent, the tangent at the equilibrium is factored.
    fn prove(&mut self, last: &mut Direction, state: &State, balance: &Balance) -> Result<(), StaticError> {
        let Newton { equations, factors, .. } = self;
        last.definite = match &last.factored {
            Factored::Symmetric(_) | Factored::Modal(_) => return Ok(()),
            Factored::Unsymmetric(near) => factors.prove(near.matrix())?,
            Factored::Iterated(_) => match factors.levels.prove_definite(&equations.system) {
                Some(iterations) => {
                    factors.work.inner += iterations as u64;
                    true
                }
                None => {
                    let (matrix, ..) = equations.linearise(state, balance, None)?;
                    factors.work.assemblies += 1;
                    factors.prove(&matrix)?
                }
            },
        };
        last.proven = true;
        Ok(())
    }
}
