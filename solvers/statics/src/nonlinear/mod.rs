//! Bodies under large displacements: internal energy with projected volume change, and equilibrium by
//! Newton's method.

mod basis;
mod curves;
mod energy;
mod error;
mod following;
mod frames;
mod group_means;
mod groups;
mod in_time;
mod lanes;
mod newton;
mod penalty;
mod problem;
mod relaxing;
mod shared;
mod solid;
mod sorted_rows;
mod split;
mod stages;
mod statics;
mod step;
mod stepper;
mod system;
#[cfg(test)]
mod tests;

pub(crate) use in_time::{Ended, InertiaTerms, StiffnessDamping, TimeTerms};
pub(crate) use newton::{Descent, Newton, State, Totals, near, shortest_travel};
pub(crate) use penalty::Rate;
pub(crate) use relaxing::Memory;
pub(crate) use stages::Stages;
pub(crate) use stepper::{Attempt, Stepper};
pub(crate) use system::SurfaceTable;

pub use basis::Basis;
pub use curves::{Curves, Timing};
pub use error::{Inverted, StaticError, Worst};
pub use following::FollowingLoad;
pub use frames::Frames;
pub use newton::{Goal, Iteration, Nearby, NewtonParams, Predicted, Traced, predict, trace, unbalanced};
pub use penalty::PenaltySurface;
pub use problem::{LinearSystems, StaticProblem};
pub use solid::{Active, Solid, SolidDilation};
pub use statics::{Rest, StaticParams, StaticPath, solve_static};
pub use step::{StaticWork, Step};
