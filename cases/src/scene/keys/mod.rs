//! The keys of a scene file, one type per table. The schema is generated from these types, and a file is checked against
//! it; `resolve` turns them into the types the program works with.

mod condition;
mod method;
mod output;

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;

pub(crate) use condition::*;
pub(crate) use method::*;
pub(crate) use output::*;

use super::procedure::{OnStall, ProcedureKind};
use super::purpose::{Publication, Purpose};
use super::region::Region;
use super::units::{Density, Length, Q, Rate, Time, Unit};
use super::vocabulary::{Given, Laws, Word, tagged};

/// A scene: a body, its material, what holds and loads it, the methods to run, what to compare and what must hold.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SceneKeys {
    /// One line that says what the scene is
    pub title: String,
    /// Where the case and its reference come from
    pub source: Option<String>,
    /// What the scene is for: "patch" (exact in every method), "smooth" (the default: errors fall with the order of theory), "rough"
    /// (no order is promised) or "published" (compared with the numbers of `published`)
    #[serde(default)]
    pub purpose: Purpose,
    /// A published comparison of methods: its claim on run times and errors is tested by the results
    pub published: Option<Publication>,
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
    /// The bean of 40 x 75 x 30 mm, by its map from the ball; the half z >= 0 alone if wanted
    Kidney {
        #[serde(default)]
        half: bool,
    },
    /// The mesh in a Gmsh file whose numbers are in `unit`
    File { path: String, unit: Unit<Length> },
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

/// What a material has whatever its law is
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

/// A share of the shear response that relaxes, and its time
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

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct ProcedureKeys {
    pub kind: ProcedureKind,
    /// Load steps at whose ends results are told; 1 unless given
    pub steps: Option<u32>,
    /// Relative residual of a step by Newton's method; 1e-8 unless given
    pub tolerance: Option<f64>,
    /// Most iterations of such a step; 25 unless given
    pub iterations: Option<u32>,
    /// Uzawa iterations of contact per such step; 0 (a plain penalty) unless given
    pub augmentations: Option<u32>,
    /// Part of the load to within which a limit point is sought, where a static path loses its stability: steps are halved
    /// down to it; unless given a limit point is told where a load step ends beyond one
    pub limit_within: Option<f64>,
    /// Lowest modes of vibration that are told and compared; 24 unless given
    pub modes: Option<u32>,
    /// What follows where a static path finds no equilibrium: "stop" unless given, or "relax", which goes on by dynamic
    /// relaxation (finite elements without a pressure field; a cloud stops)
    pub on_stall: Option<OnStall>,
    /// End of the time axis
    pub duration: Option<Q<Time>>,
    /// Time over which loads and supports grow in dynamics, and are then held; the duration unless given, "0 s" is at once
    pub over: Option<Q<Time>>,
    /// Mass-proportional damping in dynamics, of the tools too where they have a mass (explicit); none unless given
    pub damping: Option<Q<Rate>>,
    /// Whether mass acts in implicit dynamics; true unless given, false for a quasi-static motion of tissue that relaxes
    pub inertia: Option<bool>,
    /// Spectral radius of implicit dynamics at infinite frequency, 0 to 1; 0.8 unless given, and 0 with tools
    pub spectral_radius: Option<f64>,
    /// Local error of a displacement that a step of implicit dynamics may make; any unless given
    pub accuracy: Option<Q<Length>>,
    /// Time step over the critical one; 0.9 unless given
    pub safety: Option<f64>,
    /// Time step; safety times the critical one unless given
    pub step: Option<Q<Time>>,
    /// Mass of a tool driven by force over that of the body; 0.1 unless given
    pub tool_mass: Option<f64>,
}
