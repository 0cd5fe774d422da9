//! The sizes of each approach, from coarse to fine.

use std::collections::VecDeque;

use cases::scene::{Cloud, Family, Fem, Method, Scene, Size};

use crate::scenario::estimate;

/// Number of nodes of the coarsest size of a method with a single size in the scene, and number of sizes.
/// Each size has twice the nodes of the one before.
const COARSEST: usize = 100;
const SIZES: u32 = 12;

/// One approach in several sizes, from coarse to fine.
pub(super) struct Ladder {
    rungs: VecDeque<Method>,
    /// Whether the sizes are chosen here instead of in the scene. A size that cannot be made then ends the
    /// ladder.
    pub ours: bool,
    /// Number of nodes and time, s, of the last run.
    pub last: Option<(u64, f64)>,
}

impl Ladder {
    /// Removes and returns the next size.
    pub fn next(&mut self) -> Option<Method> {
        self.rungs.pop_front()
    }

    /// Returns the estimated time of the next size, s, scaled from the last run if there is one.
    pub fn foreseen(&self, scene: &Scene) -> Option<f64> {
        let next = estimate(scene, &self.rungs.front()?.family);
        Some(match self.last {
            Some((nodes, seconds)) if nodes > 0 => seconds * (next.nodes / nodes as f64).max(1.0).powf(1.3),
            _ => next.seconds,
        })
    }
}

/// Returns the ladders of a scene's methods. Methods of one series are the sizes of one ladder. A single
/// method is run in sizes chosen here, unless it has a mesh file or its own background mesh.
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

/// Whether a method can run with any number of nodes.
fn has_any_size(method: &Method) -> bool {
    let free = |size: &Size| !matches!(size, Size::File(_));
    let of_elements = |fem: &Fem| free(&fem.size);
    match &method.family {
        Family::Fem(fem) => of_elements(fem),
        Family::External(external) => of_elements(&external.elements),
        Family::Efg(efg) => match &efg.cloud {
            _ if efg.background.is_some() => false,
            Cloud::Mesh { size, .. } => free(size),
            Cloud::Uniform { .. } | Cloud::Graded { .. } | Cloud::Refined { .. } => true,
            Cloud::File { .. } => false,
        },
    }
}
