//! The command line. Stable: others script against it.

use std::path::PathBuf;

use cases::scene::Override;
use clap::{Args, ColorChoice, Parser, Subcommand, ValueEnum};
use geometry::files::GmshVersion;

use super::adapter::AdapterAction;
use super::ci::CiArgs;
use super::history::HistoryAction;
use super::init::InitArgs;
use super::pick::PickArgs;
use super::solve::SolveArgs;
use crate::process::LeashArgs;
use crate::study::{ExperimentArgs, MergeArgs, VerifyArgs};

/// Verification and benchmarks of soft-tissue solvers: finite elements, element-free Galerkin and interpolation on the
/// same scenes.
///
/// Exit codes: 0 all held; 1 a check failed; 2 bad usage or input; 3 could not run or did not converge; 4 nothing ran;
/// 5 incomplete.
#[derive(Parser)]
#[command(name = "tissuebench", version, max_term_width = 100)]
pub struct Cli {
    /// Threads of the solvers (default: all cores)
    #[arg(long, global = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// When words are coloured: on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_enum, default_value_t = ColorChoice::Auto)]
    pub color: ColorChoice,
    /// A folder with adapters of other solvers, before those beside the scene, in TISSUEBENCH_ADAPTERS and shipped (may be given
    /// several times)
    #[arg(long, global = true, value_name = "DIR")]
    pub adapters: Vec<PathBuf>,
    /// Use no adapter from beside the scene or from ./adapters: only from --adapters, TISSUEBENCH_ADAPTERS
    /// and the program
    #[arg(long, global = true)]
    pub no_local_adapters: bool,
    /// What to do
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Subcommand)]
pub enum Command {
    /// Write a scene of an organ under a plate, to be run as it is
    ///
    /// What no option gives is asked on a terminal; elsewhere defaults are taken, and named in the output.
    Init(InitArgs),
    /// Run one scene, with some or all of its methods
    Run(RunArgs),
    /// Find the cheapest method of a scene that is right within an error
    ///
    /// Each method runs from coarse to fine until it is within the error, or dearer than one that is. Exit code 0: found; 1: none is
    /// within the error.
    Pick(PickArgs),
    /// Run methods of a scene and write the body at every recorded state, as .vtu files and a .pvd series that ParaView opens
    Fields(FieldsArgs),
    /// Print the stages a scene needs, those it does not, and why
    Plan {
        /// The scene to plan
        #[command(flatten)]
        scene: SceneArgs,
        /// Plan what is estimated to take more than twice the memory of this machine or half a day
        #[arg(long)]
        force: bool,
    },
    /// Run a study: many scenes and methods; its checks gate the exit code
    Verify {
        /// Which runs
        #[command(flatten)]
        runs: VerifyArgs,
        /// What is printed and written beside the results
        #[command(flatten)]
        ci: CiArgs,
    },
    /// One run of a study in a process of its own
    #[command(hide = true)]
    Experiment(ExperimentArgs),
    /// Another program on a leash: with its limits, and gone with whoever called it
    #[command(hide = true)]
    Leash(LeashArgs),
    /// A problem in files solved by this program, as the adapters `tissuebench` and `dummy` call it
    #[command(hide = true)]
    Solve(SolveArgs),
    /// Join the shares of a study that were run by --shard, or by several machines, to the results of one run
    Merge(MergeArgs),
    /// Render tables, figures and the report of stored results
    Report {
        /// A folder that `verify` or `run --out` wrote
        results: PathBuf,
        /// Where to put the report (default: RESULTS/report)
        #[arg(long)]
        out: Option<PathBuf>,
        /// Also draw the errors and times over commits of this folder, which `history add` fills
        #[arg(long, value_name = "DIR")]
        history: Option<PathBuf>,
    },
    /// Compare the numbers of stored results with those accepted before, bit by bit on the same kind of processor
    Baseline(BaselineArgs),
    /// Compare two results: numbers by tolerance, times as ratios with their confidence
    Compare(CompareArgs),
    /// Errors and times of a study over commits: keep results, show what changed outside of noise
    History {
        /// What to do with the history
        #[command(subcommand)]
        action: HistoryAction,
    },
    /// Hold published claims against stored results: validated, qualified or refuted
    Claims(ClaimsArgs),
    /// Run every method of a scene and store what they agree on, as a reference for other scenes
    Reference(ReferenceArgs),
    /// Write the problem of one method as files that any solver can read
    Export(ExportArgs),
    /// Solvers outside this program: which there are, whether they are right, one call of them
    Adapter {
        /// What to do with them
        #[command(subcommand)]
        action: AdapterAction,
    },
    /// List everything that a scene can name: bodies and their surfaces, laws, tools, elements, kernels, metrics, units, ...
    List {
        /// Only this part, such as laws
        what: Option<String>,
    },
    /// Print the JSON schema of scene files, of study files, or of what is written for programs
    ///
    /// An editor completes and checks a scene with it: run `tissuebench schema > scene.schema.json`, and begin the scene
    /// with the line `#:schema scene.schema.json` (Even Better TOML, Taplo).
    Schema {
        /// The file or output
        #[arg(value_enum, default_value_t = SchemaOf::Scene, value_name = "WHAT")]
        of: SchemaOf,
        /// The same as `study`
        #[arg(long, hide = true, conflicts_with = "of")]
        study: bool,
    },
    /// Inspect and convert mesh files
    Mesh {
        /// What to do with them
        #[command(subcommand)]
        action: MeshAction,
    },
    /// Print a script that completes commands and options in a shell
    ///
    /// For bash: `tissuebench completions bash > ~/.local/share/bash-completion/completions/tissuebench`.
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Print the manual page of a command, or of all: `tissuebench man verify | man -l -`
    Man {
        /// The command
        command: Option<String>,
    },
}

