//! Keys of methods and their sizes.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use serde_json::Value;

use crate::scene::external::ExternalKeys;
use crate::scene::family::OverMeshKeys;
use crate::scene::method::{
    Basis, ConstraintRows, Dilation, Element, Entropy, EssentialKind, Mass, Regions, SupportShape,
};
use crate::scene::region::Region;
use crate::scene::units::{Length, Q, Unit};
use crate::scene::vocabulary::{Given, Kernels, Word};
use crate::scene::words::words;

/// Mesh size: one of nodes, spacing, level, cells and file
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-one-of" = ["level", "nodes", "spacing", "cells", "file"]))]
pub(crate) struct SizeKeys {
    pub nodes: Option<u32>,
    pub spacing: Option<Q<Length>>,
    pub level: Option<u32>,
    pub cells: Option<[u32; 3]>,
    /// Ratio of the last to the first cell along each axis, with cells
    pub grading: Option<[f64; 3]>,
    /// A mesh file: Gmsh .msh, Abaqus or CalculiX .inp, VTK .vtu or .vtk
    pub file: Option<String>,
    /// Unit of the numbers in the file; mm unless given
    pub unit: Option<Unit<Length>>,
}

/// Random displacement of the inner nodes
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct JitterKeys {
    /// Fraction of the cell size, below 0.5
    pub fraction: f64,
    pub seed: u64,
}

/// A method that solves the scene
#[derive(Deserialize)]
#[serde(tag = "family", rename_all = "kebab-case")]
pub(crate) enum MethodKeys {
    Fem(FemKeys),
    Efg(Box<EfgKeys>),
    External(Box<ExternalKeys>),
    #[serde(untagged)]
    OverMesh(OverMeshKeys),
}

/// A method that solves the scene
#[derive(JsonSchema)]
#[serde(tag = "family", rename_all = "kebab-case")]
#[allow(dead_code)] // the schema of the families whose keys are types
enum TypedKeys {
    /// Finite elements
    Fem(FemKeys),
    /// Element-free Galerkin
    Efg(Box<EfgKeys>),
    /// An external solver, called by an adapter
    External(Box<ExternalKeys>),
}

