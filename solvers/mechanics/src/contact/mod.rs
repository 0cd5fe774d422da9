//! Contact of a deformable surface with rigid tools: signed distances, a pointwise law with friction, and its
//! evaluation over the quadrature points of a surface.
//!
//! A [`Tool`] is a [`ToolShape`] put somewhere, with a [`ContactLaw`]; it moves by `closure` (m) along its direction.
//! A [`ContactSurface`] is a surface quadrature with its boxes. Evaluating one against the other gives [`Contacts`]:
//! tractions per undeformed area and their consistent tangents at the points that touch, and nothing at the others.
//! Between converged steps a [`ContactHistory`] keeps the elastic stick and the multipliers.

mod error;
mod evaluate;
mod history;
mod law;
mod surface;
mod tool;
mod tool_shape;

pub use error::ContactError;
pub use evaluate::{ContactCounts, Contacts};
pub use history::ContactHistory;
pub use law::{ContactLaw, Slip};
pub use surface::ContactSurface;
pub use tool::{PointContact, Tool};
pub use tool_shape::{Distance, ToolShape};
