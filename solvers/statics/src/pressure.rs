//! Iterative solution of nearly incompressible bodies: part of the bulk modulus is represented by pressures.

use algebra::{FactorError, Multigrid, PressureGroup};
use material::LinearElastic;
use shape::Coarser;

use crate::assembly::add_volume;
use crate::dilation::{Averaged, averaged, group_mean};
use crate::error::SolveError;
use crate::grad_table::GradTable;
use crate::problem::Assembled;

/// Ratio of bulk to shear modulus that stays with the displacements. A smaller ratio leaves more to the
/// pressures, whose iterations depend on the element; a larger ratio slows the cycles. From 5 to 15 the
/// number of iterations varies by a tenth.
pub(crate) const KEPT: f64 = 10.0;

impl Assembled<'_> {
    /// Builds the multigrid solver as [`Assembled::multigrid`] does, for nearly incompressible bodies with
    /// dilation groups. The part of a group's bulk modulus above ten times its shear modulus is left to a
    /// pressure. Without dilation groups, or if no group has such a bulk modulus, the result is that of
    /// [`Assembled::multigrid`].
    pub fn multigrid_with_pressures(&self, linear: Option<&Coarser>) -> Result<Multigrid, SolveError> {
        let body = &self.body;
        let Some(groups) = body.dilation else { return self.multigrid(linear) };
        let averaged = averaged(body, groups)?;
        let kept = |a| KEPT * group_mean(body, a, LinearElastic::mu);
        let excess: Vec<f64> = (0..groups.len())
            .map(|a| (group_mean(body, a, LinearElastic::bulk) - kept(a)).max(0.0))
            .collect();
        if excess.iter().all(|&excess| excess == 0.0) {
            return self.multigrid(linear);
        }
        let mut without = self.stiffness.clone();
        let table = GradTable::of_groups(body.nodes.len(), &averaged, |a| -excess[a] * averaged[a].0);
        add_volume(&mut without, &table, &table.incidence(body.nodes.len()));
        let pressures: Vec<PressureGroup> = (0..groups.len())
            .filter(|&a| excess[a] > 0.0)
            .map(|a| group(&averaged[a], excess[a], rest(kept(a))))
            .collect();
        let levels = Multigrid::new(&without, body.nodes, self.held(), linear, &[]);
        Ok(levels.map_err(not_definite)?.with_pressures(without, &pressures))
    }
}

/// Returns the longitudinal modulus that belongs to the kept part of a bulk modulus, Pa.
pub(crate) fn rest(kept: f64) -> f64 {
    kept * (1.0 + 4.0 / 3.0 / KEPT)
}

fn group((volume, row): &Averaged, excess: f64, rest: f64) -> PressureGroup {
    let row = row.iter().map(|&(node, b)| (node, b * *volume)).collect();
    PressureGroup { row, volume: *volume, excess, rest }
}

/// Returns the error of a matrix that cannot be factored on its coarsest level.
pub(crate) fn not_definite(error: FactorError) -> SolveError {
    match error {
        FactorError::Other(error) => error.into(),
        FactorError::NotDefinite => SolveError::NotPositiveDefinite,
    }
}
