#![allow(non_snake_case)] // M as in the formulas
//! The step of an iteration whose unknowns are the coefficients of a few modes.

use algebra::Border;
use nalgebra::DMatrix;
use shape::Vector3;

use super::Newton;
use super::direction::{Direction, Factored};
use super::equations::Balance;
use super::modal::{Modal, is_definite};
use super::policy::Descent;
use super::state::State;
use crate::error::SolveError;
use crate::nonlinear::basis::Basis;
use crate::nonlinear::error::StaticError;

/// Relative shifts of the diagonal that are tried during descent.
const SHIFTS: [f64; 6] = [1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0];

impl Newton<'_> {
    /// Computes the step of the modes' coefficients, and the displacements of the tools driven by force.
    pub(super) fn modal(
        &mut self,
        basis: &Basis,
        state: &State,
        balance: &Balance,
        time: f64,
        prescribed_move: Option<&[Vector3]>,
    ) -> Result<Direction, StaticError> {
        let equations = &mut self.equations;
        let hessian = equations.hessian(state)?;
        let surface = equations.surface_stiffness(state, balance);
        equations.system.assemble(&hessian, &surface);
        self.factors.work.assemblies += 1;
        let mut M = basis.tangent(&equations.system.stiffness);
        let skew = equations.system.skew(&surface);
        if !skew.is_empty() {
            basis.add_to_tangent(&mut M, |u, out| equations.system.add_skew(&skew, u, out));
        }
        let right = equations.right(balance, prescribed_move);
        let right = equations.system.gather(&right, &balance.pressure);
        let definite = is_definite(&M);
        self.factors.indefinite |= !definite;
        let descent = self.policy.descent;
        if descent == Descent::Smooth && !definite {
            return Err(SolveError::NotPositiveDefinite.into());
        }
        if descent == Descent::Down && !definite {
            let diagonal = M.diagonal().abs();
            let shifted = |shift: f64| &M + DMatrix::from_diagonal(&(&diagonal * shift));
            let lifted = SHIFTS.into_iter().map(shifted).find(is_definite);
            M = lifted.ok_or(SolveError::NotPositiveDefinite)?;
        }
        let (tools, borders): (Vec<usize>, Vec<Border>) = equations.borders(balance).into_iter().unzip();
        self.factors.work.factorisations += 1;
        let factored = Factored::Modal(Modal::new(M, &borders));
        let last =
            Direction { step: Vec::new(), closures: Vec::new(), definite, proven: true, factored, tools };
        self.take(last, right, state, balance, time)
    }
}
