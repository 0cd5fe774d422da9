//! Method families in addition to finite elements and element-free Galerkin: each is a crate and a line of
//! [`FAMILIES`].

use std::borrow::Cow;
use std::fmt;
use std::path::PathBuf;

use catalogue::{Problem, Values};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use shape::{FamilyEntry, MeshFamily};

use super::keys::{JitterKeys, SizeKeys};
use super::method::{Cloud, Dilation, Family, Jitter, Mass, Method, Size};
use super::report::Report;
use super::resolve::{jitter, size};
use super::vocabulary::{Given, Vocabulary, Word, build, settings, tagged};

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
pub(crate) enum Families {}

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
    beside: BesideFamily,
    #[serde(flatten)]
    given: Given<Families>,
}

/// Keys that every method over a mesh has, whatever its family.
#[derive(Deserialize, JsonSchema)]
struct BesideFamily {
    id: String,
    /// Name of the series, whose methods differ in size only; the id unless given
    series: Option<String>,
    dilation: Option<Dilation>,
    size: SizeKeys,
    jitter: Option<JitterKeys>,
    /// Mass matrix for vibrations; kind = "modes" only
    mass: Option<Mass>,
}

impl JsonSchema for OverMeshKeys {
    fn schema_name() -> Cow<'static, str> {
        "method over a mesh".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        tagged::<Families, BesideFamily>("family", "A method over a mesh", generator)
    }
}

/// The method described by the keys at `key`.
pub(crate) fn over_mesh(keys: OverMeshKeys, key: &str, report: &mut Report) -> Option<Method> {
    let BesideFamily { id, series, dilation, size: fineness, jitter: shaken, mass } = keys.beside;
    let size = size(fineness, &format!("{key}.size"), report);
    let jitter = jitter(shaken, key, report);
    let entry = keys.family.0;
    let values = settings(&keys.family, keys.given, key, report)?;
    let family = build(entry, &values, (key, &format!("{key}.family")), report)?;
    let dilation = dilation.unwrap_or(Dilation::Standard);
    let over = OverMesh { entry, values, family, dilation, size: size?, jitter };
    Some(Method { series: series.unwrap_or_else(|| id.clone()), id, family: Family::OverMesh(over), mass })
}

impl Method {
    /// Size of the mesh that supplies the nodes; `None` for a cloud without a mesh.
    pub fn size(&self) -> Option<&Size> {
        match &self.family {
            Family::Fem(fem) => Some(&fem.size),
            Family::External(external) => Some(&external.elements.size),
            Family::OverMesh(over) => Some(&over.size),
            Family::Efg(efg) => match &efg.cloud {
                Cloud::Mesh { size, .. } => Some(size),
                Cloud::Uniform { .. } | Cloud::Graded { .. } | Cloud::Refined { .. } | Cloud::File { .. } => {
                    None
                }
            },
        }
    }

    /// Replaces the size; a cloud of an exact count becomes the nodes of a mesh of the new size.
    pub fn resize(&mut self, size: &Size) {
        match &mut self.family {
            Family::Fem(fem) => fem.size = size.clone(),
            Family::External(external) => external.elements.size = size.clone(),
            Family::OverMesh(over) => over.size = size.clone(),
            Family::Efg(efg) => match (&mut efg.cloud, size) {
                (
                    Cloud::Uniform { nodes, .. } | Cloud::Graded { nodes, .. } | Cloud::Refined { nodes, .. },
                    Size::Nodes(n),
                ) => *nodes = *n,
                (Cloud::Mesh { size: old, .. }, _) => *old = size.clone(),
                (cloud, _) => *cloud = Cloud::Mesh { size: size.clone(), jitter: None },
            },
        }
    }

    /// Requested number of nodes of the mesh, if the size is given by nodes.
    pub fn nodes_of_size(&self) -> Option<usize> {
        match self.size()? {
            Size::Nodes(nodes) => Some(*nodes),
            _ => None,
        }
    }

    /// Name of the family in files.
    pub fn family_name(&self) -> &'static str {
        match &self.family {
            Family::Fem(_) => "fem",
            Family::Efg(_) => "efg",
            Family::External(_) => "external",
            Family::OverMesh(over) => over.entry.name,
        }
    }

    /// Whether the method is a cloud, whose number of nodes can be given.
    pub fn is_cloud(&self) -> bool {
        matches!(self.family, Family::Efg(_))
    }

    /// Files that the method reads.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = self.size().and_then(Size::file).into_iter().collect();
        if let Family::Efg(efg) = &self.family {
            files.extend(efg.background.as_ref().and_then(Size::file));
            if let Cloud::File { file, .. } = &efg.cloud {
                files.push(file.path.clone());
            }
        }
        files
    }
}

impl Size {
    /// The mesh file, if the size is given by a file.
    pub fn file(&self) -> Option<PathBuf> {
        match self {
            Size::File(file) => Some(file.path.clone()),
            _ => None,
        }
    }
}
