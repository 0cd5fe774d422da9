//! Clouds: the nodes of an element-free Galerkin method.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::common::{Jitter, JitterKeys, Size, SizeKeys, count};
use crate::scene::mesh_file::MeshFile;
use crate::scene::region::Region;
use crate::scene::report::Report;
use crate::scene::units::{Length, Unit};
use crate::scene::words::words;

/// Keys of a method about its cloud
#[derive(Deserialize, JsonSchema)]
pub(super) struct CloudKeys {
    /// Exact number of nodes; give nodes or size
    nodes: Option<u32>,
    /// Size of the mesh whose nodes form the cloud; give nodes or size
    size: Option<SizeKeys>,
    /// Kind of cloud; unless given, mesh with size and uniform with nodes
    cloud: Option<SourceKeys>,
    /// Regions in which a graded cloud is denser
    graded_towards: Option<Region>,
    /// Seed of a uniform or graded cloud
    seed: Option<u64>,
    jitter: Option<JitterKeys>,
}

/// A cloud by name, or a table with the source of its nodes
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum SourceKeys {
    Name(CloudName),
    Table(CloudTable),
}

/// The nodes of a file, or a cloud refined by an estimate of its error
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct CloudTable {
    /// A file with lines of x, y, z separated by commas, with or without column names, or a mesh file (.msh,
    /// .inp, .vtu, .vtk)
    file: Option<String>,
    /// Unit of the numbers in the file
    unit: Option<Unit<Length>>,
    /// Refinement: the cloud is denser in areas of larger error
    refine: Option<RefineKeys>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RefineKeys {
    by: Indicator,
    /// Number of times the cloud is regenerated; 2 unless given
    steps: Option<u32>,
    /// Largest ratio of coarsest to finest spacing; 3 unless given
    ratio: Option<f64>,
}

words! {
    /// Error estimate that refines a cloud.
    enum Indicator {
        /// Difference between displacement gradients and recovered gradients.
        GradientError = "gradient-error",
    }
}

words! {
    /// Clouds by name.
    enum CloudName {
        /// The nodes of a mesh of the given size.
        Mesh = "mesh",
        /// Quasi-uniform, with the given number of nodes.
        Uniform = "uniform",
        /// Denser towards the region `graded_towards`, with the given number of nodes.
        Graded = "graded",
    }
}

/// Source of the nodes of a cloud.
#[derive(Clone, Debug, PartialEq)]
pub enum Cloud {
    /// The nodes of a mesh.
    Mesh {
        /// Size of the mesh.
        size: Size,
        /// Random displacement of inner nodes.
        jitter: Option<Jitter>,
    },
    /// Quasi-uniform, with an exact number of nodes.
    Uniform {
        /// Number of nodes.
        nodes: usize,
        /// Seed of the generator.
        seed: u64,
    },
    /// The nodes of a file.
    File {
        /// Lines of x, y, z, or a mesh file.
        file: MeshFile,
        /// Number of nodes stated in the scene.
        nodes: Option<usize>,
    },
    /// Denser where the solution's gradients differ most from recovered gradients; exact number of nodes.
    Refined {
        /// Number of nodes.
        nodes: usize,
        /// Seed of the generator.
        seed: u64,
        /// Refinement settings.
        refine: Refine,
    },
    /// Denser towards a region, with an exact number of nodes.
    Graded {
        /// Number of nodes.
        nodes: usize,
        /// Seed of the generator.
        seed: u64,
        /// Region of higher density.
        towards: Region,
    },
}

impl Cloud {
    /// Whether the cloud is refined by its error.
    pub(crate) fn is_refined(&self) -> bool {
        matches!(self, Cloud::Refined { .. })
    }
}

/// Refinement of a cloud by its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refine {
    /// Number of clouds after the first, which is uniform.
    pub steps: usize,
    /// Largest ratio of coarsest to finest spacing.
    pub ratio: f64,
}

/// Meaning of a cloud's table.
enum Source {
    File(MeshFile),
    Refine(Refine),
}

