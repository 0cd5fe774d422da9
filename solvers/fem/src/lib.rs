//! Finite elements: from a mesh to shape tables.
//!
//! tet4, tet10, hex8 and hex20 cells, in any mixture, curved or straight. A table is built once and knows nothing
//! of what it is used for: stiffness, loads, boundary terms, probes and transfer all read the same rows.
//! Everything is in the reference configuration, in metres.

mod bounds;
mod closest;
#[cfg(test)]
mod element_tests;
mod error;
mod face;
mod locate;
mod map;
mod points;
mod rule;
mod source;
mod surface;
mod volume;

pub use error::FemError;
pub use points::{Outside, grad_rows, nearest_grad_rows, nearest_point_rows, point_rows};
pub use rule::{SurfaceRule, VolumeRule};
pub use source::Elements;
pub use surface::{flux_rows, surface_rows};
pub use volume::{cell_of_point, element_dilation, pressure_rows, regions, volume_rows};
