//! List of a study's runs before they are made.

use std::collections::BTreeSet;

use cases::scene::{self, Cloud, Family, Functions, Size, SupportRule};

use super::args::VerifyArgs;
use super::plan::StudyPlan;
use super::tasks::Task;
use crate::run::case_name;
use crate::scenario::{Estimate, estimate};

/// Planned run.
pub struct Planned {
    /// Name of the case.
    pub case: String,
    /// Method id with the settings that the study varies.
    pub name: String,
    /// Expected cost with all of its repeats.
    pub(crate) takes: Estimate,
    /// Whether the time is a stored measurement.
    pub(crate) stored: bool,
}

impl StudyPlan {
    /// Planned runs in the order of the study.
    pub fn planned(&self, args: &VerifyArgs) -> Vec<Planned> {
        let foreseen = self.foreseen(args);
        let mut referenced = BTreeSet::new();
        let each = self.tasks.iter().enumerate().map(|(index, task)| {
            let mut planned = self.one(task, foreseen.of(index), foreseen.is_stored(index));
            // The reference is solved before the first run of a scene.
            if referenced.insert((task.scene, task.poisson.map(f64::to_bits))) {
                planned.takes.seconds += self.reference_seconds(task.scene, &foreseen);
            }
            planned
        });
        each.collect()
    }

    fn one(&self, task: &Task, seconds: f64, stored: bool) -> Planned {
        let scene = &self.scenes[task.scene].2;
        let varied = scene.varied.as_ref().map(|(axis, value)| format!(" {axis}={value}"));
        let name = name(task, self.tables(task)) + &varied.unwrap_or_default();
        Planned {
            case: case_name(scene),
            name,
            takes: Estimate { seconds, ..estimate(scene, &task.method.family) },
            stored,
        }
    }
}

/// Method id with the settings that the run tables vary.
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
