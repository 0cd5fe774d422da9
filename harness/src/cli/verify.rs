//! `tissuebench verify`: runs a study, whose checks determine the exit code.

use std::path::Path;

use cases::scene;
use catalogue::warning;
use records::Status;

use crate::cli::ci::{self, CiArgs};
use crate::cli::errors::{fail, refuse, unreported};
use crate::cli::results::{close, take, write_results};
use crate::cli::scenes::{affordable, holds_key};
use crate::cli::{colour, interrupt, text};
use crate::error::Failure;
use crate::study::folder::{self, Folder};
use crate::study::jobs::bundle;
use crate::study::jobs::queue::Jobs;
use crate::study::{self, Event, Events, FinishedStudy, StudyPlan, VerifyArgs};

/// Runs the study, writes its results and the report, and returns the exit code.
/// `threads` is the number of threads that the user gave.
pub(super) fn verify(args: &VerifyArgs, ci: &CiArgs, threads: Option<u16>) -> u8 {
    let path = args.path();
    let mut plan = match planned(args, &path) {
        Ok(plan) => plan,
        Err(code) => return code,
    };
    if let Some(times) = args.times.as_deref().filter(|times| !study::has_stored(times)) {
        let times = times.display();
        eprintln!(
            "tissuebench: --times {times}: has no stored runs; give a folder written by `tissuebench verify`"
        );
        return 2;
    }
    plan.select(args);
    if plan.is_empty() {
        eprintln!("tissuebench: no run of {} matches the selection; nothing ran", path.display());
        return 4;
    }
    if ci.list {
        print!("{}", ci::names(&plan.planned(args)));
        return 0;
    }
    if ci.dry_run {
        let planned = plan.planned(args);
        if let Some(times) = &args.times {
            let known = planned.iter().filter(|run| run.stored).count();
            eprintln!("{known} of {} runs have times in {}", planned.len(), times.display());
        }
        print!("{}", ci::forecast(&planned));
        return 0;
    }
    if let Err(code) = affordable(&plan.too_large(args), args.force) {
        return code;
    }
    // An unreadable history is refused before the runs, which may take hours.
    if let Some(Err(bad)) = args.history.as_deref().map(reports::commits::check) {
        return unreported(bad);
    }
    let jobs = match args.on.on.as_ref().map(Jobs::open).transpose() {
        Ok(jobs) => jobs,
        Err(failure) => return fail(&failure),
    };
    let events = match ci::begin(ci, &plan) {
        Ok(events) => events,
        Err(bad) => {
            eprintln!("tissuebench: {bad}; give a file that can be written");
            return 2;
        }
    };
    let entered = enter(args, &path).and_then(|folder| {
        study::merge::note(args, &path).map_err(|failure| fail(&failure)).map(|()| folder)
    });
    let folder = match entered {
        Ok(folder) => folder,
        Err(code) => return code,
    };
    if !args.quiet {
        eprintln!("{}: {} runs", path.display(), plan.len());
    }
    let mut finished = match executed(&plan, args, jobs.as_ref(), threads, events.as_ref()) {
        Ok(finished) => finished,
        Err(failure) => return fail(&failure),
    };
    finished.set.provenance.source = folder::source(&path);
    if finished.stored > 0 && !args.quiet {
        eprintln!("{} of {} runs were taken from stored results", finished.stored, finished.ran);
    }
    let code = write(&finished, &folder, args);
    let code = ci::write(ci, &path, &finished.runs).map_or_else(
        |bad| {
            eprintln!("tissuebench: {bad}");
            code.max(3)
        },
        |()| code,
    );
    let code = ended(events, ci, &finished, code);
    close(folder, &args.out, code, || study::clean(&args.out))
}

/// Executes the runs in this process or, with `--on`, as jobs.
fn executed(
    plan: &StudyPlan,
    args: &VerifyArgs,
    jobs: Option<&Jobs>,
    threads: Option<u16>,
    events: Option<&Events>,
) -> Result<FinishedStudy, Failure> {
    let (Some(site), Some(jobs)) = (&args.on.on, jobs) else {
        interrupt::at_last(interrupt::resumable(args.out.clone()));
        return Ok(plan.execute_watched(args, events));
    };
    interrupt::at_last(interrupt::cancelling(jobs.clone(), args.out.clone()));
    // Processes of this machine divide its processors. A cluster gives a job one, unless more are wanted.
    let each = if site.is_local() { rayon::current_num_threads() / site.jobs() } else { 1 };
    plan.execute_on(args, site, jobs, threads.map_or(each.max(1), usize::from), events)
}

