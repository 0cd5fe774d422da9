//! Steps that are cut at the zero of the work of the residual, found by the secant.

use super::line::{Line, REFINED, Trial};
use crate::nonlinear::error::StaticError;
use crate::nonlinear::newton::equations::Balance;

/// Conditions under which the secant accepts a step.
pub(super) struct Secant {
    /// Whether the step belongs to a simulator's loop. A cut step is then accepted when less than half of the
    /// work is left (Matthies & Strang 1979). With more work left, the points that the whole step met are not
    /// in contact. The next tangent then lacks their stiffness, and the next step is cut again.
    pub repeats: bool,
    /// Work of the residual along the step above which the step is accepted, J; infinity for no such limit.
    pub enough: f64,
}

impl Line<'_, '_> {
    /// Cuts a step, whose first valid trial has been evaluated, until the residual or its work is smaller.
    pub(super) fn secant(
        mut self,
        mut trial: Trial,
        mut length: f64,
        accepts: Secant,
    ) -> Result<(Balance, f64), StaticError> {
        let slope = self.slope;
        // Work left at the longest step that is too short, and at the shortest step that is too long.
        let (mut low, mut high) = ((0.0, slope), (1.0, slope));
        loop {
            let now = trial.work;
            let last = self.trials > REFINED;
            let short = accepts.repeats && high.1 < 0.0 && now > 0.5 * slope && !last;
            let less = trial.smaller || now.abs() <= (1.0 - 0.2 * length) * slope.abs();
            if less && !short || last || now > accepts.enough {
                return Ok((trial.balance, length));
            }
            // Secant between the ends, limited to between a tenth and a half of the interval. From the far
            // side of a contact, secant steps would be too small.
            *(if short { &mut low } else { &mut high }) = (length, now);
            let part = low.1 / (low.1 - high.1);
            let part = if part.is_finite() && !short { part.clamp(0.1, 0.5) } else { 0.5 };
            length = low.0 + part * (high.0 - low.0);
            trial = self.valid(&mut length)?;
        }
    }
}
