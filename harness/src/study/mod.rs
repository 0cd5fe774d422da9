//! A study: many scenes and methods, run in a fixed order, checked and written to files.

mod args;
mod busy;
pub mod check;
mod events;
mod execute;
mod execution;
mod files;
mod filters;
pub(crate) mod folder;
mod foreseen;
pub(crate) mod isolated;
mod listing;
pub(crate) mod make_reference;
pub(crate) mod merge;
mod progress;
#[cfg(test)]
mod project;
mod shards;
mod store;
mod summary;
mod task;
mod tasks;
mod trials;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, Mutex};

use cases::scene::{self, Check, ErrorKind, Scene, Study};
use records::{Axis, Check as Verdict, Machine, Record, Reference, RunSet, SurfaceField};

use crate::error::ForeignStatus;
use crate::outcome::{Counters, Watch, provenance};
use crate::run::stored_reference::Stored;
use crate::run::{Repeats, case_name};
use crate::scenario::{purpose, too_large};
use execute::Work;
use isolated::Apart;
use progress::Progress;
use store::{Maker, Store};
use task::TaskResult;
use tasks::{Known, Task, list};
use trials::RefusedScene;

pub use args::{Loudness, VerifyArgs};
pub use busy::warn_if_busy;
pub use events::Events;
pub(crate) use events::{Event, Line};
pub(crate) use files::note_inputs;
pub use filters::Filters;
pub(crate) use filters::like;
pub use isolated::ExperimentArgs;
pub use listing::Planned;
pub use merge::MergeArgs;
pub use summary::RunSummary;
pub use task::{failed, stalled};

/// Repeats of the timed part in a study: the median of five short passes, or a single long pass.
const REPEATS: Repeats = Repeats { most: 5, seconds: 0.4 };
/// Repeats in the quick tier, whose purpose is the checks: the median of three passes for runs below 20 ms.
const QUICK: Repeats = Repeats { most: 3, seconds: 0.05 };

/// Study with its parsed scenes.
pub struct Plan {
    study: Study,
    scenes: Vec<(PathBuf, String, Scene)>,
    /// Indices of the unmodified scenes, by path.
    as_they_are: BTreeMap<PathBuf, usize>,
    /// Files of the cases, by case name.
    cases: BTreeMap<String, PathBuf>,
    tasks: Vec<Task>,
    /// Axis values at which the scene is refused.
    refused: Vec<RefusedScene>,
    /// Watch of the runs.
    watch: Option<Arc<Watch>>,
}

/// Results of a study.
pub struct Finished {
    /// Results to be written.
    pub set: RunSet,
    /// Exit codes of runs that failed.
    pub failed: Vec<u8>,
    /// Summaries of the runs, followed by those of the checks of several runs together.
    pub runs: Vec<RunSummary>,
    /// Number of finished runs.
    pub ran: usize,
    /// Number of finished runs whose results came from an earlier study or from other processes.
    pub stored: usize,
    /// Counters of this execution, references included; stored runs count nothing.
    pub counters: Counters,
}

impl Plan {
    /// Reads the scenes of a study and lists its runs. The errors are those of all scenes.
    pub fn new(study: Study) -> Result<Plan, Vec<scene::SceneError>> {
        Plan::read(study, |_| true)
    }

    /// Reads only the scene of these run tables, and lists the runs that they request.
    pub(crate) fn of_tables(study: Study, tables: &[usize]) -> Result<Plan, Vec<scene::SceneError>> {
        let first = tables.first().and_then(|&table| study.runs.get(table));
        let scene = first.map(|run| run.scene.clone());
        let mut plan = Plan::read(study, |run| Some(&run.scene) == scene.as_ref())?;
        plan.tasks.retain_mut(|task| {
            task.runs.retain(|run| tables.contains(run));
            !task.runs.is_empty()
        });
        Ok(plan)
    }

    /// Reads the scenes of the run tables for which `wanted` returns true.
    fn read(study: Study, wanted: impl Fn(&scene::Run) -> bool) -> Result<Plan, Vec<scene::SceneError>> {
        let mut plan = Plan {
            study,
            scenes: Vec::new(),
            as_they_are: BTreeMap::new(),
            cases: BTreeMap::new(),
            tasks: Vec::new(),
            refused: Vec::new(),
            watch: None,
        };
        let mut errors = Vec::new();
        let mut known = Known::default();
        let runs = plan.study.runs.clone();
        for (index, run) in runs.iter().enumerate().filter(|(_, run)| wanted(run)) {
            let read = match &run.axis {
                None => plan.scene(run).map(|at| vec![at]),
                Some(axis) => plan.along(index, run, axis),
            };
            match read {
                Ok(found) => {
                    for at in found {
                        list(&mut plan.tasks, &mut known, index, at, run, &plan.scenes[at].2);
                    }
                }
                Err(bad) => errors.extend(bad),
            }
        }
        if errors.is_empty() { Ok(plan) } else { Err(errors) }
    }

