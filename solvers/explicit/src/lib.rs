//! Explicit computation in the reference configuration: internal forces, lumped mass, critical step, central
//! differences and dynamic relaxation. No stiffness matrix is assembled.
//!
//! [`InternalForce`] evaluates the nodal forces of an [`ExplicitBody`]: in lanes, with one kernel for each
//! kind of table, or by a plain loop against which every kernel is tested. [`Dynamics`] steps a body in time,
//! and [`relax`] finds its static equilibrium.
//!
//! ```
//! use tissuebench_explicit::{ExplicitBody, InternalForce};
//! use geometry::{CellKind, generate::box_mesh};
//! use lanes::LanePath;
//! use material::{Law, NeoHookean};
//! use shape::{Point3, Vector3};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let max = Point3::new(0.01, 0.01, 0.01);
//! let mesh = box_mesh(CellKind::Tet4, Point3::origin(), max, [2; 3], [1.0; 3], None)?;
//! let volume = fem::volume_rows(&mesh, &fem::VolumeRule::STANDARD)?;
//! let laws = [Law::NeoHookean(NeoHookean::new(20e3, 0.45)?)];
//! let body = ExplicitBody { volume: &volume, laws: &laws, region: &[], axes: &[], groups: None };
//! let mut force = InternalForce::new(body, LanePath::best())?;
//! let u: Vec<Vector3> = mesh.points().iter().map(|x| Vector3::new(0.0, 0.0, 0.1 * x.z)).collect();
//! let mut f = vec![Vector3::zeros(); u.len()];
//! force.evaluate(&u, &mut f)?;
//! // Internal forces of any state sum to zero.
//! assert!(f.iter().sum::<Vector3>().norm() < 1e-12 * f.iter().map(|f| f.norm()).sum::<f64>());
//! # Ok(())
//! # }
//! ```

mod active;
mod body;
mod cell_lanes;
mod cells;
mod central_difference;
mod chunks;
mod critical_step;
mod error;
mod force;
mod frames;
mod kernel;
mod lists;
mod mass;
mod moduli;
mod motion;
mod nodal;
mod one_point;
mod one_point_lanes;
mod plain;
mod pressing;
mod quad;
mod quadratic;
mod relaxation;
mod rows;
mod scalar;
mod single;
mod step_lanes;
mod stiffness_damping;
mod tet4;
mod tet4_lanes;
mod tools;
mod trilinear;

pub use active::Contraction;
pub use body::ExplicitBody;
pub use central_difference::Dynamics;
pub use critical_step::{CriticalStep, LanczosParams, Springs, critical_step, critical_step_touching};
pub use error::{ExplicitError, InvertedPoint};
pub use force::InternalForce;
pub use frames::{FrameLoad, FrameParams, FrameState, FrameTool, Frames};
pub use kernel::{Kernel, KernelInfo, Precision};
pub use mass::{Lumping, lumped_mass, point_masses};
pub use motion::{Balance, DynamicsParams, External, Prescribed};
pub use pressing::{Pressing, PressingTool};
pub use relaxation::{RelaxationInfo, RelaxationParams, Rested, StaticLoad, relax, relax_under};
pub use tools::{MovingTool, ToolEnergies, ToolMotion, Tools};
