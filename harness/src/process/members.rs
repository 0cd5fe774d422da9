//! Descendants of a process, read from `/proc`: their resources and how they are killed.
//!
//! A leash is the "child subreaper" of its descendants: the system makes orphaned processes its children. All
//! processes that a program has started are therefore below its leash, in whatever group or session.

use std::collections::BTreeMap;
use std::time::Duration;

use rustix::process::{Pid, Signal, WaitOptions};

/// Clock ticks per second of the times in `/proc`, independent of the kernel's own timer.
const TICKS_PER_SECOND: f64 = 100.0;
/// Indices of the fields after the name in `/proc/<id>/stat`; the state is 0. They are the numbers of proc(5)
/// minus 3.
const PARENT: usize = 1;
const OWN_TIMES: [usize; 2] = [11, 12];
const TIMES_OF_CHILDREN: [usize; 2] = [13, 14];
const PAGES: usize = 21;
/// Passes over the processes to kill, and the pause between passes. A pass may miss processes started during
/// it.
const LOOKS: usize = 100;
const LOOK: Duration = Duration::from_millis(1);

/// Resources of all processes below a leash.
#[derive(Debug, Default)]
pub(super) struct Members {
    /// Resident memory of all processes together, bytes.
    pub(super) memory: u64,
    /// Largest peak memory of a single process, bytes.
    pub(super) largest: u64,
    /// CPU time of all processes, s.
    pub(super) seconds: f64,
}

/// Measures the processes below a leash.
pub(super) fn of(leash: u32) -> Members {
    let mut members = Members::default();
    let page = rustix::param::page_size() as u64;
    for (id, fields) in below(leash) {
        members.memory += page * fields.get(PAGES).map_or(0, |pages| *pages as u64);
        members.largest = members.largest.max(most(id));
        members.seconds += seconds(&fields, OWN_TIMES) + seconds(&fields, TIMES_OF_CHILDREN);
    }
    members
}

/// Returns all descendants of a process, each as its id and its fields.
fn below(root: u32) -> Vec<(u32, Vec<f64>)> {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let ids = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let mut children: BTreeMap<u32, Vec<(u32, Vec<f64>)>> = BTreeMap::new();
    for (id, fields) in ids.filter_map(|id| Some((id, fields(id)?))) {
        children.entry(fields.get(PARENT).map_or(0, |parent| *parent as u32)).or_default().push((id, fields));
    }
    let mut found = children.remove(&root).unwrap_or_default();
    let mut at = 0;
    while at < found.len() {
        found.extend(children.remove(&found[at].0).unwrap_or_default());
        at += 1;
    }
    found
}

/// Kills all descendants of a process.
pub(super) fn end_below(root: u32) {
    for _ in 0..LOOKS {
        // A zombie process has no memory.
        let left: Vec<u32> = below(root)
            .iter()
            .filter(|(_, of)| of.get(PAGES).is_some_and(|n| *n > 0.0))
            .map(|of| of.0)
            .collect();
        if left.is_empty() {
            return;
        }
        for id in left.iter().filter_map(|id| Pid::from_raw(id.cast_signed())) {
            let _ = rustix::process::kill_process(id, Signal::KILL);
        }
        std::thread::sleep(LOOK);
    }
}

/// Makes orphaned descendants children of this process.
pub(super) fn adopt() -> std::io::Result<()> {
    Ok(rustix::process::set_child_subreaper(Some(rustix::process::getpid()))?)
}

/// Kills all descendants of this process and waits for them, so that their CPU times are counted.
pub(super) fn end_own() {
    end_below(std::process::id());
    while let Ok(Some(_)) = rustix::process::wait(WaitOptions::empty()) {}
}

/// Returns the CPU time, s, of the children that a process has waited for, and of their waited-for
/// descendants. Known until the process itself is waited for.
pub(super) fn waited_for(id: u32) -> Option<f64> {
    Some(seconds(&fields(id)?, TIMES_OF_CHILDREN))
}

/// Returns the kernel CPU time of a process, s, to a hundredth.
pub(super) fn by_the_system(id: u32) -> Option<f64> {
    Some(fields(id)?.get(OWN_TIMES[1])? / TICKS_PER_SECOND)
}

fn seconds(fields: &[f64], of: [usize; 2]) -> f64 {
    of.iter().filter_map(|&at| fields.get(at)).sum::<f64>() / TICKS_PER_SECOND
}

/// Returns the fields after the name in `/proc/<id>/stat`. The state, a letter, becomes 0.
fn fields(id: u32) -> Option<Vec<f64>> {
    let text = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    let (_, behind) = text.rsplit_once(')')?;
    Some(behind.split_whitespace().map(|field| field.parse().unwrap_or(0.0)).collect())
}

/// Returns the peak resident memory of a process, bytes.
pub(super) fn most(id: u32) -> u64 {
    let text = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kb| kb.parse::<u64>().ok()).map_or(0, |kb| kb << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_process_has_memory_and_a_parent() {
        let id = std::process::id();
        let own = fields(id).unwrap();
        let parent = rustix::process::getppid().unwrap().as_raw_nonzero().get();
        assert_eq!(own[PARENT], f64::from(parent));
        let pages = own[PAGES] as u64 * rustix::param::page_size() as u64;
        assert!(pages > 1 << 20 && most(id) >= pages / 2, "{pages} {}", most(id));
        assert!(waited_for(id).is_some() && fields(u32::MAX).is_none());
    }
}
