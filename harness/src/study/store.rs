//! Stored results of single runs in the folder of a study: one file per run, written as soon as the run is
//! finished.

use std::collections::BTreeSet;
use std::fs::{self, File, TryLockError};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use catalogue::metric;
use disk::Kind;
use records::{Machine, Program, RecordError};
use serde::{Deserialize, Serialize};

use super::args::VerifyArgs;
use super::task::TaskResult;
use crate::outcome::provenance;

/// Folder of the stored results, relative to the folder of results.
const TASKS: &str = "tasks";

/// Program and machine that made a result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Maker {
    /// The program's build. Results of another build are not reused.
    program: Program,
    /// Hash of the program's file.
    hash: String,
    /// Processor and number of threads, because times of another machine are not comparable. The load is not
    /// included: a study is resumed at another time.
    machine: String,
}

impl Maker {
    /// The running program on this machine.
    pub(super) fn new(program: &Program, machine: &Machine) -> Maker {
        // Fits and refinements of samples store results many times, and the program has 200 MB.
        static HASH: OnceLock<String> = OnceLock::new();
        let hash = HASH.get_or_init(|| {
            let bytes = std::env::current_exe().and_then(fs::read).unwrap_or_default();
            blake3::hash(&bytes).to_hex().to_string()
        });
        let Machine { cpu, model, instructions, threads, .. } = machine;
        Maker {
            program: program.clone(),
            hash: hash.clone(),
            machine: format!("{cpu}, {model}, {instructions}, {threads} threads"),
        }
    }
}

/// Stored results that may replace a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Accept {
    /// No stored results.
    Nothing,
    /// Results of this program on this machine that did not fail.
    Finished,
    /// Results of this program on any machine that did not fail.
    FinishedAnywhere,
    /// All results of this program, including those of other processes that work on the study.
    All,
    /// All results, of any build of the program.
    AnyBuild,
}

/// Machines whose stored times count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Machines {
    /// This machine with this number of threads.
    This,
    /// Any machine.
    Any,
}

/// Lock of a task, held until it is dropped.
pub(super) struct Claim {
    /// Lock, held as long as the file is open.
    _lock: File,
    path: PathBuf,
    token: String,
}

impl Claim {
    /// Whether no other process has taken the task. A network file system may drop the lock of a process that
    /// it has not heard of for some time; the next owner writes its own token.
    pub(super) fn is_live(&self) -> bool {
        match disk::read_text(&self.path, Kind::MESSAGE) {
            Ok(token) => token == self.token,
            // Windows refuses to read a locked file.
            Err(bad) => bad.kind() != io::ErrorKind::NotFound,
        }
    }
}

/// Measured cost of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cost {
    /// Time with all repeats, s.
    pub(super) seconds: f64,
    /// Peak memory, bytes, if it was recorded.
    pub(super) bytes: Option<f64>,
}

#[derive(Serialize)]
struct Stored<'a> {
    by: &'a Maker,
    result: &'a TaskResult,
}

#[derive(Deserialize)]
struct Read {
    by: Maker,
    result: TaskResult,
}

/// Prefix of a stored result, which is followed by the hash: `{"hash":"...",` and the rest of the object.
const HASH: &str = "{\"hash\":\"";
const DIGITS: usize = 64;

/// Hash of a stored result and of its key, so that a result cannot be taken for that of another run.
fn hash(key: &str, rest: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(key.as_bytes()).update(rest.as_bytes());
    hasher.finalize().to_hex().to_string()
}

/// Text of a stored result with its hash.
fn sealed(key: &str, stored: &Stored) -> serde_json::Result<String> {
    let text = serde_json::to_string(stored)?;
    let rest = &text[1..];
    Ok(format!("{HASH}{}\",{rest}", hash(key, rest)))
}

