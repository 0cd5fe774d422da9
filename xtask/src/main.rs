//! Project tasks, deliberately thin: each parses its arguments and calls cargo or the `tissuebench` binary.
//!
//! Exit codes: those of `tissuebench` (0 all held, 1 a check failed, 2 bad usage, 3 could not run).

mod cargo;
mod gallery;
mod instructions;
mod mutants;
mod nightly;
mod python;
mod release;
mod skips;
mod suites;

use std::path::Path;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};
use clap::{Parser, Subcommand};

use crate::cargo::{cargo, cargo_command, code_of, root, tissuebench};

#[derive(Parser)]
#[command(name = "cargo xtask", about = "Tasks of the tissuebench workspace")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Build, run the quick tier of the verification study, write tables, figures and the report to results/
    Verify {
        /// Run the whole study instead of the quick tier: up to an hour
        #[arg(long)]
        full: bool,
        /// Further arguments of `tissuebench verify` (STUDY, --filter TEXT, --resume, ...)
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Run the quick part of the stress study, which drives every method to its limits; results go to
    /// results-stress/
    Stress {
        /// Run the whole study: about 5 minutes
        #[arg(long)]
        full: bool,
    },
    /// Run the quick tier and the quick part of the stress study and compare the results with those accepted
    /// in tests/baseline
    Baseline {
        /// Further arguments of `tissuebench baseline` (--accept TEXT, --check)
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Run the criterion benches, one per stage
    Bench {
        /// Further arguments of `cargo bench`
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Count the instructions of each kernel, if valgrind is installed; fails if a count is more than 2 %
    /// above the accepted count
    Instructions {
        /// Accept the counts
        #[arg(long)]
        accept: bool,
    },
    /// Run a small study repeatedly and count the errors of `tissuebench compare`: about a minute for every
    /// three runs
    Noise {
        /// Number of runs
        #[arg(long, default_value_t = 20)]
        runs: u16,
    },
    /// Render tables, figures and the report from results/ again, without executing runs
    Report,
    /// Verify and stress in full, then refresh the figures and tables kept in reports/gallery for the book
    Gallery,
    /// Regenerate the reference pages of the book, and build the book if mdbook is installed
    Book,
    /// Switch on the faults of tests/mutants.toml one at a time: a test must find each fault
    Mutants {
        /// Names of the faults to switch on (default: all)
        names: Vec<String>,
    },
    /// Run the checks that take hours: every fault of `mutants`, a hundred killed processes of a study, a
    /// build of every package, `cargo deny check`, and minutes of each fuzz target; if cargo-deny, cargo-fuzz
    /// and a nightly compiler are installed
    Nightly {
        /// Minutes for each fuzz target
        #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=1440))]
        minutes: u32,
    },
    /// Build the wheel of the Python module and test it in a fresh virtual environment, if maturin, numpy and
    /// pytest are installed
    Python,
    /// Import and run the models of other programs' test suites, and compare the results with those stored there
    Suites(suites::SuitesArgs),
    /// Do everything of a release that can be done without publishing: compare versions, build each crate
    /// from its package, build the wheel and test it in a fresh environment, run the README, and build the
    /// container; if the tools are installed. 30 minutes on two cores
    Release {
        /// Publish nothing. Only the workflow of a tag publishes
        #[arg(long, required = true)]
        check: bool,
    },
    /// Run the steps of continuous integration: format, lints, packages, docs, tests, quick verification
    Ci,
}

fn main() -> ExitCode {
    match run(Cli::parse().task) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::from(3)
        }
    }
}

fn run(task: Task) -> Result<u8> {
    match task {
        Task::Verify { full, args } => verify(full, &args),
        Task::Baseline { args } => {
            // The results of checks are irrelevant here.
            tissuebench("verify", &["--quick".into()])?;
            stress(false)?;
            let code = tissuebench("baseline", &[&["results".into()], &args[..]].concat())?;
            Ok(code.max(compare_stress(&args)?))
        }
        Task::Stress { full } => stress(full),
        Task::Bench { args } => cargo(&["bench", "--workspace"], &args),
        Task::Instructions { accept } => instructions::instructions(&root(), accept),
        Task::Noise { runs } => noise(runs),
        Task::Report => tissuebench("report", &["results".into()]),
        Task::Gallery => {
            let code = verify(true, &[])?.max(stress(true)?);
            if code == 0 { gallery::keep(&root()).map(|()| 0) } else { Ok(code) }
        }
        Task::Book => book(),
        Task::Mutants { names } => mutants::mutants(&root(), &names),
        Task::Nightly { minutes } => nightly::nightly(&root(), minutes),
        Task::Python => python::python(&root()),
        Task::Suites(args) => suites::suites(&root(), &args),
        Task::Release { check: _ } => release::check(&root()),
        Task::Ci => ci(),
    }
}

