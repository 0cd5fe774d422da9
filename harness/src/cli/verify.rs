//! `tissuebench verify`: a study, whose checks gate the exit code.

use cases::scene;
use reports::Status;

use crate::cli::{refuse, report, take, text};
use crate::study::{Plan, VerifyArgs, folder};

/// Runs the study, writes its results and the report; returns the exit code.
pub(super) fn verify(args: &VerifyArgs) -> u8 {
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
    if let Err(code) = take(&path, &args.out) {
        return code;
    }
    eprintln!("{}: {} runs", path.display(), plan.len());
    let finished = plan.execute(args);
    let mut set = finished.set;
    set.provenance.source = folder::source(&path);
    if let Err(bad) = reports::write_run(&args.out, &set) {
        eprintln!("tissuebench: {bad}");
        return 3;
    }
    let rendered = report(&args.out, &args.out.join("report"));
    for failure in &set.failures {
        let word = match failure.carried {
            None => "could not run".into(),
            Some(load) => format!("ended at {load:.4} of the load"),
        };
        eprintln!("{word}: {} {}: {}", failure.case, failure.method, failure.reason);
    }
    let count = |status| set.checks.iter().filter(|c| c.status == status).count();
    for check in set.checks.iter().filter(|c| matches!(c.status, Status::Fail | Status::NotRun)) {
        eprintln!("{}", text::verdict(check));
    }
    let (failed, not_run) = (count(Status::Fail), count(Status::NotRun));
    println!(
        "{} runs, {} records; checks: {} passed, {} failed, {} known not to pass, {} not run",
        finished.ran,
        set.records.len(),
        count(Status::Pass),
        failed,
        count(Status::KnownFailure),
        not_run
    );
    println!("records  {}", args.out.join("records.csv").display());
    println!("report   {}", args.out.join("report").join("report.html").display());
    match () {
        () if failed > 0 => 1,
        () if !finished.failed.is_empty() => finished.failed.iter().copied().max().unwrap_or(3),
        () if rendered != 0 => rendered,
        () if not_run > 0 => 5,
        () => 0,
    }
}
