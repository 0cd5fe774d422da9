//! The commands. Each returns an exit code: 0 success, 1 a check failed, 2 invalid usage or input, 3 could
//! not run, 4 nothing ran, 5 incomplete.

mod adapter;
mod args;
mod baseline;
mod bound;
mod ci;
mod claims;
mod colour;
mod command;
mod compare;
mod errors;
mod export;
mod fields;
mod fit;
mod history;
mod import;
mod init;
mod interrupt;
mod json;
mod like;
mod list;
mod merge;
mod mesh;
mod paced;
mod pick;
mod plan;
mod reference;
mod reproduce;
mod results;
mod run;
mod scenes;
mod solve;
mod status;
mod text;
mod vary;
mod verify;

use cases::scene;
use catalogue::nearest;
use clap::{CommandFactory, Parser};
use schemars::schema_for;

use crate::process::leash::leash;
use crate::study::Line;
use crate::study::isolated::experiment;
use crate::study::jobs::worker::job;
use args::SchemaOf;
use baseline::baseline;
use bound::bound;
use claims::claims;
use compare::compare;
use errors::{fail, unreported};
use export::export;
use fit::fit;
use json::RunObject;
use list::list;
use merge::merge;
use plan::plan;
use reference::reference;
use reproduce::reproduce;
use results::report;
use run::run;
use solve::solve;
use status::status;
use vary::vary;
use verify::verify;

pub use command::{Cli, Command};

/// Runs the command given on the command line and returns its exit code.
pub fn called() -> u8 {
    crate::run::keep_freed_memory();
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
        Command::Import(args) => import::import(&args),
        Command::Run(args) => run(&args),
        Command::Pick(args) => pick::pick(&args),
        Command::Bound(args) => bound(&args),
        Command::Loop(args) => paced::played(&args),
        Command::Fields(args) => fields::run(&args),
        Command::Plan { scene, force } => plan(&scene, force),
        Command::Verify { runs, ci } => verify(&runs, &ci, cli.threads),
        Command::Vary(args) => vary(&args),
        Command::Fit(args) => fit(&args),
        Command::Merge(args) => merge(&args),
        Command::Status(args) => status(&args),
        Command::Reproduce(args) => reproduce(&args),
        Command::Job(args) => job(&args).map_or_else(|failure| fail(&failure), |()| 0),
        Command::Leash(args) => leash(&args),
        Command::Solve(args) => solve(&args),
        Command::Experiment(args) => experiment(&args).map_or_else(|failure| fail(&failure), |()| 0),
        Command::Report { results, out, history, statements } => {
            let out = out.unwrap_or_else(|| results.join("report"));
            report(&results, &out, history.as_deref(), statements.as_deref())
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
        Command::Mesh { action } => match mesh::act(&action) {
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