/// Runs all steps in order and stops at the first failure.
fn ci() -> Result<u8> {
    let steps: [&[&str]; 5] = [
        &["fmt", "--all", "--check"],
        &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"],
        // Without --quiet, this step warns of every test that the packages leave out. After clippy, the index
        // is on disk.
        &["package", "--workspace", "--no-verify", "--allow-dirty", "--offline", "--quiet"],
        &["doc", "--workspace", "--no-deps", "--locked"],
        &["test", "--workspace", "--locked"],
    ];
    for step in steps {
        eprintln!("xtask: cargo {}", step.join(" "));
        let code = cargo(step, &[])?;
        if code != 0 {
            return Ok(code);
        }
    }
    let code = verify(false, &[])?;
    if code != 0 {
        return Ok(code);
    }
    let code = page(&root().join("results/report/report.html"))?;
    if code != 0 {
        return Ok(code);
    }
    let code = tissuebench("baseline", &["results".into(), "--check".into()])?;
    if code != 0 {
        return Ok(code);
    }
    let code = stress(false)?;
    if code != 0 {
        return Ok(code);
    }
    let code = compare_stress(&["--check".into()])?;
    if code != 0 {
        return Ok(code);
    }
    let code = instructions::instructions(&root(), false)?;
    if code != 0 { Ok(code) } else { python::python(&root()) }
}

/// Tests the verification's page in a browser, if node and Chromium are installed, and builds its script
/// again, if `npm ci` was run.
fn page(report: &Path) -> Result<u8> {
    let folder = root().join("reports/page");
    if Command::new("node").arg("--version").output().is_err() {
        let why = "node is not installed, so the page is not tested in a browser";
        return skips::skipped(&root(), "node", why);
    }
    let node = |args: &[&std::ffi::OsStr]| -> Result<u8> {
        let done = Command::new("node").args(args).current_dir(&folder).status();
        Ok(code_of(done.context("could not start node")?))
    };
    if folder.join("node_modules").is_dir() {
        let code = node(&["build.mjs".as_ref(), "--check".as_ref()])?;
        if code != 0 {
            return Ok(code);
        }
    } else {
        let why = "reports/page/node_modules is missing, so the script of the page is not rebuilt (run `npm ci` in reports/page)";
        let code = skips::skipped(&root(), "node_modules", why)?;
        if code != 0 {
            return Ok(code);
        }
    }
    node(&["test/page.mjs".as_ref(), report.as_os_str()])
}

/// Runs the stress study, which fails if a method is wrong without a warning. Only its numbers matter, not
/// its times, so there are as many simultaneous runs as processors.
fn stress(full: bool) -> Result<u8> {
    let jobs = std::thread::available_parallelism().map_or(1, |count| count.get()).to_string();
    let mut args =
        ["cases/studies/stress.toml", "--out", "results-stress", "--jobs", &jobs].map(String::from).to_vec();
    args.extend((!full).then(|| "--quick".to_string()));
    tissuebench("verify", &args)
}

/// Runs the noise study. It is no test, because its numbers are those of a machine, neither right nor wrong.
/// The runs call the program directly, because `cargo run` between them would contribute to the noise.
fn noise(runs: u16) -> Result<u8> {
    let build = ["build", "--release", "--locked", "--package", "tissuebench-harness"];
    let code = cargo(&build, &[])?;
    if code != 0 {
        return Ok(code);
    }
    let folders: Vec<String> = (1..=runs).map(|run| format!("target/noise/{run}")).collect();
    for folder in &folders {
        let mut program = Command::new(root().join("target/release/tissuebench"));
        program.args(["verify", "cases/studies/noise.toml", "--quiet", "--out", folder]).current_dir(root());
        let code = code_of(program.status().context("could not start target/release/tissuebench")?);
        if code != 0 {
            return Ok(code);
        }
    }
    let count =
        ["run", "--release", "--quiet", "--package", "tissuebench-reports", "--example", "noise", "--"];
    cargo(&count, &folders)
}

fn compare_stress(args: &[String]) -> Result<u8> {
    let own = ["results-stress", "--accepted", "tests/baseline/stress"].map(String::from);
    tissuebench("baseline", &[&own, args].concat())
}

/// Runs the quick tier, unless all runs are requested; a user's own study has no quick tier.
fn verify(full: bool, args: &[String]) -> Result<u8> {
    let quick = "--quick".to_string();
    let whole = full || args.contains(&quick) || args.iter().any(|a| a.ends_with(".toml"));
    if full {
        eprintln!("xtask: all runs of the study, up to an hour after the build");
    } else if !whole || args.contains(&quick) {
        eprintln!("xtask: the quick tier of the study, about 7 minutes after the build");
    }
    let args = if whole { args.to_vec() } else { [&[quick], args].concat() };
    tissuebench("verify", &args)
}

/// Writes the pages that the program generates about itself, then docs/book.
fn book() -> Result<u8> {
    let pages = ["test", "--locked", "--package", "tissuebench-harness", "--test", "docs", "reference"];
    let status = cargo_command(&pages, &[]).env("TISSUEBENCH_BOOK", "write").status();
    let code = code_of(status.context("could not start cargo test")?);
    if code != 0 {
        return Ok(code);
    }
    match Command::new("mdbook").arg("build").arg(root().join("docs")).status() {
        Ok(status) => Ok(code_of(status)),
        Err(_) => {
            eprintln!(
                "xtask: docs/src/reference is up to date; `cargo install mdbook` to build the book itself"
            );
            Ok(0)
        }
    }
}
