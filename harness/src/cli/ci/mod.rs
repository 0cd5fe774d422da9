//! Machine-readable output: run names, JUnit XML, GitHub annotations and events.

mod annotations;
mod junit;
mod listing;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::study::{Events, RunSummary, StudyPlan};
use annotations::annotate;
use junit::junit;
pub(super) use listing::{forecast, names};

/// Output of `verify` for continuous integration.
#[derive(Args, Clone, Debug, Default)]
pub struct CiArgs {
    /// Print the names of the runs without running them
    #[arg(long, conflicts_with = "dry_run")]
    pub list: bool,
    /// Print the runs with their estimated cost without running them
    #[arg(long)]
    pub dry_run: bool,
    /// Also write the runs and their checks as JUnit XML
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Also print failures as annotations of GitHub workflows
    #[arg(long)]
    pub annotations: bool,
    /// Also write events as they occur, one JSON object per line; `-` is stdout
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,
}

/// Opens the event stream and refuses output files that the study reads.
pub(super) fn begin(args: &CiArgs, plan: &StudyPlan) -> Result<Option<Events>, String> {
    if args.events.is_some() || args.junit.is_some() {
        plan.note_inputs();
    }
    if let Some(file) = &args.junit {
        disk::try_create(file).map_err(|bad| format!("--junit {}: {bad}", file.display()))?;
    }
    let Some(file) = &args.events else { return Ok(None) };
    Events::to(file).map(Some).map_err(|bad| format!("--events {}: {bad}", file.display()))
}

/// Writes the requested files and prints the annotations. The error says which file could not be written.
pub(super) fn write(args: &CiArgs, study: &Path, runs: &[RunSummary]) -> Result<(), String> {
    if args.annotations {
        print!("{}", annotate(runs));
    }
    let Some(file) = &args.junit else { return Ok(()) };
    let text = junit(&study.display().to_string(), runs);
    disk::write(file, text).map_err(|bad| format!("--junit {}: {bad}", file.display()))
}
