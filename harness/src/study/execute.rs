//! Execution of a study's runs, in sequence or by several processes together. Every result is stored as soon
//! as its run is finished.

use std::any::Any;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::args::VerifyArgs;
use super::files::{files, versions};
use super::isolated::Apart;
use super::plan::StudyPlan;
use super::progress::{Progress, Running};
use super::samples;
use super::store::{Accept, Claim, Store};
use super::task::{TaskResult, failed, key};
use super::tasks::{Task, named};
use crate::error::Failure;
use crate::outcome::Counters;
use crate::run::{Group, RunOptions, case_name};

/// Time between two checks for the results of other processes.
const LOOK: Duration = Duration::from_millis(20);

/// State of a running study.
pub(super) struct Work<'a> {
    pub(super) plan: &'a StudyPlan,
    pub(super) args: &'a VerifyArgs,
    pub(super) store: &'a Store,
    /// Runner that starts a process for each task, if requested.
    pub(super) apart: Option<Apart<'a>>,
    pub(super) progress: Progress<'a>,
    pub(super) done: Mutex<BTreeMap<usize, TaskResult>>,
    /// Number of results that were already stored or that other processes made.
    pub(super) stored: AtomicUsize,
}

/// Owner of a task.
enum Turn {
    /// The task has a stored result.
    Stored(Box<TaskResult>),
    /// The task belongs to this process. No other process may run it until the claim is dropped.
    Ours(Option<Claim>),
    /// Another process runs the task.
    Theirs,
}

impl Work<'_> {
    /// Runs everything.
    pub(super) fn all(&self) {
        let groups = self.plan.groups();
        let next = AtomicUsize::new(0);
        let left: Mutex<Vec<Vec<usize>>> = Mutex::new(Vec::new());
        std::thread::scope(|scope| {
            for _ in 0..self.args.jobs {
                scope.spawn(|| {
                    while let Some(members) = groups.get(next.fetch_add(1, Ordering::Relaxed)) {
                        // A scene on which another process works is left for later, so that its reference is
                        // solved only once.
                        let rest = self.group(members, false);
                        left.lock().expect("no worker panicked").push(rest);
                    }
                    // The lock must not be held during the runs.
                    let pop = || left.lock().expect("no worker panicked").pop();
                    while let Some(members) = pop() {
                        let rest = self.group(&members, true);
                        if !rest.is_empty() {
                            left.lock().expect("no worker panicked").push(rest);
                            std::thread::sleep(LOOK);
                        }
                    }
                });
            }
        });
        self.progress.finish();
    }

    /// Runs tasks that share a reference, and returns the tasks that other processes are running. Unless
    /// `thorough` is true, it stops at the first of these.
    fn group(&self, members: &[usize], thorough: bool) -> Vec<usize> {
        // The group is created when it is first needed: if all members are stored, not even the reference is
        // solved.
        let mut group: Option<Result<Group, Failure>> = None;
        let mut left = Vec::new();
        for (at, &index) in members.iter().enumerate() {
            if self.plan.is_stopped() {
                return Vec::new();
            }
            let key = self.plan.key(index, self.args);
            match self.turn(&key) {
                Turn::Stored(result) => {
                    self.stored.fetch_add(1, Ordering::Relaxed);
                    self.finished(index, *result, self.running(index), true);
                }
                Turn::Theirs if thorough => left.push(index),
                Turn::Theirs => {
                    left.extend(&members[at..]);
                    break;
                }
                Turn::Ours(claim) => {
                    let running = self.running(index);
                    let result = match &self.apart {
                        Some(apart) => apart.run(self.plan, index, &key),
                        None => self.plan.run(index, self.args, &mut group),
                    };
                    // An interrupted run has no result.
                    if self.plan.is_stopped() {
                        return Vec::new();
                    }
                    if claim.as_ref().is_some_and(|claim| !claim.is_live()) {
                        self.progress
                            .warn("warning: the lock of a run was lost; its result is discarded".into());
                        left.push(index);
                        continue;
                    }
                    if let Err(bad) = self.store.save(&key, &result) {
                        self.progress.warn(format!("warning: a result could not be stored: {bad}"));
                    }
                    self.finished(index, result, running, false);
                }
            }
        }
        left
    }

    fn turn(&self, key: &str) -> Turn {
        let accept = match (self.args.join, self.args.resume) {
            (true, _) => Accept::All,
            (false, true) => Accept::Finished,
            (false, false) => Accept::Nothing,
        };
        let stored = || match self.store.load(key, accept) {
            Ok(found) => found.map(|result| Turn::Stored(Box::new(result))),
            Err(bad) => {
                self.progress.warn(format!("warning: {bad}; the run is repeated"));
                None
            }
        };
        if let Some(stored) = stored() {
            return stored;
        }
        if !self.args.join {
            return Turn::Ours(None);
        }
        match self.store.claim(key) {
            // Another process may have finished the task in the meantime.
            Ok(Some(claim)) => stored().unwrap_or(Turn::Ours(Some(claim))),
            Ok(None) => Turn::Theirs,
            Err(bad) => {
                self.progress
                    .warn(format!("warning: a run could not be claimed and may be run twice: {bad}"));
                Turn::Ours(None)
            }
        }
    }

    fn running(&self, index: usize) -> Running {
        let task = &self.plan.tasks[index];
        let case = case_name(&self.plan.scenes[task.scene].2);
        self.progress.running(case, task.method.id.clone(), index)
    }

    fn finished(&self, index: usize, result: TaskResult, running: Running, stored: bool) {
        self.progress.done(&running, &result, stored);
        self.done.lock().expect("no worker panicked").insert(index, result);
    }
}

