//! Prediction of an equilibrium from a state nearby, which another method has found.

use contact::{ContactHistory, ToolState};
use shape::{Resultant, Vector3};

use super::equations::Equations;
use super::policy::near;
use super::{Newton, NewtonParams, State};
use crate::nonlinear::error::StaticError;
use crate::nonlinear::problem::StaticProblem;
use crate::nonlinear::step::Step;

/// A state near an equilibrium.
#[derive(Clone, Copy, Debug)]
pub struct Nearby<'a> {
    /// Fraction of the loading.
    pub time: f64,
    /// Nodal parameters, m.
    pub u: &'a [Vector3],
    /// Parameters of the pressure field, Pa, tension positive; empty without such a field.
    pub pressure: &'a [f64],
    /// Displacement of each tool, m.
    pub closures: &'a [f64],
    /// Contact history of each tool.
    pub history: &'a [ContactHistory],
}

/// Equilibrium near a state; that of the linearised problem, in which the same points touch the tools, if
/// none was found.
#[derive(Clone, Debug)]
pub struct Predicted {
    /// Nodal parameters, m.
    pub u: Vec<Vector3>,
    /// Reaction force of the nodal supports on every node, N.
    pub reaction: Vec<Vector3>,
    /// Force of each surface constrained by penalty.
    pub penalties: Vec<Resultant>,
    /// States of the tools.
    pub tools: Vec<ToolState>,
    /// Strain energy, J.
    pub energy: f64,
    /// Whether no equilibrium was found, and the linearised problem is the answer.
    pub linear: bool,
}

/// Length of the step, as a part of the whole, over which forces and energies are differentiated.
const PART: f64 = 1e-3;
/// Smallest part of the unbalanced forces that is taken off at once.
const SHORTEST: f64 = 0.3;

/// Predicts the equilibrium near a state. Supports that act during a part of the loading are taken as acting.
///
/// # Errors
/// Errors of the problem, and of its tangent or its forces in the state.
pub fn predict(
    problem: &StaticProblem,
    params: &NewtonParams,
    from: Nearby,
) -> Result<Predicted, StaticError> {
    Newton::new(problem, params)?.predict(State::near(&from))
}

impl State {
    pub(super) fn near(from: &Nearby) -> State {
        let Nearby { time, u, pressure, closures, history } = *from;
        State {
            time,
            u: u.to_vec(),
            closures: closures.to_vec(),
            history: history.to_vec(),
            pressure: pressure.to_vec(),
        }
    }
}

impl Newton<'_> {
    /// Takes the unbalanced forces of a state off, in several parts if it can't be done at once.
    fn predict(&mut self, start: State) -> Result<Predicted, StaticError> {
        let unbalanced = self.equations.balance(&start, start.time)?.out;
        let saddle = self.policy.saddle;
        let (mut left, mut length) = (1.0, 1.0f64);
        let mut state = start.clone();
        loop {
            let next = left - length.min(left);
            self.equations.load_also(unbalanced.iter().map(|force| -next * force).collect());
            let reached = near(saddle, &mut |descent| self.step(&state, None, start.time, 0, descent));
            match reached {
                Ok((reached, step)) if next == 0.0 => return Ok(self.found(reached, step)),
                Ok((reached, _)) => {
                    state = State { history: start.history.clone(), ..reached };
                    (left, length) = (next, 2.0 * length);
                }
                Err(_) if length > SHORTEST => length *= 0.5,
                Err(_) => return self.linearised(&start),
            }
        }
    }

    fn found(&self, state: State, step: Step) -> Predicted {
        let Step { tools, energy, .. } = step;
        let penalties = self.penalty_forces(&state);
        let reaction = self.reaction.clone();
        Predicted { u: state.u, reaction, penalties, tools, energy, linear: false }
    }

    /// Linearises the problem in a state.
    fn linearised(&mut self, state: &State) -> Result<Predicted, StaticError> {
        self.equations.load_also(Vec::new());
        let time = state.time;
        let moves = self.equations.prescribed_move(state, time);
        let balance = self.equations.balance(state, time)?;
        let direction = self.direction(state, &balance, time, moves.as_deref())?;
        let along = |equations: &Equations, length: f64| {
            let mut to = state.clone();
            if let Some(moves) = &moves {
                to.u.iter_mut().zip(moves).for_each(|(u, by)| *u += by * length);
            }
            equations.system.scatter_add(&direction.step, length, &mut to.u, &mut to.pressure);
            to.closures.iter_mut().zip(&direction.closures).for_each(|(c, d)| *c += length * d);
            to
        };
        let ahead = along(&self.equations, PART);
        let ahead = self.equations.balance(&ahead, time)?;
        let behind = along(&self.equations, -PART);
        let behind = self.equations.balance(&behind, time)?;
        let out: Vec<Vector3> = (balance.out.iter().zip(&ahead.out).zip(&behind.out))
            .map(|((now, ahead), behind)| now + (ahead - behind) / (2.0 * PART))
            .collect();
        let [before, now, after] = [&behind, &balance, &ahead].map(|balance| balance.internal.energy);
        let energy =
            now + (after - before) / (2.0 * PART) + 0.5 * (after - 2.0 * now + before) / (PART * PART);
        let end = along(&self.equations, 1.0);
        let [behind, now, ahead] = [&behind, &balance, &ahead].map(|balance| &balance.contacts);
        let tools = (0..now.len())
            .map(|k| {
                let closure = end.closures[k];
                let [behind, now, ahead] =
                    [behind, now, ahead].map(|contacts| ToolState::new(closure, contacts[k].as_ref()));
                let force = now.force + (ahead.force - behind.force) / (2.0 * PART);
                let moment = now.moment + (ahead.moment - behind.moment) / (2.0 * PART);
                ToolState { force, moment, ..now }
            })
            .collect();
        let penalties = self.penalty_forces(&end);
        Ok(Predicted {
            reaction: self.equations.held_back(&out),
            u: end.u,
            penalties,
            tools,
            energy,
            linear: true,
        })
    }
}
