//! What happens in a study, as it happens: one JSON object a line, for programs that watch.

use std::io::{self, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use schemars::JsonSchema;
use serde::Serialize;

/// An event.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub(crate) enum Event<'a> {
    /// The study begins.
    Begin {
        /// Version of the events.
        format: u32,
        /// Runs to be made.
        runs: usize,
    },
    /// A run begins.
    Start {
        /// The case.
        case: &'a str,
        /// The method's id.
        method: &'a str,
        /// Place of the run in the study, from 0: what distinguishes runs of one method.
        run: usize,
    },
    /// A run has ended with numbers, taken from an earlier one where `stored`.
    Done { case: &'a str, method: &'a str, run: usize, seconds: f64, stored: bool },
    /// A run has ended without numbers, or early.
    Failed { case: &'a str, method: &'a str, run: usize, seconds: f64, reason: &'a str },
    /// The study has ended.
    End {
        /// Counts of checks.
        passed: usize,
        failed: usize,
        known: usize,
        not_run: usize,
        /// The exit code of the program.
        code: u8,
    },
}

/// A line of the file of events.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Line<'a> {
    /// Seconds since the study began.
    at: f64,
    #[serde(flatten)]
    event: &'a Event<'a>,
}

/// Version of events. A change that a reader of them would notice raises it.
const FORMAT: u32 = 1;

/// Where events go.
pub struct Events {
    out: Mutex<Box<dyn Write + Send>>,
    /// Why a line could not be written.
    lost: Mutex<Option<io::Error>>,
    begin: Instant,
}

impl Events {
    /// To a file, `-` being stdout.
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

    /// To whatever takes lines.
    pub fn new(out: Box<dyn Write + Send>) -> Events {
        Events { out: Mutex::new(out), lost: Mutex::default(), begin: Instant::now() }
    }

    /// Why the events are not whole; a reader that has gone away has what it wants.
    pub(crate) fn lost(self) -> Option<io::Error> {
        let lost = self.lost.into_inner().unwrap_or_else(PoisonError::into_inner);
        lost.filter(|bad| bad.kind() != io::ErrorKind::BrokenPipe)
    }

    /// Writes one line at once. A reader that has gone away, or a full disk, ends no study.
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
