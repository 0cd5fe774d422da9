//! Methods of a scene: finite elements and element-free Galerkin, every setting stated.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::family::OverMesh;
use super::region::Region;

/// A way to solve the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    /// Unique within the scene.
    pub id: String,
    /// Name shared with the methods that differ from it in size only: in reports they are one curve.
    pub series: String,
    /// Its family and settings.
    pub family: Family,
    /// What moves in vibrations (`kind = "modes"`, which needs one).
    pub mass: Option<Mass>,
}

/// How mass is shared out among nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Mass {
    /// `M_IJ`, the integral of density and both shape functions.
    Consistent,
    /// Diagonal, on the nodal parameters: row sums, of quadratic elements the scaled diagonal.
    Lumped,
    /// The same masses on the displacements of the nodes, which a cloud's parameters are not.
    Transformed,
}

impl Mass {
    /// All, in the order they are listed.
    pub const ALL: [Mass; 3] = [Mass::Consistent, Mass::Lumped, Mass::Transformed];

    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Mass::Consistent => "consistent",
            Mass::Lumped => "lumped",
            Mass::Transformed => "transformed",
        }
    }
}

/// Family of a method.
#[derive(Clone, Debug, PartialEq)]
pub enum Family {
    /// Finite elements.
    Fem(Fem),
    /// Element-free Galerkin.
    Efg(Efg),
    /// Another family over a mesh.
    OverMesh(OverMesh),
}

/// Settings of a finite element method.
#[derive(Clone, Debug, PartialEq)]
pub struct Fem {
    /// Element type.
    pub element: Element,
    /// Treatment of the volume change.
    pub dilation: Dilation,
    /// Hex20 with 2 x 2 x 2 points for 3 x 3 x 3: does not lock where there is bending and compression at once.
    pub reduced: bool,
    /// How fine.
    pub size: Size,
    /// Random displacement of inner nodes.
    pub jitter: Option<Jitter>,
}

/// Settings of an element-free Galerkin method.
#[derive(Clone, Debug, PartialEq)]
pub struct Efg {
    /// Where the nodes are.
    pub cloud: Cloud,
    /// Shape functions.
    pub functions: Functions,
    /// Integration rule.
    pub integration: Integration,
    /// How prescribed displacements are imposed.
    pub essential: Essential,
    /// Treatment of the volume change.
    pub dilation: Dilation,
    /// Mesh to integrate over, where it is not the one the cloud is taken from.
    pub background: Option<Size>,
}

/// Shape functions of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Functions {
    /// Moving least squares.
    MovingLeastSquares {
        /// Kernel and its parameters.
        kernel: efg::Kernel,
        /// Support radius.
        support: SupportRule,
        /// Balls, or ellipsoids that follow the cells of the mesh the cloud is taken from.
        shape: SupportShape,
        /// Polynomial basis.
        basis: Basis,
    },
    /// Local maximum entropy: positive, exact on linear fields.
    MaximumEntropy {
        /// Locality: `beta h^2`.
        gamma: f64,
    },
}

impl Functions {
    /// Locality of maximum-entropy functions unless a scene gives one (Arroyo and Ortiz 2006 find 0.8 to 4 sound).
    pub const GAMMA: f64 = 1.8;

    /// Name of the basis in files and tables.
    pub fn basis(&self) -> &'static str {
        match self {
            Functions::MovingLeastSquares { basis, .. } => basis.name(),
            Functions::MaximumEntropy { .. } => "maximum-entropy",
        }
    }
}

/// Element types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)] // the names are the field's words
pub enum Element {
    Tet4,
    Tet10,
    Hex8,
    Hex20,
}

impl Element {
    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Element::Tet4 => "tet4",
            Element::Tet10 => "tet10",
            Element::Hex8 => "hex8",
            Element::Hex20 => "hex20",
        }
    }
}

/// Treatment of the volume change: which integration points share one dilation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Dilation {
    /// Each point its own.
    Standard,
    /// One per element (B-bar).
    ElementMean,
    /// One per node.
    NodalMean,
    /// An independent pressure field.
    Mixed,
}

impl Dilation {
    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Dilation::Standard => "standard",
            Dilation::ElementMean => "element-mean",
            Dilation::NodalMean => "nodal-mean",
            Dilation::Mixed => "mixed",
        }
    }
}

/// How fine a mesh or cloud is.
#[derive(Clone, Debug, PartialEq)]
pub enum Size {
    /// About this many nodes.
    Nodes(usize),
    /// Mean edge length in metres.
    Spacing(f64),
    /// Level of a family of meshes, from 1; each is twice as fine as the one before.
    Level(u32),
    /// Cells along the axes of a structured mesh.
    Cells {
        /// Number along x, y, z.
        cells: [usize; 3],
        /// Ratio of the last to the first cell along x, y, z; 1 is uniform.
        grading: [f64; 3],
    },
    /// A Gmsh file.
    File(MeshFile),
}

