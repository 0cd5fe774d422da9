//! Element-free Galerkin method. A cloud of nodes, a kernel and a polynomial basis define
//! moving-least-squares shape functions; a cloud and a locality define maximum-entropy functions. Background
//! cells or a grid provide the integration points. The results are shape tables like those of finite
//! elements, so assembly, supports and output use the same code.
//!
//! ```
//! use tissuebench_efg::{Approximation, Basis, CubicSpline, Kernel, Support};
//! use shape::Point3;
//! let nodes: Vec<Point3> =
//!     (0..27).map(|i| Point3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64) * 1e-3).collect();
//! let radii = Support::Dilatation { factor: 1.6 }.radii(&nodes, &vec![1e-3; 27])?;
//! let mls = Approximation::new(nodes, radii, Kernel::CubicSpline(CubicSpline), Basis::Linear)?;
//! let (rows, info) = mls.point_rows(&[Point3::new(0.9e-3, 1.2e-3, 0.4e-3)])?;
//! assert!(info.neighbours_min >= 4 && info.enlarged == 0);
//! let x: f64 =
//!     rows.rows().row(0).0.iter().zip(rows.rows().row(0).1).map(|(&i, v)| (i % 3) as f64 * 1e-3 * v).sum();
//! assert!((x - 0.9e-3).abs() < 1e-15); // linear fields are reproduced
//! # Ok::<(), tissuebench_efg::EfgError>(())
//! ```

mod approximation;
mod basis;
mod buckets;
mod cell_rows;
mod cells;
mod coupling;
mod detour;
mod ellipsoid;
mod error;
mod exp;
mod facets;
mod gaps;
mod gauss;
mod grid;
mod info;
mod kernel;
mod ldlt;
mod max_entropy;
mod mls;
mod node_smoothed;
mod pressure;
mod recovery;
mod row_list;
mod smoothed;
mod source;
mod support;
mod supports;

pub use approximation::Approximation;
pub use basis::Basis;
pub use coupling::{border_vertices, coupled_nodes};
pub use ellipsoid::Ellipsoid;
pub use error::EfgError;
pub use facets::{flux_rows, surface_rows};
pub use gaps::across_gaps;
pub use gauss::{gauss_regions, gauss_rows};
pub use grid::{GridInfo, grid_rows};
pub use info::MlsInfo;
pub use kernel::{
    CubicSpline, Exponential, Gaussian, KERNELS, Kernel, KernelEntry, QuarticSpline,
    RegularisedInterpolating, WendlandC2, WendlandC4, WendlandC6,
};
pub use node_smoothed::{node_smoothed_regions, node_smoothed_rows, node_smoothed_trace};
pub use recovery::gradient_error;
pub use smoothed::{Smoothing, smoothed_regions, smoothed_rows, smoothed_trace};
pub use source::{CloudSource, Functions, Integration};
pub use support::Support;