/// A scene and some of its methods.
#[derive(Args, Clone)]
pub struct SceneArgs {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub file: PathBuf,
    /// Only these methods; `*` stands for any text (may be given several times)
    #[arg(long = "method", value_name = "ID")]
    pub methods: Vec<String>,
    /// Set a key of the scene in place of the file, such as material.poisson=0.45 or
    /// "method[tet4].size.level=3" (may be given several times)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<Override>,
}

/// Arguments of `fields`.
#[derive(Args)]
pub struct FieldsArgs {
    /// The scene to run
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Where to put a .pvd file and a folder for each method
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Run what is estimated to take more than twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `run`.
#[derive(Args, Clone)]
pub struct RunArgs {
    /// The scene to run
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Nothing on stderr but errors
    #[arg(short, long)]
    pub quiet: bool,
    /// Time each run once; by default runs that take less than a second are repeated, up to five times
    #[arg(long)]
    pub once: bool,
    /// Run what is estimated to take more than twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
    /// What to print on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
    /// Also write records, tables and figures to this folder, in place of the results of an earlier run of the scene
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `reference`.
#[derive(Args)]
pub struct ReferenceArgs {
    /// The scene to run; the last method's values are stored, all methods span the uncertainty
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Solve nothing: take the values of this reference of the same scene, made before
    #[arg(long, alias = "told", value_name = "FILE", conflicts_with = "methods")]
    pub from: Option<PathBuf>,
    /// A reference of the same scene by other methods, made before, that spans the uncertainty too (may be given several times)
    #[arg(long, alias = "beside", value_name = "FILE")]
    pub alongside: Vec<PathBuf>,
    /// Store the displacement at the end at the nodes of this mesh file
    #[arg(long, value_name = "MESH")]
    pub points: PathBuf,
    /// Length unit of that file
    #[arg(long, default_value = "mm", value_parser = length_unit)]
    pub unit: LengthUnit,
    /// The file to write (JSON)
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// Arguments of `claims`.
#[derive(Args)]
pub struct ClaimsArgs {
    /// A folder that `verify` or `run --out` wrote
    pub results: PathBuf,
    /// The claims
    #[arg(long, value_name = "FILE", default_value = "cases/claims.toml")]
    pub file: PathBuf,
}

/// Arguments of `export`.
#[derive(Args)]
pub struct ExportArgs {
    /// The scene file
    pub scene: PathBuf,
    /// The method: one of finite elements, or of another solver
    #[arg(long, value_name = "ID")]
    pub method: String,
    /// Set a key of the scene in place of the file, such as material.poisson=0.45 (may be given several
    /// times)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<Override>,
    /// The folder to write
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `baseline`.
#[derive(Args)]
pub struct BaselineArgs {
    /// A folder that `verify` or `run --out` wrote
    pub results: PathBuf,
    /// The accepted numbers
    #[arg(long, value_name = "FILE", default_value = "tests/baseline/quick.toml")]
    pub file: PathBuf,
    /// Accept the differences whose text contains this, or all; without it a terminal asks for each
    #[arg(long, value_name = "TEXT", num_args = 0..=1, default_missing_value = "")]
    pub accept: Option<String>,
    /// Ask nothing: print the differences and exit with 1 if there are any
    #[arg(long, conflicts_with = "accept")]
    pub check: bool,
    /// The results are a part of the study: runs that are not in them are not missing
    #[arg(long)]
    pub part: bool,
}

/// Arguments of `compare`.
#[derive(Args)]
pub struct CompareArgs {
    /// Folders that `verify` or `run --out` wrote: before and after; or several such pairs in turn, which tell a slower program from
    /// a slower machine
    #[arg(required = true, num_args = 2.., value_names = ["BEFORE", "AFTER"])]
    pub results: Vec<PathBuf>,
    /// Relative difference from which on a number has changed
    #[arg(long, value_name = "NUMBER", default_value_t = 1e-6)]
    pub tolerance: f64,
    /// Pair runs that differ in this setting too, such as dilation, kernel, size, method or case (may be
    /// given several times)
    #[arg(long, value_name = "SETTING")]
    pub across: Vec<String>,
    /// Leave times out
    #[arg(long)]
    pub no_times: bool,
    /// What to print on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
}

/// Inputs and outputs that have a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaOf {
    /// A scene file
    Scene,
    /// A study file
    Study,
    /// A line of `run --format json`
    Run,
    /// A line of `verify --events`
    Events,
    /// checks.json; a row of checks.csv has the same columns
    Checks,
    /// provenance.json, with the version of all files beside it
    Provenance,
}

/// What `run` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table for people
    Table,
    /// JSON: one object per run, one per line, or one object of all that is compared
    Json,
}

/// What to do with mesh files.
#[derive(Subcommand)]
pub enum MeshAction {
    /// Print counts, regions, surfaces, extent, unit, volume, and the quality of the cells with the worst of them
    Info {
        /// Mesh files: Gmsh (.msh), Abaqus or CalculiX (.inp), VTK (.vtu, .vtk); or surfaces: STL, OBJ, PLY
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Length unit of the coordinates
        #[arg(long, default_value = "mm", value_parser = length_unit)]
        unit: LengthUnit,
        /// What to print on stdout: a table, or a JSON object in a line for each file (SI units)
        #[arg(long, value_enum, default_value_t = Format::Table)]
        format: Format,
    },
    /// Fill a closed surface with tetrahedra
    ///
    /// By isosurface stuffing (Labelle and Shewchuk 2007): angles between the faces of a cell are between 10.7 and 164.8 degrees. Sharp edges
    /// are rounded off at the size of a cell. A surface that is open, crosses itself or is inside out is refused with the place.
    Make(MakeArgs),
    /// Read one mesh file, write it as another kind of cells
    Convert(ConvertArgs),
}

/// Arguments of `mesh convert`.
#[derive(Args)]
pub struct ConvertArgs {
    /// The file to read: Gmsh 1, 2.2, 4.0 or 4.1 (.msh), Abaqus or CalculiX (.inp), VTK (.vtu, .vtk)
    pub from: PathBuf,
    /// The file to write, by its suffix Gmsh (.msh), Abaqus (.inp), VTK (.vtu) or the boundary alone as
    /// .stl; another one than FROM
    pub to: PathBuf,
    /// Cells to write: tet4, tet10, hex8 or hex20; by default those of the file
    #[arg(long)]
    pub element: Option<String>,
    /// Leave nodes out that no element and no set names, which are refused otherwise
    #[arg(long)]
    pub drop_unused: bool,
    /// Join pieces whose faces coincide but share no nodes
    #[arg(long)]
    pub join: bool,
    /// Turn all cells, whose corners stand in the mirrored order
    #[arg(long)]
    pub turn: bool,
    /// Version of Gmsh's format for a .msh file: 2.2 (the default, which most programs read) or 4.1
    #[arg(long, value_name = "2.2|4.1", value_parser = gmsh_version)]
    pub version: Option<GmshVersion>,
}

/// Arguments of `mesh make`.
#[derive(Args)]
pub struct MakeArgs {
    /// A closed surface: STL, OBJ or PLY
    pub surface: PathBuf,
    /// Mean length of the edges at the surface, such as "3 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length, required_unless_present = "nodes")]
    pub size: Option<f64>,
    /// About how many nodes to make, in place of --size
    #[arg(long, value_name = "N", conflicts_with = "size", value_parser = clap::value_parser!(u32).range(8..=3_000_000))]
    pub nodes: Option<u32>,
    /// Length unit of the surface, and of the mesh that is written
    #[arg(long, default_value = "mm", value_parser = length_unit)]
    pub unit: LengthUnit,
    /// How often the size of the cells may double inside, away from the surface
    #[arg(long, value_name = "TIMES", default_value_t = 2, value_parser = clap::value_parser!(u32).range(0..=3))]
    pub coarser: u32,
    /// Cells of one size: --coarser 0
    #[arg(long, conflicts_with = "coarser")]
    pub uniform: bool,
    /// The mesh to write: .msh, .inp or .vtu
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// A length with its unit, m.
pub(super) fn length(text: &str) -> Result<f64, String> {
    let metres = catalogue::Dimension::Length.read(text).map_err(|bad| bad.to_string())?;
    if metres > 0.0 { Ok(metres) } else { Err("a length above zero".into()) }
}

fn gmsh_version(text: &str) -> Result<GmshVersion, String> {
    match text {
        "2.2" => Ok(GmshVersion::Two),
        "4.1" => Ok(GmshVersion::FourOne),
        _ => Err("versions 2.2 and 4.1 are written".into()),
    }
}

/// A unit of the coordinates in a file.
#[derive(Clone, Copy, Debug)]
pub struct LengthUnit {
    /// As files and messages have it.
    pub name: &'static str,
    /// Its length in metres.
    pub metres: f64,
}

pub(super) fn length_unit(text: &str) -> Result<LengthUnit, String> {
    let known = [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6)];
    let found = known.into_iter().find(|(name, _)| *name == text);
    let (name, metres) = found.ok_or("a length unit: m, cm, mm or um")?;
    Ok(LengthUnit { name, metres })
}
