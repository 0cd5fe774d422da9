//! Bodies under large displacements: internal energy with projected volume change, and equilibrium by
//! Newton's method.

mod energy;
mod error;
mod following;
mod frames;
mod group_means;
mod groups;
mod in_time;
mod lanes;
mod newton;
mod problem;
mod relaxing;
mod shared;
mod solid;
mod sorted_rows;
mod split;
mod statics;
mod step;
mod stepper;
mod system;
#[cfg(test)]
mod tests;

pub(crate) use in_time::{Ended, InertiaTerms, Scales, TimeTerms};
pub(crate) use newton::{Descent, Newton, State, near, shortest_travel};
pub(crate) use relaxing::Memory;
pub(crate) use stepper::{Attempt, Stepper};
pub(crate) use system::SurfaceTable;

pub use error::{Inverted, StaticError, Worst};
pub use following::FollowingPressure;
pub use frames::Frames;
pub use newton::{Iteration, NewtonParams};
pub use problem::{LinearSystems, PenaltySurface, StaticProblem};
pub use solid::{Solid, SolidDilation};
pub use statics::{Rest, StaticParams, StaticPath, solve_static};
pub use step::{StaticWork, Step};
