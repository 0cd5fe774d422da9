//! Shape functions of clouds: basis, kernel and supports.

use catalogue::{Problem, Values};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::report::Report;
use crate::scene::vocabulary::{Given, Kernels, Word, build, settings};
use crate::scene::words::words;

/// Keys of a method about its shape functions
#[derive(Deserialize, JsonSchema)]
pub(super) struct FunctionKeys {
    /// Kernel; not with basis = "maximum-entropy"
    kernel: Option<KernelKeys>,
    /// Support radius over the local spacing; give this, or neighbours and factor
    support_scale: Option<f64>,
    /// Support radius over the distance to this neighbour
    neighbours: Option<u32>,
    factor: Option<f64>,
    /// Shape of the supports: balls unless given, or ellipsoids that follow the cells of the mesh whose nodes
    /// form the cloud
    neighbourhood: Option<SupportShape>,
    basis: BasisKeys,
    /// Locality of maximum-entropy functions, 0.6 to 6; 1.8 unless given
    gamma: Option<f64>,
}

/// Basis of the shape functions
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum BasisKeys {
    Polynomial(Basis),
    Entropy(Entropy),
}

/// A kernel by name, or a table with its parameters
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum KernelKeys {
    Name(Word<Kernels>),
    Table(KernelTable),
}

#[derive(Deserialize, JsonSchema)]
struct KernelTable {
    name: Word<Kernels>,
    #[serde(flatten)]
    settings: Given<Kernels>,
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

    /// Whether the functions are those of moving least squares with a linear basis.
    pub(super) fn have_linear_basis(&self) -> bool {
        matches!(self, Functions::MovingLeastSquares { basis: Basis::Linear, .. })
    }

    /// Name of the basis in files and tables.
    pub fn basis(&self) -> &'static str {
        match self {
            Functions::MovingLeastSquares { basis, .. } => basis.name(),
            Functions::MaximumEntropy { .. } => Entropy::Maximum.name(),
        }
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
    enum Entropy {
        /// Local maximum entropy: positive shape functions, exact on linear fields (Arroyo and Ortiz 2006).
        Maximum = "maximum-entropy",
    }
}

impl FunctionKeys {
    /// Reads the functions of a cloud. `has_cells` says whether its nodes are the nodes of cells.
    pub fn read(self, has_cells: bool, report: &Report) -> Option<Functions> {
        let (problem, help) = (
            "follows the cells around each node, but the nodes of this cloud have no cells",
            "take the nodes of a mesh: size = { level = 2 }",
        );
        let sound = has_cells || self.neighbourhood != Some(SupportShape::Ellipsoid);
        report.require(sound, "neighbourhood", problem, help);
        let basis = match self.basis {
            BasisKeys::Polynomial(basis) => basis,
            BasisKeys::Entropy(Entropy::Maximum) => return Some(self.maximum_entropy(report)),
        };
        let problem = "applies to basis = \"maximum-entropy\" only";
        report.require(self.gamma.is_none(), "gamma", problem, "leave it out");
        let shape = self.neighbourhood.unwrap_or(SupportShape::Ball);
        let support = self.support(basis, report);
        let Some(kernel) = self.kernel else {
            report.missing("kernel", "give kernel = \"cubic-spline\", or basis = \"maximum-entropy\"");
            return None;
        };
        let kernel = kernel.read(&report.at("kernel"));
        Some(Functions::MovingLeastSquares { kernel: kernel?, support: support?, shape, basis })
    }

    fn maximum_entropy(&self, report: &Report) -> Functions {
        for (key, given) in [
            ("kernel", self.kernel.is_some()),
            ("support_scale", self.support_scale.is_some()),
            ("neighbours", self.neighbours.is_some()),
            ("factor", self.factor.is_some()),
            ("neighbourhood", self.neighbourhood.is_some()),
        ] {
            let problem = "can't be combined with basis = \"maximum-entropy\"";
            report.require(!given, key, problem, "leave it out: gamma determines the support of the nodes");
        }
        let gamma = self.gamma.unwrap_or(Functions::GAMMA);
        let help =
            "0.8 to 4 is usual: smaller values give long rows, larger values approach linear interpolation";
        report.require((0.6..=6.0).contains(&gamma), "gamma", "is not a valid locality", help);
        Functions::MaximumEntropy { gamma }
    }

    fn support(&self, basis: Basis, report: &Report) -> Option<SupportRule> {
        let stray = self.factor.is_some() && self.neighbours.is_none();
        report.require(!stray, "factor", "applies to neighbours only", "leave it out");
        match (self.support_scale, self.neighbours) {
            (Some(d), None) => {
                let sound = (1.0..=10.0).contains(&d);
                report.require(sound, "support_scale", "is not a valid support scale", "1.2 to 3 is usual");
                Some(SupportRule::Scale(d))
            }
            (None, Some(k)) => {
                let factor = self.factor.unwrap_or(1.2);
                let sound = (1.0..=10.0).contains(&factor);
                report.require(sound, "factor", "is not a valid factor", "1.1 to 1.6 is usual");
                let least = match basis {
                    Basis::Linear => 4,
                    Basis::Quadratic => 10,
                };
                let basis = basis.name();
                let help =
                    format!("a {basis} basis needs at least {least}, and preferably three times as many");
                report.require(k >= least, "neighbours", "are too few", &help);
                Some(SupportRule::Neighbours { k: k as usize, factor })
            }
            (Some(_), Some(_)) => {
                let help = "give support_scale, or neighbours and factor, not both";
                report.add("neighbours", Problem::new("can't be combined with support_scale").help(help));
                None
            }
            (None, None) => {
                let help = "give support_scale = 1.6, or neighbours = 15 and factor = 1.2";
                report.missing("support_scale", help);
                None
            }
        }
    }
}

impl KernelKeys {
    fn read(self, report: &Report) -> Option<efg::Kernel> {
        let (word, values) = match self {
            KernelKeys::Name(word) => {
                let values = Values::new(word.0.parameters);
                (word, values)
            }
            KernelKeys::Table(keys) => {
                let values = settings(&keys.name, keys.settings, report)?;
                (keys.name, values)
            }
        };
        build(word.0, &values, "", report)
    }
}
