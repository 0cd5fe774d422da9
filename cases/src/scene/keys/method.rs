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

/// How fine: one of nodes, spacing, level, cells and file
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
    /// Of the cell size, below 0.5
    pub fraction: f64,
    pub seed: u64,
}

/// A way to solve the scene
#[derive(Deserialize)]
#[serde(tag = "family", rename_all = "kebab-case")]
pub(crate) enum MethodKeys {
    Fem(FemKeys),
    Efg(Box<EfgKeys>),
    External(Box<ExternalKeys>),
    #[serde(untagged)]
    OverMesh(OverMeshKeys),
}

/// A way to solve the scene
#[derive(JsonSchema)]
#[serde(tag = "family", rename_all = "kebab-case")]
#[allow(dead_code)] // the schema of the families whose keys are types
enum TypedKeys {
    /// Finite elements
    Fem(FemKeys),
    /// Element-free Galerkin
    Efg(Box<EfgKeys>),
    /// A solver outside this program, which an adapter calls
    External(Box<ExternalKeys>),
}

impl JsonSchema for MethodKeys {
    fn schema_name() -> Cow<'static, str> {
        "method".into()
    }

    /// One form for each family.
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
    /// Methods of one series differ in size only; the id unless given
    pub series: Option<String>,
    pub element: Element,
    pub dilation: Option<Dilation>,
    /// Hex20 with 2 x 2 x 2 instead of 3 x 3 x 3 points
    #[serde(default)]
    pub reduced: bool,
    pub size: SizeKeys,
    pub jitter: Option<JitterKeys>,
    /// What moves in vibrations; kind = "modes" only
    pub mass: Option<Mass>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct EfgKeys {
    pub id: String,
    /// Methods of one series differ in size only; the id unless given
    pub series: Option<String>,
    /// Exact number of nodes; or size
    pub nodes: Option<u32>,
    /// Size of the mesh whose nodes form the cloud; or nodes
    pub size: Option<SizeKeys>,
    /// Nodes of the cloud; mesh with size, uniform with nodes unless given
    pub cloud: Option<CloudKeys>,
    /// Regions that a graded cloud is denser in
    pub graded_towards: Option<Region>,
    /// Of a uniform or graded cloud
    pub seed: Option<u64>,
    pub jitter: Option<JitterKeys>,
    /// Not with basis = "maximum-entropy"
    pub kernel: Option<KernelKeys>,
    /// Support radius over the local spacing; or neighbours and factor
    pub support_scale: Option<f64>,
    /// Support radius over the distance to this neighbour
    pub neighbours: Option<u32>,
    pub factor: Option<f64>,
    /// Balls unless given, or ellipsoids that follow the cells of the mesh whose nodes form the cloud
    pub neighbourhood: Option<SupportShape>,
    pub basis: BasisKeys,
    /// Locality of maximum-entropy functions, 0.6 to 6; 1.8 unless given
    pub gamma: Option<f64>,
    pub integration: IntegrationKeys,
    pub essential: EssentialKeys,
    pub dilation: Option<Dilation>,
    /// What shape functions do at the borders of material regions; separate with essential = "coupling" only
    pub regions: Option<Regions>,
    /// Size of the mesh to integrate over
    pub background: Option<SizeKeys>,
    /// What moves in vibrations; kind = "modes" only
    pub mass: Option<Mass>,
}

/// A cloud by name, or where its nodes are from
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
    /// Lines of x, y, z between commas, with or without column names, or a mesh file (.msh, .inp, .vtu, .vtk)
    pub file: Option<String>,
    /// Unit of the numbers in the file
    pub unit: Option<Unit<Length>>,
    /// Makes the cloud denser where its error is larger
    pub refine: Option<RefineKeys>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RefineKeys {
    pub by: Indicator,
    /// How often the cloud is regenerated; 2 unless given
    pub steps: Option<u32>,
    /// Coarsest over finest spacing at most; 3 unless given
    pub ratio: Option<f64>,
}

words! {
    /// Estimate of the error that a cloud is refined by.
    pub(crate) enum Indicator {
        /// Displacement gradients against recovered ones.
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
        /// The nodes of a mesh of this size.
        Mesh = "mesh",
        /// Quasi-uniform, with this number of nodes.
        Uniform = "uniform",
        /// Denser towards the region `graded_towards`, with this number of nodes.
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
        /// Points per cell; in a tetrahedron 1, 4, 8, 14, 15, 24, 35 and 46 are known
        points: u32,
    },
    /// Gauss points in the cells of a grid, those outside the body left out
    Grid {
        /// Points per cell, a cube number
        points: u32,
        /// Edge of a cell; the mean node spacing unless given
        spacing: Option<Q<Length>>,
    },
    /// Conforming strain smoothing over the tetrahedra of the background mesh
    CellSmoothed {
        /// Points per face: 1, 3 or 6; 1 unless given, and 6 with order 2
        points: Option<u32>,
        /// 1 (unless given) is exact for linear displacements, 2 for quadratic ones (variationally consistent integration of
        /// second order), as the quadratic basis needs
        order: Option<u32>,
    },
    /// Strain smoothing over the quarters of the tetrahedra around each vertex of the background mesh
    NodeSmoothed {
        /// Part of the weight that the tetrahedra keep, from 0 to below 1; 0.05 is usual
        stabilisation: f64,
        /// Points per face: 1, 3 or 6; 1 unless given
        points: Option<u32>,
    },
}

/// How prescribed displacements are imposed
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum EssentialKeys {
    Name(EssentialKind),
    Table(EssentialTable),
}

/// One of these with settings
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct EssentialTable {
    pub method: EssentialKind,
    /// Stabilisation factor of Nitsche's method, or penalty factor; with these two only
    pub factor: Option<f64>,
    /// What the eliminated rows prescribe; with elimination only
    pub rows: Option<ConstraintRows>,
}
