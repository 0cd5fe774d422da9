//! The commands, each ending in an exit code: 0 all held, 1 a check failed, 2 bad usage or input, 3 could not run,
//! 4 nothing ran, 5 incomplete.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use cases::scene::{self, ErrorKind, Scene, SceneError};
use reports::{RunSet, Status};

use crate::baseline::baseline;
use crate::cli::{Cli, Command, Format, ReferenceArgs, RunArgs, VerifyArgs};
use crate::group::{Extras, Group, case_name};
use crate::json::RunObject;
use crate::outcome::{Outcome, Unfinished};
use crate::run::Repeats;
use crate::stored::Stored;
use crate::study::{self, Plan};
use crate::{Failure, check, folder, list, mesh_files, provenance};

/// Repeats of a single run's timings.
const REPEATS: Repeats = Repeats { most: 5, seconds: 1.0 };

/// Runs one command and returns its exit code.
pub fn main(cli: Cli) -> u8 {
    if let Some(threads) = cli.threads
        && let Err(bad) = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()
    {
        eprintln!("tissuebench: {bad}");
        return 3;
    }
    match cli.command {
        Command::Run(args) => run(&args),
        Command::Plan { scene, methods } => plan(&scene, &methods),
        Command::Verify(args) => verify(&args),
        Command::Report { results, out } => {
            let out = out.unwrap_or_else(|| results.join("report"));
            report(&results, &out)
        }
        Command::Baseline(args) => baseline(&args).unwrap_or_else(|bad| {
            eprintln!("tissuebench: {bad}");
            2
        }),
        Command::Reference(args) => match reference(&args) {
            Ok(()) => 0,
            Err(code) => code,
        },
        Command::List => {
            list::print();
            0
        }
        Command::Schema => {
            println!("{}", serde_json::to_string_pretty(&scene::schema()).expect("a JSON value"));
            0
        }
        Command::Mesh { action } => match mesh_files::act(&action) {
            Ok(()) => 0,
            Err(failure) => fail(&failure),
        },
    }
}

fn fail(failure: &Failure) -> u8 {
    eprintln!("tissuebench: {failure}");
    failure.exit_code()
}

/// Prints what is wrong with an input file; 2, or 3 if it is only ahead of what can run.
fn refuse(errors: &[SceneError]) -> u8 {
    for error in errors {
        eprintln!("{error}");
    }
    if errors.iter().all(|e| e.kind == ErrorKind::NotAvailable) { 3 } else { 2 }
}

/// The scene, and the indices of the methods asked for.
fn open(path: &Path, methods: &[String]) -> Result<(Scene, Vec<usize>), u8> {
    let scene = scene::load(path).map_err(|errors| refuse(&errors))?;
    let ahead = scene.unavailable();
    if !ahead.is_empty() {
        return Err(refuse(&ahead));
    }
    let mut chosen = Vec::new();
    for id in methods {
        match scene.methods.iter().position(|m| m.id == *id) {
            Some(index) => chosen.push(index),
            None => {
                let known: Vec<&str> = scene.methods.iter().map(|m| m.id.as_str()).collect();
                eprintln!("{}: no method '{id}'; it has {}", path.display(), known.join(", "));
                return Err(2);
            }
        }
    }
    if methods.is_empty() {
        chosen = (0..scene.methods.len()).collect();
    }
    Ok((scene, chosen))
}