/// Parses a stored result. A result that has changed since it was stored is refused.
fn unsealed(path: &Path, key: &str, text: &str) -> Result<Read, String> {
    let hashed = text.strip_prefix(HASH).and_then(|text| text.split_at_checked(DIGITS));
    let parts = hashed.and_then(|(hash, rest)| Some((hash, rest.strip_prefix("\",")?)));
    if parts.is_none_or(|(found, rest)| found != hash(key, rest)) {
        return Err(format!("{} does not match its stored hash: the file was changed", path.display()));
    }
    serde_json::from_str(text).map_err(|bad| format!("{}: {bad}", path.display()))
}

/// Reads the text of a stored result; `None` if there is none.
fn stored(path: &Path) -> Result<Option<String>, String> {
    match disk::read_text(path, Kind::RESULTS) {
        Ok(text) => Ok(Some(text)),
        Err(bad) if bad.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(bad) => Err(format!("{}: {bad}", path.display())),
    }
}

/// Folder of stored results.
pub(super) struct Store {
    folder: PathBuf,
    by: Maker,
}

impl Store {
    /// Store of the results of the single runs of a study.
    pub(super) fn of(args: &VerifyArgs) -> Store {
        Store::new(&args.out, Maker::new(&provenance::program(), &provenance::machine()))
    }

    pub(super) fn new(out: &Path, by: Maker) -> Store {
        Store { folder: out.join(TASKS), by }
    }

    fn file(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.json"))
    }

    /// File to which an isolated process writes the result of a key, before the result is accepted.
    pub(super) fn answer(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.answer"))
    }

    /// Returns the stored result of a key if `accept` allows the result; otherwise `None`.
    ///
    /// # Errors
    /// Returns a message if the result cannot be read or has changed since it was stored.
    pub(super) fn load(&self, key: &str, accept: Accept) -> Result<Option<TaskResult>, String> {
        if accept == Accept::Nothing {
            return Ok(None);
        }
        let path = self.file(key);
        let Some(text) = stored(&path)? else { return Ok(None) };
        let Read { by, result } = unsealed(&path, key, &text)?;
        let same_build = by.program == self.by.program && by.hash == self.by.hash;
        let good = match accept {
            Accept::Nothing => false,
            Accept::Finished => by == self.by && result.failure.is_none(),
            Accept::FinishedAnywhere => same_build && result.failure.is_none(),
            Accept::All => same_build,
            Accept::AnyBuild => true,
        };
        Ok(good.then_some(result))
    }

    /// Measured cost of the task with this key, from any build of the program; `None` if the task failed.
    pub(super) fn cost(&self, key: &str, from: Machines) -> Option<Cost> {
        let path = self.file(key);
        let Read { by, result } = unsealed(&path, key, &stored(&path).ok()??).ok()?;
        let known = from == Machines::Any || by.machine == self.by.machine;
        let memory = result.records.iter().filter(|record| record.is(&metric::MEMORY));
        let bytes = memory.map(|record| record.value).reduce(f64::max);
        (known && result.failure.is_none() && result.seconds > 0.0)
            .then_some(Cost { seconds: result.seconds, bytes })
    }

    /// Stores a result. The file is written under another name and renamed, so that an interruption leaves no
    /// partial file.
    pub(super) fn save(&self, key: &str, result: &TaskResult) -> Result<(), RecordError> {
        let path = self.file(key);
        let unwritten = |source| RecordError::Unwritten { path: path.clone(), source };
        fs::create_dir_all(&self.folder).map_err(unwritten)?;
        let text = sealed(key, &Stored { by: &self.by, result });
        records::write_text(&path, text.map_err(|bad| unwritten(bad.into()))?)
    }

