//! Processes that are started: each is limited, measured and ended as a whole, with all that it starts.

mod call;
pub(crate) mod group;
pub(crate) mod leash;
#[cfg(target_os = "linux")]
mod members;

pub(crate) use call::{Call, End, Limits, call};
pub(crate) use group::{Started, last_words};
pub use leash::LeashArgs;

/// Seconds that the system has worked for this process, to a hundredth; `None` where it does not say.
pub(crate) fn system_seconds() -> Option<f64> {
    #[cfg(target_os = "linux")]
    return members::by_the_system(std::process::id());
    #[cfg(not(target_os = "linux"))]
    None
}
