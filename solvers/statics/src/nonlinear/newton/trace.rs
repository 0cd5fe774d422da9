//! The error of a number, traced to the unbalanced forces that cause it.
//!
//! In a state u with the unbalanced forces r and the tangent K, the number J is off by `q . K^-1 r` with
//! `q = dJ/du`, which is `z . r` with the influence z of forces on the number: `K^T z = q` (Becker and
//! Rannacher, Acta Numerica 10 (2001) 1-102).

use shape::Vector3;

use super::equations::{Balance, Equations};
use super::policy::NewtonParams;
use super::predict::Nearby;
use super::{Newton, State};
use crate::nonlinear::error::StaticError;
use crate::nonlinear::problem::StaticProblem;

/// A number of a solution.
#[derive(Clone, Copy, Debug)]
pub enum Goal<'a> {
    /// Sum of the nodal parameters times these weights, m.
    Displacement(&'a [Vector3]),
    /// Force of a tool driven by displacement along its travel, N.
    Tool(usize),
    /// Sum of the forces of nodal supports times these weights of the constrained parameters, N.
    Supports(&'a [Vector3]),
}

/// Unbalanced forces and their influence.
#[derive(Clone, Debug)]
pub struct Traced {
    /// Unbalanced force on each node, N; zero along constrained parameters.
    pub unbalanced: Vec<Vector3>,
    /// Influence of a force on each node, in the number's unit per N; the motion of the constrained
    /// parameters that the number is the force of.
    pub influence: Vec<Vector3>,
    /// The number at the equilibrium of the linearised problem, m or N. Unlike the other two, it takes a
    /// pressure field's unbalanced volumes into account.
    pub predicted: f64,
}

/// Traces the error of a number in a state near an equilibrium to the unbalanced forces in it.
///
/// # Errors
/// Errors of the problem, and of its tangent or its forces in the state.
pub fn trace(
    problem: &StaticProblem,
    params: &NewtonParams,
    from: Nearby,
    goal: Goal,
) -> Result<Traced, StaticError> {
    let (mut newton, state) = at(problem, params, from)?;
    newton.trace(&state, goal)
}

/// Unbalanced force on each node in a state, N; zero along constrained parameters.
///
/// # Errors
/// Errors of the problem and of its forces in the state.
pub fn unbalanced(
    problem: &StaticProblem,
    params: &NewtonParams,
    from: Nearby,
) -> Result<Vec<Vector3>, StaticError> {
    let (mut newton, state) = at(problem, params, from)?;
    let balance = newton.equations.balance(&state, state.time)?;
    Ok(newton.equations.on_free(&balance.out))
}

/// Newton's method in a state with the prescribed values.
fn at<'a>(
    problem: &'a StaticProblem<'a>,
    params: &'a NewtonParams,
    from: Nearby,
) -> Result<(Newton<'a>, State), StaticError> {
    let newton = Newton::new(problem, params)?;
    let mut state = State::near(&from);
    newton.equations.prescribe(&mut state.u, state.time);
    Ok((newton, state))
}

impl Equations<'_> {
    /// Forces on free degrees of freedom, N, with zeros along the others.
    fn on_free(&self, forces: &[Vector3]) -> Vec<Vector3> {
        let free = |(i, force): (usize, &Vector3)| {
            Vector3::from_fn(|a, _| if self.prescribed[3 * i + a].is_some() { 0.0 } else { force[a] })
        };
        forces.iter().enumerate().map(free).collect()
    }
}

impl Newton<'_> {
    fn trace(&mut self, state: &State, goal: Goal) -> Result<Traced, StaticError> {
        let balance = self.equations.balance(state, state.time)?;
        let unbalanced = self.equations.on_free(&balance.out);
        let none = vec![Vector3::zeros(); unbalanced.len()];
        // A force of supports grows with the forces that the body would need to follow their motion.
        let (right, moves, now) = match goal {
            Goal::Displacement(weights) => (weights.to_vec(), None, sum(weights, &state.u)),
            Goal::Tool(tool) => {
                let pushed = balance.contacts[tool].as_ref().map_or(0.0, |contacts| {
                    -contacts.force().dot(&self.equations.problem.tools[tool].tool.along())
                });
                (self.equations.by_displacement(&balance, tool), None, pushed)
            }
            Goal::Supports(weights) => (none.clone(), Some(weights), -sum(weights, &balance.out)),
        };
        let sign = if moves.is_some() { -1.0 } else { 1.0 };
        let volumes = vec![0.0; balance.pressure.len()];
        self.equations.system.transposed = true;
        let (mut influence, mut of_volumes) = (moves.map_or(none, <[Vector3]>::to_vec), volumes.clone());
        let unbalanced_volumes = balance.pressure.clone();
        let right = Balance { out: right, pressure: volumes, ..balance };
        let direction = self.direction(state, &right, state.time, moves)?;
        self.equations.system.scatter_add(&direction.step, 1.0, &mut influence, &mut of_volumes);
        influence.iter_mut().for_each(|by| *by *= sign);
        let volumes: f64 = of_volumes.iter().zip(&unbalanced_volumes).map(|(z, r)| sign * z * r).sum();
        let predicted = now + sum(&influence, &unbalanced) + volumes;
        Ok(Traced { unbalanced, influence, predicted })
    }
}

/// Returns `sum of a . b`.
fn sum(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
