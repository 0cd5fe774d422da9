//! `tissuebench verify`: a study, whose checks gate the exit code.

use std::path::Path;

use cases::scene;
use reports::Status;

use crate::cli::ci::{self, CiArgs};
use crate::cli::{refuse, report, take, text};
use crate::study::events::{Event, Events};
use crate::study::{Finished, Plan, VerifyArgs, folder};

/// Runs the study, writes its results and the report; returns the exit code.
pub(super) fn verify(args: &VerifyArgs, ci: &CiArgs) -> u8 {
    let path = args.study.clone().unwrap_or_else(|| "cases/studies/verify.toml".into());
    let study = match scene::load_study(&path) {
        Ok(study) => study,
        Err(errors) => {
            if args.study.is_none() && !path.exists() {
                eprintln!(
                    "tissuebench: run from the project's folder, or name a study: tissuebench verify STUDY.toml"
                );
            }
            return refuse(&errors);
        }
    };
    let mut plan = match Plan::new(study) {
        Ok(plan) => plan,
        Err(errors) => return refuse(&errors),
    };
    plan.select(args);
    if plan.is_empty() {
        eprintln!("tissuebench: no run of {} fits; nothing ran", path.display());
        return 4;
    }
    if ci.list {
        print!("{}", ci::names(&plan.planned(&args.out)));
        return 0;
    }
    if ci.dry_run {
        print!("{}", ci::forecast(&plan.planned(&args.out)));
        return 0;
    }
    if let Err(code) = take(&path, &args.out) {
        return code;
    }
    let events = match ci.events.as_deref().map(Events::to).transpose() {
        Ok(events) => events,
        Err(bad) => {
            let file = ci.events.as_deref().unwrap_or(&path).display();
            eprintln!("tissuebench: --events {file}: {bad}; give a file that can be written");
            return 2;
        }
    };
    if !args.quiet {
        eprintln!("{}: {} runs", path.display(), plan.len());
    }
    let finished = plan.execute_watched(args, events.as_ref());
    let (code, counts) = conclude(args, &path, &finished);
    if let Some(events) = &events {
        let [passed, failed, known, not_run] = counts;
        events.send(&Event::End { passed, failed, known, not_run, code });
    }
    match ci::write(ci, &path, &finished.runs) {
        Ok(()) => code,
        Err(bad) => {
            eprintln!("tissuebench: {bad}");
            code.max(3)
        }
    }
}

/// Writes the results and the report, and says what did not hold; returns the exit code, and the checks that passed, failed, are
/// known not to pass and did not run.
fn conclude(args: &VerifyArgs, path: &Path, finished: &Finished) -> (u8, [usize; 4]) {
    let mut set = finished.set.clone();
    set.provenance.source = folder::source(path);
    let count = |status| set.checks.iter().filter(|c| c.status == status).count();
    let statuses = [Status::Pass, Status::Fail, Status::KnownFailure, Status::NotRun];
    let counts @ [passed, failed, known, not_run] = statuses.map(count);
    if let Err(bad) = reports::write_run(&args.out, &set) {
        eprintln!("tissuebench: {bad}");
        return (3, counts);
    }
    let rendered = report(&args.out, &args.out.join("report"));
    for failure in &set.failures {
        let word = match failure.carried {
            None => "could not run".into(),
            Some(load) => format!("ended at {load:.4} of the load"),
        };
        eprintln!("{word}: {} {}: {}", failure.case, failure.method, failure.reason);
    }
    for check in set.checks.iter().filter(|c| matches!(c.status, Status::Fail | Status::NotRun)) {
        eprintln!("{}", text::verdict(check));
    }
    if !args.quiet {
        println!(
            "{} runs, {} records; checks: {passed} passed, {failed} failed, {known} known not to pass, {not_run} not run",
            finished.ran,
            set.records.len(),
        );
        println!("records  {}", args.out.join("records.csv").display());
        println!("report   {}", args.out.join("report").join("report.html").display());
    }
    let code = match () {
        () if failed > 0 => 1,
        () if !finished.failed.is_empty() => finished.failed.iter().copied().max().unwrap_or(3),
        () if rendered != 0 => rendered,
        () if not_run > 0 => 5,
        () => 0,
    };
    (code, counts)
}
