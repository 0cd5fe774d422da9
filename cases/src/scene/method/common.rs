//! Settings that methods of several families have: size, jitter, dilation, mass.

use std::path::PathBuf;

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::mesh_file::MeshFile;
use crate::scene::report::Report;
use crate::scene::units::{Length, Q, Unit};
use crate::scene::words::words;

/// Mesh size: one of nodes, spacing, level, cells and file
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-one-of" = ["level", "nodes", "spacing", "cells", "file"]))]
pub(crate) struct SizeKeys {
    nodes: Option<u32>,
    spacing: Option<Q<Length>>,
    level: Option<u32>,
    cells: Option<[u32; 3]>,
    /// Ratio of the last to the first cell along each axis, with cells
    grading: Option<[f64; 3]>,
    /// A mesh file: Gmsh .msh, Abaqus or CalculiX .inp, FEBio .feb, VTK .vtu or .vtk
    file: Option<String>,
    /// Unit of the numbers in the file; mm unless given
    unit: Option<Unit<Length>>,
}

/// Size of a mesh or cloud.
#[derive(Clone, Debug, PartialEq)]
pub enum Size {
    /// About this many nodes.
    Nodes(usize),
    /// Mean edge length in metres.
    Spacing(f64),
    /// Level of a family of meshes, from 1; each level is twice as fine as the one before.
    Level(u32),
    /// Cells along the axes of a structured mesh.
    Cells {
        /// Number along x, y, z.
        cells: [usize; 3],
        /// Ratio of the last to the first cell along x, y, z; 1 is uniform.
        grading: [f64; 3],
    },
    /// A mesh file.
    File(MeshFile),
}

impl SizeKeys {
    pub fn read(self, report: &Report) -> Option<Size> {
        let grading = self.grading;
        let has_file = self.file.is_some();
        let sound = grading.is_none() || self.cells.is_some();
        report.require(sound, "grading", "applies to cells only", "leave it out");
        report.require(self.unit.is_none() || has_file, "unit", "applies to file only", "leave it out");
        match (self.nodes, self.spacing, self.level, self.cells, self.file) {
            (Some(n), None, None, None, None) => Some(Size::Nodes(count(n, report))),
            (None, Some(q), None, None, None) => Some(Size::Spacing(report.positive("spacing", q.0))),
            (None, None, Some(level), None, None) => {
                report.require(
                    (1..=8).contains(&level),
                    "level",
                    "is not a valid level",
                    "levels are 1 to 8",
                );
                Some(Size::Level(level))
            }
            (None, None, None, Some(cells), None) => {
                let cells = cells.map(|n| n as usize);
                let all = cells.iter().fold(1usize, |all, n| all.saturating_mul(*n));
                let help = format!("give 1 or more along each axis, {MOST} in all at most");
                report.require((1..=MOST).contains(&all), "cells", "is not a valid number of cells", &help);
                let grading = grading.unwrap_or([1.0; 3]);
                let sound = grading.iter().all(|g| *g > 0.0);
                report.require(sound, "grading", "is not positive", "1 is uniform");
                Some(Size::Cells { cells, grading })
            }
            (None, None, None, None, Some(file)) => {
                Some(Size::File(MeshFile::read(&file, self.unit, "file", report)))
            }
            _ => {
                let help = "give one of nodes, spacing, level, cells and file, such as { level = 2 }";
                report.add("", Problem::new("is not one size").help(help));
                None
            }
        }
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

/// Largest number of nodes or cells. A larger matrix would not fit into the memory of a large machine.
const MOST: usize = 20_000_000;

/// Checks the number of nodes at the key `nodes`.
pub(super) fn count(n: u32, report: &Report) -> usize {
    let help = format!("give 4 to {MOST}");
    report.require((4..=MOST).contains(&(n as usize)), "nodes", "is not a valid number of nodes", &help);
    n as usize
}

/// Random displacement of the inner nodes
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct JitterKeys {
    /// Fraction of the cell size, below 0.5
    fraction: f64,
    seed: u64,
}

/// Random displacement of inner nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jitter {
    /// Largest displacement along each axis over the cell size.
    pub fraction: f64,
    /// Seed of the generator.
    pub seed: u64,
}

impl JitterKeys {
    pub fn read(self, report: &Report) -> Jitter {
        let JitterKeys { fraction, seed } = self;
        let sound = (0.0..0.5).contains(&fraction);
        report.require(
            sound,
            "jitter.fraction",
            "is not a valid fraction of the cell size",
            "give 0 to below 0.5",
        );
        Jitter { fraction, seed }
    }
}

words! {
    /// Treatment of the volume change: the integration points that share one dilation.
    pub enum Dilation {
        /// Each integration point has its own dilation.
        Standard = "standard",
        /// One per element (B-bar).
        ElementMean = "element-mean",
        /// One per node and material.
        NodalMean = "nodal-mean",
        /// One per node and material, over the points at which the node is among the four largest shape
        /// functions: fewer couplings for a cloud.
        NodalNear = "nodal-near",
        /// An independent pressure field in each material.
        Mixed = "mixed",
    }
}

words! {
    /// Distribution of the mass among the nodes.
    pub enum Mass {
        /// The integral of density and both shape functions, `M_IJ`.
        Consistent = "consistent",
        /// The integral at the points of the forces, which reduced integration may leave singular.
        AtPoints = "at-points",
        /// Diagonal, on the nodal parameters: row sums, or the scaled diagonal for quadratic elements.
        Lumped = "lumped",
        /// Lumped masses on the displacements of the nodes, which differ from a cloud's nodal parameters.
        Transformed = "transformed",
    }
}