    /// Reads the unmodified scene of a run table.
    fn read_scene(&self, run: &scene::Run) -> Result<Scene, Vec<scene::SceneError>> {
        match self.study.scenes.get(&run.scene) {
            Some(scene) => Ok(scene.clone()),
            None => scene::load(&run.scene),
        }
    }

    /// Index of a run table's unmodified scene, which is read if necessary.
    fn scene(&mut self, run: &scene::Run) -> Result<usize, Vec<scene::SceneError>> {
        if let Some(&at) = self.as_they_are.get(&run.scene) {
            return Ok(at);
        }
        let at = self.add(&run.scene, self.read_scene(run)?)?;
        self.as_they_are.insert(run.scene.clone(), at);
        Ok(at)
    }

    fn add(&mut self, path: &Path, scene: Scene) -> Result<usize, Vec<scene::SceneError>> {
        if !scene.unavailable().is_empty() {
            return Err(scene.unavailable());
        }
        let other = self.cases.entry(case_name(&scene)).or_insert_with(|| path.into());
        if other != path {
            let problem = format!("is in a file with the same name as {}", other.display());
            let help = "rename one of the files: results are stored under the names of scenes";
            return Err(vec![scene.error(ErrorKind::Invalid, "title", &problem, Some(help))]);
        }
        let text = scene.text().to_string();
        self.scenes.push((path.to_path_buf(), text, scene));
        Ok(self.scenes.len() - 1)
    }

    /// Adds the scene at each value of an axis. A refused scene is an error only at the base value.
    fn along(
        &mut self,
        index: usize,
        run: &scene::Run,
        axis: &scene::Axis,
    ) -> Result<Vec<usize>, Vec<scene::SceneError>> {
        let base = self.read_scene(run)?;
        let mut found = Vec::new();
        for &value in &axis.values {
            match axis.at(&base, &run.methods, value) {
                Ok(scene) => found.push(self.add(&run.scene, scene)?),
                Err(bad) if value == axis.base => return Err(bad),
                Err(bad) => {
                    let reason = bad.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
                    self.refused.push(RefusedScene { run: index, value, reason });
                }
            }
        }
        Ok(found)
    }

    /// Keeps the runs that the arguments select.
    pub fn select(&mut self, args: &VerifyArgs) {
        let (runs, scenes) = (&self.study.runs, &self.scenes);
        self.tasks.retain_mut(|task| {
            task.runs.retain(|&run| !args.quick || runs[run].quick);
            let (case, method) = (case_name(&scenes[task.scene].2), &task.method.id);
            let contains = |text: &str| case.contains(text) || method.contains(text);
            let tags = filters::tags(task, runs, &scenes[task.scene].2);
            !task.runs.is_empty()
                && args.filter.as_deref().is_none_or(contains)
                && args.filters.fits(&case, method, &tags)
        });
        if let Some(shard) = args.shard {
            let mine = self.share(args, shard);
            let mut index = 0..;
            self.tasks.retain(|_| index.next().is_some_and(|index| mine.contains(&index)));
        }
    }

    /// Errors of the runs that exceed the limits on memory or time.
    pub(crate) fn too_large(&self, args: &VerifyArgs) -> Vec<scene::SceneError> {
        let foreseen = self.foreseen(args);
        let of =
            |task: &Task| too_large(&self.scenes[task.scene].2, &task.method, foreseen.factor(task.scene));
        self.tasks.iter().filter_map(of).collect()
    }

    /// Run tables that request a task.
    fn tables<'a>(&'a self, task: &'a Task) -> impl Iterator<Item = &'a scene::Run> {
        task.runs.iter().map(|&run| &self.study.runs[run])
    }

    /// Whether the task is requested only as one of many clouds.
    fn is_one_of_many(&self, task: &Task) -> bool {
        self.tables(task).all(|run| run.seeds > 0)
    }

    /// Whether the task is a run along an axis.
    fn is_driven(&self, task: &Task) -> bool {
        self.scenes[task.scene].2.varied.is_some()
    }

    /// Trials of the methods along every axis that was run.
    fn axes(&self, results: &BTreeMap<usize, TaskResult>) -> Vec<Axis> {
        let mut out = Vec::new();
        for (index, run) in self.study.runs.iter().enumerate() {
            let Some(axis) = &run.axis else { continue };
            let own = || results.iter().filter(|(task, _)| self.tasks[**task].runs.contains(&index));
            let Some((&first, _)) = own().next() else { continue };
            let mut found = trials::empty(&case_name(&self.scenes[self.tasks[first].scene].2), axis);
            for (&task, result) in own() {
                let Task { method, scene, .. } = &self.tasks[task];
                if let Some((_, value)) = self.scenes[*scene].2.varied {
                    found.trials.push(trials::trial(&method.id, value, axis, result));
                }
            }
            for refused in self.refused.iter().filter(|refused| refused.run == index) {
                let methods: Vec<String> = found.methods().into_iter().map(String::from).collect();
                found.trials.extend(methods.iter().map(|method| trials::refused(method, refused)));
            }
            out.push(found);
        }
        out
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.tasks.len()
    }

