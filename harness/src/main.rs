//! The `tissuebench` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(tissuebench_harness::cli::called())
}
