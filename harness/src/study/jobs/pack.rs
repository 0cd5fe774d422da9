//! Division of runs into bundles of about the wanted time, whose runs need about the same memory.

use std::collections::BTreeMap;

use super::super::foreseen::Foreseen;
use super::super::plan::StudyPlan;
use crate::scenario::{estimate, of_reference};

/// Shortest time of a bundle, s. Below, the start of a job is a relevant part of its time.
const SHORTEST: f64 = 2.0;
/// Number of bundles per job at once, so that all jobs end at about the same time.
const PER_JOB: f64 = 3.0;
/// Ratio of a job's memory to the largest estimate or measurement of its runs, and the memory of the program
/// itself, bytes.
const MEMORY: f64 = 1.5;
const PROGRAM: f64 = 1e9;

/// Runs with the memory that they need.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Packed {
    pub(super) runs: Vec<usize>,
    /// Time of the runs with their references, s.
    pub(super) seconds: f64,
    /// Memory, bytes.
    pub(super) bytes: f64,
}

/// Runs that have a reference in common.
struct Group {
    runs: Vec<(usize, f64)>,
    /// Time of the reference, s.
    reference: f64,
    bytes: f64,
}

impl StudyPlan {
    /// Divides runs into bundles for a number of jobs at once, of at most about `seconds` each.
    pub(super) fn bundles(&self, runs: &[usize], costs: &Foreseen, seconds: f64, jobs: usize) -> Vec<Packed> {
        let mut groups: BTreeMap<(usize, Option<u64>), Group> = BTreeMap::new();
        for &run in runs {
            let task = &self.tasks[run];
            let group = groups.entry((task.scene, task.poisson.map(f64::to_bits))).or_insert_with(|| {
                let scene = &self.scenes[task.scene].2;
                let bytes = of_reference(scene).map_or(0.0, |reference| reference.bytes);
                Group { runs: Vec::new(), reference: self.reference_seconds(task.scene, costs), bytes }
            });
            let estimated = || estimate(&self.scenes[task.scene].2, &task.method.family).bytes;
            group.bytes = group.bytes.max(costs.bytes(run).unwrap_or_else(estimated));
            group.runs.push((run, costs.of(run)));
        }
        packed(groups.into_values().collect(), seconds, jobs)
    }
}

/// Packs groups. A group that takes longer than the wanted time is divided, but not into parts that spend
/// more time on the reference than on their runs.
fn packed(groups: Vec<Group>, seconds: f64, jobs: usize) -> Vec<Packed> {
    let all: f64 = groups.iter().map(|g| g.reference + g.runs.iter().map(|run| run.1).sum::<f64>()).sum();
    let wanted = (all / (PER_JOB * jobs as f64)).max(SHORTEST).min(seconds);
    let mut parts: Vec<Packed> = groups.into_iter().flat_map(|group| divided(group, wanted)).collect();
    parts.sort_by(|a, b| b.seconds.total_cmp(&a.seconds).then(a.runs.cmp(&b.runs)));
    let mut bundles: Vec<Packed> = Vec::new();
    for part in parts {
        let fits = |bundle: &&mut Packed| {
            class(bundle.bytes) == class(part.bytes) && bundle.seconds + part.seconds <= wanted
        };
        match bundles.iter_mut().find(fits) {
            Some(bundle) => {
                bundle.runs.extend(part.runs);
                bundle.seconds += part.seconds;
                bundle.bytes = bundle.bytes.max(part.bytes);
            }
            None => bundles.push(part),
        }
    }
    bundles.iter_mut().for_each(|bundle| bundle.runs.sort_unstable());
    bundles
}

fn divided(group: Group, wanted: f64) -> Vec<Packed> {
    let most = wanted.max(2.0 * group.reference);
    let bytes = PROGRAM + MEMORY * group.bytes;
    let mut parts: Vec<Packed> = Vec::new();
    for (run, takes) in group.runs {
        match parts.last_mut().filter(|part| part.seconds + takes <= most) {
            Some(part) => {
                part.runs.push(run);
                part.seconds += takes;
            }
            None => parts.push(Packed { runs: vec![run], seconds: group.reference + takes, bytes }),
        }
    }
    parts
}

/// Class of memory: powers of two.
fn class(bytes: f64) -> i32 {
    bytes.log2().ceil() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(runs: &[(usize, f64)], reference: f64, bytes: f64) -> Group {
        Group { runs: runs.to_vec(), reference, bytes }
    }

    fn runs(packed: &[Packed]) -> Vec<Vec<usize>> {
        packed.iter().map(|bundle| bundle.runs.clone()).collect()
    }

    #[test]
    fn short_runs_share_a_job_and_long_groups_are_divided() {
        let short = (0..100).map(|run| group(&[(run, 0.1)], 0.0, 0.0)).collect();
        let found = packed(short, 600.0, 1);
        assert_eq!(found.iter().map(|bundle| bundle.runs.len()).collect::<Vec<_>>(), [33, 33, 33, 1]);
        let long = vec![group(&[(0, 400.0), (1, 300.0), (2, 200.0), (3, 900.0)], 50.0, 0.0)];
        assert_eq!(runs(&packed(long, 600.0, 1)), [vec![3], vec![1, 2], vec![0]]);
    }

    #[test]
    fn costly_references_are_not_repeated_and_memory_is_not_mixed() {
        let costly = vec![group(&[(0, 10.0), (1, 10.0), (2, 10.0)], 100.0, 0.0)];
        assert_eq!(runs(&packed(costly, 20.0, 8)), [vec![0, 1, 2]]);
        let mixed = vec![group(&[(0, 1.0)], 0.0, 40e9), group(&[(1, 1.0)], 0.0, 1e6)];
        let found = packed(mixed, 600.0, 1);
        assert_eq!(runs(&found), [[0], [1]]);
        assert_eq!([found[0].bytes, found[1].bytes], [61e9, 1.0015e9]);
    }
}
