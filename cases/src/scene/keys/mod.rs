//! The keys of a scene file, one type per table. The schema is generated from these types, and files are
//! checked against the schema. `resolve` converts the keys into the types used by the program.

mod condition;
mod method;
mod output;

use std::borrow::Cow;

use geometry::generate::surfaces;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

pub(crate) use condition::*;
pub(crate) use method::*;
pub(crate) use output::*;

use super::model::with_all;
use super::procedure::ProcedureKeys;
use super::purpose::{Publication, Purpose};
use super::region::Region;
use super::units::{Density, Length, Q, Time, Unit};
use super::vocabulary::{Given, Laws, Word, tagged};

/// A scene: a body, its material, supports and loads, the methods to run, the reference, and the checks.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneKeys {
    /// Title of the scene in one line
    pub title: String,
    /// Source of the case and its reference
    pub source: Option<String>,
    /// Purpose of the scene; "smooth" unless given
    pub purpose: Option<Purpose>,
    /// A published comparison of methods; the results test its claim on run times and errors
    pub published: Option<Publication>,
    pub body: BodyKeys,
    pub material: MaterialKeys,
    /// Parts of the body with their own material
    #[serde(default)]
    pub region: Vec<RegionKeys>,
    #[serde(default)]
    pub support: Vec<SupportKeys>,
    #[serde(default)]
    pub load: Vec<LoadKeys>,
    #[serde(default)]
    pub tool: Vec<ToolKeys>,
    pub procedure: Option<ProcedureKeys>,
    /// A file of methods that several scenes share, relative to the folder of the scene. A `[[method]]` takes
    /// one of its methods by `use = "id"`
    #[allow(dead_code)] // read before the keys are, by `shared`
    pub methods_from: Option<String>,
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
    /// An axis-parallel box: give two corners (min, max), or a size with one corner at the origin
    #[schemars(extend("x-surfaces" = with_all(&surfaces::BOX)))]
    Box {
        /// Lower corner; the origin unless given
        min: Option<[Q<Length>; 3]>,
        /// Upper corner
        max: Option<[Q<Length>; 3]>,
        /// Edge lengths
        size: Option<[Q<Length>; 3]>,
    },
    /// A cylinder about the z axis with its base at z = 0
    #[schemars(extend("x-surfaces" = with_all(&surfaces::CYLINDER)))]
    Cylinder {
        /// Radius
        radius: Q<Length>,
        /// Height
        height: Q<Length>,
    },
    /// A ball about the origin
    #[schemars(extend("x-surfaces" = with_all(&surfaces::BALL)))]
    Ball {
        /// Radius
        radius: Q<Length>,
    },
    /// A thick sphere about the origin
    #[schemars(extend("x-surfaces" = with_all(&surfaces::SHELL)))]
    SphereShell {
        /// Inner radius
        inner: Q<Length>,
        /// Outer radius
        outer: Q<Length>,
        /// Only the octant x, y, z >= 0
        #[serde(default)]
        #[schemars(extend("x-surfaces" = surfaces::OCTANT))]
        octant: bool,
    },
    /// The kidney, a bean of 40 x 75 x 30 mm
    #[schemars(extend("x-surfaces" = with_all(&surfaces::BALL)))]
    Kidney {
        /// Only the half z >= 0
        #[serde(default)]
        #[schemars(extend("x-surfaces" = surfaces::HALF))]
        half: bool,
        /// Weaker grading of the half's meshes under the jaw's edges, for meshes so fine that thin cells fold
        /// (10,000 nodes)
        #[serde(default)]
        mildly_graded: bool,
    },
    /// A mesh file (Gmsh .msh, Abaqus or CalculiX .inp, VTK .vtu or .vtk), which names its own surfaces, or a
    /// closed surface (STL, OBJ, PLY)
    File {
        /// The file, relative to the folder of the scene
        path: String,
        /// Unit of the numbers in the file
        unit: Unit<Length>,
        /// Join pieces whose faces coincide without shared nodes, in all meshes of this body and its methods
        #[serde(default)]
        join: bool,
    },
}

/// A material law and its constants
#[derive(Deserialize)]
pub(crate) struct MaterialKeys {
    pub law: Word<Laws>,
    #[serde(flatten)]
    pub beside: BesideLaw,
    #[serde(flatten)]
    pub settings: Given<Laws>,
}

/// Keys that every material has, whatever its law
#[derive(Deserialize, JsonSchema)]
pub(crate) struct BesideLaw {
    pub density: Option<Q<Density>>,
    #[serde(default)]
    pub prony: Vec<PronyKeys>,
}

impl JsonSchema for MaterialKeys {
    fn schema_name() -> Cow<'static, str> {
        "material".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        tagged::<Laws, BesideLaw>("law", "A material law and its constants", generator)
    }
}

/// A share of the shear response that relaxes, with its relaxation time
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PronyKeys {
    pub g: f64,
    pub tau: Q<Time>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RegionKeys {
    pub name: String,
    /// A volume named in the mesh file
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
