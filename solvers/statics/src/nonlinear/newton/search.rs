//! The line search.

use shape::Vector3;

use super::tangent::Direction;
use super::{Balance, Descent, Newton, State, work};
use crate::nonlinear::StaticError;

/// Most times a step down the energy is taken.
const FARTHEST: f64 = 64.0;

impl Newton<'_> {
    /// Takes the step, or the part of it that brings the residual's work along the step down: a step past the minimum
    /// is cut by the secant, one that inverts a point is halved. A step of [`Descent::Down`] past a limit point, where
    /// that work grows on the way, is doubled as long as more than half of it is left. With a pressure field
    /// [`Descent::Guarded`] cuts the step where the factor it came from makes a step of the new residual that is no
    /// shorter; else full steps go.
    ///
    /// In a simulator's loop a step that was cut ends where less than half of the work is left (Matthies & Strang 1979): with
    /// more no point touches that the full step met, its stiffness is not in the next tangent, and that step is cut again.
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
        // Volumes count by the scale of the matrix that was solved, which makes forces of them.
        let (free, scale) = (self.system.free, self.system.pressure_scale);
        let size = |r: &[f64]| norm(&r[..free]).hypot(scale * norm(&r[free..]));
        // A step is displacements, and pressures over the scale.
        let length_of = |x: &[f64]| norm(&x[..free]).hypot(norm(&x[free..]) / scale);
        let before =
            size(&self.system.gather(&last.out, &last.pressure)).hypot(norm(&self.lacking(last, time)));
        // A tool driven by force that does not touch yet is on its approach: no force yet says where to stop.
        let forced = |tool: usize| self.force(tool, time).is_some();
        let approaches = (last.contacts.iter().enumerate())
            .any(|(k, contacts)| forced(k) && contacts.as_ref().is_none_or(|c| c.points().is_empty()));
        let saddle = !state.pressure.is_empty();
        // The closures of tools driven by force are not part of a factor: with them the saddle's full step goes.
        let natural = saddle && self.descent == Descent::Guarded && !(0..last.contacts.len()).any(forced);
        // The tangent was made definite: its step is one down the energy, of no natural length.
        let downhill =
            self.descent == Descent::Down && self.indefinite && slope > 0.0 && !saddle && !approaches;
        let mut reached: Option<(State, Balance, f64)> = None;
        let mut length = 1.0;
        // Work left at the farthest step that is too short, and at the nearest that is too long.
        let (mut low, mut high) = ((0.0, slope), (1.0, slope));
        for trial in 0.. {
            state.u.clone_from(&start.0);
            state.pressure.clone_from(&start.1);
            state.closures.clone_from(&start.2);
            // Constrained degrees of freedom go all the way, whatever part of the step the free ones take.
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
                // No energy falls along a step of the pressure's saddle. What the same factor makes of the new
                // residual is the step that is left: it must be shorter, whatever the scales of force and volume are
                // (the natural monotonicity test, Deuflhard 2004, ch. 3.3).
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
            // Secant between the ends, kept between a tenth and a half of the way; a secant to the far side of a touch comes to it
            // in steps too small.
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
