//! Processes that are started: each is limited, measured and ended as a whole, with all that it starts.

mod call;
pub(crate) mod group;
pub(crate) mod leash;
#[cfg(target_os = "linux")]
mod members;

pub(crate) use call::{Call, End, Limits, call, said_within};
pub(crate) use group::{Started, last_words};
pub use leash::LeashArgs;

/// Most bytes in memory that this process has had since [`forget_most_memory`], or since it began; `None`
/// where the system does not say.
pub(crate) fn most_memory() -> Option<u64> {
    #[cfg(target_os = "linux")]
    return Some(members::most(std::process::id())).filter(|bytes| *bytes > 0);
    #[cfg(not(target_os = "linux"))]
    None
}

/// Makes the most memory of this process what it has now, where the system can.
pub(crate) fn forget_most_memory() {
    #[cfg(target_os = "linux")]
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Seconds that the system has worked for this process, to a hundredth; `None` where it does not say.
pub(crate) fn system_seconds() -> Option<f64> {
    #[cfg(target_os = "linux")]
    return members::by_the_system(std::process::id());
    #[cfg(not(target_os = "linux"))]
    None
}
