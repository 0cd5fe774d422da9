//! Calls of cargo and of the `tissuebench` binary.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};

use anyhow::{Context, Result};

/// Runs the release binary, and builds it first if needed.
pub(crate) fn tissuebench(command: &str, args: &[String]) -> Result<u8> {
    eprintln!(
        "xtask: building tissuebench (13 minutes on two cores the first time), then: tissuebench {command}"
    );
    let build = ["build", "--release", "--locked", "--package", "tissuebench-harness"];
    let code = cargo(&build, &[])?;
    if code != 0 {
        return Ok(code);
    }
    let run = ["run", "--release", "--locked", "--quiet", "--package", "tissuebench-harness", "--", command];
    cargo(&run, args)
}

/// Runs cargo in the workspace and returns its exit code.
pub(crate) fn cargo(args: &[&str], more: &[String]) -> Result<u8> {
    let status = cargo_command(args, more).status();
    Ok(code_of(status.with_context(|| format!("could not start cargo {}", args.join(" ")))?))
}

/// A call of cargo in the workspace.
pub(crate) fn cargo_command(args: &[&str], more: &[String]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(args).args(more).current_dir(root());
    command.env("RUSTDOCFLAGS", "-D warnings").env("CARGO_INCREMENTAL", "0");
    command
}

/// Exit code of a program; 3 if a signal ended it.
pub(crate) fn code_of(status: ExitStatus) -> u8 {
    status.code().map_or(3, |code| code as u8)
}

/// Folder of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the workspace").to_path_buf()
}
