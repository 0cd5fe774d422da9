//! Calls the program of an adapter and reads its answer.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use geometry::Vector3;

use super::answer::{Answer, displacement};
use super::find::Found;
use super::manifest::Manifest;
use super::work::{Folder, data_folder};
use crate::error::{Foreign, ForeignStatus};
use crate::process::{Call, End, Limits, call, said_within};

/// Environment variable with the Python interpreter for all adapters, instead of their own.
const PYTHON: &str = "TISSUEBENCH_PYTHON";
/// Time limit for printing a version.
const VERSION: Duration = Duration::from_secs(8);

/// A problem in files for an adapter.
pub(crate) struct Question<'a> {
    pub(crate) adapter: &'a Found,
    /// Folder for the adapter's own program files during the call.
    pub(crate) work: &'a Folder,
    /// The folder of the problem.
    pub(crate) problem: &'a Path,
    /// The folder for the answer.
    pub(crate) answer: &'a Path,
    /// Id of the problem.
    pub(crate) id: &'a str,
    pub(crate) nodes: usize,
    /// Number of load steps; 0 for a linear procedure.
    pub(crate) steps: usize,
    pub(crate) limits: Limits,
    pub(crate) threads: usize,
}

/// An answer that passed the checks of its form.
#[derive(Debug)]
pub(crate) struct Answered {
    pub(crate) call: Call,
    pub(crate) answer: Answer,
    /// Displacement, m, at the ends of the load steps, or only at the end.
    pub(crate) fields: Vec<Vec<Vector3>>,
    /// Reason for an early end; the fields then cover a part of the load.
    pub(crate) stalled: Option<Foreign>,
}

/// Calls an adapter and reads its answer.
///
/// # Errors
/// Returns an error if the adapter is not ready, exceeds a limit, crashes, or returns an invalid or failed
/// answer. A stalled load path with a known load fraction is not an error.
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
            let had = call.memory >> 20;
            let limit = question.limits.memory >> 20;
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
    // A part of the load is a usable result if the answer states the load fraction.
    let partial = objection.as_ref().is_some_and(|bad| bad.status == ForeignStatus::Stalled)
        && question.steps > 0
        && answer.load.is_some_and(|load| load > 0.0 && load < 1.0);
    if let (Some(objection), false) = (&objection, partial) {
        return Err(objection.clone());
    }
    if !status.success() {
        return Err(failed(format!("reported ok, but ended with {status}{}", said(&call))));
    }
    let fields = displacement(folder, question.nodes, question.steps).map_err(failed)?;
    Ok(Answered { call, answer, fields, stalled: objection })
}

/// Returns the last non-empty line of the program's stderr after a colon.
fn said(call: &Call) -> String {
    let line = call.last_words.lines().rev().find(|line| !line.trim().is_empty());
    line.map_or(String::new(), |line| format!(": {}", line.trim()))
}

/// Returns the command of the adapter, run in the answer folder.
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

/// Returns the folder with the adapter's programs. Those compiled into this program are written to `work`.
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

/// Replaces the placeholders in one word of `run`.
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

/// Returns the folder of the adapter's virtual environment.
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

/// Values by manifest.
type Known<T> = Mutex<BTreeMap<Manifest, T>>;

/// Returns the value stored for a manifest, or computes and stores it. Such values do not change while the
/// program runs.
fn once<T: Clone>(known: &Known<T>, manifest: &Manifest, find: impl FnOnce() -> T) -> T {
    let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry(manifest.clone()).or_insert_with(find).clone()
}

/// Checks that the requirements of an adapter are installed; the error says how to install them.
pub(crate) fn ready(adapter: &Found) -> Result<(), String> {
    static KNOWN: Known<Result<(), String>> = Mutex::new(BTreeMap::new());
    let manifest = &adapter.manifest;
    once(&KNOWN, manifest, || {
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
        // The manifest's instructions apply to programs, or else to packages that pip does not provide.
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

/// Whether this Python exists and has the packages, in any version.
fn has_packages(python: &Path, packages: &[String]) -> bool {
    let names = packages.iter().map(|package| {
        let name = package.split(['=', '<', '>', '~', '!', '[', ' ']).next().unwrap_or_default();
        format!("m.version({name:?})")
    });
    // Files in the working directory must not be imported as modules.
    let script = format!(
        "import sys; sys.path = [p for p in sys.path if p]; import importlib.metadata as m; {}",
        names.collect::<Vec<_>>().join("; ")
    );
    said_within(Command::new(python).args(["-c", &script]), VERSION).is_ok_and(|(status, _)| status.success())
}

/// Returns the version of an adapter's solver in one line.
pub(crate) fn version(adapter: &Found) -> Option<String> {
    static KNOWN: Known<Option<String>> = Mutex::new(BTreeMap::new());
    once(&KNOWN, &adapter.manifest, || {
        let here = Path::new("");
        let folder = adapter.folder.as_ref().and_then(|folder| folder.canonicalize().ok());
        let word = |word: &String| fill(adapter, word, folder.as_deref().unwrap_or(here), here, here);
        let mut words = adapter.manifest.version.iter().map(word);
        let (_, said) = said_within(Command::new(words.next()?).args(words), VERSION).ok()?;
        let line = said.iter().flat_map(|text| text.lines()).map(str::trim).find(|line| !line.is_empty())?;
        Some(format!("{} ({})", adapter.manifest.title, line.chars().take(80).collect::<String>()))
    })
}
