//! How far a study is: a bar on a terminal, a line now and then elsewhere, such as in the log of a continuous integration.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Time between two lines.
const EVERY: Duration = Duration::from_secs(10);

/// Progress through a number of runs, on stderr.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// When the last line was written; none on a terminal.
    last_line: Option<Mutex<Instant>>,
}

impl Progress {
    /// Of so many runs.
    pub(crate) fn new(runs: usize) -> Progress {
        let bar = ProgressBar::new(runs as u64);
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed}, {eta} left {msg}");
        bar.set_style(style.expect("a valid template"));
        let last_line = bar.is_hidden().then(|| Mutex::new(Instant::now()));
        Progress { bar, last_line }
    }

    /// What is running now.
    pub(crate) fn running(&self, name: String) {
        self.bar.set_message(name);
    }

    /// One more run is done.
    pub(crate) fn done(&self) {
        self.bar.inc(1);
        let Some(last) = &self.last_line else { return };
        let mut last = last.lock().expect("no worker panicked");
        if last.elapsed() >= EVERY {
            *last = Instant::now();
            eprintln!("{}", line(self.bar.position(), self.bar.length().unwrap_or(0), self.bar.elapsed()));
        }
    }

    /// A warning that stays.
    pub(crate) fn warn(&self, text: String) {
        if self.last_line.is_some() {
            eprintln!("{text}");
        } else {
            self.bar.println(text);
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// `120 of 337 runs in 40 s, about 72 s left`: as if runs took as long as those before.
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