impl JsonSchema for MethodKeys {
    fn schema_name() -> Cow<'static, str> {
        "method".into()
    }

    /// The schema, with one form for each family.
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = TypedKeys::json_schema(generator);
        let others = OverMeshKeys::json_schema(generator).to_value();
        let others = others["oneOf"].as_array().cloned().unwrap_or_default();
        if let Some(forms) = schema.get_mut("oneOf").and_then(Value::as_array_mut) {
            forms.extend(others);
        }
        schema
    }
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FemKeys {
    pub id: String,
    /// Name of the series, whose methods differ in size only; the id unless given
    pub series: Option<String>,
    pub element: Element,
    pub dilation: Option<Dilation>,
    /// Whether hex20 has 2 x 2 x 2 integration points instead of 3 x 3 x 3
    #[serde(default)]
    pub reduced: bool,
    pub size: SizeKeys,
    pub jitter: Option<JitterKeys>,
    /// Mass matrix for vibrations; kind = "modes" only
    pub mass: Option<Mass>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct EfgKeys {
    pub id: String,
    /// Name of the series, whose methods differ in size only; the id unless given
    pub series: Option<String>,
    /// Exact number of nodes; give nodes or size
    pub nodes: Option<u32>,
    /// Size of the mesh whose nodes form the cloud; give nodes or size
    pub size: Option<SizeKeys>,
    /// Kind of cloud; unless given, mesh with size and uniform with nodes
    pub cloud: Option<CloudKeys>,
    /// Regions in which a graded cloud is denser
    pub graded_towards: Option<Region>,
    /// Seed of a uniform or graded cloud
    pub seed: Option<u64>,
    pub jitter: Option<JitterKeys>,
    /// Kernel; not with basis = "maximum-entropy"
    pub kernel: Option<KernelKeys>,
    /// Support radius over the local spacing; give this, or neighbours and factor
    pub support_scale: Option<f64>,
    /// Support radius over the distance to this neighbour
    pub neighbours: Option<u32>,
    pub factor: Option<f64>,
    /// Shape of the supports: balls unless given, or ellipsoids that follow the cells of the mesh whose nodes
    /// form the cloud
    pub neighbourhood: Option<SupportShape>,
    pub basis: BasisKeys,
    /// Locality of maximum-entropy functions, 0.6 to 6; 1.8 unless given
    pub gamma: Option<f64>,
    pub integration: IntegrationKeys,
    pub essential: EssentialKeys,
    pub dilation: Option<Dilation>,
    /// Treatment of the borders of material regions by the shape functions; separate with essential =
    /// "coupling" only
    pub regions: Option<Regions>,
    /// Size of the mesh of integration cells
    pub background: Option<SizeKeys>,
    /// Mass matrix for vibrations; kind = "modes" only
    pub mass: Option<Mass>,
}

/// A cloud by name, or a table with the source of its nodes
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum CloudKeys {
    Name(CloudName),
    Table(CloudTable),
}

/// The nodes of a file, or a cloud refined by an estimate of its error
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CloudTable {
    /// A file with lines of x, y, z separated by commas, with or without column names, or a mesh file (.msh,
    /// .inp, .vtu, .vtk)
    pub file: Option<String>,
    /// Unit of the numbers in the file
    pub unit: Option<Unit<Length>>,
    /// Refinement: the cloud is denser in areas of larger error
    pub refine: Option<RefineKeys>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RefineKeys {
    pub by: Indicator,
    /// Number of times the cloud is regenerated; 2 unless given
    pub steps: Option<u32>,
    /// Largest ratio of coarsest to finest spacing; 3 unless given
    pub ratio: Option<f64>,
}

words! {
    /// Error estimate that refines a cloud.
    pub(crate) enum Indicator {
        /// Difference between displacement gradients and recovered gradients.
        GradientError = "gradient-error",
    }
}

/// Basis of the shape functions
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum BasisKeys {
    Polynomial(Basis),
    Entropy(Entropy),
}

words! {
    /// Clouds by name.
    pub(crate) enum CloudName {
        /// The nodes of a mesh of the given size.
        Mesh = "mesh",
        /// Quasi-uniform, with the given number of nodes.
        Uniform = "uniform",
        /// Denser towards the region `graded_towards`, with the given number of nodes.
        Graded = "graded",
    }
}

/// A kernel by name, or a table with its parameters
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum KernelKeys {
    Name(Word<Kernels>),
    Table(KernelTable),
}

#[derive(Deserialize, JsonSchema)]
pub(crate) struct KernelTable {
    pub name: Word<Kernels>,
    #[serde(flatten)]
    pub settings: Given<Kernels>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum IntegrationKeys {
    /// Gauss points in the tetrahedra or hexahedra of the background mesh
    Gauss {
        /// Points per cell; tetrahedra have rules of 1, 4, 8, 14, 15, 24, 35 and 46 points
        points: u32,
    },
    /// Gauss points in the cells of a grid, without the points outside the body
    Grid {
        /// Points per cell, a cube number
        points: u32,
        /// Edge length of a cell; the mean node spacing unless given
        spacing: Option<Q<Length>>,
    },
    /// Conforming strain smoothing over the tetrahedra of the background mesh
    CellSmoothed {
        /// Points per face: 1, 3 or 6; 1 unless given, and 6 with order 2
        points: Option<u32>,
        /// Order of exactness: 1 (unless given) for linear displacements, 2 for quadratic ones (variationally
        /// consistent integration of second order), as the quadratic basis needs
        order: Option<u32>,
    },
    /// Strain smoothing over the quarters of the tetrahedra around each vertex of the background mesh
    NodeSmoothed {
        /// Fraction of the weight that stays on the tetrahedra, from 0 to below 1; 0.05 is usual
        stabilisation: f64,
        /// Points per face: 1, 3 or 6; 1 unless given
        points: Option<u32>,
    },
}

/// Method of imposing prescribed displacements
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum EssentialKeys {
    Name(EssentialKind),
    Table(EssentialTable),
}

/// An essential condition with settings
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct EssentialTable {
    pub method: EssentialKind,
    /// Stabilisation factor of Nitsche's method, or penalty factor; with these two methods only
    pub factor: Option<f64>,
    /// Displacements prescribed by the eliminated rows; with elimination only
    pub rows: Option<ConstraintRows>,
}
