//! The keys of a scene file, one type per table. The schema is generated from these types, and a file is checked against
//! it; `resolve` turns them into the types the program works with.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::expression::Expression;
use super::method::{Basis, Dilation, Element, KernelName};
use super::output::SchemeName;
use super::region::Region;
use super::units::{BodyForce, Density, Dim, Force, Length, Pressure, Q, Time, Unit};

/// A scene: a body, its material, what holds and loads it, the methods to run, what to compare and what must hold.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneKeys {
    /// One line that says what the scene is
    pub title: String,
    /// Where the case and its reference come from
    pub source: Option<String>,
    pub body: BodyKeys,
    pub material: MaterialKeys,
    /// Parts of the body with a material of their own
    #[serde(default)]
    pub region: Vec<RegionKeys>,
    #[serde(default)]
    pub support: Vec<SupportKeys>,
    #[serde(default)]
    pub load: Vec<LoadKeys>,
    #[serde(default)]
    pub tool: Vec<ToolKeys>,
    pub procedure: Option<ProcedureKeys>,
    #[serde(default)]
    pub method: Vec<MethodKeys>,
    pub output: Option<OutputKeys>,
    pub reference: Option<ReferenceKeys>,
    #[serde(default)]
    pub check: Vec<CheckKeys>,
}

/// The body in its undeformed state
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum BodyKeys {
    /// From corner to corner, or of a size with one corner at the origin
    Box { min: Option<[Q<Length>; 3]>, max: Option<[Q<Length>; 3]>, size: Option<[Q<Length>; 3]> },
    /// About the z axis, the base at z = 0
    Cylinder { radius: Q<Length>, height: Q<Length> },
    /// About the origin
    Ball { radius: Q<Length> },
    /// About the origin; the octant x, y, z >= 0 alone if wanted
    SphereShell {
        inner: Q<Length>,
        outer: Q<Length>,
        #[serde(default)]
        octant: bool,
    },
    /// The bean of 40 x 75 x 30 mm, by its map from the ball
    Kidney {},
    /// The mesh in a Gmsh file whose numbers are in `unit`
    File { path: String, unit: Unit<Length> },
}

