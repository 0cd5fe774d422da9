//! The command line. Stable: users' scripts depend on it.

use std::path::PathBuf;

use clap::{ColorChoice, Parser, Subcommand};

use super::adapter::AdapterAction;
use super::args::{
    BaselineArgs, ClaimsArgs, CompareArgs, ExportArgs, FieldsArgs, ImportArgs, MeshAction, ReferenceArgs,
    RunArgs, SceneArgs, SchemaOf,
};
use super::bound::BoundArgs;
use super::ci::CiArgs;
use super::fit::FitArgs;
use super::history::HistoryAction;
use super::init::InitArgs;
use super::paced::LoopArgs;
use super::pick::PickArgs;
use super::solve::SolveArgs;
use super::vary::VaryArgs;
use crate::process::leash::LeashArgs;
use crate::study::VerifyArgs;
use crate::study::isolated::ExperimentArgs;
use crate::study::jobs::status::StatusArgs;
use crate::study::jobs::worker::JobArgs;
use crate::study::merge::MergeArgs;
use crate::study::reproduce::ReproduceArgs;

/// Verification and benchmarks of soft-tissue solvers: finite elements, element-free Galerkin and
/// interpolation on the same scenes.
///
/// Exit codes: 0 success; 1 a check failed; 2 invalid usage or input; 3 could not run or did not converge; 4
/// nothing ran; 5 incomplete.
#[derive(Parser)]
#[command(name = "tissuebench", version, max_term_width = 100)]
pub struct Cli {
    /// Number of threads of the solvers (default: all cores)
    #[arg(long, global = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// When to colour the output; auto: on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_enum, default_value_t = ColorChoice::Auto)]
    pub color: ColorChoice,
    /// Folder with adapters of other solvers; searched before those next to the scene, in
    /// TISSUEBENCH_ADAPTERS and shipped (repeatable)
    #[arg(long, global = true, value_name = "DIR")]
    pub adapters: Vec<PathBuf>,
    /// Ignore adapters next to the scene and in ./adapters; use only --adapters, TISSUEBENCH_ADAPTERS and
    /// shipped adapters
    #[arg(long, global = true)]
    pub no_local_adapters: bool,
    /// The subcommand
    #[command(subcommand)]
    pub command: Command,
}

