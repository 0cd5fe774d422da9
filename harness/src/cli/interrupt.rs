//! Ctrl-C, and the signals by which systems end a program: what is finished stays, and what runs in other processes ends.

use std::path::PathBuf;

use crate::process::group;

/// From now on a signal ends the program with exit code 5, after `last` has said or written what is left.
pub(super) fn install(mut last: impl FnMut() + Send + 'static) {
    let handler = move || {
        last();
        group::end_all();
        std::process::exit(5);
    };
    if let Err(bad) = ctrlc::set_handler(handler) {
        eprintln!("tissuebench: an interrupt will end the program at once: {bad}");
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
