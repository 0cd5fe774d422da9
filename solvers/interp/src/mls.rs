//! Moving least squares, linear and quadratic: the shape functions of element-free Galerkin used as a
//! transfer.

use efg::{Approximation, Basis, Kernel, Support};
use geometry::Cloud;
use shape::{Point3, PointRows};

use crate::neighbours::{check_count, check_finite};
use crate::{InterpError, TransferInfo};

/// Moving least squares with the cubic-spline kernel (Lancaster and Salkauskas 1981): exact for linear or
/// quadratic fields, as the basis is; does not interpolate.
///
/// [`Support::Dilatation`] multiplies the mean distance to a node's 14 nearest neighbours (all others in a
/// smaller cloud). Fallbacks of the shape functions (supports enlarged, basis regularised or reduced) are
/// counted in [`TransferInfo::fallbacks`].
pub fn mls(
    nodes: &[Point3],
    basis: Basis,
    support: Support,
    targets: &[Point3],
) -> Result<(PointRows, TransferInfo), InterpError> {
    let scheme = match basis {
        Basis::Linear => "mls-linear",
        Basis::Quadratic => "mls-quadratic",
    };
    check_finite(nodes, targets)?;
    check_count(scheme, nodes.len(), basis.terms())?;
    let cloud = Cloud::from_points(nodes.to_vec())?;
    let radii = support.radii(nodes, &cloud.spacing)?;
    let approximation = Approximation::new(cloud.points, radii, Kernel::CubicSpline, basis)?;
    let (rows, info) = approximation.point_rows(targets)?;
    Ok((rows, TransferInfo { outside: 0, fallbacks: info.fallbacks() }))
}
