//! Line search: how far a state moves along a step. The strategy is chosen before the first trial.

mod downhill;
mod monotone;
mod secant;

use shape::Vector3;

use self::secant::Secant;
use super::equations::{Balance, Equations};
use super::tangent::Direction;
use super::{Descent, Newton, State, work};
use crate::nonlinear::StaticError;

/// Number of trials, counted from 0, that a step is halved because it inverts a point.
const HALVED: usize = 10;
/// Number of trials, counted from 0, after which a valid state is accepted as it is.
const REFINED: usize = 6;

/// Choice of the length of a step.
enum Strategy {
    /// The whole step. It serves while constrained degrees of freedom move, while a force-driven tool
    /// approaches the body (no force limits the step), and with a pressure field, along whose steps no energy
    /// falls.
    Whole,
    /// A step with a pressure field is cut until the rest of the step becomes shorter.
    Monotone,
    /// A step past a limit point, along which the work of the residual grows, is lengthened.
    Downhill,
    /// A step is cut at the secant's zero of the work of the residual.
    Secant,
}

/// A step from a state, along which trial states are evaluated.
struct Line<'s, 'a> {
    equations: &'s mut Equations<'a>,
    direction: &'s Direction,
    state: &'s mut State,
    /// Displacements, pressures and closures at the start.
    start: (Vec<Vector3>, Vec<f64>, Vec<f64>),
    time: f64,
    /// Whether constrained degrees of freedom move in this step.
    moves: bool,
    /// Work of the residual along the step at the start, J.
    slope: f64,
    /// Norm of the residual at the start, N.
    before: f64,
    /// Number of evaluated trials.
    trials: usize,
}

/// A valid state on the line.
struct Trial {
    balance: Balance,
    /// Residual of the unknowns.
    unknowns: Vec<f64>,
    /// Work of the residual along the step, J.
    work: f64,
    /// Whether the residual is smaller than at the start, by a tenth of the trial's length.
    smaller: bool,
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|v| v * v).sum::<f64>().sqrt()
}

impl Newton<'_> {
    /// Takes the step or a part of it. Returns the balance there, and the length as a multiple of the step. A
    /// step that inverts a point is halved, whatever the strategy.
    pub(super) fn search(
        &mut self,
        state: &mut State,
        direction: &Direction,
        moves: bool,
        slope: f64,
        last: &Balance,
        time: f64,
    ) -> Result<(Balance, f64), StaticError> {
        let strategy = self.strategy(moves, slope, last, time);
        let equations = &mut self.equations;
        let residual = equations.system.gather(&last.out, &last.pressure);
        let before = equations.size(&residual).hypot(norm(&equations.lacking(last, time)));
        let start = (state.u.clone(), state.pressure.clone(), state.closures.clone());
        let mut line = Line { equations, direction, state, start, time, moves, slope, before, trials: 0 };
        match strategy {
            Strategy::Whole => {
                let mut length = 1.0;
                let trial = line.valid(&mut length)?;
                Ok((trial.balance, length))
            }
            Strategy::Monotone => line.monotone(&mut self.factors),
            Strategy::Downhill => line.downhill(),
            Strategy::Secant => {
                let mut length = 1.0;
                let trial = line.valid(&mut length)?;
                line.secant(trial, length, Secant { repeats: self.policy.repeats, enough: f64::INFINITY })
            }
        }
    }

    fn strategy(&self, moves: bool, slope: f64, last: &Balance, time: f64) -> Strategy {
        let forced = |tool: usize| self.equations.force(tool, time).is_some();
        let (saddle, descent) = (self.policy.saddle, self.policy.descent);
        let approaches = (last.contacts.iter().enumerate())
            .any(|(k, contacts)| forced(k) && contacts.as_ref().is_none_or(|c| c.points().is_empty()));
        // The displacements of force-driven tools are not part of a factor; with such tools the whole step of
        // the saddle point is taken.
        let natural = descent == Descent::Guarded && !(0..last.contacts.len()).any(forced);
        // A tangent that was made definite gives a descent step without a natural length.
        let lifted = descent == Descent::Down && self.factors.indefinite && slope > 0.0;
        match (moves, saddle) {
            (true, _) => Strategy::Whole,
            (false, true) if natural => Strategy::Monotone,
            (false, true) => Strategy::Whole,
            (false, false) if approaches => Strategy::Whole,
            (false, false) if lifted => Strategy::Downhill,
            (false, false) => Strategy::Secant,
        }
    }
}

impl Equations<'_> {
    /// Returns the norm of a residual, N. Volume residuals are scaled by the factor of the solved matrix,
    /// which turns them into forces.
    fn size(&self, residual: &[f64]) -> f64 {
        let (forces, volumes) = residual.split_at(self.system.free);
        norm(forces).hypot(self.system.pressure_scale * norm(volumes))
    }
}

impl Line<'_, '_> {
    /// Moves the state to `length` times the step and evaluates the forces there.
    fn at(&mut self, length: f64) -> Result<Trial, StaticError> {
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
    fn valid(&mut self, length: &mut f64) -> Result<Trial, StaticError> {
        loop {
            match self.at(*length) {
                Err(error) if self.trials > HALVED || self.moves => return Err(error),
                Err(_) => *length *= 0.5,
                valid => return valid,
            }
        }
    }
}
