//! The force of each support on the body.

use std::ops::Range;

use geometry::{Point3, Vector3};
use shape::{FixedDof, Resultant};
use statics::Timing;

use super::Prepared;
use super::conditions::{Conditions, Held};

/// Forces (N) on the body at a solution, by kind of condition.
pub struct ConditionForces<'a> {
    /// Position of a node, m: deformed under Newton's method and in dynamics, otherwise undeformed.
    pub at: &'a dyn Fn(usize) -> Point3,
    /// Force of the nodal supports on each node; empty without nodal supports.
    pub nodes: &'a [Vector3],
    /// Force of each constraint row.
    pub rows: &'a [Resultant],
    /// Force of each weakly constrained surface.
    pub weak: &'a [Resultant],
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

    /// Returns the resultant of each support's forces on the body. A degree of freedom in several supports
    /// counts for the first of them, so that the sum balances the loads.
    pub fn support_forces(&self, forces: &ConditionForces) -> Vec<Resultant> {
        let mut seen = vec![false; 3 * forces.nodes.len()];
        let each = self.held.iter().map(|Held { from, to, .. }| {
            let mut sum = Resultant::default();
            for &FixedDof { node, axis, .. } in self.fixed.get(from.fixed..to.fixed).unwrap_or_default() {
                let (i, a) = (node as usize, usize::from(axis));
                // Without nodal supports there are no nodal forces.
                if i < forces.nodes.len() && !std::mem::replace(&mut seen[3 * i + a], true) {
                    sum.add(&(forces.at)(i), &Vector3::ith(a, forces.nodes[i][a]));
                }
            }
            let of = |all: &[Resultant], range: Range<usize>| -> Resultant {
                all.get(range).unwrap_or_default().iter().copied().sum()
            };
            sum + of(forces.rows, from.rows..to.rows) + of(forces.weak, from.weak..to.weak)
        });
        each.collect()
    }

    /// Returns the resultant of each penalty surface's forces on the body under Newton's method. `u` (m) are
    /// the nodal parameters at `time`, and `timing` gives the curves of the prescribed displacements.
    pub fn penalty_forces(&self, u: &[Vector3], timing: &Timing, time: f64) -> Vec<Resultant> {
        let each = self.penalties.iter().enumerate().map(|(index, held)| {
            let part = timing.of(index).value(time);
            let mut sum = Resultant::default();
            let moved = held.surface.rows().apply(u);
            let points = held.surface.points().iter().zip(&moved).zip(&held.values);
            for (((x, u), g), w) in points.zip(held.surface.weights()) {
                let lacking = (g * part - u) * (held.beta * w);
                sum.add(&(x + u), &Vector3::from_fn(|a, _| if held.axes[a] { lacking[a] } else { 0.0 }));
            }
            sum
        });
        each.collect()
    }
}
