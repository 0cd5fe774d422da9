//! Method families in addition to finite elements and element-free Galerkin: each is a crate and a line of
//! [`FAMILIES`].

use std::borrow::Cow;
use std::fmt;

use catalogue::{Problem, Values};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use shape::{FamilyEntry, MeshFamily};

use super::common::{Dilation, Jitter, JitterKeys, Mass, Size, SizeKeys};
use crate::scene::report::Report;
use crate::scene::vocabulary::{Given, Vocabulary, Word, build, settings, tagged};

/// Families over meshes that scenes can name.
pub static FAMILIES: &[FamilyEntry] = &[];

/// Settings of a method of one of these families.
#[derive(Clone)]
pub struct OverMesh {
    /// The family.
    pub entry: &'static FamilyEntry,
    /// Parameters of the family.
    pub values: Values,
    /// The family constructed with these parameters.
    pub family: MeshFamily,
    /// Treatment of the volume change.
    pub dilation: Dilation,
    /// Size of the mesh.
    pub size: Size,
    /// Random displacement of inner nodes.
    pub jitter: Option<Jitter>,
}

impl OverMesh {
    fn compared(&self) -> (&str, &Values, Dilation, &Size, &Option<Jitter>) {
        (self.entry.name, &self.values, self.dilation, &self.size, &self.jitter)
    }
}

impl PartialEq for OverMesh {
    fn eq(&self, other: &OverMesh) -> bool {
        self.compared() == other.compared()
    }
}

impl fmt::Debug for OverMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.compared().fmt(f)
    }
}

/// The names of the families.
enum Families {}

impl Vocabulary for Families {
    type Build = fn(&Values) -> Result<MeshFamily, Problem>;
    const NOUN: &'static str = "family";
    const ENTRIES: &'static [FamilyEntry] = FAMILIES;
}

/// A method of one of these families.
#[derive(Deserialize)]
pub(crate) struct OverMeshKeys {
    family: Word<Families>,
    #[serde(flatten)]
    pub beside: BesideFamily,
    #[serde(flatten)]
    given: Given<Families>,
}

/// Keys that every method over a mesh has, whatever its family.
#[derive(Deserialize, JsonSchema)]
pub(crate) struct BesideFamily {
    pub id: String,
    /// Name of the series, whose methods differ in size only; the id unless given
    pub series: Option<String>,
    dilation: Option<Dilation>,
    size: SizeKeys,
    jitter: Option<JitterKeys>,
    /// Mass matrix for vibrations; kind = "modes" only
    pub mass: Option<Mass>,
}

impl JsonSchema for OverMeshKeys {
    fn schema_name() -> Cow<'static, str> {
        "method over a mesh".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        tagged::<Families, BesideFamily>("family", "A method over a mesh", generator)
    }
}

impl OverMeshKeys {
    pub fn read(self, report: &Report) -> Option<OverMesh> {
        let BesideFamily { dilation, size, jitter, .. } = self.beside;
        let size = size.read(&report.at("size"));
        let jitter = jitter.map(|jitter| jitter.read(report));
        let entry = self.family.0;
        let values = settings(&self.family, self.given, report)?;
        let family = build(entry, &values, "family", report)?;
        let dilation = dilation.unwrap_or(Dilation::Standard);
        Some(OverMesh { entry, values, family, dilation, size: size?, jitter })
    }
}
