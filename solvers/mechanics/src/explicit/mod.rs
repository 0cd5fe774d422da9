//! Explicit computation in the reference configuration: internal forces, lumped mass, critical step, central
//! differences and dynamic relaxation.

mod chunks;
mod error;
mod force;
mod lane_math;
mod moduli;
mod neo_lanes;
mod nodal;
mod order;
mod path;
mod plain;
mod tet4;

pub use error::{ExplicitError, InvertedPoint};
pub use force::{ExplicitBody, InternalForce};
pub use order::locality_order;
pub use path::LanePath;
