//! An adapter asked: its program called, and what it answers read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use geometry::Vector3;

use super::answer::{Answer, displacement};
use super::find::Found;
use super::work::{Folder, data_folder};
use crate::error::{Foreign, ForeignStatus};
use crate::process::{Call, End, Limits, call, said_within};

/// Python for all adapters, in place of their own.
const PYTHON: &str = "TISSUEBENCH_PYTHON";
/// How long a program may think about its version.
const VERSION: Duration = Duration::from_secs(8);

/// A problem in files, for an adapter.
pub(crate) struct Question<'a> {
    pub(crate) adapter: &'a Found,
    /// For what the adapter's programs need meanwhile.
    pub(crate) work: &'a Folder,
    /// The folder of the problem.
    pub(crate) problem: &'a Path,
    /// The folder to answer in.
    pub(crate) answer: &'a Path,
    /// Its id.
    pub(crate) id: &'a str,
    pub(crate) nodes: usize,
    /// Load steps; 0 of a linear procedure.
    pub(crate) steps: usize,
    pub(crate) limits: Limits,
    pub(crate) threads: usize,
}

/// An answer that is sound in its form.
#[derive(Debug)]
pub(crate) struct Answered {
    pub(crate) call: Call,
    pub(crate) answer: Answer,
    /// Displacement at the ends of steps, or at the end alone, m.
    pub(crate) fields: Vec<Vec<Vector3>>,
    /// Why it ended early, where its fields are those of a part of the load.
    pub(crate) stalled: Option<Foreign>,
}

/// Calls an adapter and reads its answer.
pub(crate) fn ask(question: &Question) -> Result<Answered, Foreign> {
    let failed = |reason: String| Foreign::new(ForeignStatus::Failed, reason);
    let command = command(question)?;
    let call = call(&command, question.limits)
        .map_err(|bad| failed(format!("{} can't be called: {bad}", question.adapter.manifest.name)))?;
    read(question, call)
}

fn read(question: &Question, call: Call) -> Result<Answered, Foreign> {
    let folder = question.answer;
    let failed = |reason: String| Foreign::new(ForeignStatus::Failed, reason);
    let status = match call.end {
        End::Exited(status) => status,
        End::OutOfTime => {
            let reason = format!("ended after {} s (time_limit)", question.limits.time.as_secs_f64());
            return Err(Foreign::new(ForeignStatus::TimedOut, reason));
        }
        End::OutOfMemory => {
            let (had, limit) = (call.memory >> 20, question.limits.memory >> 20);
            return Err(failed(format!("out of memory: ended with {had} MB of {limit} (memory_limit)")));
        }
    };
    let answer = match Answer::read(folder) {
        None if status.success() => {
            return Err(failed(format!("ended without {}{}", super::RESULT, said(&call))));
        }
        None => return Err(failed(format!("ended with {status}{}", said(&call)))),
        Some(answer) => answer.map_err(failed)?,
    };
    let objection = answer.objection(question.id).map_err(failed)?;
    // Part of a load is worth having, as far as it is said how much.
    let partial = objection.as_ref().is_some_and(|bad| bad.status == ForeignStatus::Stalled)
        && question.steps > 0
        && answer.load.is_some_and(|load| load > 0.0 && load < 1.0);
    if let (Some(objection), false) = (&objection, partial) {
        return Err(objection.clone());
    }
    if !status.success() {
        return Err(failed(format!("says ok, but ended with {status}{}", said(&call))));
    }
    let fields = displacement(folder, question.nodes, question.steps).map_err(failed)?;
    Ok(Answered { call, answer, fields, stalled: objection })
}

/// The last line of what a program said, behind a colon.
fn said(call: &Call) -> String {
    let line = call.last_words.lines().rev().find(|line| !line.trim().is_empty());
    line.map_or(String::new(), |line| format!(": {}", line.trim()))
}

/// The program with its arguments, in the folder that it answers in.
fn command(question: &Question) -> Result<Command, Foreign> {
    let Question { adapter: Found { manifest, .. }, problem, answer, .. } = question;
    ready(question.adapter).map_err(|reason| Foreign::new(ForeignStatus::NotOffered, reason))?;
    let failed = |reason: String| Foreign::new(ForeignStatus::Failed, reason);
    let folder = programs(question.adapter, question.work).map_err(failed)?;
    let word = |word: &String| fill(question.adapter, word, &folder, problem, answer);
    let mut words = manifest.run.iter().map(word);
    let mut command = Command::new(words.next().unwrap_or_default());
    command.args(words).current_dir(answer);
    if let Some(variable) = &manifest.threads.env {
        command.env(variable, question.threads.to_string());
    }
    Ok(command)
}

