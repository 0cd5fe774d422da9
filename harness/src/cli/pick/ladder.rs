//! The sizes of each approach, from coarse to fine.

use std::collections::VecDeque;

use cases::scene::{Cloud, Family, Fem, Method, Scene, Size};

use crate::scenario::estimate;

/// Nodes of the coarsest size of a method whose scene gives one size alone, and sizes at most, each with twice the nodes.
const COARSEST: usize = 100;
const SIZES: u32 = 12;

/// One approach in several sizes.
pub(super) struct Ladder {
    rungs: VecDeque<Method>,
    /// Whether a rung that cannot be made ends it: sizes of ours, not of the scene.
    pub ours: bool,
    /// Nodes and seconds of the last run.
    pub last: Option<(u64, f64)>,
}

impl Ladder {
    /// The next size.
    pub fn next(&mut self) -> Option<Method> {
        self.rungs.pop_front()
    }

    /// What the next size is expected to take, s: by what the last one took, or by an estimate.
    pub fn foreseen(&self, scene: &Scene) -> Option<f64> {
        let next = estimate(scene, &self.rungs.front()?.family);
        Some(match self.last {
            Some((nodes, seconds)) if nodes > 0 => seconds * (next.nodes / nodes as f64).max(1.0).powf(1.3),
            _ => next.seconds,
        })
    }
}

/// The ladders of a scene's methods: those of one series are its sizes; one alone is run in sizes of ours, unless it is bound to a file
/// or a background of its own.
pub(super) fn ladders(scene: &Scene, chosen: &[usize]) -> Vec<Ladder> {
    let mut series: Vec<(&str, Vec<&Method>)> = Vec::new();
    for method in chosen.iter().map(|&index| &scene.methods[index]) {
        match series.iter_mut().find(|(name, _)| *name == method.series) {
            Some((_, methods)) => methods.push(method),
            None => series.push((&method.series, vec![method])),
        }
    }
    let each = series.into_iter().map(|(_, mut methods)| {
        methods.sort_by(|a, b| nodes(scene, a).total_cmp(&nodes(scene, b)));
        let ours = methods.len() == 1 && has_any_size(methods[0]);
        let sizes = |method: &Method| -> VecDeque<Method> {
            let of = |k| {
                let mut method = method.clone();
                method.resize(&Size::Nodes(COARSEST << k));
                method
            };
            (0..SIZES).map(of).collect()
        };
        let rungs = if ours { sizes(methods[0]) } else { methods.into_iter().cloned().collect() };
        Ladder { rungs, ours, last: None }
    });
    each.collect()
}

fn nodes(scene: &Scene, method: &Method) -> f64 {
    estimate(scene, &method.family).nodes
}

/// Whether a method runs in any number of nodes.
fn has_any_size(method: &Method) -> bool {
    let free = |size: &Size| !matches!(size, Size::File(_));
    let of_elements = |fem: &Fem| free(&fem.size);
    match &method.family {
        Family::Fem(fem) => of_elements(fem),
        Family::External(external) => of_elements(&external.elements),
        Family::OverMesh(over) => free(&over.size),
        Family::Efg(efg) => match &efg.cloud {
            _ if efg.background.is_some() => false,
            Cloud::Mesh { size, .. } => free(size),
            Cloud::Uniform { .. } | Cloud::Graded { .. } | Cloud::Refined { .. } => true,
            Cloud::File { .. } => false,
        },
    }
}
