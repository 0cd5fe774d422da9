//! Jobs of Slurm. A job is one script for `sbatch`, whose state `squeue` reports.
//!
//! Slurm signals the steps of a job only, and a script without `srun` has none: `--signal` needs `B:`, and
//! the script must replace its shell by the program (`exec`), because the shell does not pass the signal on.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use super::job::{End, Executor, Job, State};
use super::programs::{quoted, said};

/// States in which a job waits or is stopped, and in which it runs.
const WAITING: [&str; 7] =
    ["PENDING", "CONFIGURING", "REQUEUED", "REQUEUE_HOLD", "REQUEUE_FED", "SUSPENDED", "STOPPED"];
const RUNNING: [&str; 5] = ["RUNNING", "COMPLETING", "SIGNALING", "STAGE_OUT", "RESIZING"];

/// The queue of Slurm.
pub(super) struct Slurm {
    /// Options of `sbatch` that the user gave.
    options: Vec<(String, String)>,
    /// Ends of jobs. Slurm forgets a job some minutes after its end.
    ended: BTreeMap<String, End>,
}

impl Slurm {
    pub(super) fn new(options: Vec<(String, String)>) -> Slurm {
        Slurm { options, ended: BTreeMap::new() }
    }

    fn script(&self, job: &Job) -> Result<String, String> {
        let command: Vec<String> =
            job.command.iter().map(|word| quoted(word)).collect::<Result<_, String>>()?;
        let folder = std::env::current_dir().map_err(|bad| format!("the working directory: {bad}"))?;
        let minutes = (job.time + job.notice).as_secs().div_ceil(60).max(1);
        let mut text = String::from("#!/bin/sh\n");
        let mut option = |key: &str, value: &str| {
            let _ = writeln!(text, "#SBATCH --{key}={value}");
        };
        option("job-name", &job.name);
        option("output", &pattern(&job.log)?);
        option("chdir", &word(&folder)?);
        option("ntasks", "1");
        option("cpus-per-task", &job.threads.to_string());
        option("mem", &format!("{}M", job.memory.div_ceil(1 << 20).max(1)));
        option("time", &minutes.to_string());
        option("signal", &format!("B:TERM@{}", job.notice.as_secs().max(1)));
        self.options.iter().for_each(|(key, value)| option(key, value));
        let _ = writeln!(text, "exec {}", command.join(" "));
        Ok(text)
    }
}

/// Path as the value of an option, in which a space would begin another one.
fn word(path: &Path) -> Result<String, String> {
    let text = path.to_str().ok_or_else(|| format!("{}: is not UTF-8", path.display()))?;
    match text.contains(['"', '\n']) {
        true => Err(format!("{text}: Slurm takes no path with a quotation mark or a line break")),
        false => Ok(format!("\"{text}\"")),
    }
}

/// Path of a log, in which `%` would begin a number of the job.
fn pattern(path: &Path) -> Result<String, String> {
    word(path).map(|text| text.replace('%', "%%"))
}

impl Executor for Slurm {
    fn submit(&mut self, job: &Job) -> Result<String, String> {
        let script = job.log.with_extension("sh");
        let text = self.script(job)?;
        disk::write(&script, text).map_err(|bad| format!("{}: {bad}", script.display()))?;
        let answer = said("sbatch", &["--parsable".as_ref(), script.as_os_str()])?;
        // The id may be followed by the name of the cluster.
        let id = answer.trim().split(';').next().unwrap_or_default();
        match !id.is_empty() && id.chars().all(|c| c.is_ascii_digit()) {
            true => Ok(id.into()),
            false => Err(format!("sbatch: answered {:?} in place of the number of a job", answer.trim())),
        }
    }

    fn poll(&mut self, ids: &[String]) -> Result<Vec<State>, String> {
        let left: Vec<&str> =
            ids.iter().filter(|id| !self.ended.contains_key(*id)).map(String::as_str).collect();
        let mut states = BTreeMap::new();
        if !left.is_empty() {
            let jobs = format!("--jobs={}", left.join(","));
            let answer = said("squeue", &["--noheader", "--states=all", "--format=%i|%T|%r", &jobs]);
            // Slurm refuses a list of jobs that it has all forgotten.
            let text = match answer {
                Err(bad) if bad.contains("Invalid job id") => String::new(),
                answer => answer?,
            };
            states.extend(text.lines().filter_map(state));
        }
        for id in left {
            match states.get(id) {
                Some(State::Ended(end)) => self.ended.insert(id.into(), end.clone()),
                Some(_) => None,
                None => self.ended.insert(id.into(), End::Failed("left the queue of Slurm".into())),
            };
        }
        let of = |id: &String| match self.ended.get(id) {
            Some(end) => State::Ended(end.clone()),
            None => states.get(id).cloned().unwrap_or(State::Running),
        };
        Ok(ids.iter().map(of).collect())
    }

    fn cancel(&mut self, ids: &[String]) -> Result<(), String> {
        let left: Vec<&String> = ids.iter().filter(|id| !self.ended.contains_key(*id)).collect();
        if left.is_empty() { Ok(()) } else { said("scancel", &left).map(drop) }
    }
}

/// Reads a line of `squeue`: id, state and reason.
fn state(line: &str) -> Option<(String, State)> {
    let mut parts = line.trim().splitn(3, '|');
    let (id, state, reason) = (parts.next()?, parts.next()?, parts.next().unwrap_or_default());
    let state = match state {
        _ if WAITING.contains(&state) => State::Waiting(reason.into()),
        _ if RUNNING.contains(&state) => State::Running,
        "COMPLETED" => State::Ended(End::Done),
        "TIMEOUT" | "DEADLINE" => State::Ended(End::OutOfTime),
        other if reason.is_empty() || reason == "None" => State::Ended(End::Failed(other.into())),
        other => State::Ended(End::Failed(format!("{other}: {reason}"))),
    };
    Some((id.into(), state))
}
