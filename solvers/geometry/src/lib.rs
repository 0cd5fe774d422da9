//! Bodies in space: meshes, node clouds, quadrature, spatial search and mesh quality.
//!
//! All lengths are in metres, and all data are in flat arrays. The crate is independent of approximations and
//! materials.
//!
//! ```
//! use tissuebench_geometry::{CellKind, Kidney, Search, cloud, generate::kidney_mesh, quality};
//!
//! let mesh = kidney_mesh(CellKind::Tet10, 4)?;
//! let quality = quality::check(&mesh)?;
//! assert!((quality.volume * 1e9 - 41_888.0).abs() < 25.0); // 4/3 pi 10^4 mm^3
//!
//! let nodes = cloud(&Kidney, 83, 1, &[])?;
//! let nearest = Search::new(&nodes.points)?.nearest(&mesh.points()[0], 14);
//! assert_eq!((nodes.points.len(), nearest.len()), (83, 14));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cell;
mod cloud;
pub mod element;
pub mod generate;
mod locate;
mod mesh;
pub mod pieces;
pub mod quadrature;
pub mod quality;
mod random;
mod search;
pub mod shapes;
pub mod stuffing;
pub mod surface;
mod triangle;

pub use cell::FaceKind;
pub use cloud::{
    Cloud, CloudError, PointFile, PointFileError, PointProblem, Refinement, Sizes, cloud, cloud_from_mesh,
    cloud_of_sizes, edges, read_points, read_points_text,
};
pub use element::CellKind;
pub use locate::{LocateError, Location, Locator, locate};
pub use mesh::{Facet, Mesh, MeshError};
pub use search::{Neighbour, Search, SearchError};
pub use shapes::Kidney;
pub use surface::Surface;
pub use triangle::closest_on_triangle;

/// A position in the reference configuration, in metres.
pub type Point3 = nalgebra::Point3<f64>;
/// A displacement (m), a normal (-) or a traction (Pa).
pub type Vector3 = nalgebra::Vector3<f64>;
/// A displacement gradient (-) or a stress (Pa).
pub type Matrix3 = nalgebra::Matrix3<f64>;