/// Subcommands of `tissuebench`.
#[derive(Subcommand)]
pub enum Command {
    /// Write a scene of an organ under a plate, ready to run
    ///
    /// On a terminal, values not given as options are asked for. Otherwise defaults are used and named in the
    /// output.
    Init(InitArgs),
    /// Write a scene of a model of FEBio (.feb) or CalculiX (.inp), and list what it leaves out
    ///
    /// The scene refers to the model as its mesh file. A part of the model that changes the answer and that no
    /// scene can express is refused with its line; all other parts that are not in the scene are listed.
    Import(ImportArgs),
    /// Run one scene with some or all of its methods; a model of another program is imported first
    Run(RunArgs),
    /// Find the cheapest method of a scene within an error bound
    ///
    /// Each method runs from coarse to fine until it meets the bound, or costs more than another method that
    /// does. Exit code 0: found; 1: no method meets the bound.
    Pick(PickArgs),
    /// Enclose the strain energy of a linear scene, and the force of its moving support, between strict
    /// bounds
    ///
    /// The exact values lie between the bounds. All methods run, and those whose values lie outside are
    /// wrong. Exit code 0: done; 1: the reference of the scene lies outside; 2: the scene has no bounds, with
    /// the reason.
    Bound(BoundArgs),
    /// Play a scene in real time with each method, and print how many frames miss their deadline and how far off
    /// they are
    ///
    /// The scene has `[loop]` with the rates of its frames. The scene is solved as written first. Exit code 0:
    /// done, whether or not frames are in time; 3: a method could not run.
    Loop(LoopArgs),
    /// Run methods of a scene and write every recorded state of the body, as .vtu files and a .pvd series for
    /// ParaView
    Fields(FieldsArgs),
    /// Print the stages that a scene needs and does not need, and why
    Plan {
        /// The scene to plan
        #[command(flatten)]
        scene: SceneArgs,
        /// Plan even if the estimate exceeds twice the memory of this machine or half a day
        #[arg(long)]
        force: bool,
    },
    /// Run a study of many scenes and methods; its checks determine the exit code
    Verify {
        /// Selection of runs
        #[command(flatten)]
        runs: VerifyArgs,
        /// Output on the terminal and files for continuous integration
        #[command(flatten)]
        ci: CiArgs,
    },
    /// Run the samples of a scene's uncertain inputs, and print the mean, the quantiles and the share of each
    /// input
    ///
    /// The scene has `[vary]` with the number of samples, the metrics and the distributions of its keys. The
    /// scene as written runs first.
    Vary(VaryArgs),
    /// Fit constants of a scene to a measured curve, and print them with their confidence
    ///
    /// The scene has `[fit]` with the file of the curve and the keys of the constants, whose values in the
    /// scene are the start. The scene as written runs first.
    Fit(FitArgs),
    /// Execute one run of a study in its own process
    #[command(hide = true)]
    Experiment(ExperimentArgs),
    /// Execute the runs of one job of a study
    #[command(hide = true)]
    Job(JobArgs),
    /// Run another program with limits, and end it when its caller ends
    #[command(hide = true)]
    Leash(LeashArgs),
    /// Solve a problem in files with this program, for the adapter `tissuebench`
    #[command(hide = true)]
    Solve(SolveArgs),
    /// Merge parts of a study, run with --shard or on several machines, into the results of one run
    Merge(MergeArgs),
    /// Print how many runs of a study are done, running and failed, and the time left
    ///
    /// The folder may be in use. Exit code 0: all runs have results; 5: some have not.
    Status(StatusArgs),
    /// Make stored runs of a study again, and compare their numbers with the stored ones
    ///
    /// Each run is one that `verify` has stored in the folder. Exit code 0: all numbers are the stored ones,
    /// bit by bit on the same kind of processor; 1: some differ.
    Reproduce(ReproduceArgs),
    /// Render tables, figures and the report of stored results, and the evidence of credibility by the
    /// factors of ASME V&V 40
    Report {
        /// Folder written by `verify` or `run --out`
        results: PathBuf,
        /// Folder for the report (default: RESULTS/report)
        #[arg(long)]
        out: Option<PathBuf>,
        /// Also plot errors and times over the commits in this folder, filled by `history add`
        #[arg(long, value_name = "DIR")]
        history: Option<PathBuf>,
        /// Your statements about the factors of ASME V&V 40, as TOML lines such as `context_of_use = "..."`.
        /// They fill blanks of credibility.html
        #[arg(long, value_name = "FILE")]
        statements: Option<PathBuf>,
    },
    /// Compare stored results with accepted ones: bit by bit on the same kind of processor, otherwise with a
    /// tolerance
    Baseline(BaselineArgs),
    /// Compare two results: numbers by tolerance, times as ratios with confidence intervals
    Compare(CompareArgs),
    /// Track errors and times of a study over commits: store results, show changes beyond noise
    History {
        /// Action on the history
        #[command(subcommand)]
        action: HistoryAction,
    },
    /// Compare published claims with stored results: validated, qualified or refuted
    Claims(ClaimsArgs),
    /// Run all methods of a scene and store their common result as a reference for other scenes
    Reference(ReferenceArgs),
    /// Write the problem of one method as files that any solver can read
    Export(ExportArgs),
    /// Manage adapters of external solvers: list, check, call once, install, copy
    Adapter {
        /// Action on adapters
        #[command(subcommand)]
        action: AdapterAction,
    },
    /// List everything that a scene can name: bodies and their surfaces, laws, tools, elements, kernels,
    /// metrics, units, ...
    List {
        /// Only this part, such as laws
        what: Option<String>,
    },
    /// Print the JSON schema of scene files, study files or machine-readable output
    ///
    /// Editors use the schema to complete and check scenes: run `tissuebench schema > scene.schema.json`, and
    /// begin the scene with the line `#:schema scene.schema.json` (Even Better TOML, Taplo).
    Schema {
        /// File or output to describe
        #[arg(value_enum, default_value_t = SchemaOf::Scene, value_name = "WHAT")]
        of: SchemaOf,
        /// Same as `study`
        #[arg(long, hide = true, conflicts_with = "of")]
        study: bool,
    },
    /// Inspect and convert mesh files
    Mesh {
        /// Action on mesh files
        #[command(subcommand)]
        action: MeshAction,
    },
    /// Print a shell script that completes commands and options
    ///
    /// For bash: `tissuebench completions bash > ~/.local/share/bash-completion/completions/tissuebench`.
    Completions {
        /// Shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page of one command or of all: `tissuebench man verify | man -l -`
    Man {
        /// Command
        command: Option<String>,
    },
}
