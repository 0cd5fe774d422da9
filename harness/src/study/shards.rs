//! Division of a study into shares for several machines, of equal expected time.

use std::collections::{BTreeMap, BTreeSet};

use super::args::VerifyArgs;
use super::foreseen::Foreseen;
use super::plan::StudyPlan;
use super::tasks::Task;

/// Tasks that must stay in one share, with their expected time in seconds.
struct Unit {
    tasks: Vec<usize>,
    seconds: f64,
    /// Scenes and Poisson's ratios of the tasks; each such group has one reference.
    groups: BTreeSet<(usize, Option<u64>)>,
}

impl Unit {
    fn with(mut self, other: Unit) -> Unit {
        self.tasks.extend(other.tasks);
        self.seconds += other.seconds;
        self.groups.extend(other.groups);
        self
    }
}

impl StudyPlan {
    /// Tasks of the k-th of n shares. The units are assigned in descending order of time, each to the share
    /// that would finish first with it.
    pub(super) fn share(&self, args: &VerifyArgs, (k, n): (usize, usize)) -> BTreeSet<usize> {
        let foreseen = self.foreseen(args);
        let mut units = self.units(&foreseen);
        units.sort_by(|a, b| b.seconds.total_cmp(&a.seconds).then(a.tasks.cmp(&b.tasks)));
        let mut shares: Vec<Unit> =
            (0..n).map(|_| Unit { tasks: vec![], seconds: 0.0, groups: BTreeSet::new() }).collect();
        for unit in units {
            let with = |share: &Unit| {
                let new = unit.groups.difference(&share.groups);
                let references = new.map(|group| self.reference_seconds(group.0, &foreseen));
                share.seconds + unit.seconds + references.sum::<f64>()
            };
            let seconds: Vec<f64> = shares.iter().map(with).collect();
            let first = (0..n).min_by(|&a, &b| seconds[a].total_cmp(&seconds[b])).unwrap_or(0);
            shares[first].seconds = seconds[first];
            shares[first].tasks.extend(unit.tasks);
            shares[first].groups.extend(unit.groups);
        }
        shares.swap_remove(k - 1).tasks.into_iter().collect()
    }

    /// Units of tasks that must stay together. Checks of orders and of clouds need all runs of a run table
    /// with the same method and Poisson's ratio. Families with a common run also stay together.
    fn units(&self, foreseen: &Foreseen) -> Vec<Unit> {
        let mut units: Vec<Option<Unit>> = Vec::new();
        let mut of_family: BTreeMap<Family, usize> = BTreeMap::new();
        for (index, task) in self.tasks.iter().enumerate() {
            let seconds = foreseen.of(index);
            let ratio = task.poisson.map(f64::to_bits);
            let sampled = self.is_apart(task);
            let mut unit =
                Unit { tasks: vec![index], seconds, groups: BTreeSet::from([(task.scene, ratio)]) };
            let known: BTreeSet<usize> =
                families(task, sampled).filter_map(|family| of_family.get(&family).copied()).collect();
            let at = known.first().copied().unwrap_or(units.len());
            for other in known.iter().rev().filter_map(|&at| units[at].take()) {
                unit = other.with(unit);
            }
            match known.len() {
                0 => units.push(Some(unit)),
                1 => units[at] = Some(unit),
                _ => {
                    // All families of the merged units now refer to this unit.
                    let all = unit.tasks.iter().flat_map(|&task| families(&self.tasks[task], false));
                    of_family.extend(all.map(|family| (family, at)));
                    units[at] = Some(unit);
                }
            }
            of_family.extend(families(task, sampled).map(|family| (family, at)));
        }
        units.into_iter().flatten().collect()
    }
}

/// Run table, method and Poisson's ratio.
type Family<'a> = (usize, &'a str, Option<u64>);

/// Families of a task. A sample of uncertain inputs has none: its statistics are made when all shares are
/// merged. A fit has none either.
fn families(task: &Task, sampled: bool) -> impl Iterator<Item = Family<'_>> {
    let ratio = task.poisson.map(f64::to_bits);
    let runs = if sampled { &[][..] } else { &task.runs[..] };
    runs.iter().map(move |&run| (run, task.method.id.as_str(), ratio))
}
