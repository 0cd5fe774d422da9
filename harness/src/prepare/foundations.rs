//! Springs and dampers between parts of the surface and the ground.

use catalogue::metric;
use explicit::Springs;
use geometry::Vector3;

use super::Prepared;
use super::foundation_tables::OwnedFoundation;
use super::region_check::founded;
use super::surfaces::{flux, values_of};
use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::outcome::{Metric, push};
use crate::scenario::setup::Foundation;

impl Prepared {
    /// Fills the tables of springs and dampers.
    pub(super) fn found(
        &mut self,
        method: &Discretisation,
        foundations: &[Foundation],
    ) -> Result<(), Failure> {
        for (index, foundation) in foundations.iter().enumerate() {
            for flux in flux(&*self.source, &founded(foundation, method.mesh())?)? {
                self.foundations.push(OwnedFoundation {
                    index,
                    surface: values_of(&flux)?,
                    ground: vec![Vector3::zeros(); flux.weights().len()],
                    flux,
                    stiffness: foundation.stiffness,
                    damping: foundation.damping,
                    along_normal: foundation.along_normal,
                });
            }
        }
        Ok(())
    }

    /// Returns the metrics of the force of each foundation on the body at nodal parameters `u` (m) with velocities
    /// `v` (m/s; empty for none).
    pub(crate) fn foundation_forces(&self, u: &[Vector3], v: &[Vector3]) -> Vec<Metric> {
        let mut sums = vec![Vector3::zeros(); self.foundations.last().map_or(0, |last| last.index + 1)];
        for foundation in &self.foundations {
            foundation.each_force(u, v, |_, force| sums[foundation.index] += force);
        }
        let mut metrics = Vec::new();
        for (index, sum) in sums.iter().enumerate() {
            for (axis, of) in metric::FOUNDATION_FORCE.components().into_iter().enumerate() {
                push(&mut metrics, of.at(index), sum[axis]);
            }
        }
        metrics
    }

    /// Adds the nodal forces (N) of all springs and dampers to `out`.
    pub(crate) fn add_foundation_forces(&self, u: &[Vector3], v: &[Vector3], out: &mut [Vector3]) {
        for foundation in &self.foundations {
            let rows = foundation.surface.rows();
            foundation.each_force(u, v, |q, force| {
                let (nodes, values) = rows.row(q);
                nodes.iter().zip(values).for_each(|(&node, value)| out[node as usize] += force * *value);
            });
        }
    }

    /// Returns the springs and dampers for estimates of the critical step.
    pub(crate) fn ground(&self) -> Vec<Springs<'_>> {
        let each = self.foundations.iter();
        each.map(|of| Springs { surface: &of.surface, modulus: of.stiffness, damping: of.damping }).collect()
    }
}
