//! Line search: how far a state moves along a step. The strategy is chosen before the first trial.

mod downhill;
mod line;
mod monotone;
mod secant;

use self::line::{Line, norm};
use self::secant::Secant;
use super::Newton;
use super::direction::Direction;
use super::equations::Balance;
use super::policy::Descent;
use super::state::State;
use crate::nonlinear::error::StaticError;

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
