//! Body for explicit computation.

use material::{AtPoint, Law, Material as _};
use shape::{DilationGroups, Matrix3, Vector3, VolumeRows};

use super::error::ExplicitError;

/// Body for explicit computation: a quadrature with its laws.
#[derive(Clone, Copy)]
pub struct ExplicitBody<'a> {
    /// The volume quadrature.
    pub volume: &'a VolumeRows,
    /// Laws, by region index.
    pub laws: &'a [Law],
    /// Region index of every quadrature point; empty if all points are in region 0.
    pub region: &'a [u16],
    /// Axes of the material at each point, as columns: fibre, sheet and normal. Empty if no law depends on
    /// directions.
    pub axes: &'a [Matrix3],
    /// Groups of points that share one dilation (F-bar), if any.
    pub groups: Option<&'a DilationGroups>,
}

impl ExplicitBody<'_> {
    pub(super) fn region(&self, q: usize) -> u16 {
        self.region.get(q).copied().unwrap_or(0)
    }

    pub(super) fn law(&self, q: usize) -> AtPoint<'_> {
        AtPoint::new(&self.laws[self.region(q) as usize], self.axes.get(q))
    }

    /// Returns the Lame moduli `lambda` and `mu` of the undeformed material at a point, Pa.
    pub(super) fn moduli(&self, q: usize) -> [f64; 2] {
        let law = self.law(q);
        [law.lambda(), law.mu()]
    }

    /// Returns a length of the order of the smallest spacing: the inverse of the largest shape gradient, m.
    pub(super) fn spacing(&self) -> f64 {
        1.0 / self.volume.grads().iter().map(Vector3::norm).fold(f64::MIN_POSITIVE, f64::max)
    }

    /// Returns a displacement (m) whose strain is at most 1e-6.
    pub(super) fn small_displacement(&self) -> f64 {
        1e-6 * self.spacing()
    }

    pub(super) fn check(&self) -> Result<(), ExplicitError> {
        let points = self.volume.weights().len();
        let length = |what, found, expected| Err(ExplicitError::Length { what, found, expected });
        if !self.region.is_empty() && self.region.len() != points {
            return length("region indices", self.region.len(), points);
        }
        if let Some(groups) = self.groups
            && groups.point_count() != points
        {
            return length("points of the dilation groups", groups.point_count(), points);
        }
        match (0..points).find(|&q| self.region(q) as usize >= self.laws.len()) {
            Some(point) => {
                let region = self.region(point) as usize;
                Err(ExplicitError::NoLaw { point, region, laws: self.laws.len() })
            }
            None => Ok(()),
        }
    }
}
