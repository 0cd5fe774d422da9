//! Which essential conditions are whose, and with what force each support holds the body.

use std::ops::Range;

use geometry::Vector3;
use shape::FixedDof;

use super::Prepared;

/// Conditions of each kind up to one support: nodal ones, constraint rows and weakly held surfaces.
#[derive(Clone, Copy, Default)]
pub(super) struct Conditions {
    fixed: usize,
    rows: usize,
    weak: usize,
}

/// What one support prescribes.
pub(super) struct Held {
    axes: [bool; 3],
    /// Conditions before it, and with it.
    from: Conditions,
    to: Conditions,
}

/// Forces (N) on the body at a solution.
pub struct ConditionForces<'a> {
    /// Of the nodal supports on each node; none without them.
    pub nodes: &'a [Vector3],
    /// Of each constraint row.
    pub rows: &'a [Vector3],
    /// Of each weakly held surface.
    pub weak: &'a [Vector3],
}

impl Prepared {
    pub(super) fn conditions(&self) -> Conditions {
        Conditions { fixed: self.fixed.len(), rows: self.constraints.len(), weak: self.weak.len() }
    }

    /// Notes that all conditions since `from` are those of one support.
    pub(super) fn hold(&mut self, axes: [bool; 3], from: Conditions) {
        self.held.push(Held { axes, from, to: self.conditions() });
    }

    /// Axes along which each support holds.
    pub fn support_axes(&self) -> impl Iterator<Item = [bool; 3]> {
        self.held.iter().map(|held| held.axes)
    }

    /// Force (N) of each support on the body. A degree of freedom that several hold counts for the first of them, so that all
    /// together balance what acts on the body.
    pub fn support_forces(&self, forces: &ConditionForces) -> Vec<Vector3> {
        let mut seen = vec![false; 3 * forces.nodes.len()];
        let each = self.held.iter().map(|Held { from, to, .. }| {
            let mut sum = Vector3::zeros();
            for &FixedDof { node, axis, .. } in self.fixed.get(from.fixed..to.fixed).unwrap_or_default() {
                let (i, a) = (node as usize, usize::from(axis));
                // Without nodal supports there are no forces of theirs.
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

    /// Force (N) of each surface held by penalty in a procedure of Newton's method, at nodal parameters `u` (m) and this part of
    /// what supports prescribe.
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
