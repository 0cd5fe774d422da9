//! Ctrl-C, and the signals by which systems end a program: what is finished stays, and what runs in other processes ends.

use std::path::PathBuf;
use std::sync::Mutex;

use crate::adapter;
use crate::process::group;

type Last = Box<dyn FnMut() + Send>;

/// Says or writes what is left.
static LAST: Mutex<Option<Last>> = Mutex::new(None);

/// From now on a signal ends the program with exit code 5, after what was set by [`at_last`], and without a
/// trace of what it has started.
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
        eprintln!("tissuebench: an interrupt will end the program at once: {bad}");
    }
}

/// Sets what a signal does before the program ends.
pub(super) fn at_last(last: impl FnMut() + Send + 'static) {
    if let Ok(mut known) = LAST.lock() {
        *known = Some(Box::new(last));
    }
}

/// Says that a study can be continued.
pub(super) fn resumable(out: PathBuf) -> impl FnMut() + Send + 'static {
    move || {
        // Runs in other processes would be taken for failed ones.
        group::end_all();
        eprintln!(
            "tissuebench: interrupted; {} is incomplete and keeps the finished runs: the same command with --resume goes on",
            out.display()
        );
    }
}

/// Says that nothing but files without meaning is left.
pub(super) fn incomplete(out: Option<PathBuf>) -> impl FnMut() + Send + 'static {
    move || match &out {
        Some(out) => eprintln!("tissuebench: interrupted; {} is incomplete", out.display()),
        None => eprintln!("tissuebench: interrupted"),
    }
}
