//! Ctrl-C and termination signals: finished results are kept and child processes are killed.

use std::path::PathBuf;
use std::sync::Mutex;

use crate::adapter;
use crate::process::group;
use crate::study::jobs::queue::Jobs;

type Last = Box<dyn FnMut() + Send>;

/// Action before the program ends on a signal.
static LAST: Mutex<Option<Last>> = Mutex::new(None);

/// Makes signals end the program with exit code 5, after the action set by [`at_last`]. Child processes and
/// temporary folders are removed.
pub(super) fn install() {
    let handler = || {
        match LAST.lock().ok().and_then(|mut last| last.take()) {
            Some(mut last) => last(),
            None => eprintln!("tissuebench: interrupted"),
        }
        group::end_all();
        adapter::remove_all();
        std::process::exit(5);
    };
    if let Err(bad) = ctrlc::set_handler(handler) {
        eprintln!("tissuebench: an interrupt will end the program without cleaning up: {bad}");
    }
}

/// Sets the action before the program ends on a signal.
pub(super) fn at_last(last: impl FnMut() + Send + 'static) {
    if let Ok(mut known) = LAST.lock() {
        *known = Some(Box::new(last));
    }
}

/// Returns an action that reports that the study can be continued.
pub(super) fn resumable(out: PathBuf) -> impl FnMut() + Send + 'static {
    move || {
        // Otherwise killed runs in other processes would be recorded as failed.
        group::end_all();
        eprintln!(
            "tissuebench: interrupted; {} is incomplete and keeps the finished runs: continue with the same command and --resume",
            out.display()
        );
    }
}

/// Returns an action that cancels the jobs of a study and reports that the study can be continued.
pub(super) fn cancelling(jobs: Jobs, out: PathBuf) -> impl FnMut() + Send + 'static {
    move || {
        let count = jobs.cancel_at_exit();
        eprintln!(
            "tissuebench: interrupted; {count} jobs are cancelled; {} is incomplete and keeps the finished runs: continue \
             with the same command",
            out.display()
        );
    }
}

/// Returns an action that reports that only incomplete files are left.
pub(super) fn incomplete(out: Option<PathBuf>) -> impl FnMut() + Send + 'static {
    move || match &out {
        Some(out) => eprintln!("tissuebench: interrupted; {} is incomplete", out.display()),
        None => eprintln!("tissuebench: interrupted"),
    }
}
