//! Output folder of a study or scene. Results of another study or scene do not replace those in the folder.
//! Only one process uses the folder at a time, unless all processes join the same study.

use std::collections::BTreeSet;
use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::error::Failure;

/// Lock file, which contains the ids of the processes in the folder. The system releases the lock of a
/// process that dies.
const LOCK: &str = ".lock";
/// Longest time for which the first process inspects a folder before others may join.
const ENTRY: Duration = Duration::from_secs(10);

/// Output folder that this process has locked.
pub(crate) struct Folder {
    path: PathBuf,
    /// Lock, held as long as the file is open.
    lock: File,
    /// Whether the results in the folder were complete when the folder was locked.
    whole: bool,
}

/// Name of the results in a folder: the file name of the study or scene.
pub(crate) fn source(file: &Path) -> String {
    file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Creates and locks the folder before anything is solved, so that no finished run loses its results.
///
/// # Errors
/// Returns an error if `out` is a file, if the folder cannot be written or is in use, and if it holds the
/// results of another scene or study.
pub(crate) fn take(file: &Path, out: &Path) -> Result<Folder, Failure> {
    let mut lock = open(file, out)?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => return Err(in_use(out, &mut lock)),
        // The file system has no locks: the user has to keep other processes out.
        Err(TryLockError::Error(_)) => {
            eprintln!("{}: can't be locked; make sure that no other process uses the folder", out.display())
        }
    }
    enter(out, lock, true)
}

/// Same as [`take`] for processes that work on a folder together. The first process calls `prepare` while it
/// is alone.
pub(crate) fn join(file: &Path, out: &Path, prepare: impl FnOnce()) -> Result<Folder, Failure> {
    let mut lock = open(file, out)?;
    let first = lock.try_lock().is_ok();
    if first {
        prepare();
        lock.unlock().map_err(|bad| unwritable(out, &bad))?;
    }
    let began = Instant::now();
    loop {
        match lock.try_lock_shared() {
            Ok(()) => return enter(out, lock, first),
            Err(TryLockError::WouldBlock) if began.elapsed() < ENTRY => {
                std::thread::sleep(Duration::from_millis(10));
            }
            Err(TryLockError::WouldBlock) => return Err(in_use(out, &mut lock)),
            Err(TryLockError::Error(bad)) => {
                let problem =
                    format!("--out {}: can't be locked: {bad}; use --shard and merge", out.display());
                return Err(Failure::Run(problem));
            }
        }
    }
}

fn open(file: &Path, out: &Path) -> Result<File, Failure> {
    free_for(file, out).map_err(Failure::Input)?;
    if out.exists() && !out.is_dir() {
        return Err(Failure::Input(format!("--out {}: is a file; give a folder", out.display())));
    }
    let opened = || {
        std::fs::create_dir_all(out)?;
        disk::create_lock(&out.join(LOCK))
    };
    opened().map_err(|bad| unwritable(out, &bad))
}

/// Adds the process id to the lock file, which also shows that the disk has space for a few bytes.
fn enter(out: &Path, mut lock: File, first: bool) -> Result<Folder, Failure> {
    let mut sign = || {
        if first {
            lock.set_len(0)?;
        }
        lock.seek(SeekFrom::End(0))?;
        writeln!(lock, "{}", std::process::id())
    };
    sign().map_err(|bad| unwritable(out, &bad))?;
    Ok(Folder { path: out.into(), lock, whole: !records::is_incomplete(out) })
}

fn in_use(out: &Path, lock: &mut File) -> Failure {
    let mut holders = String::new();
    let _ = lock.read_to_string(&mut holders);
    let holders: Vec<&str> = holders.lines().collect();
    Failure::Input(format!(
        "{} is in use by process {}; wait, give another folder with --out, or let processes share the study with --join",
        out.display(),
        holders.join(", ")
    ))
}

/// Error of a folder that cannot be written. Missing space or permissions stop the run; any other cause is
/// invalid input.
fn unwritable(out: &Path, bad: &std::io::Error) -> Failure {
    let problem = format!("--out {}: {bad}; give a folder that can be written", out.display());
    match bad.kind() {
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem | ErrorKind::StorageFull => {
            Failure::Run(problem)
        }
        _ => Failure::Input(problem),
    }
}

impl Folder {
    /// Marks the results as incomplete until they are written. It waits while another process writes its
    /// results, which that process reads again for its report.
    pub(crate) fn begin(&self, file: &Path) -> Result<(), Failure> {
        let _lock = self.writing();
        records::begin(&self.path, &source(file)).map_err(|bad| Failure::Run(bad.to_string()))
    }

    /// Restores the mark of complete results if nothing was run.
    pub(crate) fn leave(self) {
        if self.whole {
            let _ = records::end(&self.path);
        }
    }

    /// Locks out other processes of the same study, which may write their results at the same time. All
    /// processes write the same results. The second value says whether another process has already written
    /// them.
    pub(crate) fn writing(&self) -> (Option<File>, bool) {
        let file = disk::create_lock(&self.path.join(".writing")).ok();
        if let Some(file) = &file {
            let _ = file.lock();
        }
        (file, !records::is_incomplete(&self.path))
    }

    /// Releases the folder. Calls `clean` if no other process is left in it.
    pub(crate) fn close(self, clean: impl FnOnce()) {
        if self.lock.unlock().is_ok() && self.lock.try_lock().is_ok() {
            let _ = disk::remove(&self.path.join(".writing"));
            clean();
        }
    }
}

/// Refuses an output file that cannot be written, as [`take`] does for folders.
pub(crate) fn ready_file(out: &Path) -> Result<(), String> {
    if out.is_dir() {
        return Err(format!("--out {}: is a folder; give a file", out.display()));
    }
    disk::try_create(out)
        .map_err(|bad| format!("--out {}: {bad}; give a file that can be written", out.display()))
}

/// Description of the results in a folder, which a new run replaces; `None` if there are none.
pub(crate) fn replaced(out: &Path) -> Option<String> {
    let held = records::read_run(out).ok()?;
    let methods: BTreeSet<_> = held.plans.iter().map(|plan| (&plan.case, &plan.method)).collect();
    let scenes: BTreeSet<_> = methods.iter().map(|(case, _)| case).collect();
    match (scenes.len(), methods.len()) {
        (0, _) => None,
        (1, 1) => Some("1 method".into()),
        (1, count) => Some(format!("{count} methods")),
        (scenes, _) => Some(format!("{scenes} scenes")),
    }
}

/// Refuses a folder that holds the results of another file.
fn free_for(file: &Path, out: &Path) -> Result<(), String> {
    let here = records::source_of(out);
    let wanted = source(file);
    match here {
        Some(here) if here != wanted => Err(format!(
            "{} holds the results of {here}; give {wanted} its own folder, such as --out {}-{}",
            out.display(),
            out.display(),
            file.file_stem().unwrap_or_default().to_string_lossy()
        )),
        _ => Ok(()),
    }
}
