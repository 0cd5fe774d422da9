//! Progress of a study: a bar on a terminal, otherwise occasional lines, such as in the log of a continuous
//! integration.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::args::Loudness;
use super::events::{Event, Events};
use super::summary;
use super::task::TaskResult;
use crate::print::shown;

/// Shortest time between two lines.
const EVERY: Duration = Duration::from_secs(10);

/// Progress through a number of runs, on stderr and, if requested, as events.
pub(crate) struct Progress<'a> {
    bar: ProgressBar,
    /// Time of the last line; `None` on a terminal, or if progress is not printed in lines.
    last_line: Option<Mutex<Instant>>,
    /// Whether lines describe jobs, and not runs of this process.
    has_jobs: bool,
    loudness: Loudness,
    events: Option<&'a Events>,
}

/// A run under way.
pub(crate) struct Running {
    case: String,
    method: String,
    /// Index of the run in the study.
    run: usize,
    begin: Instant,
}

impl<'a> Progress<'a> {
    /// Progress of a study with this number of runs.
    pub(crate) fn new(runs: usize, loudness: Loudness, events: Option<&'a Events>) -> Progress<'a> {
        let bar = ProgressBar::new(runs as u64);
        if loudness == Loudness::Quiet {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed}, {eta} left {msg}");
        bar.set_style(style.expect("a valid template"));
        let by_lines = bar.is_hidden() && loudness == Loudness::Plain;
        let last_line = by_lines.then(|| Mutex::new(Instant::now()));
        if let Some(events) = events {
            events.begin(runs);
        }
        Progress { bar, last_line, has_jobs: false, loudness, events }
    }

    /// Progress of a study whose runs are executed as jobs.
    pub(crate) fn of_jobs(runs: usize, loudness: Loudness, events: Option<&'a Events>) -> Progress<'a> {
        let progress = Progress { has_jobs: true, ..Progress::new(runs, loudness, events) };
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed}; {msg}");
        progress.bar.set_style(style.expect("a valid template"));
        progress
    }

    /// Reports all jobs in one line.
    pub(crate) fn jobs(&self, summary: &str) {
        self.bar.set_message(shown(summary, false).into_owned());
        if let Some(elapsed) = self.due() {
            let [done, all] = [self.bar.position(), self.bar.length().unwrap_or(0)];
            eprintln!("{done} of {all} runs in {:.0} s, {summary}", elapsed.as_secs_f64());
        }
    }

    /// Elapsed time if a line is due.
    fn due(&self) -> Option<Duration> {
        let mut last = self.last_line.as_ref()?.lock().expect("no worker panicked");
        if last.elapsed() < EVERY {
            return None;
        }
        *last = Instant::now();
        Some(self.bar.elapsed())
    }

    /// Reports the start of a run.
    pub(crate) fn running(&self, case: String, method: String, run: usize) -> Running {
        if !self.has_jobs {
            self.bar.set_message(shown(&format!("{case} {method}"), false).into_owned());
        }
        if let Some(events) = self.events {
            events.send(&Event::Start { case: &case, method: &method, run });
        }
        Running { case, method, run, begin: Instant::now() }
    }

    /// Reports the end of a run.
    pub(crate) fn done(&self, running: &Running, result: &TaskResult, stored: bool) {
        let Running { case, method, begin, .. } = running;
        let run = running.run;
        let reason = result.failure.as_ref().map(|(failure, _)| failure.reason.as_str());
        if let Some(events) = self.events {
            let seconds = begin.elapsed().as_secs_f64();
            events.send(&match reason {
                Some(reason) => Event::Failed { case, method, run, seconds, reason },
                None => Event::Done { case, method, run, seconds, stored },
            });
        }
        self.bar.inc(1);
        if self.loudness == Loudness::Verbose {
            let how = match (reason, stored) {
                (Some(reason), _) => reason.to_string(),
                (None, true) => "stored".into(),
                (None, false) => format!("{:.4} s", summary::seconds(result)),
            };
            self.say(format!("{case} {method}: {how}"));
        }
        if !self.has_jobs
            && let Some(elapsed) = self.due()
        {
            eprintln!("{}", line(self.bar.position(), self.bar.length().unwrap_or(0), elapsed));
        }
    }

    /// Prints a warning, which stays visible above the bar.
    pub(crate) fn warn(&self, text: String) {
        self.say(text);
    }

    fn say(&self, text: String) {
        if self.bar.is_hidden() {
            eprintln!("{text}");
        } else {
            self.bar.println(shown(&text, false));
        }
    }

    /// Removes the bar.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Formats `120 of 337 runs in 40 s, about 72 s left`. The remaining runs are assumed to take as long as
/// those before.
fn line(done: u64, all: u64, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs_f64();
    let left = seconds * all.saturating_sub(done) as f64 / done.max(1) as f64;
    format!("{done} of {all} runs in {seconds:.0} s, about {left:.0} s left")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_takes_as_long_as_what_is_done() {
        assert_eq!(line(120, 360, Duration::from_secs(40)), "120 of 360 runs in 40 s, about 80 s left");
        assert_eq!(line(0, 3, Duration::ZERO), "0 of 3 runs in 0 s, about 0 s left");
    }
}