fn run(args: &RunArgs) -> u8 {
    let (scene, chosen) = match open(&args.scene, &args.methods) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let (case, machine) = (case_name(&scene), provenance::machine());
    if let Some(Err(taken)) = args.out.as_deref().map(|out| folder::free_for(&args.scene, out)) {
        eprintln!("tissuebench: {taken}");
        return 2;
    }
    let group = match Group::new(&scene, None, REPEATS) {
        Ok(group) => group,
        Err(failure) => {
            if args.format == Format::Json {
                for &index in &chosen {
                    let method = &scene.methods[index];
                    print_json(&RunObject::failed(
                        &case,
                        &method.id,
                        &unreferenced(&scene, method, &failure),
                    ));
                }
            }
            eprintln!("{failure} (every method)");
            return failure.exit_code();
        }
    };
    let mut code = 0;
    let mut outcomes: Vec<Outcome> = Vec::new();
    let mut set = RunSet::default();
    if let Some(failure) = group.reference_stalled() {
        eprintln!("reference stalled: {failure} (every method is compared with the steps it carried)");
        let reason = format!("reference stalled: {failure}");
        set.failures.push(reports::Failure { case: case.clone(), method: "reference".into(), reason });
        code = failure.exit_code();
    }
    for index in chosen {
        let method = &scene.methods[index];
        if std::io::stderr().is_terminal() {
            // A static run may take minutes.
            eprintln!("{} ...", method.id);
        }
        match group.run(
            &group.scenario(method.clone(), 0),
            Extras { picture: args.out.is_some(), frames: true, split: None },
        ) {
            Ok(outcome) => {
                if args.format == Format::Json {
                    print_json(&RunObject::finished(&outcome));
                }
                set.records.extend(outcome.records());
                set.plans.extend(outcome.plan_entries());
                set.fields.extend(outcome.field.clone());
                let records = outcome.records();
                for check in &scene.checks {
                    if check::needs_levels(check)
                        || !(check.methods.is_empty() || check.methods.contains(&method.id))
                    {
                        continue;
                    }
                    let value = check::value(check.metric.name, &records);
                    set.checks.push(check::judge(check, &case, &method.id, value));
                }
                if let Some(reason) = &outcome.relaxed {
                    eprintln!("relaxed: {reason} (method '{}')", method.id);
                }
                if let Some(failure) = &outcome.stalled {
                    eprintln!("{}: {failure} (method '{}')", outcome.status, method.id);
                    set.failures.push(stalled(&outcome, failure));
                    code = code.max(failure.exit_code());
                }
                outcomes.push(outcome);
            }
            Err(unfinished) => {
                if args.format == Format::Json {
                    print_json(&RunObject::failed(&case, &method.id, &unfinished));
                }
                let failure = unfinished.failure;
                eprintln!("{failure} (method '{}')", method.id);
                set.failures.push(reports::Failure {
                    case: case.clone(),
                    method: method.id.clone(),
                    reason: failure.to_string(),
                });
                code = code.max(failure.exit_code());
            }
        }
    }
    if args.format == Format::Table && !outcomes.is_empty() {
        println!("{}", list::outcomes(&outcomes));
    }
    for check in set.checks.iter().filter(|c| matches!(c.status, Status::Fail | Status::NotRun)) {
        eprintln!("{}", list::verdict(check));
        code = code.max(1);
    }
    set.records.extend(study::reference_records(&scene));
    if let Some(out) = &args.out {
        let text = scene.text().to_string();
        set.provenance = provenance::provenance(machine, &[(case, text)]);
        set.provenance.source = folder::source(&args.scene);
        match reports::write_run(out, &set) {
            Ok(()) => code = code.max(report(out, &out.join("report"))),
            Err(bad) => {
                eprintln!("tissuebench: {bad}");
                return 3;
            }
        }
    }
    code
}

/// A path that ended early, among what failed; its numbers are kept beside.
pub(crate) fn stalled(outcome: &Outcome, failure: &Failure) -> reports::Failure {
    reports::Failure {
        case: outcome.identity.case.clone(),
        method: outcome.identity.method.clone(),
        reason: format!("{}: {failure}", outcome.status),
    }
}

/// A method that did not run because its reference could not: what it would have done.
fn unreferenced(scene: &Scene, method: &scene::Method, failure: &Failure) -> Unfinished {
    let planned =
        Group::unreferenced(scene, REPEATS).and_then(|group| group.plan(&group.scenario(method.clone(), 0)));
    let (plan, size) = planned.unwrap_or_default();
    Unfinished { failure: failure.clone(), plan, size }
}

