//! The commands. Each returns an exit code: 0 success, 1 a check failed, 2 invalid usage or input, 3 could
//! not run, 4 nothing ran, 5 incomplete.

mod adapter;
mod args;
mod baseline;
mod ci;
mod claims;
mod colour;
mod compare;
mod export;
mod fields;
mod history;
mod init;
mod interrupt;
mod json;
mod list;
mod merge;
mod mesh_files;
mod mesh_info;
mod mesh_make;
mod pick;
mod plan;
mod reference;
mod run;
mod solve;
mod text;
mod verify;

use std::io::ErrorKind::InvalidInput;
use std::path::Path;

use cases::scene::{self, ErrorKind, Scene, SceneError};
use catalogue::nearest;
use clap::{CommandFactory, Parser};
use geometry::files;
use records::{RecordError, RunSet};
use reports::{Rendered, ReportError};
use schemars::schema_for;

use crate::Failure;
use crate::process::leash::leash;
use crate::scenario::too_large;
use crate::study::folder::{self, Folder};
use crate::study::isolated::experiment;
use crate::study::{Line, like};
use baseline::baseline;
use claims::claims;
use compare::compare;
use export::export;
use json::RunObject;
use list::list;
use merge::merge;
use plan::plan;
use reference::reference;
use run::run;
use solve::solve;
use verify::verify;

use args::{SceneArgs, SchemaOf};

pub use args::{Cli, Command};

/// Runs the command given on the command line and returns its exit code.
pub fn called() -> u8 {
    match Cli::try_parse() {
        Ok(cli) => main(cli),
        Err(bad) => {
            // The message keeps its colours unless an argument contains control characters.
            let text = bad.render().to_string();
            if crate::print::shown(&text, false) == text {
                bad.exit()
            }
            eprintln!("{}", text.trim_end());
            u8::try_from(bad.exit_code()).unwrap_or(2)
        }
    }
}

/// Runs one command and returns its exit code.
pub fn main(cli: Cli) -> u8 {
    crate::print::code(act(cli))
}

fn act(cli: Cli) -> u8 {
    if let Some(threads) = cli.threads
        && let Err(bad) = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()
    {
        eprintln!("tissuebench: {bad}");
        return 3;
    }
    colour::choose(cli.color);
    // A leash is ended by the process that started it.
    if !matches!(cli.command, Command::Leash(_)) {
        interrupt::install();
    }
    crate::adapter::add_folders(&cli.adapters);
    if cli.no_local_adapters {
        crate::adapter::leave_local_out();
    }
    match cli.command {
        Command::Init(args) => init::init(&args).map_or_else(|failure| fail(&failure), |()| 0),
        Command::Run(args) => run(&args),
        Command::Pick(args) => pick::pick(&args),
        Command::Fields(args) => fields::run(&args),
        Command::Plan { scene, force } => plan(&scene, force),
        Command::Verify { runs, ci } => verify(&runs, &ci),
        Command::Merge(args) => merge(&args),
        Command::Leash(args) => leash(&args),
        Command::Solve(args) => solve(&args),
        Command::Experiment(args) => experiment(&args).map_or_else(|failure| fail(&failure), |()| 0),
        Command::Report { results, out, history } => {
            let out = out.unwrap_or_else(|| results.join("report"));
            report(&results, &out, history.as_deref(), false)
        }
        Command::Baseline(args) => baseline(&args).unwrap_or_else(unreported),
        Command::Reference(args) => match reference(&args) {
            Ok(()) => 0,
            Err(code) => code,
        },
        Command::Export(args) => export(&args),
        Command::Adapter { action } => adapter::act(&action),
        Command::List { what } => list(what.as_deref()),
        Command::Schema { of, study } => {
            println!("{:#}", schema(if study { SchemaOf::Study } else { of }));
            0
        }
        Command::Claims(args) => claims(&args),
        Command::Compare(args) => compare(&args),
        Command::History { action } => history::act(&action),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "tissuebench", &mut script);
            print!("{}", String::from_utf8_lossy(&script));
            0
        }
        Command::Man { command } => manual(command.as_deref()),
        Command::Mesh { action } => match mesh_files::act(&action) {
            Ok(()) => 0,
            Err(failure) => fail(&failure),
        },
    }
}

/// Returns the JSON schema of an input or output.
fn schema(of: SchemaOf) -> serde_json::Value {
    match of {
        SchemaOf::Scene => scene::schema(),
        SchemaOf::Study => scene::study_schema(),
        SchemaOf::Run => schema_for!(RunObject).to_value(),
        SchemaOf::Events => schema_for!(Line).to_value(),
        SchemaOf::Checks => schema_for!(Vec<records::Check>).to_value(),
        SchemaOf::Provenance => schema_for!(records::Provenance).to_value(),
    }
}

/// Prints the manual page of a command or of the program.
fn manual(command: Option<&str>) -> u8 {
    let root = Cli::command();
    let page = match command {
        None => root,
        Some(name) => match root.find_subcommand(name) {
            Some(command) => {
                let name = format!("tissuebench-{name}");
                command.clone().bin_name(name.replacen('-', " ", 1)).display_name(name)
            }
            None => {
                let near = nearest(name, root.get_subcommands().map(clap::Command::get_name));
                let near = near.map_or(String::new(), |near| format!("; did you mean '{near}'?"));
                eprintln!("tissuebench: no command '{name}'{near}");
                return 2;
            }
        },
    };
    let mut text = Vec::new();
    match clap_mangen::Man::new(page).render(&mut text) {
        Ok(()) => {
            print!("{}", String::from_utf8_lossy(&text));
            0
        }
        Err(bad) => {
            eprintln!("tissuebench: {bad}");
            3
        }
    }
}

