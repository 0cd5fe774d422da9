//! The force of each support on the body.

use std::collections::HashSet;
use std::ops::Range;

use super::Prepared;
use super::conditions::{Conditions, Held};
use crate::scenario::setup::Support;
use geometry::{Point3, Vector3};
use shape::{FixedDof, Resultant};

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
    /// Fraction of the loading, or time in s, of these forces; `None` in a procedure in which all supports always
    /// act.
    pub time: Option<f64>,
}

/// Whether a support acts at a time: its force still does at its end, but not yet at a late start.
fn acts([from, until]: &[f64; 2], time: f64) -> bool {
    const ROUNDING: f64 = 1e-9;
    (*from == 0.0 || time > from * (1.0 + ROUNDING)) && time <= until * (1.0 + ROUNDING)
}

impl Prepared {
    pub(super) fn conditions(&self) -> Conditions {
        Conditions { fixed: self.fixed.len(), rows: self.constraints.len(), weak: self.weak.len() }
    }

    /// Records that all conditions since `from` belong to one support.
    pub(super) fn hold(&mut self, support: &Support, from: Conditions) {
        let (axes, during) = (support.axes, support.during);
        self.held.push(Held { axes, during, from, to: self.conditions() });
    }

    /// Iterates over the constrained axes of each support.
    pub fn support_axes(&self) -> impl Iterator<Item = [bool; 3]> {
        self.held.iter().map(|held| held.axes)
    }

    /// Iterates over the nodes whose parameter along an axis a support prescribes, unless an earlier one
    /// does; `None` if it is a weak support or has constraint rows.
    pub fn nodes_of_support(&self, support: usize, axis: usize) -> Option<impl Iterator<Item = u32>> {
        let Held { from, to, .. } = &self.held[support];
        let along = move |dof: &&FixedDof| usize::from(dof.axis) == axis;
        let earlier: HashSet<u32> =
            self.fixed[..from.fixed].iter().filter(along).map(|dof| dof.node).collect();
        let nodal = from.rows == to.rows && from.weak == to.weak;
        let own = self.fixed[from.fixed..to.fixed].iter().filter(along).map(|dof| dof.node);
        nodal.then(|| own.filter(move |node| !earlier.contains(node)))
    }

    /// Returns the resultant of each support's forces on the body. A degree of freedom in several supports
    /// counts for the first of them, so that the sum balances the loads.
    pub fn support_forces(&self, forces: &ConditionForces) -> Vec<Resultant> {
        let mut seen = vec![false; 3 * forces.nodes.len()];
        let each = self.held.iter().map(|Held { during, from, to, .. }| {
            let mut sum = Resultant::default();
            if let (Some(time), Some(span)) = (forces.time, during)
                && !acts(span, time)
            {
                return sum;
            }
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
}