fn print_json(object: &RunObject) {
    println!("{}", serde_json::to_string(object).expect("finite numbers and text"));
}

fn plan(path: &Path, methods: &[String]) -> u8 {
    let (scene, chosen) = match open(path, methods) {
        Ok(opened) => opened,
        Err(code) => return code,
    };
    let mut code = 0;
    for index in chosen {
        let method = &scene.methods[index];
        // A plan needs no reference: only what the run itself would do.
        let stages = Group::unreferenced(&scene, REPEATS)
            .and_then(|group| group.plan(&group.scenario(method.clone(), 0)));
        match stages {
            Ok((stages, _)) => print!("{}", list::stages(&method.id, &stages)),
            Err(failure) => {
                eprintln!("{failure} (method '{}')", method.id);
                code = code.max(failure.exit_code());
            }
        }
    }
    code
}

/// Runs every method of a scene and writes what they agree on.
fn reference(args: &ReferenceArgs) -> Result<(), u8> {
    let (scene, _) = open(&args.scene, &args.methods)?;
    let text = scene.text().to_string();
    let mesh = geometry::msh::read(&args.points, args.unit)
        .map_err(|bad| fail(&Failure::Input(format!("{}: {bad}", args.points.display()))))?;
    let read = |path: &PathBuf| -> Result<Stored, u8> {
        let of_file = |problem| fail(&Failure::Input(format!("{}: {problem}", path.display())));
        let stored = Stored::read(path).map_err(|problem| fail(&Failure::Input(problem)))?;
        stored.belongs(&text, mesh.points()).map_err(of_file)?;
        Ok(stored)
    };
    let told = args.told.as_ref().map(read).transpose()?;
    let mut used: Vec<String> = match &told {
        Some(told) => told.methods().map(Into::into).collect(),
        None if args.methods.is_empty() => scene.methods.iter().map(|m| m.id.clone()).collect(),
        None => args.methods.clone(),
    };
    // Refused before hours are spent on the methods.
    let mut beside = Vec::new();
    for path in &args.beside {
        let other = read(path)?;
        // A solution is no witness of itself.
        if let Some(twice) = other.methods().find(|id| used.iter().any(|u| u == id)) {
            let problem = format!("{}: '{twice}' is there already; name others by --method", path.display());
            return Err(fail(&Failure::Input(problem)));
        }
        used.extend(other.methods().map(Into::into));
        beside.push(other);
    }
    let mut stored = match told {
        Some(told) => told,
        None => {
            Stored::make(&scene, &text, mesh.points(), &args.methods).map_err(|failure| fail(&failure))?
        }
    };
    beside.iter().for_each(|other| stored.widen(other));
    print!("{}", list::reference(&stored));
    let json = serde_json::to_string(&stored).expect("finite numbers and text");
    std::fs::write(&args.out, json + "\n")
        .map_err(|bad| fail(&Failure::Run(format!("{} can't be written: {bad}", args.out.display()))))
}

fn verify(args: &VerifyArgs) -> u8 {
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
    if let Err(taken) = folder::free_for(&path, &args.out) {
        eprintln!("tissuebench: {taken}");
        return 2;
    }
    if plan.is_empty() {
        eprintln!("tissuebench: no run of {} fits; nothing ran", path.display());
        return 4;
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
        eprintln!("could not run: {} {}: {}", failure.case, failure.method, failure.reason);
    }
    let count = |status| set.checks.iter().filter(|c| c.status == status).count();
    for check in set.checks.iter().filter(|c| matches!(c.status, Status::Fail | Status::NotRun)) {
        eprintln!("{}", list::verdict(check));
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

fn report(results: &Path, out: &Path) -> u8 {
    match reports::render(results, out) {
        Ok(rendered) => {
            eprintln!("{} files in {}", rendered.files.len(), out.display());
            0
        }
        Err(bad) => {
            eprintln!("tissuebench: {bad}");
            2
        }
    }
}
