//! Implicit dynamics on top of nonlinear statics. Inertia is optional: without it only the material depends
//! on time.

mod energy;
mod error;
mod march;
mod mass;
mod problem;
mod scheme;

pub use energy::Energy;
pub use error::TimeError;
pub use march::solve_in_time;
pub use mass::Mass;
pub use problem::{Inertia, Motion, TimeParams, TimePath, TimeProblem, TimeStep};