/// Reads the study and its scenes. An error is printed, and its exit code returned.
fn planned(args: &VerifyArgs, path: &Path) -> Result<StudyPlan, u8> {
    let study = scene::load_study(path).map_err(|errors| {
        if args.study.is_none() && !path.exists() {
            eprintln!(
                "tissuebench: run from the project's folder, or name a study: tissuebench verify STUDY.toml"
            );
        }
        if holds_key(path, "body") {
            eprintln!("{0}: is a scene, not a study: tissuebench run {0} runs it", path.display());
            return 2;
        }
        refuse(&errors)
    })?;
    StudyPlan::new(study).map_err(|errors| refuse(&errors))
}

/// Sends the last event. Returns the exit code, which is 5 if the study succeeded but events were lost.
fn ended(events: Option<Events>, ci: &CiArgs, finished: &FinishedStudy, code: u8) -> u8 {
    let Some(events) = events else { return code };
    let [passed, failed, known, not_run] = counts(finished);
    events.send(&Event::End { passed, failed, known, not_run, code });
    let Some(bad) = events.lost() else { return code };
    let file = ci.events.as_deref().unwrap_or(Path::new("-")).display();
    eprintln!("tissuebench: --events {file}: {bad}; some events are missing");
    if code == 0 { 5 } else { code }
}

/// Returns the numbers of checks that passed, failed, are known not to pass, and did not run.
fn counts(finished: &FinishedStudy) -> [usize; 4] {
    let count = |status| finished.set.checks.iter().filter(|c| c.status == status).count();
    [Status::Pass, Status::Fail, Status::KnownFailure, Status::NotRun].map(count)
}

/// Claims the folder of results, or joins the processes that already work in it.
fn enter(args: &VerifyArgs, path: &Path) -> Result<Folder, u8> {
    if !args.join && args.on.on.is_none() {
        return take(path, &args.out).inspect(|_| study::clean(&args.out));
    }
    let joined = folder::join(path, &args.out, || {
        study::sweep(args);
        bundle::remove(&args.out);
    });
    let begun = joined.and_then(|folder| folder.begin(path).map(|()| folder));
    begun.map_err(|failure| fail(&failure))
}

/// Writes the results and the report, prints the verdicts, and returns the exit code. With `quiet` only
/// checks that did not pass are printed.
pub(super) fn write(finished: &FinishedStudy, folder: &Folder, args: &VerifyArgs) -> u8 {
    let VerifyArgs { out, history, quiet, .. } = args;
    let set = &finished.set;
    // If several processes work on a study, one of them writes the results of all.
    let (lock, written) = folder.writing();
    let rendered = match written {
        true => 0,
        false => write_results(out, set, history.as_deref(), *quiet),
    };
    drop(lock);
    for failure in &set.failures {
        let word = match failure.carried {
            None => "could not run".into(),
            Some(load) => format!("ended at {load:.4} of the load"),
        };
        let word = colour::err(colour::DOUBTFUL, &word);
        eprintln!("{word}: {} {}: {}", failure.case, failure.method, failure.reason);
    }
    for check in set.checks.iter().filter(|check| text::is_told(check)) {
        eprintln!("{}", text::painted_verdict(check));
    }
    let busy: Vec<_> =
        set.warnings.iter().filter(|w| w.code == warning::MACHINE_BUSY.code).cloned().collect();
    let [passed, failed, known, not_run] = counts(finished);
    if !quiet {
        eprint!("{}", text::warnings(&busy));
        println!(
            "{} runs, {} records; checks: {passed} passed, {failed} failed, {known} known not to pass, {not_run} not run",
            finished.ran,
            set.records.len(),
        );
        println!("records  {}", out.join("records.csv").display());
        println!("report   {}", out.join("report").join("report.html").display());
    }
    match () {
        () if failed > 0 => 1,
        () if !finished.failed.is_empty() => finished.failed.iter().copied().max().unwrap_or(3),
        () if rendered != 0 => rendered,
        () if not_run > 0 => 5,
        () => 0,
    }
}
