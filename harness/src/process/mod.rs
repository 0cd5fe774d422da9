//! Processes that are started: each is limited, measured and ended as a whole, with all that it starts.

mod call;
pub(crate) mod group;
pub(crate) mod leash;
#[cfg(target_os = "linux")]
mod members;

pub(crate) use call::{Call, End, Limits, call};
pub(crate) use group::{Started, last_words};
pub use leash::LeashArgs;
