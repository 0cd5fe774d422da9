//! The `tissuebench` command.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    ExitCode::from(harness::cli::main(harness::cli::Cli::parse()))
}
