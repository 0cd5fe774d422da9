//! The `tissuebench` command.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    // A reader that closes early (`| head`) ends the program quietly, as it does every other one.
    sigpipe::reset();
    ExitCode::from(harness::cli::main(harness::cli::Cli::parse()))
}
