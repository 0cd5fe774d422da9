//! The problem that a procedure solves.

use geometry::Point3;

use crate::discretise::Discretisation;
use crate::outcome::{Plan, Watch};
use crate::prepare::Prepared;
use crate::scenario::setup::Setup;

/// Problem that a procedure solves: the tables of one method under one setup.
pub(crate) struct Problem<'a> {
    pub(crate) method: &'a Discretisation,
    pub(crate) setup: &'a Setup,
    pub(crate) prepared: &'a Prepared,
    pub(crate) plan: &'a Plan,
    /// Observer of the run.
    pub(crate) watch: Option<&'a Watch>,
    /// Probe positions, m.
    pub(crate) probes: &'a [Point3],
}

impl Problem<'_> {
    /// Number of unknowns after elimination of the supports that always act, without those of a pressure field.
    pub(super) fn free_dofs(&self) -> usize {
        let fixed: std::collections::BTreeSet<(u32, u8)> =
            self.prepared.always_fixed().map(|f| (f.node, f.axis)).collect();
        3 * self.method.nodes().len() - fixed.len()
    }
}
