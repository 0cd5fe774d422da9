//! What a process has started, and what that has started: what it takes, as `/proc` says, and its end.
//!
//! A leash gets what is left behind by those below it (it is their "child subreaper"), so that all that a program has started is below
//! its leash, in whatever group or session it is.

use std::collections::BTreeMap;
use std::time::Duration;

use rustix::process::{Pid, Signal, WaitOptions};

/// Of times in `/proc`, whatever the kernel counts in.
const TICKS_PER_SECOND: f64 = 100.0;
/// Of the state as the first field behind the name: parent, group, and so on, as proc(5) numbers them less 3.
const PARENT: usize = 1;
const OWN_TIMES: [usize; 2] = [11, 12];
const TIMES_OF_CHILDREN: [usize; 2] = [13, 14];
const PAGES: usize = 21;
/// How often those are looked for that have been started while others were ended, and the time between.
const LOOKS: usize = 100;
const LOOK: Duration = Duration::from_millis(1);

/// All processes below a leash.
#[derive(Debug, Default)]
pub(super) struct Members {
    /// Bytes in memory, together.
    pub(super) memory: u64,
    /// Most bytes that one of them had by now.
    pub(super) largest: u64,
    /// Seconds of the processors that they had.
    pub(super) seconds: f64,
}

/// The processes below a leash now.
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

/// The processes below another one, with their numbers.
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

/// Ends all processes below another one.
pub(super) fn end_below(root: u32) {
    for _ in 0..LOOKS {
        // One that has ended and was not waited for has no memory.
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

/// Makes what those below this process leave behind its own.
pub(super) fn adopt() -> std::io::Result<()> {
    Ok(rustix::process::set_child_subreaper(Some(rustix::process::getpid()))?)
}

/// Ends all below this process, and waits for them, so that their times count.
pub(super) fn end_own() {
    end_below(std::process::id());
    while let Ok(Some(_)) = rustix::process::wait(WaitOptions::empty()) {}
}

/// Seconds of the processors that the children of a process had which it has waited for, and theirs; known until it is waited for itself.
pub(super) fn waited_for(id: u32) -> Option<f64> {
    Some(seconds(&fields(id)?, TIMES_OF_CHILDREN))
}

/// Seconds that the system has worked for a process, to a hundredth.
pub(super) fn by_the_system(id: u32) -> Option<f64> {
    Some(fields(id)?.get(OWN_TIMES[1])? / TICKS_PER_SECOND)
}

fn seconds(fields: &[f64], of: [usize; 2]) -> f64 {
    of.iter().filter_map(|&at| fields.get(at)).sum::<f64>() / TICKS_PER_SECOND
}

/// The numbers of a process behind its name; its state, which is a letter, is 0.
fn fields(id: u32) -> Option<Vec<f64>> {
    let text = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    let (_, behind) = text.rsplit_once(')')?;
    Some(behind.split_whitespace().map(|field| field.parse().unwrap_or(0.0)).collect())
}

/// Most bytes in memory that a process had at once.
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
