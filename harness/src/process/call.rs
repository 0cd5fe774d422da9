//! One call of another program, measured and limited in time and memory.

use std::io::{self, Read};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use super::group::{Started, last_words};

/// Bounds of the pause between two measurements of the processes; the pause is a tenth of the elapsed time.
const SHORTEST_PAUSE: Duration = Duration::from_millis(3);
const LONGEST_PAUSE: Duration = Duration::from_millis(100);
/// Longest wait for the program's last output, which a child process holding the pipe open may delay.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// Bytes kept of the beginning of a program's output.
const FIRST_WORDS: u64 = 4096;

/// Limits of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub(crate) time: Duration,
    /// Memory of all processes together, bytes.
    pub(crate) memory: u64,
}

/// Reason why a call ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    /// The program exited by itself.
    Exited(ExitStatus),
    OutOfTime,
    #[cfg_attr(not(target_os = "linux"), allow(dead_code))]
    OutOfMemory,
}

/// A call that has ended, including all processes it had started.
#[derive(Debug)]
pub(crate) struct Call {
    pub(crate) end: End,
    /// Wall-clock time, s.
    pub(crate) wall: f64,
    /// CPU time of all processes, s, to a hundredth; known on Linux.
    pub(crate) cpu: Option<f64>,
    /// Peak memory of all processes together, bytes; known on Linux, 0 elsewhere.
    pub(crate) memory: u64,
    /// The end of the program's output on stderr.
    pub(crate) last_words: String,
}

/// Calls a program through the command `leash`. Its processes end with the program, at a limit, or with this
/// process.
pub(crate) fn call(program: &Command, limits: Limits) -> io::Result<Call> {
    let mut command = leashed(program, limits.memory)?;
    let began = Instant::now();
    let mut started = Started::new(&mut command)?;
    // The pipe stays open as long as this process exists; the leash kills its group when the pipe closes.
    let leash = started.child().stdin.take();
    let (heard, words) = mpsc::channel();
    if let Some(stderr) = started.child().stderr.take() {
        std::thread::spawn(move || heard.send(last_words(stderr)));
    }
    let watched = watch(&mut started, began, limits);
    let cpu = watched.cpu(started.id());
    let status = started.end()?;
    drop(leash);
    let end = watched.end.unwrap_or(End::Exited(status));
    let last_words = words.recv_timeout(LAST_WORDS).unwrap_or_default();
    Ok(Call { end, wall: watched.wall, cpu, memory: watched.memory, last_words })
}

/// Runs a program for at most `time` and then kills its whole group. Returns its exit status and the
/// beginning of its stdout and stderr.
pub(crate) fn said_within(program: &mut Command, time: Duration) -> io::Result<(ExitStatus, [String; 2])> {
    heard_within(program, time, FIRST_WORDS)
}

/// Same as [`said_within`], with at most `most` bytes of each output.
pub(crate) fn heard_within(
    program: &mut Command,
    time: Duration,
    most: u64,
) -> io::Result<(ExitStatus, [String; 2])> {
    let mut started =
        Started::new(program.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()))?;
    let child = started.child();
    let out = child.stdout.take().map(|from| first_words(from, most));
    let err = child.stderr.take().map(|from| first_words(from, most));
    let began = Instant::now();
    while !started.has_ended()? && began.elapsed() < time {
        std::thread::sleep((began.elapsed() / 10).clamp(SHORTEST_PAUSE, LONGEST_PAUSE));
    }
    let status = started.end()?;
    let heard = |words: Option<mpsc::Receiver<String>>| {
        words.and_then(|words| words.recv_timeout(LAST_WORDS).ok()).unwrap_or_default()
    };
    Ok((status, [heard(out), heard(err)]))
}

/// Returns the beginning of a program's output. The output is read to its end so that the program does not
/// block.
fn first_words(from: impl Read + Send + 'static, most: u64) -> mpsc::Receiver<String> {
    let (send, heard) = mpsc::channel();
    std::thread::spawn(move || {
        let mut words = Vec::new();
        let mut from = from.take(most);
        let read = from.read_to_end(&mut words);
        let _ = send.send(String::from_utf8_lossy(&words).into_owned());
        read.and_then(|_| io::copy(&mut from.into_inner(), &mut io::sink()))
    });
    heard
}

/// Returns the command that runs `program` under this program's `leash`.
fn leashed(program: &Command, memory: u64) -> io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["leash", "--memory-limit", &memory.to_string(), "--"]);
    command.arg(program.get_program()).args(program.get_args());
    for (key, value) in program.get_envs() {
        match value {
            Some(value) => command.env(key, value),
            None => command.env_remove(key),
        };
    }
    program.get_current_dir().into_iter().for_each(|folder| {
        command.current_dir(folder);
    });
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    Ok(command)
}

/// Measurements of a process group until its first process ended or was killed.
#[derive(Default)]
struct Watched {
    /// The limit that was exceeded; `None` if the program exited by itself.
    end: Option<End>,
    wall: f64,
    memory: u64,
    /// CPU time of processes that have not been waited for, s.
    #[cfg_attr(not(target_os = "linux"), allow(dead_code))]
    running: f64,
}

impl Watched {
    fn cpu(&self, leash: u32) -> Option<f64> {
        #[cfg(target_os = "linux")]
        return super::members::waited_for(leash).map(|seconds| seconds + self.running);
        #[cfg(not(target_os = "linux"))]
        {
            let _ = leash;
            None
        }
    }
}

fn watch(started: &mut Started, began: Instant, limits: Limits) -> Watched {
    let id = started.id();
    let (ended, end) = mpsc::channel::<Instant>();
    #[cfg(unix)]
    std::thread::spawn(move || {
        super::group::wait(id);
        ended.send(Instant::now())
    });
    let mut watched = Watched::default();
    loop {
        let pause = (began.elapsed() / 10).clamp(SHORTEST_PAUSE, LONGEST_PAUSE);
        let left = limits.time.saturating_sub(began.elapsed());
        if let Ok(at) = end.recv_timeout(pause.min(left)) {
            watched.wall = (at - began).as_secs_f64();
            // The leash has waited for all processes below it.
            watched.running = 0.0;
            return watched;
        }
        watched.wall = began.elapsed().as_secs_f64();
        // Without a waiting thread, the end is polled.
        #[cfg(not(unix))]
        if started.has_ended().unwrap_or(true) {
            drop(ended);
            return watched;
        }
        look(&mut watched, id, limits.memory);
        if began.elapsed() >= limits.time {
            watched.end = Some(End::OutOfTime);
        }
        if watched.end.is_some() {
            started.kill();
            // A killed process ends later if it is waiting for a disk.
            #[cfg(unix)]
            let _ = end.recv_timeout(limits.time);
            return watched;
        }
    }
}

#[cfg(target_os = "linux")]
fn look(watched: &mut Watched, id: u32, limit: u64) {
    let members = super::members::of(id);
    watched.memory = watched.memory.max(members.memory).max(members.largest);
    watched.running = members.seconds;
    if members.memory > limit {
        watched.end = Some(End::OutOfMemory);
    }
}

#[cfg(not(target_os = "linux"))]
fn look(_: &mut Watched, _: u32, _: u64) {}
