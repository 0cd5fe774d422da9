//! Project tasks, thin by intent: each parses its arguments and shells out to cargo or to the `tissuebench` binary.
//!
//! Exit codes: those of `tissuebench` (0 all held, 1 a check failed, 2 bad usage, 3 could not run).

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};
use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(name = "cargo xtask", about = "Tasks of the tissuebench workspace")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Build, run the verification study, write tables, figures and the report to results/
    Verify {
        /// Further arguments of `tissuebench verify` (--quick, --filter TEXT, --resume, ...)
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Run the criterion benches, one per stage
    Bench {
        /// Further arguments of `cargo bench`
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        args: Vec<String>,
    },
    /// Render tables, figures and the report again from results/, without running anything
    Report,
    /// Verify in full, then refresh the figures and tables kept in reports/gallery for the README
    Gallery,
    /// What continuous integration runs: format, lints, docs, tests, quick verification
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
        Task::Verify { args } => tissuebench("verify", &args),
        Task::Bench { args } => cargo(&["bench", "--workspace"], &args),
        Task::Report => tissuebench("report", &["results".into()]),
        Task::Gallery => {
            let code = tissuebench("verify", &[])?;
            if code == 0 { keep_gallery().map(|()| 0) } else { Ok(code) }
        }
        Task::Ci => ci(),
    }
}

/// Every step in order, stopping at the first that fails.
fn ci() -> Result<u8> {
    let steps: [&[&str]; 4] = [
        &["fmt", "--all", "--check"],
        &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"],
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
    tissuebench("verify", &["--quick".into()])
}

/// Runs the release binary, building it first if needed.
fn tissuebench(command: &str, args: &[String]) -> Result<u8> {
    let mut line =
        vec!["run", "--release", "--locked", "--quiet", "--package", "tissuebench-harness", "--", command];
    line.extend(args.iter().map(String::as_str));
    eprintln!("xtask: building the release binary (minutes the first time), then: tissuebench {command}");
    cargo(&line, &[])
}

fn cargo(args: &[&str], more: &[String]) -> Result<u8> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(args)
        .args(more)
        .env("RUSTDOCFLAGS", "-D warnings")
        .env("CARGO_INCREMENTAL", "0")
        .current_dir(root())
        .status()
        .with_context(|| format!("could not start cargo {}", args.join(" ")))?;
    Ok(status.code().map_or(3, |code| code as u8))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the workspace").to_path_buf()
}

/// Copies the figures and tables that the README shows from the last results.
fn keep_gallery() -> Result<()> {
    let (from, to) = (root().join("results/report"), root().join("reports/gallery"));
    std::fs::create_dir_all(&to)?;
    for old in std::fs::read_dir(&to)? {
        std::fs::remove_file(old?.path())?;
    }
    for folder in ["figures", "tables"] {
        for entry in
            std::fs::read_dir(from.join(folder)).with_context(|| format!("no {folder} in results"))?
        {
            let path = entry?.path();
            if path.extension().is_some_and(|e| e == "svg" || e == "md") {
                std::fs::copy(&path, to.join(path.file_name().expect("a file")))?;
            }
        }
    }
    Ok(())
}