/// A file of a mesh or of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Path, relative ones taken from the folder of the file that names it.
    pub path: PathBuf,
    /// Metres per unit of its numbers.
    pub unit: f64,
}

/// A cloud that follows an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refine {
    /// Clouds after the first, which is uniform.
    pub steps: usize,
    /// Coarsest over finest spacing at most.
    pub ratio: f64,
}

/// Random displacement of inner nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jitter {
    /// Largest displacement along each axis over the cell size.
    pub fraction: f64,
    /// Seed of the generator.
    pub seed: u64,
}

/// Where the nodes of a cloud are.
#[derive(Clone, Debug, PartialEq)]
pub enum Cloud {
    /// The nodes of a mesh.
    Mesh {
        /// Size of the mesh.
        size: Size,
        /// Random displacement of inner nodes.
        jitter: Option<Jitter>,
    },
    /// Quasi-uniform, of an exact count.
    Uniform {
        /// Number of nodes.
        nodes: usize,
        /// Seed of the generator.
        seed: u64,
    },
    /// The nodes of a file.
    File {
        /// Lines of x, y, z, or a Gmsh file.
        file: MeshFile,
        /// How many nodes the scene says it has.
        nodes: Option<usize>,
    },
    /// Denser where the gradients of the solution before differ most from recovered ones, of an exact count.
    Refined {
        /// Number of nodes.
        nodes: usize,
        /// Seed of the generator.
        seed: u64,
        /// How often.
        refine: Refine,
    },
    /// Denser towards a region, of an exact count.
    Graded {
        /// Number of nodes.
        nodes: usize,
        /// Seed of the generator.
        seed: u64,
        /// The region it is denser in.
        towards: Region,
    },
}

impl Method {
    /// The method on a cloud of another seed, if chance has a part in its cloud.
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
}

/// How the support radius of a node is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SupportRule {
    /// This factor times the local spacing.
    Scale(f64),
    /// This factor times the distance to the k-th neighbour.
    Neighbours {
        /// Which neighbour.
        k: usize,
        /// Factor on its distance.
        factor: f64,
    },
}

/// What a node's support looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SupportShape {
    /// A ball.
    #[default]
    Ball,
    /// An ellipsoid: a ball in the metric in which the cells around the node are isotropic.
    Ellipsoid,
}

impl SupportShape {
    /// Both, in the order they are listed.
    pub const ALL: [SupportShape; 2] = [SupportShape::Ball, SupportShape::Ellipsoid];

    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            SupportShape::Ball => "ball",
            SupportShape::Ellipsoid => "ellipsoid",
        }
    }
}

/// Polynomial bases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names are the field's words
pub enum Basis {
    Linear,
    Quadratic,
}

impl Basis {
    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Basis::Linear => "linear",
            Basis::Quadratic => "quadratic",
        }
    }
}

/// Integration rules of element-free Galerkin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integration {
    /// Gauss points in the cells of the background mesh.
    Gauss {
        /// Points per cell.
        points: usize,
    },
    /// Gauss points in the cells of a grid, those outside the body left out.
    Grid {
        /// Points per cell, a cube number.
        points: usize,
        /// Edge of a cell in metres; the mean node spacing unless given.
        spacing: Option<f64>,
    },
    /// Conforming smoothing over the tetrahedra of the background mesh.
    CellSmoothed {
        /// Displacements it is exact for: 1 linear (constant gradients per cell), 2 quadratic (linear gradients).
        order: u32,
        /// Points per face: 1, 3 or 6.
        face_points: usize,
    },
    /// Smoothing over the quarters of the tetrahedra around each vertex of the background mesh.
    NodeSmoothed {
        /// Share of the weight that the tetrahedra keep, from 0 to below 1.
        stabilisation: f64,
        /// Points per face: 1, 3 or 6.
        face_points: usize,
    },
}

/// How prescribed displacements are imposed; a factor left out takes the default of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Essential {
    /// Nitsche's method.
    Nitsche {
        /// Stabilisation factor.
        factor: Option<f64>,
    },
    /// Penalty.
    Penalty {
        /// Penalty factor.
        factor: Option<f64>,
    },
    /// Lagrange multipliers.
    Multipliers,
    /// Exact elimination of constraint rows.
    Elimination {
        /// What the rows say.
        rows: ConstraintRows,
    },
    /// Finite elements along what is held, coupled to the cloud; their nodes are held exactly.
    Coupling,
}

/// What the eliminated rows of a held surface say, one for each node whose share of the surface this is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ConstraintRows {
    /// The mean displacement over the share is the prescribed one's.
    Means,
    /// The displacement at the point of the surface nearest to the node is the prescribed one.
    Points,
}

impl ConstraintRows {
    /// The name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            ConstraintRows::Means => "means",
            ConstraintRows::Points => "points",
        }
    }
}