/// A material law and its constants
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum MaterialKeys {
    /// Isotropic linear elasticity at small strain
    Linear {
        young: Q<Pressure>,
        poisson: f64,
        density: Option<Q<Density>>,
    },
    SaintVenantKirchhoff {
        young: Q<Pressure>,
        poisson: f64,
        density: Option<Q<Density>>,
    },
    NeoHookean {
        young: Q<Pressure>,
        poisson: f64,
        density: Option<Q<Density>>,
    },
    Hencky {
        young: Q<Pressure>,
        poisson: f64,
        density: Option<Q<Density>>,
    },
    MooneyRivlin {
        c10: Q<Pressure>,
        c01: Q<Pressure>,
        bulk: Q<Pressure>,
        density: Option<Q<Density>>,
    },
    Ogden {
        mu: Vec<Q<Pressure>>,
        alpha: Vec<f64>,
        bulk: Q<Pressure>,
        density: Option<Q<Density>>,
    },
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RegionKeys {
    pub name: String,
    /// A volume that the mesh file names
    pub on: Option<Names>,
    #[serde(rename = "where")]
    pub place: Option<Region>,
    pub material: MaterialKeys,
}

/// A name or a list of names
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Names {
    One(String),
    Several(Vec<String>),
}

/// The word "exact": values from the solution that `[reference]` names
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ExactWord {
    Exact,
}

/// A quantity, or an expression in x, y and z (metres) with the unit of its value
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(bound = "")]
pub(crate) enum FieldKeys<D: Dim> {
    Constant(Q<D>),
    Expression(FieldOf<D>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
pub(crate) struct FieldOf<D: Dim> {
    pub unit: Unit<D>,
    pub of: Expression,
}

/// Three components, "exact", or three expressions with one unit
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[serde(bound = "")]
pub(crate) enum VectorKeys<D: Dim> {
    Exact(ExactWord),
    Components([FieldKeys<D>; 3]),
    Expressions(VectorOf<D>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound = "")]
pub(crate) struct VectorOf<D: Dim> {
    pub unit: Unit<D>,
    pub of: [Expression; 3],
}

/// What a support prescribes along one axis
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum AxisKeys {
    Exact(ExactWord),
    Field(FieldKeys<Length>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxesKeys {
    pub x: Option<AxisKeys>,
    pub y: Option<AxisKeys>,
    pub z: Option<AxisKeys>,
}

/// Prescribed displacement
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum MoveKeys {
    Exact(ExactWord),
    Axes(AxesKeys),
}

/// Prescribed displacement of a region
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SupportKeys {
    /// Names that the shape or the mesh file gives
    pub on: Option<Names>,
    /// Comparisons joined by 'and'
    #[serde(rename = "where")]
    pub place: Option<Region>,
    /// Axes held at zero, such as "xyz"
    pub fix: Option<String>,
    #[serde(rename = "move")]
    pub motion: Option<MoveKeys>,
}

/// A given load: one of traction, pressure (along the inner normal) and body force
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadKeys {
    pub on: Option<Names>,
    #[serde(rename = "where")]
    pub place: Option<Region>,
    pub traction: Option<VectorKeys<Pressure>>,
    pub pressure: Option<FieldKeys<Pressure>>,
    pub body: Option<VectorKeys<BodyForce>>,
}

/// A rigid tool
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToolKeys {
    pub name: String,
    pub shape: super::tool::ToolShapeName,
    /// Half extents
    pub half: Option<[Q<Length>; 3]>,
    pub radius: Option<Q<Length>>,
    pub length: Option<Q<Length>>,
    pub path: Option<String>,
    pub unit: Option<Unit<Length>>,
    pub at: [Q<Length>; 3],
    /// Direction of motion
    pub along: [f64; 3],
    pub drive: DriveKeys,
    pub friction: Option<f64>,
}

/// How a tool is driven
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DriveKeys {
    pub closure: Option<Q<Length>>,
    pub force: Option<Q<Force>>,
    pub pressure: Option<Q<Pressure>>,
    /// Time of the ramp
    pub over: Option<Q<Time>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ProcedureKeys {
    pub kind: super::tool::ProcedureKind,
    /// Load steps
    pub steps: Option<u32>,
    /// End of the time axis
    pub duration: Option<Q<Time>>,
}

/// How fine: one of nodes, spacing, level, cells and file
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SizeKeys {
    pub nodes: Option<u32>,
    pub spacing: Option<Q<Length>>,
    pub level: Option<u32>,
    pub cells: Option<[u32; 3]>,
    /// Ratio of the last to the first cell along each axis, with cells
    pub grading: Option<[f64; 3]>,
    /// A Gmsh file
    pub file: Option<String>,
    /// Unit of the numbers in the file; mm unless given
    pub unit: Option<Unit<Length>>,
}

/// Random displacement of the inner nodes
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct JitterKeys {
    /// Of the cell size, below 0.5
    pub fraction: f64,
    pub seed: u64,
}

/// A way to solve the scene
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "family", rename_all = "kebab-case")]
pub(crate) enum MethodKeys {
    /// Finite elements
    Fem(FemKeys),
    /// Element-free Galerkin
    Efg(EfgKeys),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FemKeys {
    pub id: String,
    pub element: Element,
    pub dilation: Option<Dilation>,
    pub size: SizeKeys,
    pub jitter: Option<JitterKeys>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct EfgKeys {
    pub id: String,
    /// Exact number of nodes; or size
    pub nodes: Option<u32>,
    /// Size of the mesh whose nodes form the cloud; or nodes
    pub size: Option<SizeKeys>,
    pub cloud: Option<CloudName>,
    /// Regions that a graded cloud is denser in
    pub graded_towards: Option<Region>,
    /// Of a uniform or graded cloud
    pub seed: Option<u64>,
    pub jitter: Option<JitterKeys>,
    pub kernel: KernelKeys,
    /// Support radius over the local spacing; or neighbours and factor
    pub dilatation: Option<f64>,
    /// Support radius over the distance to this neighbour
    pub neighbours: Option<u32>,
    pub factor: Option<f64>,
    pub basis: Basis,
    pub integration: IntegrationKeys,
    pub essential: EssentialKeys,
    pub dilation: Option<Dilation>,
    /// Size of the mesh to integrate over
    pub background: Option<SizeKeys>,
}

#[derive(Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum CloudName {
    Mesh,
    Uniform,
    Graded,
}

/// A kernel by name, or a table with its parameters
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum KernelKeys {
    Name(KernelName),
    Table(KernelTable),
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct KernelTable {
    pub name: KernelName,
    /// Width of a gaussian or exponential kernel relative to the support radius
    pub alpha: Option<f64>,
    /// Exponent of an exponential kernel
    pub power: Option<u32>,
    /// Regularisation of the regularised-interpolating kernel
    pub eps: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum IntegrationKeys {
    /// Gauss points in the tetrahedra or hexahedra of the background mesh
    Gauss { points: u32 },
    /// Gauss points in the cells of a grid, those outside the body left out
    Grid { points: u32, spacing: Option<Q<Length>> },
    /// Conforming smoothing over tetrahedra, with points per face
    CellSmoothed { points: Option<u32> },
}

/// How prescribed displacements are imposed
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum EssentialKeys {
    Name(EssentialName),
    Table(EssentialTable),
}

#[derive(Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum EssentialName {
    Nitsche,
    Penalty,
    Multipliers,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct EssentialTable {
    pub method: EssentialName,
    /// Stabilisation or penalty factor
    pub factor: Option<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OutputKeys {
    /// Points to report
    pub probes: Option<Vec<[Q<Length>; 3]>>,
    pub transfer: Option<TransfersKeys>,
}

/// One transfer or several
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum TransfersKeys {
    One(TransferKeys),
    Several(Vec<TransferKeys>),
}

/// A transfer of nodal displacements to other points
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TransferKeys {
    pub to: TargetKeys,
    pub scheme: SchemeName,
    pub neighbours: Option<u32>,
    pub power: Option<f64>,
    pub dilatation: Option<f64>,
}

/// "reference-nodes", "probes", or the nodes of a mesh file
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum TargetKeys {
    Name(TargetName),
    File(MeshFileKeys),
}

#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TargetName {
    ReferenceNodes,
    Probes,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshFileKeys {
    pub file: String,
    pub unit: Option<Unit<Length>>,
}

/// What results are compared with; further keys are parameters of the exact solution
#[derive(Deserialize, JsonSchema)]
pub(crate) struct ReferenceKeys {
    /// An exact solution by name
    pub exact: Option<String>,
    /// A stored record
    pub record: Option<String>,
    /// A method of this scene, run at another size if one is given
    pub method: Option<String>,
    pub size: Option<SizeKeys>,
    #[serde(flatten)]
    pub parameters: BTreeMap<String, ParameterKeys>,
}

/// A parameter: a number, a quantity or name in quotes, or lists of them
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum ParameterKeys {
    Truth(bool),
    Number(f64),
    Text(String),
    List(Vec<ParameterItem>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum ParameterItem {
    Number(f64),
    Text(String),
    List(Vec<ParameterLeaf>),
}

#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum ParameterLeaf {
    Number(f64),
    Text(String),
}

/// A bound: a number, or a quantity in quotes
pub(crate) type BoundKeys = ParameterLeaf;

/// What must hold
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckKeys {
    pub metric: String,
    /// The methods it holds for; all unless given
    pub method: Option<Names>,
    pub at_most: Option<BoundKeys>,
    pub at_least: Option<BoundKeys>,
    /// Low and high end of a known defect, reported as not passing
    pub known_band: Option<[BoundKeys; 2]>,
    pub reason: Option<String>,
}
