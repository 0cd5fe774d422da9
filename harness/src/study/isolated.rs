//! `--isolate`: every run of a study in its own process. The program starts itself with the hidden command
//! `experiment`. A crash or an exceeded time limit affects only that run.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use clap::Args;

use super::args::VerifyArgs;
use super::plan::StudyPlan;
use super::store::Store;
use super::task::TaskResult;
use crate::adapter;
use crate::error::Failure;
use crate::process::group;
use crate::process::group::{Started, last_words};
use crate::run::case_name;

/// Shortest and longest time between two checks whether a process has ended.
const SHORTEST_PAUSE: Duration = Duration::from_micros(200);
const LONGEST_PAUSE: Duration = Duration::from_millis(50);

/// Arguments of the hidden command `experiment`: one run of a study in a process of its own.
#[derive(Args)]
pub struct ExperimentArgs {
    /// The study file
    pub study: PathBuf,
    /// Indices of the run tables that request the run
    #[arg(long, value_delimiter = ',')]
    pub tables: Vec<usize>,
    /// Number of the sample of uncertain inputs, from 0
    #[arg(long)]
    pub sample: Option<u32>,
    /// Key of the stored result
    #[arg(long)]
    pub key: String,
    /// File to which the result is written
    #[arg(long)]
    pub answer: PathBuf,
    /// Whether the study is run in its quick tier
    #[arg(long)]
    pub quick: bool,
    /// Id of the parent process, with which this process ends
    #[arg(long)]
    pub parent: u32,
    /// Memory that the run may allocate, bytes
    #[arg(long)]
    pub memory_limit: Option<u64>,
}

/// Runner that starts a process for each run.
pub(super) struct Apart<'a> {
    args: &'a VerifyArgs,
    study: PathBuf,
    store: &'a Store,
}

/// End of a process.
struct Ended {
    /// Exit status; `None` if the process exceeded its time limit.
    status: Option<ExitStatus>,
    last_words: String,
}

