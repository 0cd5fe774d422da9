//! Trial states along a step.

use shape::Vector3;

use crate::nonlinear::error::StaticError;
use crate::nonlinear::newton::direction::Direction;
use crate::nonlinear::newton::equations::{Balance, Equations, work};
use crate::nonlinear::newton::state::State;

/// Number of trials, counted from 0, that a step is halved because it inverts a point.
const HALVED: usize = 10;
/// Number of trials, counted from 0, after which a valid state is accepted as it is.
pub(super) const REFINED: usize = 6;

/// A step from a state, along which trial states are evaluated.
pub(super) struct Line<'s, 'a> {
    pub(super) equations: &'s mut Equations<'a>,
    pub(super) direction: &'s Direction,
    pub(super) state: &'s mut State,
    /// Displacements, pressures and closures at the start.
    pub(super) start: (Vec<Vector3>, Vec<f64>, Vec<f64>),
    pub(super) time: f64,
    /// Whether constrained degrees of freedom move in this step.
    pub(super) moves: bool,
    /// Work of the residual along the step at the start, J.
    pub(super) slope: f64,
    /// Norm of the residual at the start, N.
    pub(super) before: f64,
    /// Number of evaluated trials.
    pub(super) trials: usize,
}

/// A valid state on the line.
pub(super) struct Trial {
    pub(super) balance: Balance,
    /// Residual of the unknowns.
    pub(super) unknowns: Vec<f64>,
    /// Work of the residual along the step, J.
    pub(super) work: f64,
    /// Whether the residual is smaller than at the start, by a tenth of the trial's length.
    pub(super) smaller: bool,
}

pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}

impl Equations<'_> {
    /// Returns the norm of a residual, N. Volume residuals are scaled by the factor of the solved matrix,
    /// which turns them into forces.
    pub(super) fn size(&self, residual: &[f64]) -> f64 {
        let (forces, volumes) = residual.split_at(self.system.free);
        norm(forces).hypot(self.system.pressure_scale * norm(volumes))
    }
}

impl Line<'_, '_> {
    /// Moves the state to `length` times the step and evaluates the forces there.
    pub(super) fn at(&mut self, length: f64) -> Result<Trial, StaticError> {
        let Line { equations, direction, state, start, time, .. } = self;
        self.trials += 1;
        state.u.clone_from(&start.0);
        state.pressure.clone_from(&start.1);
        state.closures.clone_from(&start.2);
        // Constrained degrees of freedom take the whole step, whatever fraction of the step the free degrees
        // of freedom take.
        equations.prescribe(&mut state.u, *time);
        equations.system.scatter_add(&direction.step, length, &mut state.u, &mut state.pressure);
        state.closures.iter_mut().zip(&direction.closures).for_each(|(c, d)| *c += length * d);
        let balance = equations.balance(state, *time)?;
        let unknowns = equations.system.gather(&balance.out, &balance.pressure);
        let lacking = equations.lacking(&balance, *time);
        let work = work(&direction.step, &unknowns) + work(&direction.closures, &lacking);
        let size = equations.size(&unknowns).hypot(norm(&lacking));
        let smaller = size <= (1.0 - 0.1 * length) * self.before;
        Ok(Trial { balance, unknowns, work, smaller })
    }

    /// Evaluates the forces at `length` times the step, which is halved until no point is inverted.
    pub(super) fn valid(&mut self, length: &mut f64) -> Result<Trial, StaticError> {
        loop {
            match self.at(*length) {
                Err(error) if self.trials > HALVED || self.moves => return Err(error),
                Err(_) => *length *= 0.5,
                valid => return valid,
            }
        }
    }
}
