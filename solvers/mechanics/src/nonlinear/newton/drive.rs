//! Tools driven by force: their closures are unknowns.

use super::{Balance, Newton, State};
use crate::Vector3;
use crate::linear_solver::Border;
use crate::nonlinear::Drive;

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

    /// The tools driven by force that touch, each with its row and column of the tangent: with `a = sum w N S along`
    /// (S = -dt/dx) and `a'` the same of S transposed, a closure `dd` gives `K du - a dd = r`, and
    /// `D dd - a' . du = F - Q` balances the tool, `D = sum w along . S along`.
    pub(super) fn borders(&self, balance: &Balance) -> Vec<(usize, Border)> {
        let Some(surface) = self.problem.contact else { return Vec::new() };
        let rows = surface.rows();
        let none = vec![0.0; balance.pressure.len()];
        let mut borders = Vec::new();
        for (k, (driven, contacts)) in self.problem.tools.iter().zip(&balance.contacts).enumerate() {
            let (Drive::Force(_), Some(contacts)) = (driven.drive, contacts) else { continue };
            let along = driven.tool.along();
            let mut sides = [
                vec![Vector3::zeros(); self.problem.nodes.len()],
                vec![Vector3::zeros(); self.problem.nodes.len()],
            ];
            let mut corner = 0.0;
            for (&q, dt) in contacts.points().iter().zip(contacts.stiffness()) {
                let w = rows.weights()[q as usize];
                let (right, left) = (dt * along * w, dt.tr_mul(&along) * w);
                corner -= right.dot(&along);
                let (at, values) = rows.rows().row(q as usize);
                for (&node, value) in at.iter().zip(values) {
                    sides[0][node as usize] += right * *value;
                    sides[1][node as usize] += left * *value;
                }
            }
            if corner > 0.0 {
                let [column, row] = sides.map(|side| self.system.gather(&side, &none));
                borders.push((k, Border { column, row, corner }));
            }
        }
        borders
    }

    /// Closure that brings a tool which does not touch into contact, with the penetration that a hundredth of the
    /// surface would need for `force`.
    pub(super) fn approach(&self, tool: usize, state: &State, force: f64) -> f64 {
        let Some(surface) = self.problem.contact else { return 0.0 };
        let driven = self.problem.tools[tool].tool;
        let gap = surface.gap(driven, state.closures[tool], &state.u);
        let area: f64 = surface.rows().weights().iter().sum();
        gap.max(0.0) + force.abs() / (driven.law().penalty() * 0.01 * area)
    }
}
