//! Child processes: each is limited, measured and killed together with all its descendants.

mod call;
pub(crate) mod group;
pub(crate) mod leash;
#[cfg(target_os = "linux")]
mod members;

pub(crate) use call::{Call, End, Limits, call, heard_within, said_within};

/// Returns the memory of this machine, bytes; if unknown, the memory of a large machine.
pub(crate) fn memory() -> f64 {
    let known = || {
        let text = std::fs::read_to_string("/proc/meminfo").ok()?;
        let total = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
        Some(1024.0 * total.split_whitespace().next()?.parse::<f64>().ok()?)
    };
    known().unwrap_or(256e9)
}

/// Returns the peak memory of this process, bytes, since [`forget_most_memory`] or since its start; `None` if
/// unknown.
pub(crate) fn most_memory() -> Option<u64> {
    #[cfg(target_os = "linux")]
    return Some(members::most(std::process::id())).filter(|bytes| *bytes > 0);
    #[cfg(not(target_os = "linux"))]
    None
}

/// Resets the peak memory of this process to its present memory, if the system supports this.
pub(crate) fn forget_most_memory() {
    #[cfg(target_os = "linux")]
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Returns the kernel CPU time of this process, s, to a hundredth; `None` if unknown.
pub(crate) fn system_seconds() -> Option<f64> {
    #[cfg(target_os = "linux")]
    return members::by_the_system(std::process::id());
    #[cfg(not(target_os = "linux"))]
    None
}