    /// Whether nothing is to be run.
    pub fn is_empty(&self) -> bool {
        self.tasks.is_empty()
    }

    /// Runs everything. Results are in the order of the study, whatever the number of jobs.
    pub fn execute(&self, args: &VerifyArgs) -> Finished {
        self.execute_watched(args, None)
    }

    /// Same as [`execute`](Plan::execute), and reports events as they happen.
    pub(crate) fn execute_watched(&self, args: &VerifyArgs, events: Option<&Events>) -> Finished {
        let machine = Machine { at_once: args.jobs.into(), ..provenance::machine() };
        let store = store(args);
        let work = Work {
            plan: self,
            args,
            store: &store,
            apart: args.apart.isolate.then(|| Apart::new(args, &store)),
            progress: Progress::new(self.tasks.len(), args.loudness(), events),
            done: Mutex::default(),
            stored: AtomicUsize::new(0),
        };
        work.all();
        let finished = self.collect(work.done.into_inner().expect("no worker panicked"), machine);
        Finished { stored: work.stored.into_inner(), ..finished }
    }

    fn collect(&self, results: BTreeMap<usize, TaskResult>, machine: Machine) -> Finished {
        let mut set = RunSet::default();
        let mut failed = Vec::new();
        let mut counters = Counters::default();
        let mut runs = Vec::new();
        for (&index, result) in &results {
            let task = &self.tasks[index];
            counters += result.counters;
            set.records.extend(result.records.iter().cloned());
            set.plans.extend(result.plans.iter().cloned());
            set.warnings.extend(result.warnings.iter().cloned());
            compared_with(&mut set, result.reference.as_ref());
            for field in &result.fields {
                // Of a method at several sizes, the finest is shown.
                let same =
                    |other: &&mut SurfaceField| other.case == field.case && other.method == field.method;
                match set.fields.iter_mut().find(same) {
                    Some(other) if other.points.len() >= field.points.len() => {}
                    Some(other) => *other = field.clone(),
                    None => set.fields.push(field.clone()),
                }
            }
            let verdicts = self.verdicts(task, result);
            let mut run = self.summary(task, result, &verdicts);
            // Along an axis, the way in which a run ends is a result.
            if let Some((failure, code)) = result.failure.as_ref().filter(|_| !self.is_driven(task)) {
                set.failures.push(failure.clone());
                // A feature that a solver does not offer is a result, not a failure.
                let offered = failure.status != ForeignStatus::NotOffered.name();
                // Stalls among many clouds are results if there are metrics. So is a known early end.
                let counted = self.is_one_of_many(task) && !result.records.is_empty();
                let known =
                    |v: &Verdict| v.metric == "load-carried" && v.status == records::Status::KnownFailure;
                if offered && !counted && !verdicts.iter().any(known) {
                    failed.push(*code);
                    run.failure = Some(failure.reason.clone());
                    if !failure.at.is_empty() {
                        run.at = failure.at.clone();
                    }
                }
            }
            runs.push(run);
            set.checks.extend(verdicts);
        }
        for (_, _, scene) in &self.scenes {
            set.records.extend(reference_records(scene));
        }
        let families = self.families(&results);
        let mut together = self.family_verdicts(&families);
        failed.extend(self.without_any(&families));
        set.axes = self.axes(&results);
        together.extend(set.axes.iter().flat_map(trials::verdicts));
        runs.extend(together.iter().map(|check| self.together(check)));
        set.checks.extend(together);
        let texts: Vec<(String, String)> =
            self.scenes.iter().map(|(_, text, scene)| (case_name(scene), text.clone())).collect();
        set.provenance = provenance::provenance(machine, &texts);
        warn_if_busy(&mut set);
        Finished { set, failed, runs, ran: results.len(), stored: 0, counters }
    }

    /// Checks of one run: those of the scene, for its own cloud, and those of the study's run table.
    fn verdicts(&self, task: &Task, result: &TaskResult) -> Vec<Verdict> {
        let scene = &self.scenes[task.scene].2;
        let label = label(task, &result.records, self.is_one_of_many(task));
        self.checks(task)
            .filter(|check| !check::is_of_many(check))
            .map(|check| match (check::value(check.address, &result.records), &result.failure) {
                (None, Some((failure, _))) => {
                    check::not_run(check, &case_name(scene), &label, &failure.reason)
                }
                (value, _) => {
                    let band = check::band(check.address, &result.records);
                    check::judge(check, &case_name(scene), &label, value, band)
                }
            })
            .collect()
    }

