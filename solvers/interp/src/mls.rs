//! Moving least squares, linear and quadratic: element-free Galerkin shape functions used as a transfer.

use catalogue::{Build, Entry};
use efg::{Approximation, Basis, CubicSpline, Kernel, MlsInfo, Support};
use geometry::Cloud;
use shape::{GradRows, Point3, PointRows};

use crate::error::InterpError;
use crate::neighbours::{check_count, check_finite};
use crate::transfer::{Source, Transfer, TransferInfo, scaled, support_scale};

/// The scheme of [`mls`] with the linear basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MlsLinear {
    /// Ratio of support radius to mean spacing.
    pub support_scale: f64,
}

pub(crate) const MLS_LINEAR: Entry<Build<MlsLinear>> = Entry {
    name: "mls-linear",
    meaning: "moving least squares, linear basis",
    source: "Lancaster and Salkauskas (1981)",
    parameters: &[support_scale(1.6)],
    build: |values| Ok(MlsLinear { support_scale: values.number("support_scale")? }),
};

impl Transfer for MlsLinear {
    fn name(&self) -> &'static str {
        MLS_LINEAR.name
    }

    fn exact_degree(&self) -> Option<usize> {
        Some(1)
    }

    fn interpolates(&self) -> bool {
        false
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        mls(source.nodes, Basis::Linear, scaled(self.support_scale), targets)
    }

    fn grad_rows(&self, source: Source, targets: &[Point3]) -> Result<(GradRows, TransferInfo), InterpError> {
        mls_gradients(source.nodes, Basis::Linear, scaled(self.support_scale), targets)
    }
}

/// The scheme of [`mls`] with the quadratic basis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MlsQuadratic {
    /// Ratio of support radius to mean spacing.
    pub support_scale: f64,
}

pub(crate) const MLS_QUADRATIC: Entry<Build<MlsQuadratic>> = Entry {
    name: "mls-quadratic",
    meaning: "moving least squares, quadratic basis",
    source: "Lancaster and Salkauskas (1981)",
    parameters: &[support_scale(2.5)],
    build: |values| Ok(MlsQuadratic { support_scale: values.number("support_scale")? }),
};

impl Transfer for MlsQuadratic {
    fn name(&self) -> &'static str {
        MLS_QUADRATIC.name
    }

    fn exact_degree(&self) -> Option<usize> {
        Some(2)
    }

    fn interpolates(&self) -> bool {
        false
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        mls(source.nodes, Basis::Quadratic, scaled(self.support_scale), targets)
    }

    fn grad_rows(&self, source: Source, targets: &[Point3]) -> Result<(GradRows, TransferInfo), InterpError> {
        mls_gradients(source.nodes, Basis::Quadratic, scaled(self.support_scale), targets)
    }
}

/// The scheme of [`mls_modified`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MlsModified {
    /// Ratio of support radius to mean spacing.
    pub support_scale: f64,
}

pub(crate) const MLS_MODIFIED: Entry<Build<MlsModified>> = Entry {
    name: "mls-modified",
    meaning: "moving least squares, quadratic basis with penalised second derivatives",
    source: "Joldes et al. (2015)",
    parameters: &[support_scale(2.0)],
    build: |values| Ok(MlsModified { support_scale: values.number("support_scale")? }),
};

impl Transfer for MlsModified {
    fn name(&self) -> &'static str {
        MLS_MODIFIED.name
    }

    fn exact_degree(&self) -> Option<usize> {
        Some(1)
    }

    fn interpolates(&self) -> bool {
        false
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        mls_modified(source.nodes, scaled(self.support_scale), targets)
    }

    fn grad_rows(&self, source: Source, targets: &[Point3]) -> Result<(GradRows, TransferInfo), InterpError> {
        mls_modified_gradients(source.nodes, scaled(self.support_scale), targets)
    }
}

/// Regularisation of the quadratic block in [`mls_modified`], relative to the sum of the weights.
const MODIFIED: f64 = 1e-5;

/// Builds the table of moving least squares with the cubic-spline kernel (Lancaster and Salkauskas 1981). The
/// scheme is exact for linear or quadratic fields, according to the basis, and does not interpolate.
///
/// [`Support::Dilatation`] multiplies the mean distance to a node's 14 nearest neighbours (all others in a
/// smaller cloud). Fallbacks of the shape functions (enlarged supports, regularised or reduced basis) are
/// counted in [`TransferInfo::fallbacks`].
pub fn mls(
    nodes: &[Point3],
    basis: Basis,
    support: Support,
    targets: &[Point3],
) -> Result<(PointRows, TransferInfo), InterpError> {
    Ok(counted(plain(nodes, basis, support, targets)?.point_rows(targets)?))
}

/// Builds the table of [`mls`] with gradients (1/m).
pub fn mls_gradients(
    nodes: &[Point3],
    basis: Basis,
    support: Support,
    targets: &[Point3],
) -> Result<(GradRows, TransferInfo), InterpError> {
    Ok(counted(plain(nodes, basis, support, targets)?.grad_rows(targets)?))
}

/// Builds the table of modified moving least squares (Joldes et al. 2015): a quadratic basis whose second
/// derivatives are penalised by 1e-5 of the sum of the weights. Supports therefore need not contain ten nodes
/// in general position. The scheme is exact for linear fields, almost exact for quadratic fields, and does
/// not interpolate. Support and fallbacks are as in [`mls`]; the penalty does not count as a fallback.
pub fn mls_modified(
    nodes: &[Point3],
    support: Support,
    targets: &[Point3],
) -> Result<(PointRows, TransferInfo), InterpError> {
    Ok(counted(modified(nodes, support, targets)?.point_rows(targets)?))
}

/// Builds the table of [`mls_modified`] with gradients (1/m).
pub fn mls_modified_gradients(
    nodes: &[Point3],
    support: Support,
    targets: &[Point3],
) -> Result<(GradRows, TransferInfo), InterpError> {
    Ok(counted(modified(nodes, support, targets)?.grad_rows(targets)?))
}

fn plain(
    nodes: &[Point3],
    basis: Basis,
    support: Support,
    targets: &[Point3],
) -> Result<Approximation, InterpError> {
    let scheme = match basis {
        Basis::Linear => "mls-linear",
        Basis::Quadratic => "mls-quadratic",
    };
    approximation(scheme, nodes, basis, support, targets)
}

fn modified(nodes: &[Point3], support: Support, targets: &[Point3]) -> Result<Approximation, InterpError> {
    Ok(approximation("mls-modified", nodes, Basis::Quadratic, support, targets)?.regularised(MODIFIED)?)
}

fn approximation(
    scheme: &'static str,
    nodes: &[Point3],
    basis: Basis,
    support: Support,
    targets: &[Point3],
) -> Result<Approximation, InterpError> {
    check_finite(nodes, targets)?;
    check_count(scheme, nodes.len(), basis.terms())?;
    let cloud = Cloud::from_points(nodes.to_vec())?;
    let radii = support.radii(nodes, &cloud.spacing)?;
    Ok(Approximation::new(cloud.points, radii, Kernel::CubicSpline(CubicSpline), basis)?)
}

fn counted<T>((rows, info): (T, MlsInfo)) -> (T, TransferInfo) {
    (rows, TransferInfo { outside: 0, fallbacks: info.fallbacks() })
}
