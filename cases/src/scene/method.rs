//! Methods of a scene: finite elements and element-free Galerkin, with all settings explicit.

use std::path::PathBuf;

use super::external::External;
use super::family::OverMesh;
use super::region::Region;
use super::words::words;

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
}

words! {
    /// Distribution of the mass among the nodes.
    pub enum Mass {
        /// The integral of density and both shape functions, `M_IJ`.
        Consistent = "consistent",
        /// Diagonal, on the nodal parameters: row sums, or the scaled diagonal for quadratic elements.
        Lumped = "lumped",
        /// Lumped masses on the displacements of the nodes, which differ from a cloud's nodal parameters.
        Transformed = "transformed",
    }
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
    /// Whether hex20 has 2 x 2 x 2 points instead of 3 x 3 x 3: avoids locking in combined bending and
    /// compression.
    pub reduced: bool,
    /// Size of the mesh.
    pub size: Size,
    /// Random displacement of inner nodes.
    pub jitter: Option<Jitter>,
}

/// Settings of an element-free Galerkin method.
#[derive(Clone, Debug, PartialEq)]
pub struct Efg {
    /// Nodes of the method.
    pub cloud: Cloud,
    /// Shape functions.
    pub functions: Functions,
    /// Integration rule.
    pub integration: Integration,
    /// Method of imposing prescribed displacements.
    pub essential: Essential,
    /// Treatment of the volume change.
    pub dilation: Dilation,
    /// Treatment of the borders of material regions by the shape functions.
    pub regions: Regions,
    /// Mesh of integration cells, if it differs from the mesh that supplies the nodes.
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
        /// Balls, or ellipsoids that follow the cells of the mesh that supplies the nodes.
        shape: SupportShape,
        /// Polynomial basis.
        basis: Basis,
    },
    /// Local maximum entropy: positive, exact on linear fields.
    MaximumEntropy {
        /// Locality `gamma = beta h^2`, dimensionless.
        gamma: f64,
    },
}

impl Functions {
    /// Default locality of maximum-entropy functions (Arroyo and Ortiz 2006 recommend 0.8 to 4).
    pub const GAMMA: f64 = 1.8;

    /// Name of the basis in files and tables.
    pub fn basis(&self) -> &'static str {
        match self {
            Functions::MovingLeastSquares { basis, .. } => basis.name(),
            Functions::MaximumEntropy { .. } => Entropy::Maximum.name(),
        }
    }
}

words! {
    /// Element types.
    pub enum Element {
        /// Linear tetrahedron.
        Tet4 = "tet4",
        /// Quadratic tetrahedron.
        Tet10 = "tet10",
        /// Trilinear hexahedron.
        Hex8 = "hex8",
        /// Quadratic serendipity hexahedron.
        Hex20 = "hex20",
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

/// A file of a mesh or of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Path; relative paths are resolved from the folder of the file that names it.
    pub path: PathBuf,
    /// Metres per unit of the numbers in the file.
    pub unit: f64,
    /// Whether pieces of the mesh are joined at faces that coincide.
    pub join: bool,
}

/// Refinement of a cloud by its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refine {
    /// Number of clouds after the first, which is uniform.
    pub steps: usize,
    /// Largest ratio of coarsest to finest spacing.
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
}

/// Rule for the support radius of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SupportRule {
    /// Factor times the local spacing.
    Scale(f64),
    /// Factor times the distance to the k-th neighbour.
    Neighbours {
        /// Number `k` of the neighbour.
        k: usize,
        /// Factor on its distance.
        factor: f64,
    },
}

words! {
    /// Shape of the support of a node.
    pub enum SupportShape {
        /// A ball; the default.
        Ball = "ball",
        /// An ellipsoid: a ball in the metric in which the cells around the node are isotropic. It follows
        /// the cells of the mesh whose nodes form the cloud.
        Ellipsoid = "ellipsoid",
    }
}

words! {
    /// Treatment of the borders of material regions by a cloud's shape functions.
    pub enum Regions {
        /// Shape functions reach across and smooth the jump of the strain; the default.
        Blended = "blended",
        /// Shape functions end at the border. Linear finite elements along it, coupled to the cloud, keep the
        /// displacement continuous.
        Separate = "separate",
    }
}

words! {
    /// Polynomial bases of moving least squares.
    pub enum Basis {
        /// Complete linear polynomials: 1, x, y, z.
        Linear = "linear",
        /// Complete quadratic polynomials: 10 terms.
        Quadratic = "quadratic",
    }
}

words! {
    /// Bases that are not polynomial.
    pub(crate) enum Entropy {
        /// Local maximum entropy: positive shape functions, exact on linear fields (Arroyo and Ortiz 2006).
        Maximum = "maximum-entropy",
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
    /// Gauss points in the cells of a grid, without the points outside the body.
    Grid {
        /// Points per cell, a cube number.
        points: usize,
        /// Edge length of a cell in metres; the mean node spacing if `None`.
        spacing: Option<f64>,
    },
    /// Conforming smoothing over the tetrahedra of the background mesh.
    CellSmoothed {
        /// Order of exactness: 1 for linear displacements (constant gradients per cell), 2 for quadratic ones
        /// (linear gradients).
        order: u32,
        /// Points per face: 1, 3 or 6.
        face_points: usize,
    },
    /// Smoothing over the quarters of the tetrahedra around each vertex of the background mesh.
    NodeSmoothed {
        /// Share of the weight that stays on the tetrahedra, from 0 to below 1.
        stabilisation: f64,
        /// Points per face: 1, 3 or 6.
        face_points: usize,
    },
}

/// Method of imposing prescribed displacements. A factor of `None` is the default of the method.
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
        /// Displacements prescribed by the rows.
        rows: ConstraintRows,
    },
    /// Finite elements along the constrained surface, coupled to the cloud; their nodes are constrained
    /// exactly.
    Coupling,
}

impl Essential {
    /// Kind of the condition, without its settings.
    pub fn kind(&self) -> EssentialKind {
        match self {
            Essential::Nitsche { .. } => EssentialKind::Nitsche,
            Essential::Penalty { .. } => EssentialKind::Penalty,
            Essential::Multipliers => EssentialKind::Multipliers,
            Essential::Elimination { .. } => EssentialKind::Elimination,
            Essential::Coupling => EssentialKind::Coupling,
        }
    }
}

words! {
    /// Ways to impose prescribed displacements on a cloud.
    pub enum EssentialKind {
        /// Nitsche's method: consistent and symmetric, with a stabilisation factor.
        Nitsche = "nitsche",
        /// Penalty, with a factor.
        Penalty = "penalty",
        /// Lagrange multipliers.
        Multipliers = "multipliers",
        /// Exact elimination of constraint rows.
        Elimination = "elimination",
        /// Linear finite elements along the constrained surface, coupled consistently to the cloud; their
        /// nodes are constrained exactly.
        Coupling = "coupling",
    }
}

words! {
    /// Displacements prescribed by the eliminated rows of a constrained surface, one row for each of its
    /// nodes.
    pub enum ConstraintRows {
        /// The mean displacement over the tributary area of the node; the default.
        Means = "means",
        /// The displacement at the point of the surface nearest to the node.
        Points = "points",
    }
}
