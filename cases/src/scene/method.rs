//! Methods of a scene: finite elements and element-free Galerkin, every setting stated.

use std::path::PathBuf;

use super::external::External;
use super::family::OverMesh;
use super::region::Region;
use super::words::words;

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

words! {
    /// How mass is distributed among the nodes.
    pub enum Mass {
        /// The integral of density and both shape functions, `M_IJ`.
        Consistent = "consistent",
        /// Diagonal, on the nodal parameters: row sums; for quadratic elements the scaled diagonal.
        Lumped = "lumped",
        /// The lumped masses on the displacements of the nodes, which a cloud's parameters are not.
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
    /// A solver outside this program.
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
    /// Whether shape functions reach across the borders of material regions.
    pub regions: Regions,
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
    /// Treatment of the volume change: which integration points share one dilation.
    pub enum Dilation {
        /// Each point has its own.
        Standard = "standard",
        /// One per element (B-bar).
        ElementMean = "element-mean",
        /// One per node and material.
        NodalMean = "nodal-mean",
        /// One per node and material, of the points at which it is among the four that count most: of a cloud
        /// fewer couplings.
        NodalNear = "nodal-near",
        /// An independent pressure field in each material.
        Mixed = "mixed",
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
    /// A mesh file.
    File(MeshFile),
}

/// A file of a mesh or of positions.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Path, relative ones taken from the folder of the file that names it.
    pub path: PathBuf,
    /// Metres per unit of its numbers.
    pub unit: f64,
    /// Whether pieces of the mesh are joined where their faces coincide.
    pub join: bool,
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
        /// Lines of x, y, z, or a mesh file.
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

words! {
    /// Shape of the support of a node.
    pub enum SupportShape {
        /// A ball; used unless given.
        Ball = "ball",
        /// An ellipsoid: a ball in the metric in which the cells around the node are isotropic. It follows the cells of the mesh
        /// whose nodes form the cloud.
        Ellipsoid = "ellipsoid",
    }
}

words! {
    /// What shape functions of a cloud do at the borders of material regions.
    pub enum Regions {
        /// They reach across and smooth the jump of the strain; used unless given.
        Blended = "blended",
        /// They end there: linear finite elements along the border, coupled to the cloud, keep the displacement continuous.
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

impl Essential {
    /// Which of them it is.
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
        /// Linear finite elements along the constrained surface, coupled consistently to the cloud; their nodes are constrained
        /// exactly.
        Coupling = "coupling",
    }
}

words! {
    /// What the eliminated rows of a constrained surface prescribe, one row for each of its nodes.
    pub enum ConstraintRows {
        /// The mean displacement over the tributary area of the node; used unless given.
        Means = "means",
        /// The displacement at the point of the surface nearest to the node.
        Points = "points",
    }
}
