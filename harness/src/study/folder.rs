//! The folder that results go to: those of one study or scene, which another one does not replace, and of one process at a time
//! unless all of them work on it together.

use std::collections::BTreeSet;
use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::Failure;

/// Locked by whoever works on a folder, with the numbers of the processes in it. The system takes the lock of one that dies.
const LOCK: &str = ".lock";
/// How long another process takes at most to look through a folder before others join it.
const ENTRY: Duration = Duration::from_secs(10);

/// A folder that this process has taken.
pub(crate) struct Folder {
    path: PathBuf,
    /// Held as long as the file is open.
    lock: File,
    /// Whether its results were whole when it was taken.
    whole: bool,
}

/// What the results in a folder are called: the name of the study's or scene's file.
pub(crate) fn source(file: &Path) -> String {
    file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Makes the folder before anything is solved, so that no finished run loses its results, and locks it.
///
/// # Errors
/// A file of that name, a folder that can't be written or is in use, or one with the results of another scene or study.
pub(crate) fn take(file: &Path, out: &Path) -> Result<Folder, Failure> {
    let mut lock = open(file, out)?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => return Err(in_use(out, &mut lock)),
        // A file system without locks: as before there were any.
        Err(TryLockError::Error(_)) => {
            eprintln!("{}: can't be locked; see that no other process uses it", out.display())
        }
    }
    enter(out, lock, true)
}

/// The same for processes that work on a folder together. The first of them calls `prepare` while it is alone.
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

/// Signs in; shows by it that there is space for a few bytes.
fn enter(out: &Path, mut lock: File, first: bool) -> Result<Folder, Failure> {
    let mut sign = || {
        if first {
            lock.set_len(0)?;
        }
        lock.seek(SeekFrom::End(0))?;
        writeln!(lock, "{}", std::process::id())
    };
    sign().map_err(|bad| unwritable(out, &bad))?;
    Ok(Folder { path: out.into(), lock, whole: !reports::is_incomplete(out) })
}

fn in_use(out: &Path, lock: &mut File) -> Failure {
    let mut holders = String::new();
    let _ = lock.read_to_string(&mut holders);
    let holders: Vec<&str> = holders.lines().collect();
    Failure::Input(format!(
        "{} is in use by process {}; wait for it, give another folder by --out, or let studies work on it together by --join",
        out.display(),
        holders.join(", ")
    ))
}

/// Without space or rights nothing can be run; another name is not what is wrong.
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
    /// Marks the results as incomplete until they are written; not while another process writes them, which it reads again for its
    /// report.
    pub(crate) fn begin(&self, file: &Path) -> Result<(), Failure> {
        let _lock = self.writing();
        reports::begin(&self.path, &source(file)).map_err(|bad| Failure::Run(bad.to_string()))
    }

    /// Nothing was run: what is there is as whole as it was.
    pub(crate) fn leave(self) {
        if self.whole {
            let _ = reports::end(&self.path);
        }
    }

    /// Locks out the others that work on it, which may write their results at the same time. Their results are the same: whether
    /// they have written them.
    pub(crate) fn writing(&self) -> (Option<File>, bool) {
        let file = disk::create_lock(&self.path.join(".writing")).ok();
        if let Some(file) = &file {
            let _ = file.lock();
        }
        (file, !reports::is_incomplete(&self.path))
    }

    /// Calls `clean` if no other process is left in the folder.
    pub(crate) fn close(self, clean: impl FnOnce()) {
        if self.lock.unlock().is_ok() && self.lock.try_lock().is_ok() {
            let _ = disk::remove(&self.path.join(".writing"));
            clean();
        }
    }
}

/// Refuses a file that can't be written where it is to go, as [`take`] does for folders.
pub(crate) fn ready_file(out: &Path) -> Result<(), String> {
    if out.is_dir() {
        return Err(format!("--out {}: is a folder; give a file", out.display()));
    }
    disk::try_create(out)
        .map_err(|bad| format!("--out {}: {bad}; give a file that can be written", out.display()))
}

/// What the results in a folder are of, all of which a new run replaces; `None` where there are none.
pub(crate) fn replaced(out: &Path) -> Option<String> {
    let held = reports::read_run(out).ok()?;
    let methods: BTreeSet<_> = held.plans.iter().map(|plan| (&plan.case, &plan.method)).collect();
    let scenes: BTreeSet<_> = methods.iter().map(|(case, _)| case).collect();
    match (scenes.len(), methods.len()) {
        (0, _) => None,
        (1, 1) => Some("1 method".into()),
        (1, count) => Some(format!("{count} methods")),
        (scenes, _) => Some(format!("{scenes} scenes")),
    }
}

/// Refuses a folder with the results of another file.
fn free_for(file: &Path, out: &Path) -> Result<(), String> {
    let (here, wanted) = (reports::source_of(out), source(file));
    match here {
        Some(here) if here != wanted => Err(format!(
            "{} holds the results of {here}; give those of {wanted} a folder of their own, such as --out {}-{}",
            out.display(),
            out.display(),
            file.file_stem().unwrap_or_default().to_string_lossy()
        )),
        _ => Ok(()),
    }
}
