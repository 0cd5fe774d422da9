//! Methods of a scene: a file for each family and for each part of a cloud.

mod cloud;
mod common;
mod efg;
mod element;
mod essential;
mod external;
mod fem;
mod functions;
mod integration;
mod pod;

use std::path::PathBuf;

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

pub use cloud::{Cloud, Refine};
pub(crate) use common::SizeKeys;
pub use common::{Dilation, Jitter, Mass, Size};
pub use efg::{Efg, Regions};
pub use element::Element;
pub(crate) use essential::EssentialKeys;
pub use essential::{ConstraintRows, Essential, EssentialKind};
pub(crate) use external::{ADAPTERS, NO_ADAPTER, is_adapter};
pub use external::{External, Setting};
pub use fem::{Adapt, Fem, Hourglass, HourglassModulus};
pub use functions::{Basis, Functions, SupportRule, SupportShape};
pub use integration::Integration;
pub(crate) use integration::IntegrationKeys;
pub use pod::Pod;
use pod::Reduces;

use super::procedure::ProcedureKind;
use super::report::Report;
use efg::EfgKeys;
use external::ExternalKeys;
use fem::FemKeys;

/// A method that solves the scene
#[derive(Deserialize, JsonSchema)]
#[serde(tag = "family", rename_all = "kebab-case")]
pub(crate) enum MethodKeys {
    /// Finite elements
    Fem(Box<Named<FemKeys>>),
    /// Element-free Galerkin
    Efg(Box<Named<EfgKeys>>),
    /// An external solver, called by an adapter
    External(Box<Named<ExternalKeys>>),
}

// The keys of a family with those of its name.
#[derive(Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
pub(crate) struct Named<K> {
    id: String,
    /// Name of the series, whose methods differ in size only; the id unless given
    series: Option<String>,
    #[serde(flatten)]
    keys: K,
}

/// A method that solves the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    /// Id, unique within the scene.
    pub id: String,
    /// Name shared by methods that differ in size only: reports join them into one curve.
    pub series: String,
    /// Family with its settings.
    pub family: Family,
    /// Mass matrix for vibrations (`kind = "modes"`, which requires it).
    pub mass: Option<Mass>,
    /// Reduction to a few deformations.
    pub pod: Option<Pod>,
}

/// Family of a method.
#[derive(Clone, Debug, PartialEq)]
pub enum Family {
    /// Finite elements.
    Fem(Fem),
    /// Element-free Galerkin.
    Efg(Efg),
    /// An external solver.
    External(External),
}

impl Family {
    /// Properties on which a reduced model of the method depends.
    fn reduces(&self) -> Reduces {
        match self {
            Family::Fem(fem) => Reduces {
                dilation: fem.dilation,
                refined: fem.adapt.is_some(),
                hourglass: fem.hourglass.is_some(),
            },
            Family::Efg(efg) => {
                Reduces { dilation: efg.dilation, refined: efg.cloud.is_refined(), hourglass: false }
            }
            Family::External(external) => Reduces {
                dilation: external.elements.dilation,
                refined: false,
                hourglass: external.elements.hourglass.is_some(),
            },
        }
    }
}

/// Longest id of a method, characters: the id is part of file names.
const LONGEST_ID: usize = 64;

impl MethodKeys {
    pub fn read(self, report: &Report) -> Option<Method> {
        let (id, series, mass, pod, family) = match self {
            MethodKeys::Fem(named) => {
                let Named { id, series, mut keys } = *named;
                (id, series, keys.mass, keys.pod.take(), keys.read(report).map(Family::Fem))
            }
            MethodKeys::Efg(named) => {
                let Named { id, series, mut keys } = *named;
                (id, series, keys.mass, keys.pod.take(), keys.read(report).map(Family::Efg))
            }
            MethodKeys::External(named) => {
                let Named { id, series, keys } = *named;
                (id, series, None, None, keys.read(report).map(Family::External))
            }
        };
        let pod = pod.map(|keys| keys.read(&report.at("pod")));
        Some(Method { series: series.unwrap_or_else(|| id.clone()), id, family: family?, mass, pod })
    }
}