impl<'a> Apart<'a> {
    pub(super) fn new(args: &'a VerifyArgs, store: &'a Store) -> Apart<'a> {
        Apart { args, study: args.path(), store }
    }

    /// Runs a task and returns its result, or the failure that corresponds to the last end of its process. A
    /// run of a job whose process gave no result is repeated as often as `--retries` allows.
    pub(super) fn run(&self, plan: &StudyPlan, index: usize, key: &str) -> TaskResult {
        let mut retries = 0..self.args.on.retries.unwrap_or(0);
        loop {
            match self.once(plan, index, key) {
                Err(_) if retries.next().is_some() => {}
                Ok(result) => return result,
                Err(failure) => {
                    let task = &plan.tasks[index];
                    let case = case_name(&plan.scenes[task.scene].2);
                    return TaskResult::failed(&case, &task.method, &failure);
                }
            }
        }
    }

    fn once(&self, plan: &StudyPlan, index: usize, key: &str) -> Result<TaskResult, Failure> {
        let task = &plan.tasks[index];
        let answer = self.store.answer(key);
        let _ = disk::remove(&answer);
        // A killed process leaves its temporary files behind, so it gets its own folder.
        let work = adapter::Folder::new().map_err(std::io::Error::other);
        let ended = work.and_then(|work| {
            let mut command = self.command(&task.runs, plan.sample(task), key, &answer)?;
            self.watch(command.env("TMPDIR", work.path()))
        });
        // The answer file is either complete or absent.
        let result = disk::read_text(&answer, disk::Kind::RESULTS)
            .ok()
            .and_then(|text| serde_json::from_str(&text).ok());
        let _ = disk::remove(&answer);
        match (ended, result) {
            (Ok(Ended { status: Some(_), .. }), Some(result)) => Ok(result),
            (Ok(ended), _) => Err(self.failure(&ended)),
            (Err(bad), _) => Err(Failure::Run(format!("could not be started: {bad}"))),
        }
    }

    fn command(
        &self,
        tables: &[usize],
        sample: Option<u32>,
        key: &str,
        answer: &Path,
    ) -> std::io::Result<Command> {
        let mut command = Command::new(std::env::current_exe()?);
        let tables: Vec<String> = tables.iter().map(usize::to_string).collect();
        command.arg("experiment").arg(&self.study).arg("--tables").arg(tables.join(","));
        command.args(["--key", key]).arg("--answer").arg(answer);
        command.args(["--parent", &std::process::id().to_string()]);
        command.args(["--threads", &rayon::current_num_threads().to_string()]);
        command.args(self.args.quick.then_some("--quick"));
        command.args(adapter::leaves_local_out().then_some("--no-local-adapters"));
        if let Some(sample) = sample {
            command.args(["--sample", &sample.to_string()]);
        }
        if let Some(bytes) = self.args.apart.memory_limit {
            command.args(["--memory-limit", &bytes.to_string()]);
        }
        if let Ok(folders) = std::env::join_paths(adapter::given_folders()) {
            command.env(adapter::FOLDERS, folders);
        }
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        Ok(command)
    }

    /// Waits for a process up to its time limit, then ends everything that the process has started.
    fn watch(&self, command: &mut Command) -> std::io::Result<Ended> {
        let mut started = Started::new(command)?;
        let stderr = started.child().stderr.take();
        let reader = std::thread::spawn(move || stderr.map_or_else(String::new, last_words));
        let began = Instant::now();
        let in_time = loop {
            if started.has_ended().unwrap_or(true) {
                break true;
            }
            if self.args.apart.time_limit.is_some_and(|limit| began.elapsed() > limit) {
                break false;
            }
            // The pause is a tenth of the elapsed time, so that the end of a run is noticed without a
            // relevant delay.
            std::thread::sleep((began.elapsed() / 10).clamp(SHORTEST_PAUSE, LONGEST_PAUSE));
        };
        let status = started.end()?;
        let last_words = reader.join().unwrap_or_default();
        Ok(Ended { status: in_time.then_some(status), last_words })
    }

    fn failure(&self, ended: &Ended) -> Failure {
        let said = ended.last_words.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("");
        let limits = &self.args.apart;
        let memory = ended.last_words.lines().find(|line| line.contains("memory allocation of"));
        Failure::Run(match (&ended.status, memory) {
            (None, _) => {
                let limit = limits.time_limit.unwrap_or_default().as_secs_f64();
                format!("out of time: ended after {limit} s (--time-limit)")
            }
            (Some(_), Some(line)) => match limits.memory_limit {
                Some(bytes) => format!("out of memory: {line} within {bytes} bytes (--memory-limit)"),
                None => format!("out of memory: {line}"),
            },
            (Some(status), None) => format!("crashed ({status}): {said}"),
        })
    }
}

/// Executes the command `experiment`: runs the task and writes its result.
pub(crate) fn experiment(args: &ExperimentArgs) -> Result<(), Failure> {
    // Buffers that the libraries keep for good do not count towards the run's memory limit.
    algebra::reserve_workspaces();
    group::limit(args.parent, args.memory_limit).map_err(|bad| Failure::Run(bad.to_string()))?;
    let unreadable = |errors: Vec<cases::scene::SceneError>| {
        Failure::Input(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    };
    let first = args.tables.first().copied().unwrap_or_default();
    let study = cases::scene::load_study_for(&args.study, first).map_err(unreadable)?;
    let plan = StudyPlan::of_tables(study, &args.tables, args.sample).map_err(unreadable)?;
    // The runs of a fit are stored next to those of the study.
    let out = args.answer.parent().and_then(|tasks| tasks.parent()).unwrap_or(Path::new("")).into();
    let verify = VerifyArgs { quick: args.quick, out, ..VerifyArgs::of(&args.study) };
    let index = (0..plan.len()).find(|&index| plan.key(index, &verify) == args.key);
    let index = index
        .ok_or_else(|| Failure::Input("the scene of this run has changed since the study began".into()))?;
    let result = plan.run(index, &verify, &mut None);
    if let Some(folder) = args.answer.parent() {
        std::fs::create_dir_all(folder).map_err(|bad| Failure::Run(bad.to_string()))?;
    }
    let text = serde_json::to_string(&result).map_err(|bad| Failure::Run(bad.to_string()))?;
    records::write_text(&args.answer, text).map_err(|bad| Failure::Run(bad.to_string()))
}
