//! What the processes of a group have, as `/proc` says.

/// Of times in `/proc`, whatever the kernel counts in.
const TICKS_PER_SECOND: f64 = 100.0;
/// Of the state as the first field behind the name: parent, group, and so on, as proc(5) numbers them less 3.
const GROUP: usize = 2;
const OWN_TIMES: [usize; 2] = [11, 12];
const TIMES_OF_CHILDREN: [usize; 2] = [13, 14];
const PAGES: usize = 21;

/// All processes of a group but its leash.
#[derive(Debug, Default)]
pub(super) struct Members {
    /// Bytes in memory, together.
    pub(super) memory: u64,
    /// Most bytes that one of them had by now.
    pub(super) largest: u64,
    /// Seconds of the processors that they had.
    pub(super) seconds: f64,
}

/// The members of the group of a leash now.
pub(super) fn of(leash: u32) -> Members {
    let mut members = Members::default();
    let page = rustix::param::page_size() as u64;
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let ids = entries.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    for (id, fields) in ids.filter(|id| *id != leash).filter_map(|id| Some((id, fields(id)?))) {
        if fields.get(GROUP).copied() != Some(f64::from(leash)) {
            continue;
        }
        members.memory += page * fields.get(PAGES).map_or(0, |pages| *pages as u64);
        members.largest = members.largest.max(most(id));
        members.seconds += seconds(&fields, OWN_TIMES) + seconds(&fields, TIMES_OF_CHILDREN);
    }
    members
}

/// Seconds of the processors that the children of a process had which it has waited for, and theirs; known until it is waited for itself.
pub(super) fn waited_for(id: u32) -> Option<f64> {
    Some(seconds(&fields(id)?, TIMES_OF_CHILDREN))
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
fn most(id: u32) -> u64 {
    let text = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kb| kb.parse::<u64>().ok()).map_or(0, |kb| kb << 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_process_has_memory_and_a_group() {
        let id = std::process::id();
        let own = fields(id).unwrap();
        let group = rustix::process::getpgrp().as_raw_nonzero().get();
        assert_eq!(own[GROUP], f64::from(group));
        let pages = own[PAGES] as u64 * rustix::param::page_size() as u64;
        assert!(pages > 1 << 20 && most(id) >= pages / 2, "{pages} {}", most(id));
        assert!(waited_for(id).is_some() && fields(u32::MAX).is_none());
    }
}