/// Reports contradictions of the methods with each other, with the procedure, and with the regions of the
/// scene.
pub(crate) fn demands(methods: &[Method], kind: ProcedureKind, has_regions: bool, report: &Report) {
    if methods.is_empty() {
        report.add("method", Problem::new("is missing").help("add a [[method]] with id, family and size"));
    }
    for (i, method) in methods.iter().enumerate() {
        let report = report.at(&format!("method[{i}]"));
        if methods[..i].iter().any(|other| other.id == method.id) {
            let problem = Problem::new("is the id of another method").found(&method.id);
            report.add("id", problem.help("ids are unique"));
        }
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        // The id names files and folders, for which one or two dots have another meaning.
        let dots = method.id.chars().all(|c| c == '.');
        let sound = !dots && method.id.len() <= LONGEST_ID && method.id.chars().all(plain);
        let help = format!("use up to {LONGEST_ID} letters, digits, '-', '_' and '.', not dots alone");
        report.require(sound, "id", "is not a valid id", &help);
        let vibrates = kind == ProcedureKind::Modes;
        if vibrates && method.mass.is_none() && !matches!(method.family, Family::External(_)) {
            report.missing("mass", "add mass = \"consistent\", \"lumped\" or \"transformed\"");
        }
        let help = "leave it out, or take [procedure] kind = \"modes\"";
        report.require(vibrates || method.mass.is_none(), "mass", "applies to vibrations only", help);
        if let Some(pod) = &method.pod {
            pod.demands(&method.family.reduces(), kind, &report.at("pod"));
        }
        match &method.family {
            Family::Fem(fem) => fem.demands(&report),
            Family::Efg(efg) => efg.demands(kind, has_regions, &report),
            Family::External(_) => {}
        }
    }
}

impl Method {
    /// The method on a cloud with another seed; `None` if its cloud has no random part.
    pub fn seeded(&self, new: u64) -> Option<Method> {
        let mut method = self.clone();
        let Family::Efg(efg) = &mut method.family else { return None };
        match &mut efg.cloud {
            Cloud::Mesh { jitter: Some(jitter), .. } => jitter.seed = new,
            Cloud::Mesh { jitter: None, .. } | Cloud::File { .. } => return None,
            Cloud::Uniform { seed, .. } | Cloud::Graded { seed, .. } | Cloud::Refined { seed, .. } => {
                *seed = new
            }
        }
        Some(method)
    }

    /// Size of the mesh that supplies the nodes; `None` for a cloud without a mesh.
    pub fn size(&self) -> Option<&Size> {
        match &self.family {
            Family::Fem(fem) => Some(&fem.size),
            Family::External(external) => Some(&external.elements.size),
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

    /// Requested number of nodes of the mesh, if the size is given by nodes; `None` for the first of several
    /// meshes.
    pub fn nodes_of_size(&self) -> Option<usize> {
        if matches!(&self.family, Family::Fem(Fem { adapt: Some(_), .. })) {
            return None;
        }
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

    /// The same elements of the same size, solved by another solver; `None` unless they are plain finite
    /// elements, which other solvers have too.
    pub fn solved_by(&self, adapter: &str) -> Option<Method> {
        let Family::Fem(fem) = &self.family else { return None };
        let family = Family::External(External::twin(fem, adapter)?);
        let name = |own: &str| format!("{own}-{adapter}");
        Some(Method { id: name(&self.id), series: name(&self.series), family, mass: None, pod: None })
    }

    /// Whether the method is `other`, at any size, solved by another solver.
    pub fn is_twin_of(&self, other: &Method) -> bool {
        let Family::External(external) = &self.family else { return false };
        other.solved_by(&external.adapter).is_some_and(|twin| twin.id == self.id)
    }
}
