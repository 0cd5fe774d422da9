//! The runs of a study by name, before they are made.

use cases::scene::{self, Cloud, Family, Functions, Size, SupportRule};

use super::Plan;
use super::tasks::Task;
use crate::run::case_name;
use crate::scenario::{Estimate, estimate};

/// A run that would be made.
pub struct Planned {
    /// Its case.
    pub case: String,
    /// The method, with what the study changes of it.
    pub name: String,
    /// What it is about to take.
    pub(crate) takes: Estimate,
}

impl Plan {
    /// The runs in their order.
    pub fn planned(&self) -> Vec<Planned> {
        self.tasks.iter().map(|task| self.one(task)).collect()
    }

    fn one(&self, task: &Task) -> Planned {
        let scene = &self.scenes[task.scene].2;
        let varied = scene.varied.as_ref().map(|(axis, value)| format!(" {axis}={value}"));
        let name = name(task, self.tables(task)) + &varied.unwrap_or_default();
        Planned { case: case_name(scene), name, takes: estimate(scene, &task.method.family) }
    }
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
