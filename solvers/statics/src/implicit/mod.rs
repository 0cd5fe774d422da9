//! Motion in real time by an implicit scheme over the nonlinear statics: with inertia, or without it where only the
//! material knows the time.

mod energy;
mod error;
mod march;
mod mass;
mod problem;
mod ramp;
mod scheme;

pub use energy::Energy;
pub use error::TimeError;
pub use march::solve_in_time;
pub use mass::Mass;
pub use problem::{Inertia, Motion, TimeParams, TimePath, TimeProblem, TimeStep};
pub use ramp::{Ramp, Ramps};
