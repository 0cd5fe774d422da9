//! Systems that run jobs: this machine, Slurm, HyperQueue, Snakemake. Each implements [`Executor`], and
//! passes the tests in `harness/tests/executors.rs`.

mod hyperqueue;
mod job;
mod local;
mod programs;
mod site;
mod slurm;
mod snakemake;

use crate::error::Failure;

pub use job::{End, Executor, Job, State};
pub use site::Site;

/// Returns the executor of a site.
///
/// # Errors
/// The programs of the system are not installed.
pub fn open(site: &Site) -> Result<Box<dyn Executor>, Failure> {
    Ok(match site {
        Site::Local { jobs } => Box::new(local::Local::new((*jobs).into())),
        Site::Slurm { options, .. } => {
            programs::needed("slurm", &["sbatch", "squeue", "scancel"])?;
            Box::new(slurm::Slurm::new(options.clone()))
        }
        Site::HyperQueue { options, .. } => {
            programs::needed("hyperqueue", &["hq"])?;
            Box::new(hyperqueue::HyperQueue::new(options.clone()))
        }
        Site::Snakemake { folder, jobs } => {
            programs::needed("snakemake", &["snakemake"])?;
            Box::new(snakemake::Snakemake::new(folder, (*jobs).into()))
        }
    })
}
