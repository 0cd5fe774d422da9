//! `tissuebench status`: how far the study in a folder of results is.

use crate::cli::errors::{fail, refuse};
use crate::study::jobs::status::{Status, StatusArgs};
use crate::study::merge::Unmerged;

/// Longest list of runs.
const MOST: usize = 20;

/// Prints the state of a study. Returns 0 if all runs have results, and 5 otherwise.
pub(super) fn status(args: &StatusArgs) -> u8 {
    let status = match Status::of(&args.results) {
        Ok(status) => status,
        Err(Unmerged::Scenes(errors)) => return refuse(&errors),
        Err(Unmerged::Other(failure)) => return fail(&failure),
    };
    let Status { runs, done, running, failed, jobs, seconds_left, worst } = &status;
    println!(
        "{done} of {runs} runs done, {} running, {} failed; about {seconds_left:.0} s left",
        running.len(),
        failed.len()
    );
    list("running", running.iter().map(|name| format!("  {name}")));
    list("failed", failed.iter().map(|(name, reason)| format!("  {name}: {reason}")));
    list(
        "jobs",
        jobs.iter().map(|job| {
            let state = if job.is_running { "running" } else { "not running" };
            let (number, left, runs) = (job.number, job.left, job.runs);
            format!("  {number}: {state}, {left} of {runs} runs and about {:.0} s left", job.seconds_left)
        }),
    );
    if let Some((name, seconds)) = worst {
        println!("longest run left: {name}, about {seconds:.1} s");
    }
    if done == runs { 0 } else { 5 }
}

/// Prints the first lines of a list under its title.
fn list(title: &str, lines: impl ExactSizeIterator<Item = String>) {
    let count = lines.len();
    if count > 0 {
        println!("{title}:");
        lines.take(MOST).for_each(|line| println!("{line}"));
    }
    if count > MOST {
        println!("  and {} more", count - MOST);
    }
}
