//! A study: many scenes and methods, run in a fixed order, checked, written out.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use cases::scene::{self, Check, Scene, Size, Study};
use indicatif::{ProgressBar, ProgressStyle};
use reports::{Check as Verdict, Record, RunSet, SurfaceField};

use crate::cli::VerifyArgs;
use crate::group::{Extras, Group, case_name, resize};
use crate::run::Repeats;
use crate::stored::Stored;
use crate::task::{self, TaskResult};
use crate::work::Work;
use crate::{Failure, check};

/// Repeats of the timed part in a study: medians of five where a run is short, one where it is long.
const REPEATS: Repeats = Repeats { most: 5, seconds: 0.4 };
/// Repeats in the quick tier, whose purpose is the checks: medians of three for runs below 20 ms.
const QUICK: Repeats = Repeats { most: 3, seconds: 0.05 };

/// One run of a study.
struct Task {
    /// Index of the study's run table it belongs to.
    run: usize,
    scene: usize,
    method: scene::Method,
    level: u32,
    poisson: Option<f64>,
    picture: bool,
}

/// A study with its scenes read.
pub struct Plan {
    study: Study,
    scenes: Vec<(PathBuf, String, Scene)>,
    tasks: Vec<Task>,
}

/// What a study came to.
pub struct Finished {
    /// Everything to be written.
    pub set: RunSet,
    /// Exit codes of runs that failed.
    pub failed: Vec<u8>,
    /// Runs done.
    pub ran: usize,
    /// Work done now, references included; stored runs took none.
    pub work: Work,
}

impl Plan {
    /// Reads the scenes of a study and lists its runs.
    pub fn new(study: Study) -> Result<Plan, Vec<scene::SceneError>> {
        let mut scenes: Vec<(PathBuf, String, Scene)> = Vec::new();
        let mut tasks = Vec::new();
        let mut errors = Vec::new();
        for (index, run) in study.runs.iter().enumerate() {
            let known = scenes.iter().position(|(path, ..)| *path == run.scene);
            let at = match known {
                Some(at) => at,
                None => match scene::load(&run.scene) {
                    Ok(scene) if !scene.unavailable().is_empty() => {
                        errors.extend(scene.unavailable());
                        continue;
                    }
                    Ok(scene) => {
                        let text = std::fs::read_to_string(&run.scene).unwrap_or_default();
                        scenes.push((run.scene.clone(), text, scene));
                        scenes.len() - 1
                    }
                    Err(bad) => {
                        errors.extend(bad);
                        continue;
                    }
                },
            };
            list(&mut tasks, index, at, run, &scenes[at].2);
        }
        if errors.is_empty() { Ok(Plan { study, scenes, tasks }) } else { Err(errors) }
    }

    /// Keeps the runs that the arguments select.
    pub fn select(&mut self, args: &VerifyArgs) {
        let (runs, scenes) = (&self.study.runs, &self.scenes);
        self.tasks.retain(|task| {
            let wanted = (!args.quick || runs[task.run].quick)
                && args.filter.as_deref().is_none_or(|text| {
                    case_name(&scenes[task.scene].2).contains(text) || task.method.id.contains(text)
                });
            // Shares deal out whole run tables, so that orders see all their levels.
            let mine = args.shard.is_none_or(|(k, n)| task.run % n == k - 1);
            wanted && mine
        });
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.tasks.len()
    }

    /// Whether nothing is to be run.
    pub fn is_empty(&self) -> bool {
        self.tasks.is_empty()
    }

    /// Runs everything. Results come in the order of the study, whatever the number of jobs.
    pub fn execute(&self, args: &VerifyArgs) -> Finished {
        let store = args.out.join("tasks");
        let program = task::program();
        let bar = progress(self.tasks.len());
        let groups = self.groups();
        let next = AtomicUsize::new(0);
        let done: Mutex<BTreeMap<usize, TaskResult>> = Mutex::new(BTreeMap::new());
        std::thread::scope(|scope| {
            for _ in 0..args.jobs {
                scope.spawn(|| {
                    while let Some(members) = groups.get(next.fetch_add(1, Ordering::Relaxed)) {
                        self.group(members, args, &store, &program, &bar, &done);
                    }
                });
            }
        });
        bar.finish_and_clear();
        self.collect(done.into_inner().expect("no worker panicked"))
    }

