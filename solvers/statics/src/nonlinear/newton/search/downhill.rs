//! Longer steps past a limit point, at which the body gives way and the energy falls beyond the Newton step.

use super::line::Line;
use super::secant::Secant;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::newton::equations::Balance;

/// Largest multiple of a step.
const FARTHEST: f64 = 64.0;

impl Line<'_, '_> {
    /// Doubles the step while more than half of the work is left. A step that is too long from the start is
    /// cut by the secant until work is left.
    pub(super) fn downhill(mut self) -> Result<(Balance, f64), StaticError> {
        let mut length = 1.0;
        let mut trial = self.valid(&mut length)?;
        if !(trial.work > 0.0) {
            return self.secant(trial, length, Secant { repeats: false, enough: 0.0 });
        }
        while trial.work > 0.5 * self.slope && (1.0..FARTHEST).contains(&length) {
            let shorter = self.state.clone();
            match self.at(2.0 * length) {
                Ok(longer) if longer.work > 0.0 => (trial, length) = (longer, 2.0 * length),
                _ => {
                    *self.state = shorter;
                    break;
                }
            }
        }
        Ok((trial.balance, length))
    }
}
