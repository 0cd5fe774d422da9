//! Ctrl-C, and the signals by which systems end a program: what is finished stays, and what runs in other processes ends.

use std::path::{Path, PathBuf};

use crate::process::group;

/// From now on a signal ends the program with exit code 5 and a word on what is left.
pub(super) fn install(out: Option<&Path>, resume: bool) {
    let out: Option<PathBuf> = out.map(Into::into);
    let handler = move || {
        group::end_all();
        match &out {
            Some(out) if resume => eprintln!(
                "tissuebench: interrupted; {} is incomplete and keeps the finished runs: the same command with --resume goes on",
                out.display()
            ),
            Some(out) => eprintln!("tissuebench: interrupted; {} is incomplete", out.display()),
            None => eprintln!("tissuebench: interrupted"),
        }
        std::process::exit(5);
    };
    if let Err(bad) = ctrlc::set_handler(handler) {
        eprintln!("tissuebench: an interrupt will end the program at once: {bad}");
    }
}
