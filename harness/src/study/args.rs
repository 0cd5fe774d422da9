//! Arguments that select the runs of a study and the folder of their results.

use std::path::{Path, PathBuf};
use std::time::Duration;

use catalogue::Dimension;
use clap::Args;

use super::filters::Filters;
use crate::executor::Site;

/// Isolation of runs from each other.
#[derive(Args)]
pub struct ApartArgs {
    /// Execute each run, with its reference, in its own process: a crash, an endless loop or a lack of memory
    /// affects only this run
    #[arg(long)]
    pub isolate: bool,
    /// Time limit of a run, including its reference, such as "60 s" or "10 min"
    #[arg(long, value_name = "TIME", requires = "isolate", value_parser = duration)]
    pub time_limit: Option<Duration>,
    /// Memory limit of a run, such as 500MB or "2 GiB" (Linux only)
    #[arg(long, value_name = "SIZE", requires = "isolate", value_parser = bytes)]
    pub memory_limit: Option<u64>,
}

/// Execution of a study as jobs.
#[derive(Args, Clone, Debug)]
pub struct OnArgs {
    /// Execute the runs as jobs: local:N (N processes of this machine), slurm or hyperqueue, with options such
    /// as slurm:jobs=16,partition=short, or snakemake:FOLDER, whose profile says where. Stored results are kept
    /// as with --resume
    #[arg(long, value_name = "SYSTEM", conflicts_with_all = ["shard", "join", "jobs"])]
    pub on: Option<Site>,
    /// Wanted time of a job. Runs are bundled by their stored times, or by estimates
    #[arg(long, value_name = "TIME", requires = "on", default_value = "10 min", value_parser = duration)]
    pub job_time: Duration,
    /// Number of times that a run is repeated if it crashes or exceeds a time limit, each time in a job of
    /// its own (default: 2)
    #[arg(long, value_name = "N", requires = "on")]
    pub retries: Option<u8>,
}

impl OnArgs {
    /// Arguments of a study that runs in this process.
    pub(super) const HERE: OnArgs = OnArgs { on: None, job_time: Duration::from_secs(600), retries: None };

    /// Repetitions of a run of a job.
    pub(super) fn retries(&self) -> u8 {
        self.retries.unwrap_or(2)
    }
}

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
    /// Execution as jobs.
    #[command(flatten)]
    pub on: OnArgs,
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
            on: OnArgs::HERE,
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

fn duration(text: &str) -> Result<Duration, String> {
    let seconds = Dimension::Time.read_positive(text).map_err(|bad| bad.to_string())?;
    Duration::try_from_secs_f64(seconds).map_err(|bad| bad.to_string())
}

fn bytes(text: &str) -> Result<u64, String> {
    Dimension::Bytes.read_positive(text).map(|bytes| bytes as u64).map_err(|bad| bad.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_have_units() {
        assert_eq!(duration("0.5 s"), Ok(Duration::from_millis(500)));
        assert_eq!(duration("2min"), Ok(Duration::from_secs(120)));
        for text in ["60", "0 s", "-1 s", "nan s", "inf s", "soon", "1e300 s", "1 GB"] {
            assert!(duration(text).is_err(), "{text}");
        }
        let sizes = [("500MB", 500_000_000), ("1.5 GB", 1_500_000_000), ("3 KiB", 3072), ("7 B", 7)];
        for (text, size) in sizes {
            assert_eq!(bytes(text), Ok(size), "{text}");
        }
        for text in ["", "4096", "0 B", "MB", "-1GB", "2 XB", "2 s"] {
            assert!(bytes(text).is_err(), "{text}");
        }
        assert!(bytes("500").unwrap_err().contains("write \"500 GB\""), "{:?}", bytes("500"));
    }
}