    /// Indices of tasks that share scene and Poisson's ratio, in order of their first.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for (index, task) in self.tasks.iter().enumerate() {
            let same = |other: &Task| other.scene == task.scene && other.poisson == task.poisson;
            match groups.iter_mut().find(|g| same(&self.tasks[g[0]])) {
                Some(group) => group.push(index),
                None => groups.push(vec![index]),
            }
        }
        groups
    }

    fn group(
        &self,
        members: &[usize],
        args: &VerifyArgs,
        store: &Path,
        program: &str,
        bar: &ProgressBar,
        done: &Mutex<BTreeMap<usize, TaskResult>>,
    ) {
        let first = &self.tasks[members[0]];
        let (_, text, scene) = &self.scenes[first.scene];
        let case = case_name(scene);
        // Made when first needed: with all members stored, not even the reference is run.
        let mut group: Option<Result<Group, Failure>> = None;
        for &index in members {
            let task = &self.tasks[index];
            bar.set_message(format!("{case} {}", task.method.id));
            let split = self.study.runs[task.run].split;
            let what =
                format!("{:?} {} {:?} {} {split:?}", task.method, task.level, task.poisson, task.picture);
            let key = task::key(program, text, &files(scene), &what);
            let stored = if args.resume { TaskResult::load(store, &key) } else { None };
            let known = stored.is_some();
            let result = stored.unwrap_or_else(|| {
                let mut shared = Work::default();
                let group = group.get_or_insert_with(|| {
                    let group = Group::new(scene, task.poisson, if args.quick { QUICK } else { REPEATS });
                    shared = group.as_ref().map_or(shared, Group::reference_work);
                    group
                });
                let outcome = match group {
                    Ok(group) => {
                        // Clouds of many seeds are of one kind: one loop is enough for them all.
                        let frames = !args.quick && self.study.runs[task.run].seeds == 0;
                        let extras = Extras { picture: task.picture, frames, split };
                        group.run(&group.scenario(task.method.clone(), task.level), extras)
                    }
                    Err(failure) => Err(failure.clone().into()),
                };
                let mut result = match outcome {
                    Ok(outcome) => TaskResult::finished(&outcome),
                    Err(unfinished) => TaskResult::failed(&case, &task.method.id, &unfinished.failure),
                };
                result.work += shared;
                if let (Ok(Some(stalled)), None) =
                    (group.as_ref().map(Group::reference_stalled), &result.failure)
                {
                    let reason = format!("reference stalled: {stalled}");
                    let run = reports::Failure { case: case.clone(), method: task.method.id.clone(), reason };
                    result.failure = Some((run, stalled.exit_code()));
                }
                result
            });
            if !known && let Err(bad) = result.store(store, &key) {
                bar.println(format!("warning: {} could not be stored: {bad}", store.display()));
            }
            done.lock().expect("no worker panicked").insert(index, result);
            bar.inc(1);
        }
    }

    fn collect(&self, results: BTreeMap<usize, TaskResult>) -> Finished {
        let mut set = RunSet::default();
        let mut failed = Vec::new();
        let mut work = Work::default();
        for (&index, result) in &results {
            let task = &self.tasks[index];
            work += result.work;
            set.records.extend(result.records.iter().cloned());
            set.plans.extend(result.plans.iter().cloned());
            for field in &result.fields {
                // Of a method at several sizes the finest is shown.
                let same =
                    |other: &&mut SurfaceField| other.case == field.case && other.method == field.method;
                match set.fields.iter_mut().find(same) {
                    Some(other) if other.points.len() >= field.points.len() => {}
                    Some(other) => *other = field.clone(),
                    None => set.fields.push(field.clone()),
                }
            }
            let verdicts = self.verdicts(task, result);
            if let Some((failure, code)) = &result.failure {
                set.failures.push(failure.clone());
                // Of many clouds one may stall: how many did is a result. One without any numbers is in no count. So is
                // a path known to end where it does.
                let counted = self.study.runs[task.run].seeds > 0 && !result.records.is_empty();
                let known =
                    |v: &Verdict| v.metric == "load-carried" && v.status == reports::Status::KnownFailure;
                if !counted && !verdicts.iter().any(known) {
                    failed.push(*code);
                }
            }
            set.checks.extend(verdicts);
        }
        for (_, _, scene) in &self.scenes {
            set.records.extend(reference_records(scene));
        }
        set.checks.extend(self.family_verdicts(&results));
        let texts: Vec<(String, String)> =
            self.scenes.iter().map(|(_, text, scene)| (case_name(scene), text.clone())).collect();
        set.provenance = crate::provenance::provenance(&texts, 0);
        Finished { set, failed, ran: results.len(), work }
    }

    /// Checks of one run: the scene's own (of its own cloud) and those of the study's run table.
    fn verdicts(&self, task: &Task, result: &TaskResult) -> Vec<Verdict> {
        let scene = &self.scenes[task.scene].2;
        let label = label(task, &result.records, self.study.runs[task.run].seeds > 0);
        self.checks(task)
            .filter(|check| !check::needs_levels(check))
            .map(|check| {
                let value = check::value(check.metric.name, &result.records);
                let mut verdict = check::judge(check, &case_name(scene), &label, value);
                if let (None, Some((failure, _))) = (value, &result.failure) {
                    verdict.reason = failure.reason.clone();
                }
                verdict
            })
            .collect()
    }

    fn checks<'a>(&'a self, task: &'a Task) -> impl Iterator<Item = &'a Check> {
        let scene = &self.scenes[task.scene].2;
        let run = &self.study.runs[task.run];
        // A scene's checks are of its own cloud.
        let own = if run.seeds == 0 { &scene.checks[..] } else { &[] };
        let all = own.iter().chain(&run.checks);
        all.filter(|c| c.methods.is_empty() || c.methods.contains(&task.method.id))
    }

    /// Checks of orders: once for each method and Poisson's ratio of a run table.
    fn family_verdicts(&self, results: &BTreeMap<usize, TaskResult>) -> Vec<Verdict> {
        let mut verdicts = Vec::new();
        let mut seen: Vec<(usize, &str, Option<u64>)> = Vec::new();
        for &index in results.keys() {
            let task = &self.tasks[index];
            let family = (task.run, task.method.id.as_str(), task.poisson.map(f64::to_bits));
            if seen.contains(&family) {
                continue;
            }
            seen.push(family);
            let members: Vec<&[Record]> = results
                .iter()
                .filter(|(i, _)| {
                    let t = &self.tasks[**i];
                    (t.run, t.method.id.as_str(), t.poisson.map(f64::to_bits)) == family
                })
                .map(|(_, result)| result.records.as_slice())
                .collect();
            let case = case_name(&self.scenes[task.scene].2);
            for check in self.checks(task).filter(|c| check::needs_levels(c)) {
                let value = check::order(check.metric.name, &members);
                let label = match task.poisson {
                    Some(poisson) => format!("{} nu={poisson}", task.method.id),
                    None => task.method.id.clone(),
                };
                verdicts.push(check::judge(check, &case, &label, value));
            }
        }
        verdicts
    }
}

