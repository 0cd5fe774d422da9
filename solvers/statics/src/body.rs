//! A body: a quadrature with a material at each point.

use material::LinearElastic;
use shape::{DilationGroups, Point3, VolumeRows};

use crate::error::SolveError;

/// A quadrature with its materials. All fields are borrowed, so one set of tables serves many problems.
#[derive(Clone, Copy, Debug)]
pub struct LinearBody<'a> {
    /// Node positions, m. The rigid motions of the nodal parameters are built from these positions. The
    /// tables must therefore reproduce linear fields, as elements and moving least squares do.
    pub nodes: &'a [Point3],
    /// The volume quadrature.
    pub volume: &'a VolumeRows,
    /// One law per region.
    pub materials: &'a [LinearElastic],
    /// Region of each quadrature point (index into `materials`); empty if all points are in region 0.
    pub region: &'a [u16],
    /// Volumetric projection: points get `(lambda' = -2 mu / 3, mu)`, and each group adds
    /// `kappa V_a b_a b_a^T`. The bulk modulus of a group that spans regions is the volume average over its
    /// points.
    pub dilation: Option<&'a DilationGroups>,
}

impl<'a> LinearBody<'a> {
    /// Returns the law at a quadrature point.
    pub fn material(&self, point: usize) -> &'a LinearElastic {
        &self.materials[region_of(self.region, point)]
    }

    /// Checks lengths and indices, and that the dilation groups belong to this quadrature.
    pub(crate) fn check(&self) -> Result<(), SolveError> {
        let points = self.volume.weights().len();
        let nodes = self.volume.rows().node_count();
        check_len("node positions", self.nodes.len(), nodes)?;
        if let Some(index) = self.nodes.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(SolveError::NotFinite { what: "position of node", index });
        }
        check_regions(self.region, points, self.materials)?;
        match self.dilation {
            Some(groups) => check_len("points of the dilation groups", groups.point_count(), points),
            None => Ok(()),
        }
    }
}

pub(crate) fn region_of(region: &[u16], point: usize) -> usize {
    region.get(point).map_or(0, |&r| r as usize)
}

pub(crate) fn check_regions(
    region: &[u16],
    points: usize,
    materials: &[LinearElastic],
) -> Result<(), SolveError> {
    if !region.is_empty() {
        check_len("regions of points", region.len(), points)?;
    }
    let bad = if region.is_empty() {
        materials.is_empty().then_some(0)
    } else {
        region.iter().position(|&r| r as usize >= materials.len())
    };
    match bad {
        Some(point) => Err(SolveError::NoMaterial {
            point,
            region: region_of(region, point),
            materials: materials.len(),
        }),
        None => Ok(()),
    }
}

pub(crate) fn check_len(what: &'static str, found: usize, expected: usize) -> Result<(), SolveError> {
    if found == expected { Ok(()) } else { Err(SolveError::Length { what, found, expected }) }
}
