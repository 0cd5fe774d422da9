//! Tools driven by force: their closures are unknowns.

use super::tangent::Factored;
use super::{Balance, Newton, State};
use crate::nonlinear::{Drive, StaticError};
use crate::{SolveError, Vector3};

impl Newton<'_> {
    /// What each tool driven by force still lacks of it, N: its share in the line search's work, without which a tool
    /// alone out of balance gives a slope of zero and every step is cut. 0 for one driven by closure.
    pub(super) fn lacking(&self, balance: &Balance, time: f64) -> Vec<f64> {
        let scale = self.scales(time).tools;
        (self.problem.tools.iter().zip(&balance.contacts))
            .map(|(driven, contacts)| match driven.drive {
                Drive::Force(full) => {
                    full * scale + contacts.as_ref().map_or(0.0, |c| c.force().dot(&driven.tool.along()))
                }
                Drive::Closure(_) => 0.0,
            })
            .collect()
    }

    /// Closures of the tools driven by force, by elimination: with `a = sum w N S along` (S = -dt/dx) the step is
    /// `du = x + X dd`, `K X = a`, and `dd` balances the tool: `(D - a' . X) dd = F - Q + a' . x`,
    /// `D = sum w along . S along`. One tool at a time: the columns of all tools make a small dense system.
    pub(super) fn drive(
        &mut self,
        factored: &Factored,
        state: &State,
        balance: &Balance,
        time: f64,
        step: &mut [f64],
    ) -> Result<Vec<f64>, StaticError> {
        let mut moves = vec![0.0; self.problem.tools.len()];
        let Some(surface) = self.problem.contact else { return Ok(moves) };
        let rows = surface.rows();
        let nodes = self.problem.nodes.len();
        let none = vec![0.0; state.pressure.len()];
        // (tool, X, a', D, what its force lacks)
        let mut driven = Vec::new();
        for (k, tool) in self.problem.tools.iter().enumerate() {
            let Drive::Force(full) = tool.drive else { continue };
            let full = full * self.scales(time).tools;
            let along = tool.tool.along();
            let mut columns = [vec![Vector3::zeros(); nodes], vec![Vector3::zeros(); nodes]];
            let (mut own, mut pushed) = (0.0, 0.0);
            if let Some(contacts) = &balance.contacts[k] {
                pushed = -contacts.force().dot(&along);
                for (&q, dt) in contacts.points().iter().zip(contacts.stiffness()) {
                    let w = rows.weights()[q as usize];
                    let (right, left) = (dt * along * -w, dt.tr_mul(&along) * -w);
                    own += right.dot(&along);
                    let (at, values) = rows.rows().row(q as usize);
                    for (&node, value) in at.iter().zip(values) {
                        columns[0][node as usize] += right * *value;
                        columns[1][node as usize] += left * *value;
                    }
                }
            }
            if !(own > 0.0) {
                moves[k] = self.approach(k, state, full)?;
                continue;
            }
            let mut x = self.system.gather(&columns[0], &none);
            self.solve(factored, &mut x)?;
            driven.push((k, x, self.system.gather(&columns[1], &none), own, full - pushed));
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let m = driven.len();
        if m > 0 {
            let matrix = nalgebra::DMatrix::from_fn(m, m, |i, j| {
                f64::from(u8::from(i == j)) * driven[i].3 - dot(&driven[i].2, &driven[j].1)
            });
            let right = nalgebra::DVector::from_fn(m, |i, _| driven[i].4 + dot(&driven[i].2, step));
            let solution = matrix.lu().solve(&right).ok_or(SolveError::NotPositiveDefinite)?;
            for (i, (k, x, _, _, _)) in driven.iter().enumerate() {
                moves[*k] = solution[i];
                for (s, x) in step.iter_mut().zip(x) {
                    *s += x * solution[i];
                }
            }
        }
        Ok(moves)
    }

    /// Closure that brings a tool which does not touch into contact, with the penetration that a hundredth of the
    /// surface would need for `force`.
    fn approach(&self, tool: usize, state: &State, force: f64) -> Result<f64, StaticError> {
        let Some(surface) = self.problem.contact else { return Ok(0.0) };
        let driven = self.problem.tools[tool].tool;
        let gap = surface.gap(driven, state.closures[tool], &state.u);
        let area: f64 = surface.rows().weights().iter().sum();
        Ok(gap.max(0.0) + force.abs() / (driven.law().penalty() * 0.01 * area))
    }
}
