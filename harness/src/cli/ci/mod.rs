//! What is read by machines rather than people: names of runs, JUnit XML, GitHub's annotations, events.

mod annotations;
mod junit;
mod listing;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::study::RunSummary;

use annotations::annotate;
use junit::junit;
pub(super) use listing::{forecast, names};

/// What `verify` writes for continuous integration.
#[derive(Args, Clone, Debug, Default)]
pub struct CiArgs {
    /// Print the names of the runs, and make none
    #[arg(long, conflicts_with = "dry_run")]
    pub list: bool,
    /// Print the runs with what each is estimated to take, and make none
    #[arg(long)]
    pub dry_run: bool,
    /// Also write the runs and their checks as JUnit XML
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Also print what failed as annotations of GitHub's workflows
    #[arg(long)]
    pub annotations: bool,
    /// Also write what happens as it happens, one JSON object a line; `-` is stdout
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,
}

/// Writes and prints what was asked for; says what could not be written.
pub(super) fn write(args: &CiArgs, study: &Path, runs: &[RunSummary]) -> Result<(), String> {
    if args.annotations {
        print!("{}", annotate(runs));
    }
    let Some(file) = &args.junit else { return Ok(()) };
    let text = junit(&study.display().to_string(), runs);
    std::fs::write(file, text).map_err(|bad| format!("--junit {}: {bad}", file.display()))
}
