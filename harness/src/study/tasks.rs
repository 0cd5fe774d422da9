//! The runs that a study's tables request, each of them once.

use std::collections::HashMap;

use cases::scene::{self, Cloud, Scene, Size};

use crate::scenario::method_identity;

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

/// Indices of runs by scene, bits of Poisson's ratio and [`named`]. Comparing each run with all others takes
/// minutes for 50,000 runs.
pub(super) type Known = HashMap<(usize, Option<u64>, String), Vec<usize>>;

/// Names a method of a scene with everything that a run table can change: size, seed, kernel, support scale,
/// essential conditions and solver.
pub(super) fn named(method: &scene::Method) -> String {
    let identity = method_identity(method);
    let mut name = format!("{}, {}, seed {}", method.id, identity.variant, identity.seed);
    match method.size() {
        Some(Size::Level(level)) => name += &format!(", level {level}"),
        Some(Size::Nodes(nodes)) => name += &format!(", {nodes} nodes"),
        // A run table gives no other sizes, so this is the size in the scene.
        _ => {}
    }
    if let scene::Family::Efg(scene::Efg { cloud, .. }) = &method.family
        && let Cloud::Uniform { nodes, .. } | Cloud::Graded { nodes, .. } | Cloud::Refined { nodes, .. } =
            cloud
    {
        name += &format!(", cloud of {nodes} nodes");
    }
    // A kernel of the scene may have other parameters than the same kernel of a run table.
    if let scene::Family::Efg(efg) = &method.family {
        name += &format!(", {:?}", efg.functions);
    }
    identity.settings().iter().for_each(|(setting, value)| name += &format!(", {setting} {value}"));
    name
}

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
    let plain = run.kernels.is_empty()
        && run.support_scales.is_empty()
        && run.nodes.is_empty()
        && run.essentials.is_empty();
    // A picture of every kernel or seed would show the same body many times.
    let picture = scene.output.pictures && plain && run.seeds == 0;
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
                    let which = (at, own_ratio(poisson).map(f64::to_bits), named(&method));
                    let places = known.entry(which).or_default();
                    let fits = |t: &Task| {
                        t.method == method
                            && (run.split.is_none() || t.split.is_none() || run.split == t.split)
                    };
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use cases::scene;

    use crate::study::args::VerifyArgs;
    use crate::study::plan::StudyPlan;

    /// A resumed study would take the result of one run for the result of another.
    #[test]
    fn the_key_of_a_run_has_everything_that_a_run_table_changes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study.toml");
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/scenes/first.toml");
        let text = format!(
            "title = \"variations\"\n\
             [[run]]\nscene = {scene:?}\nmethods = [\"tet10\"]\nlevels = [1, 2]\npoisson = [0.3, 0.4]\n\
             [[run]]\nscene = {scene:?}\nmethods = [\"efg\"]\nnodes = [200, 300]\n\
             kernels = [\"cubic-spline\", \"wendland-c2\"]\nsupport_scales = [1.6, 2.0]\n\
             essentials = [\"nitsche\", \"multipliers\"]\nseeds = 2\n"
        );
        std::fs::write(&path, text).unwrap();
        let plan = StudyPlan::new(scene::load_study(&path).unwrap()).unwrap();
        assert_eq!(plan.len(), 2 * 2 + 2_usize.pow(5));
        let args = VerifyArgs::of(&path);
        let keys: BTreeSet<String> = (0..plan.len()).map(|index| plan.key(index, &args)).collect();
        assert_eq!(keys.len(), plan.len());
    }

    /// A kernel of the scene has its own parameter, and a split its own spacing.
    #[test]
    fn the_key_of_a_run_has_what_its_name_leaves_out() {
        let folder = tempfile::tempdir().unwrap();
        let scene = include_str!("../../../cases/scenes/first.toml");
        let scene = scene.replace("\"cubic-spline\"", "{ name = \"gaussian\", alpha = 0.3 }");
        std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
        let path = folder.path().join("study.toml");
        let keys = |tables: &str| {
            let text = format!("title = \"parameters\"\n{tables}");
            std::fs::write(&path, text).unwrap();
            let plan = StudyPlan::new(scene::load_study(&path).unwrap()).unwrap();
            let args = VerifyArgs::of(&path);
            (0..plan.len()).map(|index| plan.key(index, &args)).collect::<BTreeSet<String>>()
        };
        let table = |more: &str| format!("[[run]]\nscene = \"scene.toml\"\nmethods = [\"efg\"]\n{more}\n");
        let kernels = [table(""), table("kernels = [\"gaussian\"]")].concat();
        assert_eq!(keys(&kernels).len(), 2);
        let split = |spacing: &str| {
            table(&format!("split = {{ rule = \"grid\", points = 8, spacing = \"{spacing}\" }}"))
        };
        assert_eq!(keys(&[split("2 mm"), split("3 mm")].concat()).len(), 2);
        assert!(keys(&split("2 mm")).is_disjoint(&keys(&split("3 mm"))));
    }
}
