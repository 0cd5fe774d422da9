//! Line search.

use shape::Vector3;

use super::tangent::Direction;
use super::{Balance, Descent, Newton, State, work};
use crate::nonlinear::StaticError;

/// Largest multiple of a descent step.
const FARTHEST: f64 = 64.0;

impl Newton<'_> {
    /// Takes the step, or a fraction of it that reduces the work of the residual along the step. A step past
    /// the minimum is cut by the secant, and a step that inverts a point is halved.
    ///
    /// A step of [`Descent::Down`] past a limit point, at which this work grows along the step, is doubled
    /// while more than half of the work is left. With a pressure field, full steps are taken. Only
    /// [`Descent::Guarded`] cuts a step, if the same factor applied to the new residual gives a step that is
    /// no shorter.
    ///
    /// In a simulator's loop a cut step is accepted when less than half of the work is left (Matthies &
    /// Strang 1979). With more work left, the points that the full step met are not in contact. The next
    /// tangent then lacks their stiffness, and the next step is cut again.
    pub(super) fn search(
        &mut self,
        state: &mut State,
        direction: &Direction,
        prescribed_move: Option<&[Vector3]>,
        slope: f64,
        last: &Balance,
        time: f64,
    ) -> Result<(Balance, f64), StaticError> {
        let Direction { step, closures, factored, .. } = direction;
        let start = (state.u.clone(), state.pressure.clone(), state.closures.clone());
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
        // Volume residuals are scaled by the factor of the solved matrix, which turns them into forces.
        let (free, scale) = (self.system.free, self.system.pressure_scale);
        let size = |r: &[f64]| norm(&r[..free]).hypot(scale * norm(&r[free..]));
        // A step consists of displacements, and of pressures divided by the scale.
        let length_of = |x: &[f64]| norm(&x[..free]).hypot(norm(&x[free..]) / scale);
        let before =
            size(&self.system.gather(&last.out, &last.pressure)).hypot(norm(&self.lacking(last, time)));
        // A force-driven tool that does not touch yet is approaching: no force limits the step.
        let forced = |tool: usize| self.force(tool, time).is_some();
        let approaches = (last.contacts.iter().enumerate())
            .any(|(k, contacts)| forced(k) && contacts.as_ref().is_none_or(|c| c.points().is_empty()));
        let saddle = !state.pressure.is_empty();
        // The displacements of force-driven tools are not part of a factor; with such tools the full step of
        // the saddle point is taken.
        let natural = saddle && self.descent == Descent::Guarded && !(0..last.contacts.len()).any(forced);
        // The tangent was made definite. Its step is a descent step without a natural length.
        let downhill =
            self.descent == Descent::Down && self.indefinite && slope > 0.0 && !saddle && !approaches;
        let mut reached: Option<(State, Balance, f64)> = None;
        let mut length = 1.0;
        // Work left at the longest step that is too short, and at the shortest step that is too long.
        let (mut low, mut high) = ((0.0, slope), (1.0, slope));
        for trial in 0.. {
            state.u.clone_from(&start.0);
            state.pressure.clone_from(&start.1);
            state.closures.clone_from(&start.2);
            // Constrained degrees of freedom move all the way, whatever fraction of the step the free ones
            // take.
            self.prescribe(&mut state.u, time);
            self.system.scatter_add(step, length, &mut state.u, &mut state.pressure);
            state.closures.iter_mut().zip(closures).for_each(|(c, d)| *c += length * d);
            let balance = match self.balance(state, time) {
                Ok(balance) => balance,
                Err(_) if reached.is_some() => break,
                Err(error) if trial >= 10 || prescribed_move.is_some() => return Err(error),
                Err(_) => {
                    length *= 0.5;
                    continue;
                }
            };
            let unknowns = self.system.gather(&balance.out, &balance.pressure);
            let lacking = self.lacking(&balance, time);
            let now = work(step, &unknowns) + work(closures, &lacking);
            let smaller = size(&unknowns).hypot(norm(&lacking)) <= (1.0 - 0.1 * length) * before;
            if natural && !smaller && prescribed_move.is_none() && trial < 6 {
                // No energy falls along a step of the pressure's saddle point. The same factor applied to the
                // new residual gives the remaining step. This step must be shorter, independently of the
                // scales of force and volume (the natural monotonicity test, Deuflhard 2004, ch. 3.3).
                let mut left = unknowns.clone();
                self.solve(factored, &mut left)?;
                if !(length_of(&left) <= (1.0 - 0.25 * length) * length_of(step)) {
                    let bend: Vec<f64> = left.iter().zip(step).map(|(l, s)| l - (1.0 - length) * s).collect();
                    let best = 0.5 * length.powi(2) * length_of(step) / length_of(&bend);
                    length =
                        if best.is_finite() { best.clamp(0.1 * length, 0.5 * length) } else { 0.5 * length };
                    continue;
                }
                return Ok((balance, length));
            }
            if downhill && now > 0.0 && prescribed_move.is_none() {
                if now > 0.5 * slope && (1.0..FARTHEST).contains(&length) {
                    reached = Some((state.clone(), balance, length));
                    length *= 2.0;
                    continue;
                }
                return Ok((balance, length));
            }
            if reached.is_some() {
                break;
            }
            let short = self.repeats && high.1 < 0.0 && now > 0.5 * slope && trial < 6;
            let less = smaller || now.abs() <= (1.0 - 0.2 * length) * slope.abs();
            if less && !short || prescribed_move.is_some() || saddle || approaches || trial >= 6 {
                return Ok((balance, length));
            }
            // Secant between the ends, limited to between a tenth and a half of the interval. From the far
            // side of a contact, secant steps would be too small.
            *(if short { &mut low } else { &mut high }) = (length, now);
            let part = low.1 / (low.1 - high.1);
            let part = if part.is_finite() && !short { part.clamp(0.1, 0.5) } else { 0.5 };
            length = low.0 + part * (high.0 - low.0);
        }
        let (farthest, balance, length) =
            reached.expect("the loop ends early only with a step that goes down");
        *state = farthest;
        Ok((balance, length))
    }
}
