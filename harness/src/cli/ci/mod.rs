//! What continuous integration reads: JUnit XML and GitHub's annotations.

mod annotations;
mod junit;

use std::path::PathBuf;

use clap::Args;

pub(super) use annotations::annotate;
pub(super) use junit::junit;

/// What `verify` writes for continuous integration.
#[derive(Args, Clone, Debug, Default)]
pub struct CiArgs {
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