/// The rows of a stored reference; one that can't be read has failed every method that asked for it.
pub fn reference_records(scene: &Scene) -> Vec<Record> {
    let Some(scene::Reference::Record(path)) = &scene.reference else { return Vec::new() };
    let poisson = scene.material.elastic().map_or(0.0, |e| e.poisson);
    Stored::load(scene, path).map(|s| s.records(&case_name(scene), poisson)).unwrap_or_default()
}

/// Lists the runs of one table: methods, times levels (or node counts), times kernels, times dilatations, times essential
/// conditions, times seeds, times Poisson's ratios.
fn list(tasks: &mut Vec<Task>, index: usize, at: usize, run: &scene::Run, scene: &Scene) {
    let ratios: Vec<Option<f64>> =
        if run.poisson.is_empty() { vec![None] } else { run.poisson.iter().copied().map(Some).collect() };
    // A picture of an organ says something; one of a box does not, nor does one for each kernel or seed.
    let organ = matches!(scene.body, scene::Body::Kidney { .. } | scene::Body::File(_));
    let plain = run.kernels.is_empty()
        && run.dilatations.is_empty()
        && run.nodes.is_empty()
        && run.essentials.is_empty();
    let picture = organ && plain && run.seeds == 0;
    for &poisson in &ratios {
        for method in &scene.methods {
            if !(run.methods.is_empty() || run.methods.contains(&method.id)) {
                continue;
            }
            for (level, sized) in sizes(run, method) {
                let shaped = kernels(run, sized).into_iter().flat_map(|method| dilatations(run, method));
                let held = shaped.flat_map(|method| essentials(run, method));
                for method in held.flat_map(|method| seeds(run, method)) {
                    // The scene's own cloud may have been asked for before.
                    let same = |t: &Task| (t.scene, t.poisson) == (at, poisson) && t.method == method;
                    if run.seeds == 0 || !tasks.iter().any(same) {
                        tasks.push(Task { run: index, scene: at, method, level, poisson, picture });
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
        resize(&mut method, &size);
        method
    };
    if !run.levels.is_empty() {
        return run.levels.iter().map(|&level| (level, sized(Size::Level(level)))).collect();
    }
    if let (scene::Family::Efg(_), false) = (&method.family, run.nodes.is_empty()) {
        return run.nodes.iter().map(|&nodes| (0, sized(Size::Nodes(nodes)))).collect();
    }
    vec![(own_level(method), method.clone())]
}

fn own_level(method: &scene::Method) -> u32 {
    let size = match &method.family {
        scene::Family::Fem(fem) => &fem.size,
        scene::Family::Efg(efg) => match &efg.cloud {
            scene::Cloud::Mesh { size, .. } => size,
            scene::Cloud::Uniform { .. }
            | scene::Cloud::Graded { .. }
            | scene::Cloud::Refined { .. }
            | scene::Cloud::File { .. } => {
                return 0;
            }
        },
    };
    if let Size::Level(level) = size { *level } else { 0 }
}

/// The method with each kernel that the run table names.
fn kernels(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    each(&run.kernels, method, |kernel, _, &name| {
        *kernel = scene::Kernel { name, alpha: None, power: None, eps: None };
    })
}

/// The method with each dilatation that the run table names.
fn dilatations(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    each(&run.dilatations, method, |_, support, &factor| *support = scene::SupportRule::Dilatation(factor))
}

/// The method held in each of the ways that the run table names.
fn essentials(run: &scene::Run, method: scene::Method) -> Vec<scene::Method> {
    if run.essentials.is_empty() || !matches!(method.family, scene::Family::Efg(_)) {
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
    change: impl Fn(&mut scene::Kernel, &mut scene::SupportRule, &T),
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

/// Method id with what tells this run from others of the same id.
fn label(task: &Task, records: &[Record], seeded: bool) -> String {
    let mut text = task.method.id.clone();
    if task.level > 0 {
        text += &format!(" level {}", task.level);
    }
    if let (Some(first), 0) = (records.first(), task.level) {
        text += &format!(" {} {} nodes", first.variant, first.nodes);
    }
    if let Some(poisson) = task.poisson {
        text += &format!(" nu={poisson}");
    }
    if seeded {
        text += &format!(" seed={}", records.first().map_or(0, |r| r.seed));
    }
    text
}

/// Mesh files that a scene names: a changed mesh is a changed run.
fn files(scene: &Scene) -> Vec<PathBuf> {
    let of_size = |size: &Size| match size {
        Size::File(file) => Some(file.path.clone()),
        _ => None,
    };
    let mut found = Vec::new();
    if let scene::Body::File(file) = &scene.body {
        found.push(file.path.clone());
    }
    for method in &scene.methods {
        match &method.family {
            scene::Family::Fem(fem) => found.extend(of_size(&fem.size)),
            scene::Family::Efg(efg) => {
                found.extend(efg.background.as_ref().and_then(of_size));
                match &efg.cloud {
                    scene::Cloud::Mesh { size, .. } => found.extend(of_size(size)),
                    scene::Cloud::File { file, .. } => found.push(file.path.clone()),
                    _ => {}
                }
            }
        }
    }
    for transfer in &scene.output.transfers {
        if let scene::Target::File(file) = &transfer.to {
            found.push(file.path.clone());
        }
    }
    if let Some(scene::Reference::Method { size: Some(size), .. }) = &scene.reference {
        found.extend(of_size(size));
    }
    if let Some(scene::Reference::Record(path)) = &scene.reference {
        found.push(path.clone());
    }
    found.sort();
    found.dedup();
    found
}

/// A bar on a terminal, nothing elsewhere.
fn progress(len: usize) -> ProgressBar {
    let bar = ProgressBar::new(len as u64);
    let style =
        ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} {msg}").expect("a valid template");
    bar.set_style(style);
    bar
}
