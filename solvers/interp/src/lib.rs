//! Transfer of a nodal field to other points by common schemes.
//!
//! A scheme is a table from nodes to targets. The table is built once from the positions and applied to any
//! field as a sparse product. Each scheme states the fields that it reproduces and whether it interpolates
//! ([`Scheme::exact_degree`], [`Scheme::interpolates`]); both are tested. The transpose of a table transfers
//! forces from the targets to the nodes ([`shape::Rows::apply_transposed`]). Some schemes also provide
//! gradients ([`Scheme::grad_rows`]).
//!
//! ```
//! use tissuebench_interp::{InverseDistance, Radial, Scheme};
//! use shape::{Point3, Vector3};
//! let nodes: Vec<Point3> =
//!     (0..27).map(|i| Point3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64) * 1e-3).collect();
//! let target = [Point3::new(0.3e-3, 1.6e-3, 0.5e-3)];
//! let field: Vec<Vector3> = nodes.iter().map(|x| 0.1 * x.coords).collect();
//! let error = |scheme: Scheme| -> Result<f64, tissuebench_interp::InterpError> {
//!     let (rows, _) = scheme.rows(&nodes, None, &target)?;
//!     Ok((rows.rows().apply(&field)[0] - 0.1 * target[0].coords).norm())
//! };
//! assert!(error(Radial::Cubic.into())? < 1e-15); // exact for linear fields
//! assert!(error(InverseDistance { neighbours: 4, power: 2.0 }.into())? > 1e-6); // exact for constants only
//! # Ok::<(), tissuebench_interp::InterpError>(())
//! ```

mod circumcentre;
mod delaunay;
mod error;
mod frame;
mod hull;
mod lanes;
mod neighbours;
mod scheme;
mod sibson;
mod table;
mod twofold;

pub use error::InterpError;
pub use scheme::SchemeEntry;

scheme::schemes! {
    nearest::{Nearest [ENTRY]},
    inverse_distance::{InverseDistance [ENTRY]},
    shepard::{Shepard [ENTRY]},
    mls::{MlsLinear [MLS_LINEAR], MlsQuadratic [MLS_QUADRATIC], MlsModified [MLS_MODIFIED]},
    radial::{Radial [THIN_PLATE, CUBIC, MULTIQUADRIC, GAUSSIAN, WENDLAND_C2]},
    natural_neighbour::{NaturalNeighbour [ENTRY]},
    barycentric::{Barycentric [ENTRY]},
}

/// Counts of special cases of a transfer; none of them is an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TransferInfo {
    /// Number of extrapolated targets, outside the mesh (barycentric) or outside the convex hull of the nodes
    /// (natural neighbour). Other schemes always report 0.
    pub outside: usize,
    /// Number of targets for which the plain formula was replaced: by an enlarged support (Shepard, moving
    /// least squares), by a regularised or reduced basis (moving least squares), or by a linear field fitted
    /// to the natural neighbours, because rounding spoilt the Voronoi volumes (natural neighbour).
    pub fallbacks: usize,
}