fn fail(failure: &Failure) -> u8 {
    eprintln!("tissuebench: {failure}");
    failure.exit_code()
}

/// Prints the errors of an input file. Returns 2, or 3 if the file only uses features not available yet.
fn refuse(errors: &[SceneError]) -> u8 {
    for error in errors {
        eprintln!("{error}");
    }
    if errors.iter().all(|e| e.kind == ErrorKind::NotAvailable) { 3 } else { 2 }
}

/// Prints why a file is not a scene, or which command takes it if it is a study or a body. Returns the exit
/// code.
fn refuse_scene(path: &Path, errors: &[SceneError]) -> u8 {
    if holds_key(path, "run") {
        eprintln!("{0}: is a study, not a scene: tissuebench verify {0} runs it", path.display());
    } else if files::is_surface(path) || files::is_mesh(path) {
        eprintln!(
            "{0}: is a body, not a scene: tissuebench init --file {0} writes a scene for the body",
            path.display()
        );
    } else {
        return refuse(errors);
    }
    2
}

/// Claims the results folder for a scene or study, and prints which results it replaces. Returns an exit code
/// on failure.
fn take(file: &Path, out: &Path) -> Result<Folder, u8> {
    let folder = folder::take(file, out).map_err(|failure| fail(&failure))?;
    if let Some(what) = folder::replaced(out) {
        eprintln!("{}: replaces the results of {what}", out.display());
    }
    folder.begin(file).map_err(|failure| fail(&failure))?;
    Ok(folder)
}

/// Loads the scene and returns it with the indices of the selected methods.
fn open(args: &SceneArgs) -> Result<(Scene, Vec<usize>), u8> {
    let path = &args.file;
    let scene = scene::load_with(path, &args.set).map_err(|errors| refuse_scene(path, &errors))?;
    let chosen = choose(&scene, args)?;
    Ok((scene, chosen))
}

/// Returns the indices of the selected methods, if the scene can run.
fn choose(scene: &Scene, args: &SceneArgs) -> Result<Vec<usize>, u8> {
    let ahead = scene.unavailable();
    if !ahead.is_empty() {
        return Err(refuse(&ahead));
    }
    let known: Vec<&str> = scene.methods.iter().map(|m| m.id.as_str()).collect();
    for id in &args.methods {
        if !known.iter().any(|name| like(id, name)) {
            let near = nearest(id, known.iter().copied());
            let near = near.map_or(String::new(), |near| format!("; did you mean '{near}'?"));
            let file = args.file.display();
            eprintln!("{file}: no method '{id}'; known methods are {}{near}", known.join(", "));
            return Err(2);
        }
    }
    let wanted = |name: &str| args.methods.is_empty() || args.methods.iter().any(|id| like(id, name));
    Ok((0..known.len()).filter(|&index| wanted(known[index])).collect())
}

/// Whether a refused file has this top-level key, which distinguishes scenes from studies.
fn holds_key(path: &Path, key: &str) -> bool {
    let text = disk::read_text(path, disk::Kind::SCENE).unwrap_or_default();
    text.parse::<toml::Table>().is_ok_and(|table| table.contains_key(key))
}

/// Refuses runs whose cost exceeds any plausible intention. With `force` this is only a warning.
fn affordable(found: &[SceneError], force: bool) -> Result<(), u8> {
    for error in found {
        eprintln!("{error}");
    }
    if found.is_empty() || force { Ok(()) } else { Err(2) }
}

/// Applies the same check to some methods of a scene.
fn affordable_methods(scene: &Scene, chosen: &[usize], force: bool) -> Result<(), u8> {
    let of = |&index: &usize| too_large(scene, &scene.methods[index], 1.0);
    affordable(&chosen.iter().filter_map(of).collect::<Vec<_>>(), force)
}

fn report(results: &Path, out: &Path, history: Option<&Path>, quiet: bool) -> u8 {
    rendered(reports::render_over_commits(results, out, history), quiet)
}

/// Writes a folder of results with its report and returns the exit code.
fn write_results(out: &Path, set: &RunSet, history: Option<&Path>, quiet: bool) -> u8 {
    rendered(reports::write_with_report(out, set, history), quiet)
}

fn rendered(done: Result<Rendered, ReportError>, quiet: bool) -> u8 {
    match done {
        Ok(rendered) => {
            if !quiet {
                eprintln!("{} files; open {}", rendered.files.len(), rendered.page.display());
            }
            0
        }
        Err(bad) => unreported(bad),
    }
}

/// Prints why results could not be read or written, and returns the exit code.
fn unreported(bad: impl Into<ReportError>) -> u8 {
    let bad = bad.into();
    eprintln!("tissuebench: {bad}");
    match &bad {
        // The output is an input, or not a regular file.
        ReportError::Records(RecordError::Unwritten { source, .. }) if source.kind() == InvalidInput => 2,
        ReportError::Records(RecordError::Incomplete { .. } | RecordError::Unwritten { .. }) => 5,
        _ => 2,
    }
}
