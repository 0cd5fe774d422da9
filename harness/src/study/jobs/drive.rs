//! Execution of a study as jobs: runs are bundled and handed over, ended jobs are examined, and runs that
//! crashed are repeated.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::ffi::OsString;
use std::time::{Duration, Instant};

use records::Machine;

use super::super::args::VerifyArgs;
use super::super::events::Events;
use super::super::foreseen::Foreseen;
use super::super::merge::Note;
use super::super::plan::StudyPlan;
use super::super::progress::{Progress, Running};
use super::super::results::FinishedStudy;
use super::super::store::{Accept, Machines, Store, has_stored};
use super::super::task::TaskResult;
use super::bundle::{self, Bundle, BundledRun, Files, Heard};
use super::pack::Packed;
use super::queue::Jobs;
use crate::adapter;
use crate::error::Failure;
use crate::executor::{End, Job, Site, State};
use crate::outcome::provenance;
use crate::run::case_name;

/// Ratio of the time limit of a job to its expected or wanted time, and the time to start it and to read the
/// study, s.
const LIMIT: f64 = 3.0;
const START: f64 = 300.0;
/// Time between the signal that a job's time is over and its end by force.
const NOTICE: Duration = Duration::from_secs(60);
/// Longest wait for the results of a finished job to appear on a network file system.
const SETTLE: Duration = Duration::from_secs(60);
/// Number of successive questions that the system may leave without an answer.
const UNANSWERED: u32 = 60;
/// Bounds of the pause between two looks at the jobs, on this machine and elsewhere.
const HERE: [Duration; 2] = [Duration::from_millis(20), Duration::from_secs(1)];
const ELSEWHERE: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(10)];

/// A study under way.
struct Drive<'a> {
    plan: &'a StudyPlan,
    args: &'a VerifyArgs,
    site: &'a Site,
    jobs: &'a Jobs,
    /// Number of threads of each job.
    threads: usize,
    store: Store,
    keys: Vec<String>,
    costs: Foreseen,
    progress: Progress<'a>,
    results: BTreeMap<usize, TaskResult>,
    /// Number of jobs that ended during each run.
    attempts: BTreeMap<usize, u8>,
    waiting: VecDeque<Packed>,
    active: Vec<Active>,
    /// Number of the last job.
    last: usize,
    /// Number of successive questions without an answer.
    unanswered: u32,
}

/// A job that has been handed over.
struct Active {
    id: String,
    files: Files,
    packed: Packed,
    state: State,
    /// Runs that have begun, by their index in the study.
    running: BTreeMap<usize, Running>,
    /// Time at which the job was first seen to have ended.
    ended: Option<Instant>,
}

impl StudyPlan {
    /// Executes the runs as jobs. Results are in the order of the study.
    ///
    /// # Errors
    /// Returns an error if a job cannot be handed over, or if the system does not answer for some minutes.
    /// Finished runs are stored.
    pub(crate) fn execute_on(
        &self,
        args: &VerifyArgs,
        site: &Site,
        jobs: &Jobs,
        threads: usize,
        events: Option<&Events>,
    ) -> Result<FinishedStudy, Failure> {
        let here = Machine { threads: threads as u32, at_once: site.jobs() as u32, ..provenance::machine() };
        // Times of an earlier execution of this study are the best estimates.
        let times = args.times.clone().or_else(|| has_stored(&args.out).then(|| args.out.clone()));
        let mut drive = Drive {
            plan: self,
            args,
            site,
            jobs,
            threads,
            store: Store::of(args),
            keys: (0..self.len()).map(|index| self.key(index, args)).collect(),
            costs: self.foreseen_from(args, times.as_deref(), Machines::Any),
            progress: Progress::of_jobs(self.len(), args.loudness(), events),
            results: BTreeMap::new(),
            attempts: BTreeMap::new(),
            waiting: VecDeque::new(),
            active: Vec::new(),
            last: bundle::all(&args.out).last().map_or(0, Files::number),
            unanswered: 0,
        };
        let stored = drive.take_stored();
        let done = drive.all();
        drive.progress.finish();
        if done.is_err() {
            jobs.cancel_active();
        }
        done?;
        let machine = drive.machine(here);
        Ok(FinishedStudy { stored, ..self.collect(drive.results, machine) })
    }
}

