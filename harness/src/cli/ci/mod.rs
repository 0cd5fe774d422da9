//! What is read by machines rather than people: names of runs, JUnit XML, GitHub's annotations, events.

mod annotations;
mod junit;
mod listing;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::study::{Events, Plan, RunSummary};

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

/// Begins the events, and refuses files that the study reads.
pub(super) fn begin(args: &CiArgs, plan: &Plan) -> Result<Option<Events>, String> {
    if args.events.is_some() || args.junit.is_some() {
        plan.note_inputs();
    }
    if let Some(file) = &args.junit {
        disk::try_create(file).map_err(|bad| format!("--junit {}: {bad}", file.display()))?;
    }
    let Some(file) = &args.events else { return Ok(None) };
    Events::to(file).map(Some).map_err(|bad| format!("--events {}: {bad}", file.display()))
}

/// Writes and prints what was asked for; says what could not be written.
pub(super) fn write(args: &CiArgs, study: &Path, runs: &[RunSummary]) -> Result<(), String> {
    if args.annotations {
        print!("{}", annotate(runs));
    }
    let Some(file) = &args.junit else { return Ok(()) };
    let text = junit(&study.display().to_string(), runs);
    disk::write(file, text).map_err(|bad| format!("--junit {}: {bad}", file.display()))
}
