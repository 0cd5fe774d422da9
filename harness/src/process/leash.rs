//! The hidden command `leash`: runs another program and kills all descendants of that program when it ends,
//! or when the process that started the leash ends.
//!
//! A program that is killed leaves its child processes behind. The leash does not: its stdin is a pipe, which
//! the system closes when the process at the other end ends for any reason.

use std::ffi::OsString;
use std::io::Read;
use std::process::{Command, ExitStatus, Stdio};

use clap::Args;

use super::group;
#[cfg(target_os = "linux")]
use super::members;

/// Exit codes as in shells: for a program that does not exist, and the offset for one ended by a signal.
const NOT_FOUND: u8 = 127;
#[cfg(unix)]
const SIGNAL: i32 = 128;

/// Arguments of the hidden command `leash`.
#[derive(Args)]
pub struct LeashArgs {
    /// Memory limit of each process, in bytes
    #[arg(long)]
    pub memory_limit: Option<u64>,
    /// The program with its arguments
    #[arg(required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    pub command: Vec<OsString>,
}

/// Runs the program and returns its exit code.
pub(crate) fn leash(args: &LeashArgs) -> u8 {
    #[cfg(target_os = "linux")]
    if let Err(bad) = members::adopt() {
        eprintln!("tissuebench: processes that leave the process group will not be ended: {bad}");
    }
    std::thread::spawn(|| {
        let mut pipe = [0; 64];
        while let Ok(1..) = std::io::stdin().read(&mut pipe) {}
        end_own_group();
    });
    if let Some(bad) = args.memory_limit.and_then(|bytes| group::limit_memory(bytes).err()) {
        eprintln!("tissuebench: the memory can't be limited: {bad}");
    }
    let Some((program, rest)) = args.command.split_first() else { return 2 };
    let ended = Command::new(program).args(rest).stdin(Stdio::null()).status();
    #[cfg(target_os = "linux")]
    members::end_own();
    match ended {
        Ok(status) => code(status),
        Err(bad) => {
            eprintln!("tissuebench: {} can't be started: {bad}", program.to_string_lossy());
            NOT_FOUND
        }
    }
}

fn code(status: ExitStatus) -> u8 {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return u8::try_from(SIGNAL + signal).unwrap_or(1);
    }
    status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)
}

/// Kills the process group of this process, and with it the process, if the process is the group leader.
/// Another group is not touched.
fn end_own_group() {
    #[cfg(unix)]
    if rustix::process::getpgrp() == rustix::process::getpid() {
        group::kill(std::process::id());
    }
}