impl CloudTable {
    fn read(self, report: &Report) -> Option<Source> {
        match (self.file, self.unit, self.refine) {
            (Some(file), Some(unit), None) => {
                Some(Source::File(MeshFile::read(&file, Some(unit), "file", report)))
            }
            (Some(_), None, None) => {
                report.missing("unit", "give the unit of the numbers in the file: unit = \"mm\"");
                None
            }
            (None, None, Some(RefineKeys { by: Indicator::GradientError, steps, ratio })) => {
                let (steps, ratio) = (steps.unwrap_or(2), ratio.unwrap_or(3.0));
                let sound = (1..=10).contains(&steps);
                report.require(
                    sound,
                    "refine.steps",
                    "is not a valid number of steps",
                    "give 1 to 10; 2 is usual",
                );
                let sound = (1.0..=10.0).contains(&ratio);
                report.require(sound, "refine.ratio", "is not a valid ratio", "give 1 to 10; 3 is usual");
                Some(Source::Refine(Refine { steps: steps as usize, ratio }))
            }
            _ => {
                let help = "give { file = \"nodes.csv\", unit = \"mm\" }, or { refine = { by = \"gradient-error\" } }";
                report.add("", Problem::new("is not one cloud").help(help));
                None
            }
        }
    }
}

impl CloudKeys {
    /// Whether the nodes of the cloud are the nodes of cells.
    pub fn has_cells(&self) -> bool {
        let file = match &self.cloud {
            Some(SourceKeys::Table(table)) => table.file.as_ref(),
            _ => None,
        };
        self.size.is_some() || file.is_some_and(|file| mesh_files::is_mesh(file.as_ref()))
    }

    pub fn read(self, report: &Report) -> Option<Cloud> {
        let jitter = self.jitter.map(|jitter| jitter.read(report));
        let (name, source) = match self.cloud {
            Some(SourceKeys::Name(name)) => (Some(name), None),
            Some(SourceKeys::Table(table)) => (None, table.read(&report.at("cloud"))),
            None => (None, None),
        };
        let nodes = self.nodes.map(|n| count(n, report));
        let size = self.size.map(|size| size.read(&report.at("size")));
        let of_mesh = size.is_some();
        let stray = "does not belong to this cloud";
        let help = "jitter moves the nodes of a mesh: give size";
        report.require(of_mesh || jitter.is_none(), "jitter", stray, help);
        let given = of_mesh || matches!(source, Some(Source::File(_)));
        report.require(!given || self.seed.is_none(), "seed", stray, "nodes that are given need none");
        let seed = self.seed.unwrap_or(1);
        if let Some(source) = source {
            let help = "cloud = { ... } describes the whole cloud; nodes = 83 may give its number of nodes";
            for (key, given) in [("size", of_mesh), ("graded_towards", self.graded_towards.is_some())] {
                report.require(!given, key, "does not apply to this cloud", help);
            }
            return match (source, nodes) {
                (Source::File(file), nodes) => Some(Cloud::File { file, nodes }),
                (Source::Refine(refine), Some(nodes)) => Some(Cloud::Refined { nodes, seed, refine }),
                (Source::Refine(_), None) => {
                    report.missing("nodes", "give nodes = 332, the number of nodes after every step");
                    None
                }
            };
        }
        match (nodes, size, name, self.graded_towards) {
            (None, Some(size), None | Some(CloudName::Mesh), None) => {
                Some(Cloud::Mesh { size: size?, jitter })
            }
            (Some(nodes), None, None | Some(CloudName::Uniform), None) => {
                Some(Cloud::Uniform { nodes, seed })
            }
            (Some(nodes), None, Some(CloudName::Graded), Some(towards)) => {
                Some(Cloud::Graded { nodes, seed, towards })
            }
            (Some(_), None, Some(CloudName::Graded), None) => {
                let help = "give the denser region: graded_towards = \"z >= 10 mm\"";
                report.missing("graded_towards", help);
                None
            }
            (None, None, ..) => {
                let help = "give nodes = 83 for a cloud of that count, or size for the nodes of a mesh";
                report.missing("nodes", help);
                None
            }
            _ => {
                let help = "give nodes with cloud = \"uniform\", or with \"graded\" and graded_towards; give size \
                            with cloud = \"mesh\"";
                report.add("cloud", Problem::new("does not fit the other keys").help(help));
                None
            }
        }
    }
}
