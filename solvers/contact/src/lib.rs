//! Contact of a deformable surface with rigid tools: signed distances, a pointwise law with friction, and its
//! evaluation over the quadrature points of a surface.
//!
//! A [`Tool`] is a [`ToolShape`] at a position, with a [`ContactLaw`]; it moves by `closure` (m) along its
//! path, or turns. A [`ContactSurface`] is a surface quadrature with bounding boxes. Evaluating a tool against a
//! surface gives [`Contacts`]: tractions per undeformed area and their consistent tangents at the points that
//! touch, and nothing at the others. Over many small steps a [`ContactSearch`] finds the same contacts with
//! less work.
//!
//! Between converged steps a [`ContactHistory`] keeps the elastic stick and the multipliers. Some errors do
//! not show in a single state and are checked after a step: [`ContactSurface::check_passage`] finds tools
//! that jumped over the surface, and [`ContactSurface::check_overlap`] finds tools that overlap the body
//! between its points.
//!
//! ```
//! use tissuebench_contact::{ContactLaw, Slip, Sphere, Tool};
//! use shape::{Matrix3, Point3, Vector3};
//! # fn main() -> Result<(), tissuebench_contact::ContactError> {
//! // A ball of 5 mm that comes down along -z, without friction; penalty 5e8 Pa/m.
//! let (ball, law) = (Sphere { radius: 5e-3 }.into(), ContactLaw::frictionless(5e8)?);
//! let tool = Tool::new(ball, Point3::new(0.0, 0.0, 5e-3), Matrix3::identity(), -Vector3::z(), law)?;
//! let top = Point3::origin();
//! let apart = tool.contact(-1e-3, &top, &Slip::NONE, 0.0);
//! let pressed = tool.contact(1e-5, &top, &Slip::NONE, 0.0);
//! assert_eq!(apart.traction, Vector3::zeros());
//! assert!((pressed.traction - Vector3::new(0.0, 0.0, -5e3)).norm() < 1e-9 * 5e3);
//! # Ok(())
//! # }
//! ```

mod contacts;
mod drive;
mod error;
mod evaluate;
mod history;
mod law;
mod motion;
mod outline;
mod overlap;
mod search;
mod side;
mod surface;
mod tool;
mod tool_shape;
mod tool_travel;

pub use contacts::Contacts;
pub use drive::{Drive, DrivenTool, ToolState};
pub use error::ContactError;
pub use evaluate::ContactCounts;
pub use history::ContactHistory;
pub use law::{ContactLaw, Slip};
pub use motion::{Leg, Motion, Pose, Turn};
pub use outline::Outline;
pub use overlap::ON_THE_WAY;
pub use search::{ContactSearch, SearchAt};
pub use surface::ContactSurface;
pub use tool::{PointContact, Tool};
pub use tool_shape::*;
pub use tool_travel::Stand;
