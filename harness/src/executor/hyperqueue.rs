//! Jobs of HyperQueue, by its program `hq`.

use std::collections::BTreeMap;
use std::ffi::OsString;

use serde::Deserialize;

use super::job::{End, Executor, Job, State};
use super::programs::{LATE, limited, said};

/// The queue of a server of HyperQueue.
pub(super) struct HyperQueue {
    /// Options of `hq submit` that the user gave.
    options: Vec<(String, String)>,
}

impl HyperQueue {
    pub(super) fn new(options: Vec<(String, String)>) -> HyperQueue {
        HyperQueue { options }
    }
}

/// Answer to `hq submit`.
#[derive(Deserialize)]
struct Submitted {
    id: u32,
}

/// Answer to `hq job info`. A job has one task here.
#[derive(Deserialize)]
struct Detail {
    info: Info,
    #[serde(default)]
    tasks: Vec<Task>,
}

#[derive(Deserialize)]
struct Info {
    id: u32,
}

#[derive(Deserialize)]
struct Task {
    state: String,
    #[serde(default)]
    error: String,
}

/// Reads an answer in JSON.
fn read<T: for<'a> Deserialize<'a>>(text: &str) -> Result<T, String> {
    serde_json::from_str(text)
        .map_err(|bad| format!("hq: its answer is not understood: {bad}: {}", text.trim()))
}

/// Calls `hq` with an answer in JSON.
fn asked(args: Vec<OsString>) -> Result<String, String> {
    said("hq", &[vec!["--output-mode=json".into()], args].concat())
}

impl Executor for HyperQueue {
    fn submit(&mut self, job: &Job) -> Result<String, String> {
        let folder = std::env::current_dir().map_err(|bad| format!("the working directory: {bad}"))?;
        let option = |key: &str, value: &OsString| {
            let mut word = OsString::from(format!("--{key}="));
            word.push(value);
            word
        };
        let mut args = vec![
            "submit".into(),
            option("name", &(&job.name).into()),
            option("cpus", &job.threads.to_string().into()),
            option("cwd", &folder.into()),
            option("stdout", &job.log.clone().into()),
            "--stderr=none".into(),
            "--directives=off".into(),
        ];
        args.extend(self.options.iter().map(|(key, value)| option(key, &value.into())));
        args.push("--".into());
        // Two open files of one log would overwrite each other.
        args.extend(["sh", "-c", "exec \"$@\" 2>&1", "sh"].map(Into::into));
        args.extend(limited(job));
        asked(args).and_then(|text| read(&text)).map(|Submitted { id }| id.to_string())
    }

    fn poll(&mut self, ids: &[String]) -> Result<Vec<State>, String> {
        let details: Vec<Detail> = read(&asked(vec!["job".into(), "info".into(), ids.join(",").into()])?)?;
        let states: BTreeMap<String, State> =
            details.iter().map(|detail| (detail.info.id.to_string(), state(detail))).collect();
        let gone = || State::Ended(End::Failed("HyperQueue has forgotten the job".into()));
        Ok(ids.iter().map(|id| states.get(id).cloned().unwrap_or_else(gone)).collect())
    }

    fn cancel(&mut self, ids: &[String]) -> Result<(), String> {
        if ids.is_empty() { Ok(()) } else { said("hq", &["job", "cancel", &ids.join(",")]).map(drop) }
    }
}

fn state(detail: &Detail) -> State {
    let Some(task) = detail.tasks.first() else { return State::Waiting(String::new()) };
    match task.state.as_str() {
        "waiting" => State::Waiting("no free worker".into()),
        "running" => State::Running,
        "finished" => State::Ended(End::Done),
        "canceled" => State::Ended(End::Failed("cancelled".into())),
        _ if task.error.contains(&format!("exit code {LATE}")) => State::Ended(End::OutOfTime),
        _ => State::Ended(End::Failed(task.error.clone())),
    }
}