/// The folder with the programs of an adapter; those that this program brings with it are written out.
fn programs(adapter: &Found, work: &Folder) -> Result<PathBuf, String> {
    if let Some(folder) = &adapter.folder {
        return folder.canonicalize().map_err(|bad| format!("{}: {bad}", folder.display()));
    }
    let folder = work.inside("adapter")?;
    for (name, bytes) in adapter.files() {
        disk::write(&folder.join(&name), bytes).map_err(|bad| format!("{name}: can't be written: {bad}"))?;
    }
    Ok(folder)
}

/// A word of `run` as it is called.
fn fill(adapter: &Found, word: &str, folder: &Path, problem: &Path, answer: &Path) -> String {
    let own = folder.join(word);
    if !word.is_empty() && own.is_file() {
        return own.display().to_string();
    }
    let program = std::env::current_exe().map_or("tissuebench".into(), |path| path.display().to_string());
    word.replace("{problem}", &problem.display().to_string())
        .replace("{answer}", &answer.display().to_string())
        .replace("{folder}", &folder.display().to_string())
        .replace("{tissuebench}", &program)
        .replace("{python}", &python(&adapter.manifest.name).display().to_string())
}

/// The virtual environment of an adapter.
pub(crate) fn environment(name: &str) -> Option<PathBuf> {
    Some(data_folder()?.join("adapters").join(name).join("venv"))
}

fn python(name: &str) -> PathBuf {
    if let Some(given) = std::env::var_os(PYTHON).filter(|path| !path.is_empty()) {
        return given.into();
    }
    let own = environment(name).map(|venv| venv.join("bin/python"));
    own.filter(|path| path.exists()).unwrap_or_else(|| "python3".into())
}

/// Answers that do not change while this program runs, by the words of the question.
fn once<T: Clone>(known: &Mutex<BTreeMap<String, T>>, key: &str, find: impl FnOnce() -> T) -> T {
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry(key.to_string()).or_insert_with(find).clone()
}

/// Whether what an adapter needs is there; what to do where it is not.
pub(crate) fn ready(adapter: &Found) -> Result<(), String> {
    static KNOWN: Mutex<BTreeMap<String, Result<(), String>>> = Mutex::new(BTreeMap::new());
    let manifest = &adapter.manifest;
    once(&KNOWN, &format!("{manifest:?}"), || {
        let say = if manifest.install.say.is_empty() {
            String::new()
        } else {
            format!(": {}", manifest.install.say)
        };
        if let Some(program) = manifest.install.programs.iter().find(|program| !in_path(program)) {
            return Err(format!(
                "{} needs the program {program}, which is not installed{say}",
                manifest.name
            ));
        }
        let uses_python = manifest.run.iter().any(|word| word.contains("{python}"));
        let packages = &manifest.install.python;
        if !uses_python || has_packages(&python(&manifest.name), packages) {
            return Ok(());
        }
        let what = if packages.is_empty() { "Python".into() } else { packages.join(", ") };
        let name = &manifest.name;
        // What is said is of the programs where there are some, and otherwise of packages that pip does not bring.
        let say = match manifest.install.programs.is_empty() && !say.is_empty() {
            true => say,
            false => format!(": tissuebench adapter install {name}"),
        };
        Err(format!("{name} needs {what}, which is not installed{say}"))
    })
}

fn in_path(program: &str) -> bool {
    let paths = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&paths).any(|folder| folder.join(program).is_file())
}

/// Whether a Python is there and has packages, whatever their version.
fn has_packages(python: &Path, packages: &[String]) -> bool {
    let names = packages.iter().map(|package| {
        let name = package.split(['=', '<', '>', '~', '!', '[', ' ']).next().unwrap_or_default();
        format!("m.version({name:?})")
    });
    // Files of the folder that this program is called in are no modules.
    let script = format!(
        "import sys; sys.path = [p for p in sys.path if p]; import importlib.metadata as m; {}",
        names.collect::<Vec<_>>().join("; ")
    );
    said_within(Command::new(python).args(["-c", &script]), VERSION).is_ok_and(|(status, _)| status.success())
}

/// What an adapter's solver says of its version, in a line.
pub(crate) fn version(adapter: &Found) -> Option<String> {
    static KNOWN: Mutex<BTreeMap<String, Option<String>>> = Mutex::new(BTreeMap::new());
    once(&KNOWN, &format!("{:?}", adapter.manifest), || {
        let here = Path::new("");
        let folder = adapter.folder.as_ref().and_then(|folder| folder.canonicalize().ok());
        let word = |word: &String| fill(adapter, word, folder.as_deref().unwrap_or(here), here, here);
        let mut words = adapter.manifest.version.iter().map(word);
        let (_, said) = said_within(Command::new(words.next()?).args(words), VERSION).ok()?;
        let line = said.iter().flat_map(|text| text.lines()).map(str::trim).find(|line| !line.is_empty())?;
        Some(format!("{} ({})", adapter.manifest.title, line.chars().take(80).collect::<String>()))
    })
}
