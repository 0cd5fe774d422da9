//! Arguments of the commands. Stable: users' scripts depend on them.

use std::path::PathBuf;

use cases::scene::Override;
use clap::{Args, Subcommand, ValueEnum};
use mesh_files::GmshVersion;

/// A scene and some of its methods.
#[derive(Args, Clone)]
pub struct SceneArgs {
    /// Scene file
    #[arg(value_name = "SCENE")]
    pub file: PathBuf,
    /// Run only these methods; `*` matches any text (repeatable)
    #[arg(long = "method", value_name = "ID")]
    pub methods: Vec<String>,
    /// Override a key of the scene, such as material.poisson=0.45 or "method[tet4].size.level=3" (repeatable)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<Override>,
}

/// Arguments of `fields`.
#[derive(Args)]
pub struct FieldsArgs {
    /// The scene to run
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Folder for a .pvd file and a folder per method
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Model or mesh file whose numbers of nodes and elements the results get: in tables METHOD-nodes.csv and
    /// METHOD-elements.csv of the end, and as arrays of the .vtu files
    #[arg(long, value_name = "MODEL")]
    pub like: Option<PathBuf>,
    /// Run even if the estimate exceeds twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `import`.
#[derive(Args)]
pub struct ImportArgs {
    /// Model of FEBio (.feb, specification 4.0 or 3.0) or deck of CalculiX (.inp)
    pub model: PathBuf,
    /// Scene to write; only the parts left out are printed unless given
    #[arg(long, value_name = "SCENE")]
    pub out: Option<PathBuf>,
    /// Unit of the model's lengths, which determines its other units: m, N, s, kg, Pa or mm, N, s, t, MPa
    #[arg(long, value_enum, default_value_t = ModelUnit::M)]
    pub unit: ModelUnit,
    /// Step of a deck to import; the last unless given
    #[arg(long, value_name = "NUMBER")]
    pub step: Option<usize>,
}

/// Consistent sets of units, by their lengths.
#[derive(Clone, Copy, ValueEnum)]
pub enum ModelUnit {
    /// m, N, s, kg, Pa
    M,
    /// mm, N, s, t, MPa
    Mm,
}

/// Arguments of `run`.
#[derive(Args, Clone)]
pub struct RunArgs {
    /// The scene to run
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Print only errors on stderr
    #[arg(short, long)]
    pub quiet: bool,
    /// Time each run once; by default runs shorter than a second are repeated, up to five times
    #[arg(long)]
    pub once: bool,
    /// Run even if the estimate exceeds twice the memory of this machine or half a day
    #[arg(long)]
    pub force: bool,
    /// Output format on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
    /// Also write records, tables and figures to this folder, replacing the results of an earlier run of the
    /// scene
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `reference`.
#[derive(Args)]
pub struct ReferenceArgs {
    /// Scene to run; stores the values of the last method, with the spread of all methods as uncertainty
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Solve nothing: take the values of this earlier reference of the same scene
    #[arg(long, alias = "told", value_name = "FILE", conflicts_with = "methods")]
    pub from: Option<PathBuf>,
    /// Earlier reference of the same scene by other methods, included in the uncertainty (repeatable)
    #[arg(long, alias = "beside", value_name = "FILE")]
    pub alongside: Vec<PathBuf>,
    /// Store the final displacement at the nodes of this mesh file
    #[arg(long, value_name = "MESH")]
    pub points: PathBuf,
    /// Length unit of the mesh file
    #[arg(long, default_value = "mm", value_parser = length_unit)]
    pub unit: LengthUnit,
    /// File to write (JSON)
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// Arguments of `claims`.
#[derive(Args)]
pub struct ClaimsArgs {
    /// Folder written by `verify` or `run --out`
    pub results: PathBuf,
    /// Claims file (default: the claims of the program)
    #[arg(long, value_name = "FILE")]
    pub file: Option<PathBuf>,
}

/// Arguments of `export`.
#[derive(Args)]
pub struct ExportArgs {
    /// Scene file
    pub scene: PathBuf,
    /// Method: finite elements or an external solver
    #[arg(long, value_name = "ID")]
    pub method: String,
    /// Override a key of the scene, such as material.poisson=0.45 (repeatable)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<Override>,
    /// Folder to write
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `baseline`.
#[derive(Args)]
pub struct BaselineArgs {
    /// Folder written by `verify` or `run --out`
    pub results: PathBuf,
    /// Folder of accepted results, with a file for each case
    #[arg(long, value_name = "DIR", default_value = "tests/baseline/quick")]
    pub accepted: PathBuf,
    /// Accept differences whose text contains TEXT, or all differences; by default a terminal asks for each
    #[arg(long, value_name = "TEXT", num_args = 0..=1, default_missing_value = "")]
    pub accept: Option<String>,
    /// Never ask: print the differences, with exit code 1 if there are any
    #[arg(long, conflicts_with = "accept")]
    pub check: bool,
    /// The results are only a part of the study: do not report other runs as missing
    #[arg(long)]
    pub part: bool,
}

/// Arguments of `compare`.
#[derive(Args)]
pub struct CompareArgs {
    /// Folders written by `verify` or `run --out`: before and after. Several such pairs in turn separate a
    /// slower program from a slower machine
    #[arg(required = true, num_args = 2.., value_names = ["BEFORE", "AFTER"])]
    pub results: Vec<PathBuf>,
    /// Relative difference above which a number counts as changed
    #[arg(long, value_name = "NUMBER", default_value_t = 1e-6)]
    pub tolerance: f64,
    /// Also pair runs that differ in this setting, such as dilation, kernel, size, method or case
    /// (repeatable)
    #[arg(long, value_name = "SETTING")]
    pub across: Vec<String>,
    /// Leave out times
    #[arg(long)]
    pub no_times: bool,
    /// Output format on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub format: Format,
}

/// Files and outputs with a schema.
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
    /// provenance.json, with the version of all files next to it
    Provenance,
}

/// Output format on stdout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table for reading
    Table,
    /// JSON: one object per run and line, or one object for a comparison
    Json,
}

/// Actions on mesh files.
#[derive(Subcommand)]
pub enum MeshAction {
    /// Print counts, regions, surfaces, extent, unit, volume and cell quality, with the worst cells
    Info {
        /// Mesh files: Gmsh (.msh), Abaqus or CalculiX (.inp), VTK (.vtu, .vtk); or surfaces: STL, OBJ, PLY,
        /// OFF, .vtp, .mesh
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Length unit of the coordinates
        #[arg(long, default_value = "mm", value_parser = length_unit)]
        unit: LengthUnit,
        /// Output format on stdout: a table, or one JSON object per line and file (SI units)
        #[arg(long, value_enum, default_value_t = Format::Table)]
        format: Format,
    },
    /// Fill a closed surface with tetrahedra
    ///
    /// Isosurface stuffing (Labelle and Shewchuk 2007): dihedral angles lie between 10.7 and 164.8 degrees.
    /// Sharp edges are rounded at the scale of a cell. A surface that is open, intersects itself or is inside
    /// out is refused, with the location of the fault, unless --repair mends it or --wrap encloses it.
    Make(MakeArgs),
    /// Read a mesh file and write it with another kind of cells or in another format
    Convert(ConvertArgs),
}

/// Arguments of `mesh convert`.
#[derive(Args)]
pub struct ConvertArgs {
    /// File to read: Gmsh 1, 2.2, 4.0 or 4.1 (.msh), Abaqus or CalculiX (.inp), VTK (.vtu, .vtk)
    pub from: PathBuf,
    /// File to write, other than FROM. The suffix selects the format: Gmsh (.msh), Abaqus (.inp), VTK (.vtu),
    /// or the boundary alone (.stl)
    pub to: PathBuf,
    /// Kind of cells to write: tet4, tet10, hex8, hex20, wedge6 or wedge15 (default: that of the file)
    #[arg(long)]
    pub element: Option<String>,
    /// Drop nodes that belong to no element and no set; by default such a mesh is refused
    #[arg(long)]
    pub drop_unused: bool,
    /// Join pieces with coincident faces that share no nodes
    #[arg(long)]
    pub join: bool,
    /// Reverse the node order of all cells, for a file in mirrored order
    #[arg(long)]
    pub turn: bool,
    /// Gmsh format version of a .msh file: 2.2 (default, read by most programs) or 4.1
    #[arg(long, value_name = "2.2|4.1", value_parser = gmsh_version)]
    pub version: Option<GmshVersion>,
}

/// Arguments of `mesh make`.
#[derive(Args)]
pub struct MakeArgs {
    /// Surface: STL, OBJ, PLY, OFF, VTK .vtp or Medit .mesh. Several files, and several closed parts of a file, nest
    /// or touch and become regions, such as a tumour in an organ
    #[arg(required = true, num_args = 1.., value_name = "SURFACE")]
    pub surface: Vec<PathBuf>,
    /// Mend small faults: doubled corners and triangles, T-junctions, reversed triangles, and holes of up to
    /// a tenth of the surface's diagonal. Every change is listed
    #[arg(long)]
    pub repair: bool,
    /// Wrap a surface that is open, crosses itself, branches or is partly reversed: a closed surface around
    /// everything that it surrounds, of cells with edges of this length
    #[arg(long, value_name = "LENGTH", value_parser = length, conflicts_with = "repair")]
    pub wrap: Option<f64>,
    /// List the changes of --repair and --wrap without their places
    #[arg(short, long)]
    pub quiet: bool,
    /// Mean edge length at the surface, such as "3 mm"
    #[arg(long, value_name = "LENGTH", value_parser = length, required_unless_present = "nodes")]
    pub size: Option<f64>,
    /// Approximate number of nodes, instead of --size
    #[arg(long, value_name = "N", conflicts_with = "size", value_parser = clap::value_parser!(u32).range(8..=3_000_000))]
    pub nodes: Option<u32>,
    /// Length unit of the surface and of the written mesh
    #[arg(long, default_value = "mm", value_parser = length_unit)]
    pub unit: LengthUnit,
    /// Number of times that the cell size may double inside, away from the surface
    #[arg(long, value_name = "TIMES", default_value_t = 2, value_parser = clap::value_parser!(u32).range(0..=3))]
    pub coarser: u32,
    /// Cells of uniform size: --coarser 0
    #[arg(long, conflicts_with = "coarser")]
    pub uniform: bool,
    /// Mesh file to write: .msh, .inp or .vtu
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// Parses a length with its unit; returns m.
pub(super) fn length(text: &str) -> Result<f64, String> {
    catalogue::Dimension::Length.read_positive(text).map_err(|bad| bad.to_string())
}

fn gmsh_version(text: &str) -> Result<GmshVersion, String> {
    match text {
        "2.2" => Ok(GmshVersion::Two),
        "4.1" => Ok(GmshVersion::FourOne),
        _ => Err("versions 2.2 and 4.1 are written".into()),
    }
}

/// A length unit of coordinates in a file.
#[derive(Clone, Copy, Debug)]
pub struct LengthUnit {
    /// Name of the unit in files and messages.
    pub name: &'static str,
    /// Length of the unit, m.
    pub metres: f64,
}

pub(super) fn length_unit(text: &str) -> Result<LengthUnit, String> {
    let known = [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6)];
    let found = known.into_iter().find(|(name, _)| *name == text);
    let (name, metres) = found.ok_or("a length unit: m, cm, mm or um")?;
    Ok(LengthUnit { name, metres })
}
