//! Jobs as processes of this machine, some at a time.

use std::collections::BTreeMap;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::job::{End, Executor, Job, State};
use crate::process::group::Started;
use crate::process::memory;

/// Longest wait for a cancelled job that has received the signal TERM.
const CANCELLED: Duration = Duration::from_secs(5);
const LOOK: Duration = Duration::from_millis(10);

/// Processes of this machine.
pub(super) struct Local {
    /// Number of jobs at once.
    most: usize,
    /// Memory of all running jobs together, bytes. A job that needs more runs alone.
    memory: f64,
    last: u64,
    waiting: Vec<(String, Job)>,
    running: BTreeMap<String, Process>,
    ended: BTreeMap<String, End>,
}

struct Process {
    started: Started,
    job: Job,
    began: Instant,
    /// Whether the job has received the signal TERM because of its time.
    is_late: bool,
}

impl Local {
    pub(super) fn new(most: usize) -> Local {
        let (waiting, running, ended) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        Local { most, memory: memory(), last: 0, waiting, running, ended }
    }

    /// Starts waiting jobs as long as there is room for them.
    fn start(&mut self) {
        while let Some((_, job)) = self.waiting.first() {
            let taken: f64 = self.running.values().map(|process| process.job.memory as f64).sum();
            let fits = self.running.is_empty() || taken + job.memory as f64 <= self.memory;
            if self.running.len() >= self.most || !fits {
                return;
            }
            let (id, job) = self.waiting.remove(0);
            match begun(&job) {
                Ok(started) => {
                    let process = Process { started, job, began: Instant::now(), is_late: false };
                    self.running.insert(id, process);
                }
                Err(bad) => {
                    let program = job.command.first().cloned().unwrap_or_default();
                    let problem = format!("{} can't be started: {bad}", program.to_string_lossy());
                    self.ended.insert(id, End::Failed(problem));
                }
            }
        }
    }

    /// Ends processes whose program has ended or whose time is over.
    fn look(&mut self) {
        let mut over = Vec::new();
        for (id, process) in &mut self.running {
            let took = process.began.elapsed();
            if took > process.job.time && !process.is_late {
                process.is_late = true;
                process.started.terminate();
            }
            let by_itself = process.started.has_ended().unwrap_or(true);
            if by_itself || took > process.job.time + process.job.notice {
                over.push(id.clone());
            }
        }
        for id in over {
            let Some(process) = self.running.remove(&id) else { continue };
            let is_late = process.is_late;
            let end = match process.started.end() {
                _ if is_late => End::OutOfTime,
                Ok(status) => ended(status),
                Err(bad) => End::Failed(bad.to_string()),
            };
            self.ended.insert(id, end);
        }
    }
}

impl Executor for Local {
    fn submit(&mut self, job: &Job) -> Result<String, String> {
        self.last += 1;
        let id = self.last.to_string();
        self.waiting.push((id.clone(), job.clone()));
        self.start();
        Ok(id)
    }

    fn poll(&mut self, ids: &[String]) -> Result<Vec<State>, String> {
        self.look();
        self.start();
        let state = |id: &String| match self.ended.get(id) {
            Some(end) => State::Ended(end.clone()),
            None if self.running.contains_key(id) => State::Running,
            None if self.running.len() < self.most => State::Waiting("memory".into()),
            None => State::Waiting("other jobs".into()),
        };
        Ok(ids.iter().map(state).collect())
    }

    fn cancel(&mut self, ids: &[String]) -> Result<(), String> {
        let cancelled = || End::Failed("cancelled".into());
        for (id, _) in self.waiting.extract_if(.., |(id, _)| ids.contains(id)) {
            self.ended.insert(id, cancelled());
        }
        let mut processes: Vec<(String, Process)> =
            self.running.extract_if(.., |id, _| ids.contains(id)).collect();
        processes.iter().for_each(|(_, process)| process.started.terminate());
        let began = Instant::now();
        for (id, mut process) in processes.drain(..) {
            while !process.started.has_ended().unwrap_or(true) && began.elapsed() < CANCELLED {
                std::thread::sleep(LOOK);
            }
            let _ = process.started.end();
            self.ended.insert(id, cancelled());
        }
        Ok(())
    }
}

/// Starts the program of a job.
fn begun(job: &Job) -> std::io::Result<Started> {
    let log = disk::create(&job.log)?;
    let errors = log.try_clone()?;
    let program = job.command.first().ok_or_else(|| std::io::Error::other("there is no command"))?;
    let mut command = Command::new(program);
    command.args(&job.command[1..]).stdin(Stdio::null());
    Started::new(command.stdout(log).stderr(errors))
}

fn ended(status: ExitStatus) -> End {
    if status.success() { End::Done } else { End::Failed(status.to_string()) }
}
