//! The runs of a study by name, before they are made.

use std::collections::BTreeMap;
use std::path::Path;

use cases::scene::{self, Cloud, Family, Functions, Size, SupportRule};
use reports::Record;

use super::Plan;
use super::tasks::Task;
use crate::run::{Group, Repeats, case_name};

/// A run that would be made.
pub struct Planned {
    /// Its case.
    pub case: String,
    /// The method, with what the study changes of it.
    pub name: String,
    /// About how many nodes it has; nothing where they are in a file.
    pub nodes: Option<f64>,
    /// What a pass over it took in the results that are there, s.
    pub seconds: Option<f64>,
}

impl Plan {
    /// The runs in their order. Their times are those of earlier results in `out`, if there are any.
    pub fn planned(&self, out: &Path) -> Vec<Planned> {
        let before = reports::read_run(out).map_or(BTreeMap::new(), |run| totals(&run.records));
        self.tasks.iter().map(|task| self.one(task, &before)).collect()
    }

    fn one(&self, task: &Task, before: &BTreeMap<(String, String, u32), f64>) -> Planned {
        let scene = &self.scenes[task.scene].2;
        let case = case_name(scene);
        let group = Group::unreferenced(scene, Repeats::ONCE).ok();
        let nodes = group.map(|group| group.scenario(task.method.clone(), task.level).expected_nodes());
        let key = (case.clone(), task.method.id.clone(), task.level);
        let varied = scene.varied.as_ref().map(|(axis, value)| format!(" {axis}={value}"));
        let name = name(task, self.tables(task)) + &varied.unwrap_or_default();
        Planned { name, nodes: nodes.filter(|n| *n > 0.0), seconds: before.get(&key).copied(), case }
    }
}

/// Mean of the total times of the runs of a method at a level: what a study varies else hardly changes them.
fn totals(records: &[Record]) -> BTreeMap<(String, String, u32), f64> {
    let mut sums: BTreeMap<_, (f64, f64)> = BTreeMap::new();
    let total = |r: &&Record| r.quantity == "time" && r.phase == "total" && r.statistic == "median";
    for record in records.iter().filter(total) {
        let sum = sums.entry((record.case.clone(), record.method.clone(), record.level)).or_default();
        *sum = (sum.0 + record.value, sum.1 + 1.0);
    }
    sums.into_iter().map(|(key, (sum, count))| (key, sum / count)).collect()
}

/// The method's id with what the tables vary.
fn name<'a>(task: &Task, tables: impl Iterator<Item = &'a scene::Run>) -> String {
    let mut name = task.method.id.clone();
    if task.level > 0 {
        name += &format!(" level {}", task.level);
    }
    if let Some(poisson) = task.poisson {
        name += &format!(" nu={poisson}");
    }
    let Family::Efg(efg) = &task.method.family else { return name };
    let (nodes, seed) = match &efg.cloud {
        Cloud::Mesh { size: Size::Nodes(nodes), jitter } => (Some(*nodes), jitter.map(|j| j.seed)),
        Cloud::Mesh { jitter, .. } => (None, jitter.map(|j| j.seed)),
        Cloud::Uniform { nodes, seed }
        | Cloud::Refined { nodes, seed, .. }
        | Cloud::Graded { nodes, seed, .. } => (Some(*nodes), Some(*seed)),
        Cloud::File { nodes, .. } => (*nodes, None),
    };
    let (mut kernels, mut scales, mut essentials, mut counts, mut seeds) =
        (false, false, false, false, false);
    for run in tables {
        kernels |= !run.kernels.is_empty();
        scales |= !run.support_scales.is_empty();
        essentials |= !run.essentials.is_empty();
        counts |= !run.nodes.is_empty();
        seeds |= run.seeds > 0;
    }
    if let (true, Some(nodes)) = (counts, nodes) {
        name += &format!(" {nodes} nodes");
    }
    if let Functions::MovingLeastSquares { kernel, support, .. } = &efg.functions {
        if kernels {
            name += &format!(" {}", kernel.name());
        }
        if let (true, SupportRule::Scale(scale)) = (scales, support) {
            name += &format!(" scale {scale}");
        }
    }
    if essentials {
        name += &format!(" {}", efg.essential.kind().name());
    }
    if let (true, Some(seed)) = (seeds, seed) {
        name += &format!(" seed {seed}");
    }
    name
}
