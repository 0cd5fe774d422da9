//! The force of each support on the body.

use std::ops::Range;

use geometry::Vector3;
use shape::FixedDof;

use super::Prepared;
use super::conditions::{Conditions, Held};

/// Forces (N) on the body at a solution, by kind of condition.
pub struct ConditionForces<'a> {
    /// Force of the nodal supports on each node; empty without nodal supports.
    pub nodes: &'a [Vector3],
    /// Force of each constraint row.
    pub rows: &'a [Vector3],
    /// Force of each weakly constrained surface.
    pub weak: &'a [Vector3],
}

impl Prepared {
    pub(super) fn conditions(&self) -> Conditions {
        Conditions { fixed: self.fixed.len(), rows: self.constraints.len(), weak: self.weak.len() }
    }

    /// Records that all conditions since `from` belong to one support.
    pub(super) fn hold(&mut self, axes: [bool; 3], from: Conditions) {
        self.held.push(Held { axes, from, to: self.conditions() });
    }

    /// Iterates over the constrained axes of each support.
    pub fn support_axes(&self) -> impl Iterator<Item = [bool; 3]> {
        self.held.iter().map(|held| held.axes)
    }

    /// Returns the force (N) of each support on the body. A degree of freedom in several supports counts for
    /// the first of them, so that the sum balances the loads.
    pub fn support_forces(&self, forces: &ConditionForces) -> Vec<Vector3> {
        let mut seen = vec![false; 3 * forces.nodes.len()];
        let each = self.held.iter().map(|Held { from, to, .. }| {
            let mut sum = Vector3::zeros();
            for &FixedDof { node, axis, .. } in self.fixed.get(from.fixed..to.fixed).unwrap_or_default() {
                let (i, a) = (node as usize, usize::from(axis));
                // Without nodal supports there are no nodal forces.
                if i < forces.nodes.len() && !std::mem::replace(&mut seen[3 * i + a], true) {
                    sum[a] += forces.nodes[i][a];
                }
            }
            let of = |all: &[Vector3], range: Range<usize>| -> Vector3 {
                all.get(range).unwrap_or_default().iter().sum()
            };
            sum + of(forces.rows, from.rows..to.rows) + of(forces.weak, from.weak..to.weak)
        });
        each.collect()
    }

    /// Returns the force (N) of each penalty surface on the body under Newton's method. `u` (m) are the nodal
    /// parameters and `part` is the applied fraction of the prescribed displacements.
    pub fn penalty_forces(&self, u: &[Vector3], part: f64) -> Vec<Vector3> {
        let each = self.penalties.iter().map(|held| {
            let points = held.surface.rows().apply(u);
            let at = points.iter().zip(&held.values).zip(held.surface.weights());
            let sum: Vector3 = at.map(|((u, g), w)| (g * part - u) * *w).sum();
            Vector3::from_fn(|a, _| if held.axes[a] { held.beta * sum[a] } else { 0.0 })
        });
        each.collect()
    }
}
