//! Explicit computation in the reference configuration: internal forces, lumped mass, critical step, central
//! differences and dynamic relaxation.

mod central_difference;
mod chunks;
mod critical_step;
mod error;
mod force;
mod hex8;
mod hex8_lanes;
mod lane_math;
mod mass;
mod moduli;
mod neo_lanes;
mod nodal;
mod order;
pub(crate) mod path;
mod plain;
mod pressing;
mod quad;
mod relaxation;
mod rows;
mod tet4;
mod tools;
mod trilinear;

pub use central_difference::{Balance, Dynamics, DynamicsParams, External, Prescribed};
pub use critical_step::{CriticalStep, LanczosParams, Springs, critical_step, critical_step_touching};
pub use error::{ExplicitError, InvertedPoint};
pub use force::{ExplicitBody, InternalForce};
pub use mass::{Lumping, lumped_mass};
pub use order::locality_order;
pub use path::LanePath;
pub use pressing::{Pressing, PressingTool};
pub use relaxation::{RelaxationInfo, RelaxationParams, StaticLoad, relax, relax_under};
pub use tools::{MovingTool, ToolEnergies, ToolMotion, Tools};
