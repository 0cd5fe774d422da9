//! The natural monotonicity test (Deuflhard 2004, ch. 3.3): the same factor applied to the new residual gives
//! the rest of the step, which must be shorter than the step.
//!
//! No energy falls along a step of the pressure's saddle point. The test is independent of the scales of
//! force and volume.

use super::line::{Line, REFINED, norm};
use crate::nonlinear::error::StaticError;
use crate::nonlinear::newton::equations::Balance;
use crate::nonlinear::newton::factors::Factors;

impl Line<'_, '_> {
    pub(super) fn monotone(mut self, factors: &mut Factors) -> Result<(Balance, f64), StaticError> {
        let mut length = 1.0;
        loop {
            let trial = self.valid(&mut length)?;
            if trial.smaller || self.trials > REFINED {
                return Ok((trial.balance, length));
            }
            let mut rest = trial.unknowns;
            factors.solve(&self.direction.factored, &self.equations.system, &mut rest)?;
            let whole = self.length_of(&self.direction.step);
            if self.length_of(&rest) <= (1.0 - 0.25 * length) * whole {
                return Ok((trial.balance, length));
            }
            let steps = rest.iter().zip(&self.direction.step);
            let bend: Vec<f64> = steps.map(|(rest, step)| rest - (1.0 - length) * step).collect();
            let best = 0.5 * length.powi(2) * whole / self.length_of(&bend);
            length = if best.is_finite() { best.clamp(0.1 * length, 0.5 * length) } else { 0.5 * length };
        }
    }

    /// Returns the length of a step, which consists of displacements, and of pressures divided by their
    /// scale.
    fn length_of(&self, step: &[f64]) -> f64 {
        let (displacements, pressures) = step.split_at(self.equations.system.free);
        norm(displacements).hypot(norm(pressures) / self.equations.system.pressure_scale)
    }
}
