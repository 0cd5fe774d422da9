//! The value of `--on`: the system that runs the jobs of a study.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// Jobs at once on a cluster, unless `jobs=N` is given.
const JOBS: u16 = 16;
const USAGE: &str = "write local:8, slurm:jobs=16,partition=NAME, hyperqueue:jobs=16 or snakemake:FOLDER";

/// System that runs jobs, with its options.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Site {
    /// This machine.
    Local {
        /// Number of jobs at once.
        jobs: u16,
    },
    /// Slurm.
    Slurm {
        /// Number of jobs in the queue at once.
        jobs: u16,
        /// Further options of `sbatch`.
        options: Vec<(String, String)>,
    },
    /// HyperQueue.
    HyperQueue {
        /// Number of jobs in the queue at once.
        jobs: u16,
        /// Further options of `hq submit`.
        options: Vec<(String, String)>,
    },
    /// Snakemake.
    Snakemake {
        /// Folder with the profile (`config.yaml`), if there is one, and for the files of the jobs.
        folder: PathBuf,
        /// Number of jobs at once.
        jobs: u16,
    },
}

impl Site {
    /// Number of jobs that are handed over at once.
    pub fn jobs(&self) -> usize {
        match self {
            Site::Local { jobs }
            | Site::Slurm { jobs, .. }
            | Site::HyperQueue { jobs, .. }
            | Site::Snakemake { jobs, .. } => usize::from(*jobs),
        }
    }

    /// Whether all jobs run on this machine.
    pub fn is_local(&self) -> bool {
        matches!(self, Site::Local { .. })
    }
}

impl FromStr for Site {
    type Err = String;

    fn from_str(text: &str) -> Result<Site, String> {
        let (system, rest) = text.split_once(':').unwrap_or((text, ""));
        match system {
            "local" => Ok(Site::Local { jobs: count(rest, "local")? }),
            "slurm" => {
                let (jobs, options) = options(rest)?;
                Ok(Site::Slurm { jobs, options })
            }
            "hyperqueue" => {
                let (jobs, options) = options(rest)?;
                Ok(Site::HyperQueue { jobs, options })
            }
            "snakemake" => match rest {
                "" => Err(format!("snakemake needs a folder; {USAGE}")),
                rest => {
                    let given =
                        rest.strip_prefix("jobs=").map(|rest| rest.split_once(',').unwrap_or((rest, "")));
                    match given {
                        None => Ok(Site::Snakemake { folder: rest.into(), jobs: JOBS }),
                        Some((_, "")) => Err(format!("snakemake needs a folder; {USAGE}")),
                        Some((jobs, folder)) => {
                            Ok(Site::Snakemake { folder: folder.into(), jobs: count(jobs, "jobs=")? })
                        }
                    }
                }
            },
            _ => Err(format!("no system '{system}'; {USAGE}")),
        }
    }
}

impl fmt::Display for Site {
    fn fmt(&self, to: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Site::Local { jobs } => write!(to, "local:{jobs}"),
            Site::Snakemake { folder, jobs } => write!(to, "snakemake:jobs={jobs},{}", folder.display()),
            Site::Slurm { jobs, options } | Site::HyperQueue { jobs, options } => {
                let system = if matches!(self, Site::Slurm { .. }) { "slurm" } else { "hyperqueue" };
                write!(to, "{system}:jobs={jobs}")?;
                options.iter().try_for_each(|(key, value)| write!(to, ",{key}={value}"))
            }
        }
    }
}

/// Reads a number of jobs.
fn count(text: &str, system: &str) -> Result<u16, String> {
    let problem = || format!("'{text}' is no number of jobs from 1 to 1024; {USAGE}");
    match text.parse() {
        Ok(jobs @ 1..=1024) => Ok(jobs),
        _ if text.is_empty() => Err(format!("{system} needs a number of jobs; {USAGE}")),
        _ => Err(problem()),
    }
}

/// Reads `jobs=16,partition=short,...`.
fn options(text: &str) -> Result<(u16, Vec<(String, String)>), String> {
    let (mut jobs, mut options) = (JOBS, Vec::new());
    for part in text.split(',').filter(|part| !part.is_empty()) {
        match part.split_once('=') {
            Some(("jobs", value)) => jobs = count(value, "jobs=")?,
            Some((key, _)) if RESERVED.contains(&key) => {
                return Err(format!("'{part}': {key} is set for each job from its runs; leave it out"));
            }
            Some((key, value)) if is_option(key) && !value.is_empty() => {
                options.push((key.into(), value.into()));
            }
            _ => return Err(format!("'{part}' is no option; write KEY=VALUE, such as partition=short")),
        }
    }
    Ok((jobs, options))
}

/// Options of `sbatch` and `hq submit` that follow from the runs of a job.
const RESERVED: [&str; 15] = [
    "array",
    "chdir",
    "cpus",
    "cpus-per-task",
    "cwd",
    "error",
    "mem",
    "name",
    "ntasks",
    "output",
    "signal",
    "stderr",
    "stdout",
    "time",
    "wait",
];

fn is_option(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_have_options_and_bad_ones_are_named() {
        let read = |text: &str| text.parse::<Site>();
        assert_eq!(read("local:8"), Ok(Site::Local { jobs: 8 }));
        let options = vec![("partition".into(), "short".into()), ("qos".into(), "a".into())];
        assert_eq!(read("slurm:jobs=4,partition=short,qos=a"), Ok(Site::Slurm { jobs: 4, options }));
        assert_eq!(read("slurm").unwrap().to_string(), "slurm:jobs=16");
        for (text, says) in [
            ("cloud", "no system 'cloud'"),
            ("local", "needs a number of jobs"),
            ("local:0", "'0' is no number of jobs from 1 to 1024"),
            ("slurm:jobs=x", "'x' is no number"),
            ("slurm:partition", "'partition' is no option"),
            ("slurm:time=3", "time is set for each job"),
            ("hyperqueue:cpus=3", "cpus is set for each job"),
            ("snakemake", "needs a folder"),
        ] {
            let bad = read(text).unwrap_err();
            assert!(bad.contains(says), "{text}: {bad}");
        }
    }
}
