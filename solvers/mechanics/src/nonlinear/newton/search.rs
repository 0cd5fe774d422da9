//! The line search.

use super::{Balance, Newton, State, work};
use crate::Vector3;
use crate::nonlinear::{Drive, StaticError};

impl Newton<'_> {
    /// Takes the step, or the part of it that brings the residual's work along the step down: a step past the minimum
    /// is cut by the secant, one that inverts a point is halved.
    pub(super) fn search(
        &mut self,
        state: &mut State,
        step: &[f64],
        closures: &[f64],
        held_move: Option<&[Vector3]>,
        slope: f64,
        last: &Balance,
        time: f64,
    ) -> Result<(Balance, f64), StaticError> {
        let start = (state.u.clone(), state.pressure.clone(), state.closures.clone());
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
        let none = vec![0.0; state.pressure.len()];
        let before = norm(&self.system.gather(&last.out, &none)).hypot(norm(&self.lacking(last, time)));
        // A tool driven by force that does not touch yet is on its approach: no force on its way tells where to stop.
        let approaches = (self.problem.tools.iter().zip(&last.contacts)).any(|(driven, contacts)| {
            matches!(driven.drive, Drive::Force(_)) && contacts.as_ref().is_none_or(|c| c.points().is_empty())
        });
        let mut length = 1.0;
        for trial in 0.. {
            state.u.clone_from(&start.0);
            state.pressure.clone_from(&start.1);
            state.closures.clone_from(&start.2);
            // Held degrees of freedom go all the way, whatever part of the step the free ones take.
            self.prescribe(&mut state.u, time);
            self.system.scatter_add(step, length, &mut state.u, &mut state.pressure);
            state.closures.iter_mut().zip(closures).for_each(|(c, d)| *c += length * d);
            let balance = match self.balance(state, time) {
                Ok(balance) => balance,
                Err(error) if trial >= 10 || held_move.is_some() => return Err(error),
                Err(_) => {
                    length *= 0.5;
                    continue;
                }
            };
            let saddle = !state.pressure.is_empty();
            let unknowns = self.system.gather(&balance.out, &balance.pressure);
            let lacking = self.lacking(&balance, time);
            let now = work(step, &unknowns) + work(closures, &lacking);
            // The pressure's saddle has no descent direction; there, and while held values move, the full step goes.
            let smaller = norm(&unknowns).hypot(norm(&lacking)) <= (1.0 - 0.1 * length) * before;
            if now.abs() <= (1.0 - 0.2 * length) * slope.abs()
                || smaller
                || held_move.is_some()
                || saddle
                || approaches
                || trial >= 6
            {
                return Ok((balance, length));
            }
            // Secant between slope at 0 and now at `length`, kept between a tenth and a half of it.
            let secant = length * slope / (slope - now);
            length = if secant.is_finite() { secant.clamp(0.1 * length, 0.5 * length) } else { 0.5 * length };
        }
        unreachable!("the loop returns or fails by its eleventh trial")
    }
}
