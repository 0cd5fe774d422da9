//! Force-driven tools, whose displacements are unknowns: their missing forces, and their rows and columns of
//! the tangent.

use algebra::Border;
use contact::Drive;
use shape::Vector3;

use super::equations::{Balance, Equations};
use super::state::State;

impl Equations<'_> {
    /// Returns the missing force of each force-driven tool, N; 0 for a displacement-driven tool. The missing
    /// force enters the work of the line search. Without this term, a tool out of balance alone would give a
    /// slope of zero, and every step would be cut.
    pub fn lacking(&self, balance: &Balance, time: f64) -> Vec<f64> {
        (self.problem.tools.iter().zip(&balance.contacts).enumerate())
            .map(|(k, (driven, contacts))| {
                self.force(k, time).map_or(0.0, |force| {
                    force + contacts.as_ref().map_or(0.0, |c| c.force().dot(&driven.tool.along()))
                })
            })
            .collect()
    }

    /// Returns the force that drives a tool at `time`, N; `None` for a tool driven by displacement or under
    /// displacement control.
    pub fn force(&self, tool: usize, time: f64) -> Option<f64> {
        match self.problem.tools[tool].drive {
            Drive::Force(full) if !self.displacement_driven[tool] => Some(full * self.part(tool, time)),
            Drive::Force(_) | Drive::Closure(_) => None,
        }
    }

    /// Returns the part of the drive of a tool at `time`.
    pub fn part(&self, tool: usize, time: f64) -> f64 {
        self.problem.curves.tools.of(tool).value(time)
    }

    /// Returns the full force of a force-driven tool, N; 1 N for another.
    pub fn full_force(&self, tool: usize) -> f64 {
        match self.problem.tools[tool].drive {
            Drive::Force(full) => full.abs(),
            Drive::Closure(_) => 1.0,
        }
    }

    /// Returns the force-driven tools in contact, each with its row and column of the tangent.
    ///
    /// With `a = sum w N S along` (S = -dt/dx) and `a'` the same with S transposed, a displacement increment
    /// `dd` of the tool gives `K du - a dd = r`. The tool is balanced by `D dd - a' . du = F - Q` with
    /// `D = sum w along . S along`.
    pub fn borders(&self, balance: &Balance) -> Vec<(usize, Border)> {
        let Some(surface) = self.problem.contact else { return Vec::new() };
        let rows = surface.rows();
        let none = vec![0.0; balance.pressure.len()];
        let mut borders = Vec::new();
        for (k, (driven, contacts)) in self.problem.tools.iter().zip(&balance.contacts).enumerate() {
            let (Some(_), Some(contacts)) = (self.force(k, 1.0), contacts) else { continue };
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
                if let Some(part) = self.beside_internal() {
                    sides[0].iter_mut().for_each(|column| *column *= part);
                }
                let [column, row] = sides.map(|side| self.system.gather(&side, &none));
                borders.push((k, Border { column, row, corner }));
            }
        }
        borders
    }

    /// Returns the derivative of a tool's force along its travel with respect to the nodal parameters, N/m.
    pub fn by_displacement(&self, balance: &Balance, tool: usize) -> Vec<Vector3> {
        let mut by = vec![Vector3::zeros(); self.problem.nodes.len()];
        let (Some(surface), Some(contacts)) = (self.problem.contact, &balance.contacts[tool]) else {
            return by;
        };
        let (rows, along) = (surface.rows(), self.problem.tools[tool].tool.along());
        for (&q, dt) in contacts.points().iter().zip(contacts.stiffness()) {
            let left = dt.tr_mul(&along) * rows.weights()[q as usize];
            let (at, values) = rows.rows().row(q as usize);
            at.iter().zip(values).for_each(|(&node, value)| by[node as usize] += left * *value);
        }
        by
    }

    /// Returns the displacement, m, that brings a tool into contact, with the penetration at which a
    /// hundredth of the surface carries `force`.
    pub fn approach(&self, tool: usize, state: &State, force: f64) -> f64 {
        let Some(surface) = self.problem.contact else { return 0.0 };
        let driven = self.problem.tools[tool].tool;
        let gap = surface.gap(driven, state.closures[tool], &state.u);
        let area: f64 = surface.rows().weights().iter().sum();
        gap.max(0.0) + force.abs() / (driven.law().penalty() * 0.01 * area)
    }
}