impl Drive<'_> {
    /// Takes the results that are already stored, and returns their number.
    fn take_stored(&mut self) -> usize {
        for index in 0..self.plan.len() {
            if let Some(result) = self.load(index) {
                let running = self.running(index);
                self.progress.done(&running, &result, true);
                self.results.insert(index, result);
            }
        }
        self.results.len()
    }

    /// Executes all runs without a result.
    fn all(&mut self) -> Result<(), Failure> {
        let left: Vec<usize> = (0..self.plan.len()).filter(|run| !self.results.contains_key(run)).collect();
        let wanted = self.args.on.job_time.as_secs_f64();
        self.waiting = self.plan.bundles(&left, &self.costs, wanted, self.site.jobs()).into();
        let [shortest, longest] = if self.site.is_local() { HERE } else { ELSEWHERE };
        let began = Instant::now();
        loop {
            self.hand_over()?;
            if self.active.is_empty() {
                return Ok(());
            }
            std::thread::sleep((began.elapsed() / 50).clamp(shortest, longest));
            self.look()?;
        }
    }

    /// Hands over waiting bundles as long as the system takes jobs.
    fn hand_over(&mut self) -> Result<(), Failure> {
        while self.active.len() < self.site.jobs()
            && let Some(packed) = self.waiting.pop_front()
        {
            self.last += 1;
            let files = Files::new(&self.args.out, self.last);
            let bundle = self.bundle(&packed);
            files.write(&bundle).map_err(|bad| Failure::Run(bad.to_string()))?;
            let submitted = self.job(&bundle, &files).and_then(|job| self.jobs.submit(&job));
            match submitted {
                Ok(id) => {
                    let state = State::Waiting(String::new());
                    let running = BTreeMap::new();
                    self.active.push(Active { id, files, packed, state, running, ended: None });
                }
                // Sites limit the number of jobs.
                Err(bad) if !self.active.is_empty() => {
                    let _ = disk::remove(files.bundle());
                    self.progress.warn(format!("warning: {bad}; tried again after the next job ends"));
                    self.waiting.push_front(packed);
                    return Ok(());
                }
                Err(bad) => return Err(Failure::Run(format!("--on {}: {bad}", self.site))),
            }
        }
        Ok(())
    }

    fn bundle(&self, packed: &Packed) -> Bundle {
        let run = |&index: &usize| BundledRun {
            index,
            key: self.keys[index].clone(),
            seconds: self.costs.of(index),
        };
        let apart = &self.args.apart;
        Bundle {
            note: Note::new(self.args, self.args.path()),
            runs: packed.runs.iter().map(run).collect(),
            bytes: packed.bytes,
            limit: START + LIMIT * packed.seconds.max(self.args.on.job_time.as_secs_f64()),
            isolate: apart.isolate,
            time_limit: apart.time_limit,
            memory_limit: apart.memory_limit,
            retries: self.args.on.retries(),
        }
    }

    fn job(&self, bundle: &Bundle, files: &Files) -> Result<Job, String> {
        let program = std::env::current_exe().map_err(|bad| format!("the program's own path: {bad}"))?;
        let mut command: Vec<OsString> = vec![program.into(), "job".into(), files.bundle().into()];
        if self.site.is_local() {
            command.extend(["--parent".into(), std::process::id().to_string().into()]);
        }
        command.extend(["--threads".into(), self.threads.to_string().into()]);
        command.extend(adapter::leaves_local_out().then(|| "--no-local-adapters".into()));
        for folder in adapter::given_folders() {
            command.extend(["--adapters".into(), folder.into()]);
        }
        Ok(Job {
            name: format!("tissuebench-{}", files.number()),
            command,
            log: files.log(),
            threads: self.threads,
            memory: bundle.bytes as u64,
            time: Duration::try_from_secs_f64(bundle.limit).map_err(|bad| bad.to_string())?,
            notice: NOTICE,
        })
    }

    /// Asks for the states of all jobs, takes their results and examines the jobs that have ended.
    fn look(&mut self) -> Result<(), Failure> {
        let ids: Vec<String> = self.active.iter().map(|active| active.id.clone()).collect();
        match self.jobs.poll(&ids) {
            Ok(states) => {
                self.unanswered = 0;
                self.active.iter_mut().zip(states).for_each(|(active, state)| active.state = state);
            }
            Err(bad) => {
                self.unanswered += 1;
                if self.unanswered == 1 {
                    self.progress.warn(format!("warning: {bad}"));
                }
                if self.unanswered > UNANSWERED {
                    return Err(Failure::Run(format!("--on {}: no answer: {bad}", self.site)));
                }
            }
        }
        for mut active in std::mem::take(&mut self.active) {
            self.hear(&mut active);
            let end = if let State::Ended(end) = &active.state { Some(end.clone()) } else { None };
            match end {
                None => self.active.push(active),
                Some(end) => self.examine(active, &end),
            }
        }
        self.jobs.set_active(self.active.iter().map(|active| active.id.clone()).collect());
        self.progress.jobs(&self.summary());
        Ok(())
    }

    /// Takes the results of runs that a job has reported.
    fn hear(&mut self, active: &mut Active) {
        let heard = Heard::of(&active.files);
        let runs = active.packed.runs.clone();
        let index = |run: &usize| runs.get(*run).copied();
        for index in heard.begun.iter().filter_map(index) {
            if !self.results.contains_key(&index) && !active.running.contains_key(&index) {
                active.running.insert(index, self.running(index));
            }
        }
        for index in heard.ended.iter().filter_map(index) {
            self.take(index, &active.running);
        }
    }

    /// Takes the result of a run if it is stored, and returns whether the run has a result.
    fn take(&mut self, index: usize, running: &BTreeMap<usize, Running>) -> bool {
        if self.results.contains_key(&index) {
            return true;
        }
        let Some(result) = self.load(index) else { return false };
        match running.get(&index) {
            Some(running) => self.progress.done(running, &result, false),
            None => self.progress.done(&self.running(index), &result, false),
        }
        self.results.insert(index, result);
        true
    }

    /// Repeats the runs that an ended job has left. The run at which the job ended is repeated alone, with
    /// twice the time and memory. After the last retry it has failed.
    fn examine(&mut self, mut active: Active, end: &End) {
        let runs = active.packed.runs.clone();
        let left: Vec<usize> = runs.iter().copied().filter(|&run| !self.take(run, &active.running)).collect();
        if left.is_empty() {
            return;
        }
        let since = *active.ended.get_or_insert_with(Instant::now);
        if *end == End::Done && since.elapsed() < SETTLE {
            self.active.push(active);
            return;
        }
        let current: BTreeSet<usize> =
            Heard::of(&active.files).current().filter_map(|run| runs.get(run).copied()).collect();
        let why = reason(&active.files, end);
        self.progress.warn(format!("warning: {why}; {} of its {} runs are left", left.len(), runs.len()));
        let (suspects, others): (Vec<usize>, Vec<usize>) = left.iter().partition(|run| current.contains(run));
        let Packed { seconds, bytes, .. } = active.packed;
        // A job that ended before its first run is repeated as it was.
        let blamed = if suspects.is_empty() { &left } else { &suspects };
        let failed: Vec<usize> = blamed.iter().copied().filter(|&run| self.is_last_attempt(run)).collect();
        failed.iter().for_each(|&run| self.fail(run, &why));
        let again =
            |runs: Vec<usize>| runs.into_iter().filter(|run| !failed.contains(run)).collect::<Vec<_>>();
        let others = again(others);
        if !others.is_empty() {
            self.waiting.push_back(Packed { runs: others, seconds, bytes });
        }
        for run in again(suspects) {
            let seconds = 2.0 * seconds.max(self.args.on.job_time.as_secs_f64());
            self.waiting.push_front(Packed { runs: vec![run], seconds, bytes: 2.0 * bytes });
        }
    }

    /// Counts a job that ended at a run, and returns whether the run is not repeated any more.
    fn is_last_attempt(&mut self, run: usize) -> bool {
        let attempts = self.attempts.entry(run).or_default();
        *attempts += 1;
        *attempts > self.args.on.retries()
    }

    /// Records the failure of a run, unless another process has it.
    fn fail(&mut self, run: usize, why: &str) {
        let count = self.attempts.get(&run).copied().unwrap_or_default();
        let failure = Failure::Run(format!("gave no result in {count} jobs: {why}"));
        let task = &self.plan.tasks[run];
        let result = TaskResult::failed(&self.case(run), &task.method, &failure);
        let key = &self.keys[run];
        if let Ok(Some(_claim)) = self.store.claim(key)
            && let Err(bad) = self.store.save(key, &result)
        {
            self.progress.warn(format!("warning: a result could not be stored: {bad}"));
        }
        self.progress.done(&self.running(run), &result, false);
        self.results.insert(run, result);
    }

    fn load(&self, index: usize) -> Option<TaskResult> {
        self.store.load(&self.keys[index], Accept::All).ok().flatten()
    }

    fn case(&self, index: usize) -> String {
        case_name(&self.plan.scenes[self.plan.tasks[index].scene].2)
    }

    fn running(&self, index: usize) -> Running {
        self.progress.running(self.case(index), self.plan.tasks[index].method.id.clone(), index)
    }

    /// Describes the jobs in part of a line, such as `2 failed; 8 jobs running, 3 waiting: Resources; about
    /// 72 s left`.
    fn summary(&self) -> String {
        let failed = self.results.values().filter(|result| result.failure.is_some()).count();
        let running = self.active.iter().filter(|active| active.state == State::Running).count();
        let reasons: BTreeSet<&str> = self
            .active
            .iter()
            .filter_map(
                |active| if let State::Waiting(reason) = &active.state { Some(&**reason) } else { None },
            )
            .filter(|reason| !reason.is_empty())
            .collect();
        let mut waiting = format!("{} waiting", self.active.len() - running + self.waiting.len());
        if !reasons.is_empty() {
            waiting += &format!(": {}", reasons.into_iter().collect::<Vec<_>>().join(", "));
        }
        let left = self.seconds_left() / running.max(1) as f64;
        format!("{failed} failed; {running} jobs running, {waiting}; about {left:.0} s left")
    }

    /// Expected time of all runs without a result, s. It is corrected by the times of the finished runs.
    fn seconds_left(&self) -> f64 {
        let (mut took, mut expected, mut left) = (0.0, 0.0, 0.0);
        for index in 0..self.plan.len() {
            match self.results.get(&index) {
                Some(result) if result.seconds > 0.0 => {
                    took += result.seconds;
                    expected += self.costs.of(index);
                }
                Some(_) => {}
                None => left += self.costs.of(index),
            }
        }
        if expected > 0.0 { left * took / expected } else { left }
    }

    /// Machine of the jobs. A warning names the number of kinds of machines if there is more than one.
    fn machine(&self, here: Machine) -> Machine {
        if self.site.is_local() {
            return here;
        }
        let machines: Vec<Machine> =
            bundle::all(&self.args.out).iter().filter_map(Files::machine_of).collect();
        let kinds: BTreeSet<_> =
            machines.iter().map(|of| (of.processor(), &of.instructions, of.threads)).collect();
        if kinds.len() > 1 {
            self.progress.warn(format!("the times come from {} kinds of machines", kinds.len()));
        }
        machines.into_iter().next().unwrap_or(here)
    }
}

/// Describes the end of a job, with the last line of its log.
fn reason(files: &Files, end: &End) -> String {
    let number = files.number();
    let mut text = match end {
        End::Done => format!("job {number} ended without the results of all runs"),
        End::OutOfTime => format!("job {number} exceeded its time"),
        End::Failed(why) => format!("job {number} ended: {why}"),
    };
    let said = files.last_words();
    if !said.is_empty() {
        text += &format!(" ({said})");
    }
    text
}
