//! Events of a study as they happen, one JSON object per line, for programs that monitor the study.

use std::io::{self, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use schemars::JsonSchema;
use serde::Serialize;

/// Event of a study.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub(crate) enum Event<'a> {
    /// The study begins.
    Begin {
        /// Version of the event format.
        format: u32,
        /// Number of runs to be made.
        runs: usize,
    },
    /// A run begins.
    Start {
        /// Name of the case.
        case: &'a str,
        /// Id of the method.
        method: &'a str,
        /// Index of the run in the study, from 0. It distinguishes runs of one method.
        run: usize,
    },
    /// A run has ended with results, which come from an earlier run if `stored` is true.
    Done { case: &'a str, method: &'a str, run: usize, seconds: f64, stored: bool },
    /// A run has ended early or without results.
    Failed { case: &'a str, method: &'a str, run: usize, seconds: f64, reason: &'a str },
    /// The study has ended.
    End {
        /// Number of passed checks.
        passed: usize,
        failed: usize,
        known: usize,
        not_run: usize,
        /// The exit code of the program.
        code: u8,
    },
}

/// Line of the event file.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Line<'a> {
    /// Seconds since the study began.
    at: f64,
    #[serde(flatten)]
    event: &'a Event<'a>,
}

/// Version of the event format, raised by every change that a reader of events would notice.
const FORMAT: u32 = 1;

/// Output of events.
pub struct Events {
    out: Mutex<Box<dyn Write + Send>>,
    /// First error of writing a line.
    lost: Mutex<Option<io::Error>>,
    begin: Instant,
}

impl Events {
    /// Writes events to a file; `-` is stdout.
    pub(crate) fn to(path: &Path) -> io::Result<Events> {
        let out: Box<dyn Write + Send> = if path == Path::new("-") {
            Box::new(crate::print::Stdout)
        } else {
            Box::new(disk::create(path)?)
        };
        Ok(Events::new(out))
    }

    /// Writes the first line: how many runs follow.
    pub(crate) fn begin(&self, runs: usize) {
        self.send(&Event::Begin { format: FORMAT, runs });
    }

    /// Writes events to any writer.
    pub fn new(out: Box<dyn Write + Send>) -> Events {
        Events { out: Mutex::new(out), lost: Mutex::default(), begin: Instant::now() }
    }

    /// Error that made the events incomplete, if any. A reader that closed the pipe is not an error.
    pub(crate) fn lost(self) -> Option<io::Error> {
        let lost = self.lost.into_inner().unwrap_or_else(PoisonError::into_inner);
        lost.filter(|bad| bad.kind() != io::ErrorKind::BrokenPipe)
    }

    /// Writes and flushes one line. Neither a closed pipe nor a full disk ends the study.
    pub(crate) fn send(&self, event: &Event) {
        let at = (self.begin.elapsed().as_secs_f64() * 1e3).round() / 1e3;
        let Ok(line) = serde_json::to_string(&Line { at, event }) else { return };
        if let Ok(mut out) = self.out.lock() {
            let written = writeln!(out, "{line}").and_then(|()| out.flush());
            if let (Err(bad), Ok(mut lost)) = (written, self.lost.lock()) {
                lost.get_or_insert(bad);
            }
        }
    }
}