    fn checks<'a>(&'a self, task: &'a Task) -> impl Iterator<Item = &'a Check> {
        let scene = &self.scenes[task.scene].2;
        let own = if self.is_one_of_many(task) || self.is_driven(task) { &[] } else { &scene.checks[..] };
        let all = own.iter().chain(self.tables(task).flat_map(|run| &run.checks));
        all.filter(|c| c.methods.is_empty() || c.methods.contains(&task.method.id))
    }

    /// Runs of each run table by method and Poisson's ratio, in the order of their first results.
    fn families<'a>(&'a self, results: &'a BTreeMap<usize, TaskResult>) -> Vec<Family<'a>> {
        let mut families: Vec<Family> = Vec::new();
        let same = |a: &Task, b: &Task| a.method.id == b.method.id && a.poisson == b.poisson;
        for (&index, result) in results {
            let task = &self.tasks[index];
            for &run in &task.runs {
                match families.iter_mut().find(|f| f.run == run && same(f.first, task)) {
                    Some(family) => family.members.push(result),
                    None => families.push(Family { run, first: task, members: vec![result] }),
                }
            }
        }
        families
    }

    /// Checks of orders and of clouds: one for each method and Poisson's ratio of a run table.
    fn family_verdicts(&self, families: &[Family]) -> Vec<Verdict> {
        let mut verdicts = Vec::new();
        for Family { run, first, members } in families {
            let case = case_name(&self.scenes[first.scene].2);
            let label = match first.poisson {
                Some(poisson) => format!("{} nu={poisson}", first.method.id),
                None => first.method.id.clone(),
            };
            let own = |c: &&Check| c.methods.is_empty() || c.methods.contains(&first.method.id);
            for check in self.study.runs[*run].checks.iter().filter(own).filter(|c| check::is_of_many(c)) {
                let records: Vec<&[Record]> = members.iter().map(|member| &member.records[..]).collect();
                let value = check::of_many(check.address, &records);
                let failed = members.iter().find_map(|member| member.failure.as_ref());
                verdicts.push(match (value, failed) {
                    (None, Some((failure, _))) => check::not_run(check, &case, &label, &failure.reason),
                    (value, _) => check::judge(check, &case, &label, value, None),
                });
            }
        }
        verdicts
    }

    /// Exit codes of the groups of clouds in which no cloud reached the whole load.
    fn without_any(&self, families: &[Family]) -> Vec<u8> {
        let seeded = families.iter().filter(|family| self.study.runs[family.run].seeds > 0);
        let none = seeded.filter(|f| !f.members.iter().any(|member| check::carried(&member.records)));
        none.filter_map(|f| f.members.iter().find_map(|m| m.failure.as_ref()).map(|(_, code)| *code))
            .collect()
    }
}

/// Runs of a run table with one method and one Poisson's ratio: its levels or its clouds.
struct Family<'a> {
    run: usize,
    first: &'a Task,
    members: Vec<&'a TaskResult>,
}

/// Adds the reference of a run unless it is already in the set. Several runs may have the same reference.
pub fn compared_with(set: &mut RunSet, reference: Option<&Reference>) {
    if let Some(reference) = reference.filter(|reference| !set.references.contains(reference)) {
        set.references.push(reference.clone());
    }
}

/// Rows of a stored reference; none if the file cannot be read, which fails every method that needs it.
pub fn reference_records(scene: &Scene) -> Vec<Record> {
    let Some(scene::Reference::Record(path)) = &scene.reference else { return Vec::new() };
    let case = Record {
        case: case_name(scene),
        purpose: purpose(scene.purpose),
        published: scene.published.map_or("", |p| p.name()).into(),
        poisson: scene.material.constant("poisson").unwrap_or(0.0),
        ..Record::default()
    };
    Stored::load(scene, path).map(|s| s.records(&case)).unwrap_or_default()
}

/// Removes leftovers of killed processes. Call it only if no other process uses the folder.
pub(crate) fn clean(args: &VerifyArgs) {
    store::clean(&args.out);
}

/// Keeps only finished results of this program on this machine. Only the first joining process calls it.
pub(crate) fn sweep(args: &VerifyArgs) {
    clean(args);
    store(args).sweep();
}

/// Whether a folder of results contains stored results of single runs.
pub fn has_stored(out: &Path) -> bool {
    store::any(out)
}

/// Store of the results of single runs.
fn store(args: &VerifyArgs) -> Store {
    Store::new(&args.out, Maker::new(&provenance::program(), &provenance::machine()))
}

/// Method id with the settings that distinguish the run from others of the same method.
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