    /// Locks a task for this process until the claim is dropped; `None` if another process holds the
    /// lock. The system releases the locks of a process that dies.
    ///
    /// # Errors
    /// Returns an error if the lock file cannot be created or locked.
    pub(super) fn claim(&self, key: &str) -> io::Result<Option<Claim>> {
        fs::create_dir_all(&self.folder)?;
        let path = self.claim_file(key);
        let mut lock = disk::create_lock(&path)?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(bad)) => return Err(bad),
        }
        let token = format!("{} {:016x}", std::process::id(), RandomState::new().hash_one(&path));
        lock.set_len(0)?;
        lock.write_all(token.as_bytes())?;
        Ok(Some(Claim { _lock: lock, path, token }))
    }

    /// Whether a process holds the lock of a task.
    pub(super) fn is_claimed(&self, key: &str) -> bool {
        let path = self.claim_file(key);
        path.exists()
            && disk::create_lock(&path)
                .is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
    }

    fn claim_file(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.claim"))
    }

    /// Removes all results except the accepted ones. From then on, all results come from processes that work
    /// on the study together. Call it only in the first of them.
    pub(super) fn sweep(&self, accept: Accept) {
        for path in files(&self.folder, &["json"]) {
            let key = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if !matches!(self.load(&key, accept), Ok(Some(_))) {
                let _ = disk::remove(&path);
            }
        }
    }
}

/// Programs and machines that made the results of a study's shares.
#[derive(Default)]
pub(super) struct Share {
    build: Option<(Program, String)>,
    /// Machines on which the results were made.
    pub(super) machines: BTreeSet<String>,
}

impl Share {
    /// Reads a result in a folder, with its text; `None` if there is none.
    ///
    /// # Errors
    /// Returns a message if the result cannot be read or was made by another build than the results before.
    pub(super) fn take(&mut self, out: &Path, key: &str) -> Option<Result<(String, TaskResult), String>> {
        let path = out.join(TASKS).join(format!("{key}.json"));
        let read = stored(&path).and_then(|text| {
            let Some(text) = text else { return Ok(None) };
            unsealed(&path, key, &text).map(|read| Some((text, read)))
        });
        let (text, Read { by, result }) = match read {
            Ok(found) => found?,
            Err(problem) => return Some(Err(problem)),
        };
        let build = (by.program, by.hash);
        if *self.build.get_or_insert_with(|| build.clone()) != build {
            return Some(Err(format!("{} was written by another build of the program", path.display())));
        }
        self.machines.insert(by.machine);
        Some(Ok((text, result)))
    }
}

/// Whether a folder of results contains stored results of single runs.
pub fn has_stored(out: &Path) -> bool {
    !files(&out.join(TASKS), &["json"]).is_empty()
}

/// Stores the text of a result from another folder.
pub(super) fn keep(out: &Path, key: &str, text: &str) -> Result<(), RecordError> {
    let folder = out.join(TASKS);
    fs::create_dir_all(&folder).map_err(|source| RecordError::Unwritten { path: folder.clone(), source })?;
    records::write_text(&folder.join(format!("{key}.json")), text)
}

/// Keeps only finished results of this program: those of this machine, or with `--on` those of any machine.
/// Only the first joining process calls it.
pub(crate) fn sweep(args: &VerifyArgs) {
    clean(&args.out);
    let anywhere = args.on.on.is_some();
    Store::of(args).sweep(if anywhere { Accept::FinishedAnywhere } else { Accept::Finished });
}

/// Removes files that killed processes left in a folder of results. Call it only if no other process uses the
/// folder.
pub(crate) fn clean(out: &Path) {
    for path in files(&out.join(TASKS), &["partial", "claim", "answer"]) {
        let _ = disk::remove(&path);
    }
}

fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    paths.filter(|path| path.extension().is_some_and(|e| endings.iter().any(|ending| e == *ending))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn store(dir: &Path, program: &Program, machine: &Machine) -> Store {
        Store::new(dir, Maker::new(program, machine))
    }

    #[test]
    fn another_program_machine_or_number_of_threads_runs_anew() {
        let dir = tempfile::tempdir().unwrap();
        let program = Program::default();
        let machine = Machine { threads: 2, ..Machine::default() };
        let known = store(dir.path(), &program, &machine);
        known.save("key", &TaskResult::default()).unwrap();
        let found = |program: &Program, machine: &Machine, accept| {
            store(dir.path(), program, machine).load("key", accept).unwrap().is_some()
        };
        let later = Machine { load: Some(3.0), quiet: Some(false), clock: Some(3.1), ..machine.clone() };
        assert!(found(&program, &later, Accept::Finished));
        assert!(!found(&program, &later, Accept::Nothing));
        for other in
            [Machine { threads: 1, ..machine.clone() }, Machine { cpu: "another".into(), ..machine.clone() }]
        {
            assert!(!found(&program, &other, Accept::Finished));
            assert!(found(&program, &other, Accept::All));
        }
        for other in [
            Program { commit: "another".into(), ..program.clone() },
            Program { dirty: true, ..program.clone() },
        ] {
            assert!(!found(&other, &machine, Accept::Finished) && !found(&other, &machine, Accept::All));
        }
    }

    #[test]
    fn shares_of_two_machines_are_joined_and_of_two_builds_are_not() {
        let dir = tempfile::tempdir().unwrap();
        let (program, machine) = (Program::default(), Machine::default());
        let other_machine = Machine { cpu: "another".into(), ..machine.clone() };
        let other_program = Program { commit: "another".into(), ..program.clone() };
        let mut share = Share::default();
        let mut take = |name: &str, program: &Program, machine: &Machine| {
            let folder = dir.path().join(name);
            store(&folder, program, machine).save("key", &TaskResult::default()).unwrap();
            share.take(&folder, "key").unwrap().map(|_| ())
        };
        assert!(take("one", &program, &machine).is_ok() && take("two", &program, &other_machine).is_ok());
        assert!(take("three", &other_program, &machine).unwrap_err().contains("another build"));
        assert_eq!(share.machines.len(), 2);
    }

    #[test]
    fn a_changed_result_and_one_of_another_key_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let store = store(dir.path(), &Program::default(), &Machine::default());
        let record = records::Record { value: 0.125, ..records::Record::default() };
        store.save("key", &TaskResult { records: vec![record], ..TaskResult::default() }).unwrap();
        let load = |key: &str| store.load(key, Accept::Finished);
        assert_eq!(load("key").unwrap().unwrap().records[0].value, 0.125);
        let text = fs::read_to_string(store.file("key")).unwrap();
        fs::write(store.file("other"), &text).unwrap();
        assert!(load("other").unwrap_err().contains("other.json does not match its stored hash"));
        for changed in
            [text.replace("0.125", "0.126"), text.replacen(HASH, "{\"hush\":\"", 1), text[..80].into()]
        {
            fs::write(store.file("key"), changed).unwrap();
            assert!(load("key").unwrap_err().contains("the file was changed"));
            let taken = Share::default().take(dir.path(), "key").unwrap();
            assert!(taken.unwrap_err().contains("the file was changed"));
        }
    }

    #[test]
    fn a_task_is_claimed_once_and_free_again_after_its_holder() {
        let dir = tempfile::tempdir().unwrap();
        let store = store(dir.path(), &Program::default(), &Machine::default());
        let free = |key| store.claim(key).unwrap();
        let claim = free("key");
        assert!(free("key").is_none() && free("other").is_some());
        let claim = claim.unwrap();
        assert!(claim.is_live());
        fs::write(store.claim_file("key"), "another process").unwrap();
        assert!(!claim.is_live());
        drop(claim);
        assert!(free("key").is_some());
    }

    #[test]
    fn a_sweep_leaves_finished_results_only() {
        let dir = tempfile::tempdir().unwrap();
        let store = store(dir.path(), &Program::default(), &Machine::default());
        store.save("finished", &TaskResult::default()).unwrap();
        let failure = crate::Failure::Run("rigid".into());
        let failed = (records::Failure { reason: failure.to_string(), ..records::Failure::default() }, 3);
        store.save("failed", &TaskResult { failure: Some(failed), ..TaskResult::default() }).unwrap();
        for (name, text) in [("half.json", "{"), ("killed.json.partial", ""), ("killed.claim", "")] {
            fs::write(store.folder.join(name), text).unwrap();
        }
        assert!(
            store.load("failed", Accept::All).unwrap().is_some()
                && store.load("failed", Accept::Finished).unwrap().is_none()
        );
        store.sweep(Accept::Finished);
        clean(dir.path());
        assert_eq!(files(&store.folder, &["json", "partial", "claim"]), [store.file("finished")]);
    }
}
