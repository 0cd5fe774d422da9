//! Results of a study: execution of its runs, their records and checks.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::AtomicUsize;

use cases::scene::{self, Check, Scene};
use records::{Axis, Check as Verdict, Machine, Record, Reference, RunSet, SurfaceField};

use super::args::VerifyArgs;
use super::busy::warn_if_busy;
use super::events::Events;
use super::execute::Work;
use super::isolated::Apart;
use super::plan::{StudyPlan, label};
use super::progress::Progress;
use super::store::Store;
use super::summary::RunSummary;
use super::task::TaskResult;
use super::tasks::Task;
use super::{check, trials};
use crate::error::ForeignStatus;
use crate::outcome::{Counters, provenance};
use crate::run::case_name;
use crate::run::stored_reference::Stored;
use crate::scenario::purpose;

/// Results of a study.
pub struct FinishedStudy {
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

impl StudyPlan {
    /// Runs everything. Results are in the order of the study, whatever the number of jobs.
    pub fn execute(&self, args: &VerifyArgs) -> FinishedStudy {
        self.execute_watched(args, None)
    }

    /// Same as [`execute`](StudyPlan::execute), and reports events as they happen.
    pub(crate) fn execute_watched(&self, args: &VerifyArgs, events: Option<&Events>) -> FinishedStudy {
        let machine = Machine { at_once: args.jobs.into(), ..provenance::machine() };
        let (done, stored) = self.worked(args, events);
        FinishedStudy { stored, ..self.collect(done, machine) }
    }

    /// Runs everything. Returns the results by task, and the number of those that were stored.
    pub(super) fn worked(
        &self,
        args: &VerifyArgs,
        events: Option<&Events>,
    ) -> (BTreeMap<usize, TaskResult>, usize) {
        let store = Store::of(args);
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
        (work.done.into_inner().expect("no worker panicked"), work.stored.into_inner())
    }

    pub(super) fn collect(&self, results: BTreeMap<usize, TaskResult>, machine: Machine) -> FinishedStudy {
        let mut set = RunSet::default();
        let mut failed = Vec::new();
        let mut counters = Counters::default();
        let mut runs = Vec::new();
        for (&index, result) in &results {
            let task = &self.tasks[index];
            counters += result.counters;
            if self.sample(task).is_some() {
                runs.push(self.summary(task, result, &[]));
                continue;
            }
            if self.is_fit(task) {
                let run = self.collect_fit(task, result, &mut set);
                failed.extend(result.failure.as_ref().map(|(_, code)| *code));
                runs.push(run);
                continue;
            }
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
                // Stalls among many clouds are results if there are metrics. So is a foreseen early end.
                let counted = self.is_one_of_many(task) && !result.records.is_empty();
                let foreseen = check::foreseen_end(self.checks(task), &result.records);
                if offered && !counted && !foreseen {
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
        // Samples and fits are in the scene's own text.
        let scenes = || self.scenes.iter().filter(|(_, _, scene)| scene.sample.is_none() && !scene.is_fit);
        for (_, _, scene) in scenes() {
            set.records.extend(reference_records(scene));
        }
        let families = self.families(&results);
        let mut together = self.family_verdicts(&families);
        failed.extend(self.without_any(&families));
        set.axes = self.axes(&results);
        set.samples = self.samples(&results);
        together.extend(self.statistic_verdicts(&set));
        failed.extend(self.without_samples(&set, &results));
        together.extend(set.axes.iter().flat_map(trials::verdicts));
        runs.extend(together.iter().map(|check| self.together(check)));
        set.checks.extend(together);
        let texts: Vec<(String, String)> =
            scenes().map(|(_, text, scene)| (case_name(scene), text.clone())).collect();
        set.provenance = provenance::provenance(machine, &texts);
        warn_if_busy(&mut set);
        FinishedStudy { set, failed, runs, ran: results.len(), stored: 0, counters }
    }

    /// Adds a fit with its checks or its failure, and returns its summary.
    fn collect_fit(&self, task: &Task, result: &TaskResult, set: &mut RunSet) -> RunSummary {
        let verdicts = self.fit_verdicts(task, result);
        let mut run = self.summary(task, result, &verdicts);
        if let Some((failure, _)) = &result.failure {
            run.failure = Some(failure.reason.clone());
            set.failures.push(failure.clone());
        }
        set.fits.extend(result.fit.clone());
        set.checks.extend(verdicts);
        run
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
            .map(|verdict| Verdict { runs: check::run_ids(&result.records), ..verdict })
            .collect()
    }

    pub(super) fn checks<'a>(&'a self, task: &'a Task) -> impl Iterator<Item = &'a Check> {
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
            if self.is_apart(task) {
                continue;
            }
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
                let verdict = match (value, failed) {
                    (None, Some((failure, _))) => check::not_run(check, &case, &label, &failure.reason),
                    (value, _) => check::judge(check, &case, &label, value, None),
                };
                let runs = check::run_ids(records.into_iter().flatten());
                verdicts.push(Verdict { runs, ..verdict });
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
