//! The runs that a study's tables request, each of them once.

use std::collections::HashMap;

use cases::scene::{self, Scene, Size};

/// Run of a study.
pub(super) struct Task {
    /// Indices of the run tables that request this run. The run is made once, even for several tables.
    pub(super) runs: Vec<usize>,
    pub(super) scene: usize,
    pub(super) method: scene::Method,
    pub(super) level: u32,
    pub(super) poisson: Option<f64>,
    pub(super) picture: bool,
    /// Rule of a second integration, if one of the tables requests it.
    pub(super) split: Option<scene::Integration>,
}

/// Indices of runs by scene, Poisson's ratio and method. Comparing each run with all others takes minutes for
/// 50,000 runs.
pub(super) type Known = HashMap<(usize, String), Vec<usize>>;

/// Lists the runs of one table: all combinations of methods, levels (or node counts), kernels, support
/// scales, essential conditions, seeds, solvers and Poisson's ratios.
pub(super) fn list(
    tasks: &mut Vec<Task>,
    known: &mut Known,
    index: usize,
    at: usize,
    run: &scene::Run,
    scene: &Scene,
) {
    let ratios: Vec<Option<f64>> =
        if run.poisson.is_empty() { vec![None] } else { run.poisson.iter().copied().map(Some).collect() };
    // Pictures are made of organs only, and not for every kernel or seed. A picture of a box would show
    // nothing.
    let organ = matches!(scene.body, scene::Body::Kidney { .. } | scene::Body::File(_));
    let plain = run.kernels.is_empty()
        && run.support_scales.is_empty()
        && run.nodes.is_empty()
        && run.essentials.is_empty();
    let picture = organ && plain && run.seeds == 0;
    // The scene's own Poisson's ratio makes one run, whether the table names it or not.
    let own = scene.material.constant("poisson");
    let own_ratio = |poisson: Option<f64>| poisson.or(own);
    for &poisson in &ratios {
        for method in run.chosen(scene) {
            for (level, sized) in sizes(run, method) {
                let shaped = kernels(run, sized).into_iter().flat_map(|method| support_scales(run, method));
                let held = shaped.flat_map(|method| essentials(run, method));
                let placed = held.flat_map(|method| seeds(run, method));
                for method in placed.flat_map(|method| solvers(run, method)) {
                    // A run may occur in several tables, such as a level both alone and among other levels,
                    // or a cloud among clouds.
                    let places =
                        known.entry((at, format!("{:?} {method:?}", own_ratio(poisson)))).or_default();
                    let fits = |t: &Task| run.split.is_none() || t.split.is_none() || run.split == t.split;
                    match places.iter().copied().find(|&place| fits(&tasks[place])) {
                        Some(place) => {
                            let task = &mut tasks[place];
                            task.runs.push(index);
                            task.split = task.split.or(run.split);
                            task.picture |= picture;
                        }
                        None => {
                            places.push(tasks.len());
                            tasks.push(Task {
                                runs: vec![index],
                                scene: at,
                                method,
                                level,
                                poisson,
                                picture,
                                split: run.split,
                            });
                        }
                    }
                }
            }
        }
    }
}

/// Returns the method at each level or node count of the run table; unchanged if the table has none.
fn sizes(run: &scene::Run, method: &scene::Method) -> Vec<(u32, scene::Method)> {
    let sized = |size: Size| {
        let mut method = method.clone();
        method.resize(&size);
        method
    };
    if !run.levels.is_empty() {
        return run.levels.iter().map(|&level| (level, sized(Size::Level(level)))).collect();
    }
    if method.is_cloud() && !run.nodes.is_empty() {
        return run.nodes.iter().map(|&nodes| (0, sized(Size::Nodes(nodes)))).collect();
    }
    vec![(own_level(method), method.clone())]
}

fn own_level(method: &scene::Method) -> u32 {
    match method.size() {
        Some(Size::Level(level)) => *level,
        _ => 0,
    }
}

/// Returns the method with each kernel of the run table.
fn kernels(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    each(&run.kernels, method, |kernel, _, &name| {
        *kernel = name;
    })
}

/// Returns the method with each support scale of the run table.
fn support_scales(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    each(&run.support_scales, method, |_, support, &factor| *support = scene::SupportRule::Scale(factor))
}

/// Returns the method with each treatment of essential conditions in the run table.
fn essentials(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    if run.essentials.is_empty() || !method.is_cloud() {
        return vec![method];
    }
    let held = |&essential: &scene::Essential| {
        let mut method = method.clone();
        if let scene::Family::Efg(efg) = &mut method.family {
            efg.essential = essential;
        }
        method
    };
    run.essentials.iter().map(held).collect()
}

/// Returns a moving-least-squares method changed by each of `values`. Without values, or for another kind of
/// method, it returns the method unchanged.
fn each<T>(
    values: &[T],
    method: scene::Method,
    change: impl Fn(&mut efg::Kernel, &mut scene::SupportRule, &T),
) -> Vec<scene::Method> {
    let with = |value: &T| {
        let mut method = method.clone();
        let scene::Family::Efg(efg) = &mut method.family else { return None };
        let scene::Functions::MovingLeastSquares { kernel, support, .. } = &mut efg.functions else {
            return None;
        };
        change(kernel, support, value);
        Some(method)
    };
    let changed: Vec<scene::Method> = values.iter().filter_map(with).collect();
    if changed.is_empty() { vec![method] } else { changed }
}

/// Returns the method on a cloud of each seed of the run table.
fn seeds(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    match run.seeds {
        0 => vec![method],
        count => (1..=count).filter_map(|seed| method.seeded(seed)).collect(),
    }
}

/// Returns the method, followed by the same method with each external solver of the run table. Running them
/// in succession compares them under the same machine load.
fn solvers(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    let others: Vec<_> = run.adapters.iter().filter_map(|adapter| method.solved_by(adapter)).collect();
    std::iter::once(method).chain(others).collect()
}
