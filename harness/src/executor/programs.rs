//! Calls to the programs of a job system.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use super::job::Job;
use crate::error::Failure;
use crate::process::heard_within;

/// Longest wait for an answer of a job system.
const ANSWER: Duration = Duration::from_secs(60);
/// Bytes that are read of an answer.
const BYTES: u64 = 16 << 20;

/// Checks that programs are on the search path.
pub(super) fn needed(system: &str, programs: &[&str]) -> Result<(), Failure> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let is_there = |program: &&&str| std::env::split_paths(&path).any(|dir| dir.join(program).is_file());
    match programs.iter().find(|program| !is_there(program)) {
        None => Ok(()),
        Some(program) => Err(Failure::Run(format!(
            "--on {system}: the program {program} is not on PATH; run it where {system} is installed, or give --on local:N"
        ))),
    }
}

/// Calls a program and returns its stdout.
///
/// # Errors
/// Returns the program's first lines on stderr if it fails, or the reason why it could not be called.
pub(super) fn said(program: &str, args: &[impl AsRef<OsStr>]) -> Result<String, String> {
    let called = heard_within(Command::new(program).args(args), ANSWER, BYTES);
    let (status, [out, err]) = called.map_err(|bad| format!("{program}: {bad}"))?;
    match status.success() {
        true => Ok(out),
        false if err.trim().is_empty() => Err(format!("{program}: {status}")),
        false => Err(format!("{program}: {}", err.trim().lines().collect::<Vec<_>>().join("; "))),
    }
}

/// Returns a word that a shell reads as exactly this text.
///
/// # Errors
/// The text is not Unicode.
pub(super) fn quoted(text: &OsStr) -> Result<String, String> {
    let text = text.to_str().ok_or_else(|| format!("{}: is not UTF-8", Path::new(text).display()))?;
    Ok(format!("'{}'", text.replace('\'', r"'\''")))
}

/// Exit code of `timeout` for a program that exceeded its time.
pub(super) const LATE: &str = "124";

/// Command of a job under the program `timeout`, for systems that end a late job without a signal before.
pub(super) fn limited(job: &Job) -> Vec<OsString> {
    let [time, notice] = [job.time, job.notice].map(|time| time.as_secs_f64().to_string());
    let words = ["timeout".into(), format!("--kill-after={notice}"), time];
    words.into_iter().map(OsString::from).chain(job.command.iter().cloned()).collect()
}
