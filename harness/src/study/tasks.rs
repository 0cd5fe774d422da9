//! The runs that a study's tables ask for, each of them once.

use std::collections::HashMap;

use cases::scene::{self, Scene, Size};

/// One run of a study.
pub(super) struct Task {
    /// Indices of the study's run tables that ask for it, which may be several: it is run once.
    pub(super) runs: Vec<usize>,
    pub(super) scene: usize,
    pub(super) method: scene::Method,
    pub(super) level: u32,
    pub(super) poisson: Option<f64>,
    pub(super) picture: bool,
    /// Rule of a second integration, where one of the tables asks for it.
    pub(super) split: Option<scene::Integration>,
}

/// Places of runs by scene, Poisson's ratio and method: to compare each with all others takes minutes for 50,000.
pub(super) type Known = HashMap<(usize, String), Vec<usize>>;

/// Lists the runs of one table: methods, times levels (or node counts), times kernels, times support scales, times essential
/// conditions, times seeds, times solvers, times Poisson's ratios.
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
    // A picture of an organ says something; one of a box does not, nor does one for each kernel or seed.
    let organ = matches!(scene.body, scene::Body::Kidney { .. } | scene::Body::File(_));
    let plain = run.kernels.is_empty()
        && run.support_scales.is_empty()
        && run.nodes.is_empty()
        && run.essentials.is_empty();
    let picture = organ && plain && run.seeds == 0;
    // The scene's own ratio, named or not, makes one run.
    let own = scene.material.constant("poisson");
    let own_ratio = |poisson: Option<f64>| poisson.or(own);
    for &poisson in &ratios {
        for method in run.chosen(scene) {
            for (level, sized) in sizes(run, method) {
                let shaped = kernels(run, sized).into_iter().flat_map(|method| support_scales(run, method));
                let held = shaped.flat_map(|method| essentials(run, method));
                let placed = held.flat_map(|method| seeds(run, method));
                for method in placed.flat_map(|method| solvers(run, method)) {
                    // One run may be in several tables: a level among levels and alone, a cloud among clouds.
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

/// The method at each level or node count that the run table names; as it is where it names none.
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

/// The method with each kernel that the run table names.
fn kernels(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    each(&run.kernels, method, |kernel, _, &name| {
        *kernel = name;
    })
}

/// The method with each support scale that the run table names.
fn support_scales(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    each(&run.support_scales, method, |_, support, &factor| *support = scene::SupportRule::Scale(factor))
}

/// The method held in each of the ways that the run table names.
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

/// Moving least squares changed by each of `values`; the method as it is where there are none, or where it is of another kind.
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

/// The method on a cloud of each seed that the run table names.
fn seeds(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    match run.seeds {
        0 => vec![method],
        count => (1..=count).filter_map(|seed| method.seeded(seed)).collect(),
    }
}

/// The method, and behind it the same by each solver outside this program that the run table names: both see the machine alike.
fn solvers(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    let others: Vec<_> = run.adapters.iter().filter_map(|adapter| method.solved_by(adapter)).collect();
    std::iter::once(method).chain(others).collect()
}