impl StudyPlan {
    /// Indices of the tasks, grouped by scene and Poisson's ratio, in the order of the first task of each
    /// group.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut known = BTreeMap::new();
        for (index, task) in self.tasks.iter().enumerate() {
            let which = (task.scene, task.poisson.map(f64::to_bits));
            let at = *known.entry(which).or_insert(groups.len());
            if at == groups.len() {
                groups.push(Vec::new());
            }
            groups[at].push(index);
        }
        groups
    }

    /// Key under which a task's result is stored: a hash of everything that the result depends on except the
    /// program and the machine.
    pub(super) fn key(&self, index: usize, args: &VerifyArgs) -> String {
        let task = &self.tasks[index];
        let (_, text, scene) = &self.scenes[task.scene];
        let options = self.options(task, args);
        let repeats = self.repeats(task, args);
        let Task { method, level, poisson, .. } = task;
        let RunOptions { picture, frames, split, states: _ } = options;
        let versions = versions(scene, method);
        let run = (case_name(scene), &scene.varied, named(method), level, poisson);
        let done = (picture, frames, split.map(|split| format!("{split:?}")), repeats.most, repeats.seconds);
        let what = serde_json::to_string(&(run, done, versions)).expect("texts and numbers");
        key(text, &files(scene, method), &what)
    }

    fn options(&self, task: &Task, args: &VerifyArgs) -> RunOptions {
        let split = self.tables(task).find_map(|run| run.split);
        // Clouds that differ only in their seed do not need a loop each.
        let played = !args.quick || self.tables(task).any(|run| run.quick && run.loops);
        let frames = played && !self.is_one_of_many(task);
        RunOptions { picture: task.picture, states: false, frames, split }
    }

    /// Runs a task with the reference of its group. A panic fails only this run.
    pub(super) fn run<'a>(
        &'a self,
        index: usize,
        args: &VerifyArgs,
        group: &mut Option<Result<Group<'a>, Failure>>,
    ) -> TaskResult {
        let task = &self.tasks[index];
        let (_, _, scene) = &self.scenes[task.scene];
        if self.is_fit(task) {
            let start = Instant::now();
            let found = caught(|| self.fit(task, args));
            let mut result =
                found.unwrap_or_else(|panic| TaskResult::failed(&case_name(scene), &task.method, &panic));
            result.seconds = start.elapsed().as_secs_f64();
            return result;
        }
        let repeats = self.repeats(task, args);
        let mut shared = Counters::default();
        let group = group.get_or_insert_with(|| {
            let group =
                caught(|| Group::watched(Cow::Borrowed(scene), task.poisson, repeats, self.watch.clone()))
                    .unwrap_or_else(Err);
            shared = group.as_ref().map_or(shared, Group::reference_counters);
            group
        });
        let start = Instant::now();
        let mut result = match group {
            Ok(group) => self.compared(task, group, self.options(task, args)),
            Err(failure) => TaskResult::failed(&case_name(scene), &task.method, failure),
        };
        if let (Some(vary), Some(_)) = (&scene.vary, scene.sample) {
            result = samples::condensed(vary, result);
        }
        result.seconds = start.elapsed().as_secs_f64();
        result.counters += shared;
        result
    }

    /// Result of one method. If its reference ended early, that is the result's failure.
    fn compared(&self, task: &Task, group: &Group, options: RunOptions) -> TaskResult {
        let case = case_name(&self.scenes[task.scene].2);
        let method = &task.method;
        let run = || group.run(&group.scenario(task.method.clone(), task.level), options);
        let mut result = match caught(run) {
            Ok(Ok(outcome)) => TaskResult::finished(&outcome),
            Ok(Err(unfinished)) => TaskResult::failed(&case, method, &unfinished.failure),
            Err(panic) => TaskResult::failed(&case, method, &panic),
        };
        if let (Some(stalled), None) = (group.reference_stalled(), &result.failure) {
            let reason = format!("reference stalled: {stalled}");
            let carried = group.reference_carried();
            let run = records::Failure { reason, carried, ..failed(&case, method, stalled) };
            result.failure = Some((run, stalled.exit_code()));
        }
        result
    }
}

/// Returns the result of a function, or a failure if the function panics.
fn caught<T>(function: impl FnOnce() -> T) -> Result<T, Failure> {
    let message = |panic: Box<dyn Any + Send>| {
        let text = panic.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
        Failure::Run(format!("panicked: {}", text.unwrap_or_else(|| "no message".into())))
    };
    catch_unwind(AssertUnwindSafe(function)).map_err(message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_failure_with_its_message() {
        assert_eq!(caught(|| 1).unwrap(), 1);
        let panics: [Result<(), Failure>; 2] = [caught(|| panic!("at {}", 3)), caught(|| panic!("at 3"))];
        for failure in panics {
            let failure = failure.expect_err("a panic");
            assert_eq!((failure.to_string().as_str(), failure.exit_code()), ("panicked: at 3", 3));
        }
    }
}
