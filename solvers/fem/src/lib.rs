//! Finite elements: from a mesh to shape tables.
//!
//! Cells are of any kinds in any mixture, curved or straight. A table is built once,
//! independently of its use: stiffness, loads, boundary terms, probes and transfer all read the same rows.
//! Everything is in the reference configuration, in metres.
//!
//! ```
//! use geometry::{CellKind, generate::box_mesh};
//! use shape::{Point3, Vector3};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let max = Point3::new(0.02, 0.01, 0.01);
//! let mesh = box_mesh(CellKind::Tet10, Point3::origin(), max, [2, 1, 1], [1.0; 3], None)?;
//! let volume = tissuebench_fem::volume_rows(&mesh, &tissuebench_fem::VolumeRule::STANDARD)?;
//! assert!((volume.weights().iter().sum::<f64>() - 2e-6).abs() < 1e-18);
//! // The gradients of a linear field are reproduced at every point: u = (3 y, 0, 0).
//! let u: Vec<Vector3> = mesh.points().iter().map(|x| Vector3::new(3.0 * x.y, 0.0, 0.0)).collect();
//! let gradients = volume.at().displacement_gradients(&u);
//! assert!(gradients.iter().all(|h| (h[(0, 1)] - 3.0).abs() < 1e-12 && h[(0, 0)].abs() < 1e-12));
//! # Ok(())
//! # }
//! ```

mod bounds;
mod closest;
#[cfg(test)]
mod element_tests;
mod equilibrium;
mod error;
mod face;
mod linear;
mod locate;
mod map;
mod points;
mod rule;
mod source;
mod surface;
mod uniform;
mod volume;

pub use equilibrium::{EquilibriumTet, FaceNumbers, Response, face_moments};
pub use error::FemError;
pub use linear::linear_nodes;
pub use points::{Outside, grad_rows, nearest_cells, nearest_grad_rows, nearest_point_rows, point_rows};
pub use rule::{SurfaceRule, VolumeRule};
pub use source::Elements;
pub use surface::{divided_surface_rows, flux_rows, outline_rows, surface_rows};
pub use uniform::uniform_rows;
pub use volume::{cell_of_point, element_dilation, pressure_rows, regions, volume_rows};
