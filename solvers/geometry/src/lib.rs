//! Bodies in space: meshes, node clouds, quadrature, spatial search, mesh files and mesh quality.
//!
//! Everything is in metres and in flat arrays; nothing here knows an approximation or a material.

mod cell;
mod cloud;
pub mod generate;
mod isoparametric;
mod locate;
mod mesh;
pub mod msh;
pub mod quadrature;
pub mod quality;
mod random;
mod search;
pub mod shapes;

pub use cell::{CellKind, FaceKind};
pub use cloud::{Cloud, CloudError, Refinement, cloud, cloud_from_mesh};
pub use locate::{LocateError, Location, locate};
pub use mesh::{Facet, Mesh, MeshError};
pub use search::{Neighbour, Search, SearchError};
pub use shapes::Kidney;

/// A position in the reference configuration, in metres.
pub type Point3 = nalgebra::Point3<f64>;
/// A displacement (m), a normal (-) or a traction (Pa).
pub type Vector3 = nalgebra::Vector3<f64>;
/// A displacement gradient (-) or a stress (Pa).
pub type Matrix3 = nalgebra::Matrix3<f64>;
