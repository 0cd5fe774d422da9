//! Arguments that select the runs of a study and the folder of their results.

use std::path::{Path, PathBuf};

use clap::Args;

use super::Filters;
use super::isolated::ApartArgs;

/// Arguments of `verify`.
#[derive(Args)]
pub struct VerifyArgs {
    /// The study file (default: cases/studies/verify.toml)
    pub study: Option<PathBuf>,
    /// Execute only the runs of the quick tier
    #[arg(long)]
    pub quick: bool,
    /// Execute only runs whose case or method contains this text
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// Further filters
    #[command(flatten)]
    pub filters: Filters,
    /// Execute only the K-th of N shares of the runs, which have about equal cost
    #[arg(long, value_name = "K/N", value_parser = shard)]
    pub shard: Option<(usize, usize)>,
    /// Number of concurrent runs; more than 1 distorts the times
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: u16,
    /// Keep stored results of runs whose scene, method and program have not changed
    #[arg(long)]
    pub resume: bool,
    /// Share the study with other processes that use --join on the same folder: each run is executed once.
    /// Stored results are kept as with --resume
    #[arg(long)]
    pub join: bool,
    /// Isolation of runs.
    #[command(flatten)]
    pub apart: ApartArgs,
    /// Run even if the estimate exceeds twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
    /// Print only errors
    #[arg(short, long)]
    pub quiet: bool,
    /// Print one line per run
    #[arg(short, long, conflicts_with = "quiet")]
    pub verbose: bool,
    /// Folder for records, tables, figures and the report; replaces the results of an earlier run of the
    /// study
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub out: PathBuf,
    /// Estimate run times from the times stored in these results of this machine, for --dry-run, --shard and
    /// refusals
    #[arg(long, value_name = "DIR")]
    pub times: Option<PathBuf>,
    /// Also plot errors and times over the commits in this folder, filled by `history add`
    #[arg(long, value_name = "DIR")]
    pub history: Option<PathBuf>,
}

impl VerifyArgs {
    /// Path of the study file.
    pub fn path(&self) -> PathBuf {
        self.study.clone().unwrap_or_else(|| "cases/studies/verify.toml".into())
    }

    /// Default arguments for a study.
    pub fn of(study: &Path) -> VerifyArgs {
        VerifyArgs {
            study: Some(study.into()),
            quick: false,
            filter: None,
            filters: Filters::default(),
            quiet: false,
            verbose: false,
            shard: None,
            jobs: 1,
            resume: false,
            join: false,
            apart: ApartArgs { isolate: false, time_limit: None, memory_limit: None },
            force: true,
            out: PathBuf::new(),
            times: None,
            history: None,
        }
    }

    /// Verbosity of the progress reports.
    pub fn loudness(&self) -> Loudness {
        match (self.quiet, self.verbose) {
            (true, _) => Loudness::Quiet,
            (_, true) => Loudness::Verbose,
            _ => Loudness::Plain,
        }
    }
}

/// Verbosity of a study's progress reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loudness {
    /// Errors only.
    Quiet,
    /// A progress bar, or a line every ten seconds.
    #[default]
    Plain,
    /// A line for each run.
    Verbose,
}

fn shard(text: &str) -> Result<(usize, usize), String> {
    let fix = "write K/N with K from 1 to N, such as 1/4";
    let (k, n) = text.split_once('/').ok_or(fix)?;
    let (k, n): (usize, usize) = (k.parse().map_err(|_| fix)?, n.parse().map_err(|_| fix)?);
    if (1..=n).contains(&k) { Ok((k, n)) } else { Err(fix.into()) }
}
