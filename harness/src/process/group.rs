//! A process and all its descendants: limited, killed as a whole, and ended with the process that started it.

use std::io::{self, Read};
use std::process::{Child, Command, ExitStatus};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Bytes kept of the end of a process's output.
const LAST_WORDS: usize = 4096;

/// Ids of the running processes. Locked while a process is started, so that none is missed when all are
/// killed.
static RUNNING: Mutex<Vec<u32>> = Mutex::new(Vec::new());

fn running() -> std::sync::MutexGuard<'static, Vec<u32>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A process in a process group of its own.
pub(crate) struct Started {
    child: Child,
}

impl Started {
    pub(crate) fn new(command: &mut Command) -> io::Result<Started> {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        let mut running = running();
        let child = command.spawn()?;
        running.push(child.id());
        Ok(Started { child })
    }

    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    pub(crate) fn child(&mut self) -> &mut Child {
        &mut self.child
    }

    /// Whether the process has ended. The process is not reaped, so its id is not reused before its group is
    /// killed.
    #[cfg(unix)]
    pub(crate) fn has_ended(&mut self) -> io::Result<bool> {
        use rustix::process::{WaitId, WaitIdOptions, waitid};
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        Ok(waitid(WaitId::Pid(pid(self.child.id())), options)?.is_some())
    }

    #[cfg(not(unix))]
    pub(crate) fn has_ended(&mut self) -> io::Result<bool> {
        Ok(self.child.try_wait()?.is_some())
    }

    /// Kills the process and its group, without waiting.
    pub(super) fn kill(&self) {
        kill(self.child.id());
    }

    /// Sends the signal TERM to the process and its group, where the system has signals.
    pub(crate) fn terminate(&self) {
        #[cfg(unix)]
        let _ = rustix::process::kill_process_group(pid(self.child.id()), rustix::process::Signal::TERM);
    }

    /// Kills the process and its group, and waits for the process.
    pub(crate) fn end(mut self) -> io::Result<ExitStatus> {
        let mut running = running();
        kill(self.child.id());
        let _ = self.child.kill();
        let status = self.child.wait();
        running.retain(|id| *id != self.child.id());
        status
    }
}

/// Waits until a process has ended, without reaping it: its id is not reused before.
#[cfg(unix)]
pub(super) fn wait(id: u32) {
    use rustix::process::{WaitId, WaitIdOptions, waitid};
    while let Err(rustix::io::Errno::INTR) =
        waitid(WaitId::Pid(pid(id)), WaitIdOptions::EXITED | WaitIdOptions::NOWAIT)
    {}
}

/// Returns the end of a process's output, whatever its length.
pub(crate) fn last_words(mut from: impl Read) -> String {
    let mut kept = Vec::new();
    let mut buffer = [0; LAST_WORDS];
    while let Ok(read @ 1..) = from.read(&mut buffer) {
        kept.extend(&buffer[..read]);
        let old = kept.len().saturating_sub(LAST_WORDS);
        kept.drain(..old);
    }
    String::from_utf8_lossy(&kept).into_owned()
}

/// Kills all groups and blocks the start of others. Called just before the program exits; a second call does
/// nothing.
pub(crate) fn end_all() {
    static ENDED: AtomicBool = AtomicBool::new(false);
    if ENDED.swap(true, Ordering::Relaxed) {
        return;
    }
    let running = running();
    running.iter().for_each(|id| kill(*id));
    std::mem::forget(running);
}

#[cfg(unix)]
fn pid(id: u32) -> rustix::process::Pid {
    rustix::process::Pid::from_raw(id.cast_signed()).expect("the number of a process that was started")
}

/// Kills all descendants of a process, in whatever group, and the group of the process.
#[cfg(unix)]
pub(super) fn kill(id: u32) {
    #[cfg(target_os = "linux")]
    super::members::end_below(id);
    let _ = rustix::process::kill_process_group(pid(id), rustix::process::Signal::KILL);
}

#[cfg(not(unix))]
pub(super) fn kill(_: u32) {}

/// Makes this process end with its parent and limits the memory it may allocate from now on, in bytes.
///
/// The limit applies to writable memory, not to address space, of which an allocator reserves 64 MB per
/// thread.
#[cfg(target_os = "linux")]
pub(crate) fn limit(parent: u32, memory: Option<u64>) -> io::Result<()> {
    use rustix::process::{Signal, getppid, set_parent_process_death_signal};
    set_parent_process_death_signal(Some(Signal::KILL))?;
    // The parent may have ended before.
    if getppid().map(rustix::process::Pid::as_raw_nonzero).map(|id| id.get().cast_unsigned()) != Some(parent)
    {
        return Err(io::Error::other("the study that started it has ended"));
    }
    memory.map_or(Ok(()), limit_memory)
}

/// Limits this process, and each process it starts, to `bytes` more than it has allocated now.
#[cfg(target_os = "linux")]
pub(super) fn limit_memory(bytes: u64) -> io::Result<()> {
    use rustix::process::{Resource, Rlimit, setrlimit};
    let most = Some(allocated()?.saturating_add(bytes));
    Ok(setrlimit(Resource::Data, Rlimit { current: most, maximum: most })?)
}

#[cfg(not(target_os = "linux"))]
pub(super) fn limit_memory(_: u64) -> io::Result<()> {
    Ok(())
}

/// Returns the memory this process has allocated, bytes.
#[cfg(target_os = "linux")]
fn allocated() -> io::Result<u64> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmData:")).unwrap_or_default();
    let kilobytes: Option<u64> = line.split_whitespace().next().and_then(|word| word.parse().ok());
    kilobytes.map(|kb| kb << 10).ok_or_else(|| io::Error::other("/proc/self/status has no VmData"))
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn limit(_: u32, memory: Option<u64>) -> io::Result<()> {
    match memory {
        None => Ok(()),
        Some(_) => Err(io::Error::other("--memory-limit is supported on Linux only")),
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::io::{BufRead, BufReader};
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    use super::*;

    /// Whether a process exists and has not ended.
    fn runs(id: &str) -> bool {
        let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).unwrap_or_default();
        stat.rsplit_once(')').is_some_and(|(_, state)| !state.trim_start().starts_with(['Z', 'X']))
    }

    #[test]
    fn what_a_process_leaves_behind_is_ended_with_it() {
        let mut command = Command::new("sh");
        command.args(["-c", "sleep 1000 & echo $!"]).stdout(Stdio::piped());
        let mut started = Started::new(&mut command).unwrap();
        let mut child = String::new();
        BufReader::new(started.child().stdout.take().unwrap()).read_line(&mut child).unwrap();
        let began = Instant::now();
        while !started.has_ended().unwrap() {
            assert!(began.elapsed() < Duration::from_secs(10));
        }
        assert!(runs(child.trim()), "it has left one");
        assert!(started.end().unwrap().success());
        while runs(child.trim()) {
            assert!(began.elapsed() < Duration::from_secs(10), "it runs on");
        }
    }
}
