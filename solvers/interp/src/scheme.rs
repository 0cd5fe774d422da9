//! The schemes as values: what a scene file names and a study sweeps.

use efg::{Basis, Support};
use geometry::Mesh;
use shape::{GradRows, Point3, PointRows};

use crate::{InterpError, Radial, TransferInfo};

/// A transfer scheme with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scheme {
    /// [`crate::nearest`].
    Nearest,
    /// [`crate::inverse_distance`].
    InverseDistance {
        /// How many nearest nodes count.
        neighbours: usize,
        /// Power `p` of the distance.
        power: f64,
    },
    /// [`crate::shepard`].
    Shepard {
        /// Support radius over mean spacing.
        dilatation: f64,
    },
    /// [`crate::mls`] with the linear basis.
    MlsLinear {
        /// Support radius over mean spacing.
        dilatation: f64,
    },
    /// [`crate::mls`] with the quadratic basis.
    MlsQuadratic {
        /// Support radius over mean spacing.
        dilatation: f64,
    },
    /// [`crate::mls_modified`].
    MlsModified {
        /// Support radius over mean spacing.
        dilatation: f64,
    },
    /// [`crate::radial`].
    Radial(Radial),
    /// [`crate::natural_neighbour`].
    NaturalNeighbour,
    /// [`crate::barycentric`].
    Barycentric,
}

impl Scheme {
    /// Every scheme, in the order tables list them; parameters as in the transfer study of the kidney.
    pub const ALL: [Scheme; 13] = [
        Scheme::Nearest,
        Scheme::InverseDistance { neighbours: 4, power: 2.0 },
        Scheme::Shepard { dilatation: 1.6 },
        Scheme::MlsLinear { dilatation: 1.6 },
        Scheme::MlsQuadratic { dilatation: 2.5 },
        Scheme::MlsModified { dilatation: 2.0 },
        Scheme::Radial(Radial::ThinPlate),
        Scheme::Radial(Radial::Cubic),
        Scheme::Radial(Radial::Multiquadric { shape: 1.0 }),
        Scheme::Radial(Radial::Gaussian { shape: 1.5, polynomial: true }),
        Scheme::Radial(Radial::WendlandC2 { support: 4.0, polynomial: true }),
        Scheme::NaturalNeighbour,
        Scheme::Barycentric,
    ];

    /// The name used in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Scheme::Nearest => "nearest",
            Scheme::InverseDistance { .. } => "inverse-distance",
            Scheme::Shepard { .. } => "shepard",
            Scheme::MlsLinear { .. } => "mls-linear",
            Scheme::MlsQuadratic { .. } => "mls-quadratic",
            Scheme::MlsModified { .. } => "mls-modified",
            Scheme::Radial(radial) => radial.name(),
            Scheme::NaturalNeighbour => "natural-neighbour",
            Scheme::Barycentric => "barycentric",
        }
    }

    /// The scheme of that name with the parameters of [`Scheme::ALL`].
    pub fn from_name(name: &str) -> Option<Scheme> {
        Scheme::ALL.into_iter().find(|scheme| scheme.name() == name)
    }

    /// Degree of the polynomials it transfers exactly: 0, 1 or 2; none if not even constants.
    pub fn exact_degree(self) -> Option<usize> {
        match self {
            Scheme::Nearest | Scheme::InverseDistance { .. } | Scheme::Shepard { .. } => Some(0),
            Scheme::Radial(radial) => radial.polynomial().then_some(1),
            Scheme::MlsLinear { .. }
            | Scheme::MlsModified { .. }
            | Scheme::NaturalNeighbour
            | Scheme::Barycentric => Some(1),
            Scheme::MlsQuadratic { .. } => Some(2),
        }
    }

    /// True if a target at a node gets that node's value.
    pub fn interpolates(self) -> bool {
        !matches!(
            self,
            Scheme::Shepard { .. }
                | Scheme::MlsLinear { .. }
                | Scheme::MlsQuadratic { .. }
                | Scheme::MlsModified { .. }
        )
    }

    /// The table from `nodes` to `targets` (m). Only [`Scheme::Barycentric`] reads `mesh`, whose points
    /// `nodes` must be.
    pub fn rows(
        self,
        nodes: &[Point3],
        mesh: Option<&Mesh>,
        targets: &[Point3],
    ) -> Result<(PointRows, TransferInfo), InterpError> {
        let plain = |rows: PointRows| (rows, TransferInfo::default());
        let by = |factor: f64| Support::Dilatation { factor };
        match self {
            Scheme::Nearest => crate::nearest(nodes, targets).map(plain),
            Scheme::InverseDistance { neighbours, power } => {
                crate::inverse_distance(nodes, neighbours, power, targets).map(plain)
            }
            Scheme::Shepard { dilatation } => crate::shepard(nodes, by(dilatation), targets),
            Scheme::MlsLinear { dilatation } => crate::mls(nodes, Basis::Linear, by(dilatation), targets),
            Scheme::MlsQuadratic { dilatation } => {
                crate::mls(nodes, Basis::Quadratic, by(dilatation), targets)
            }
            Scheme::MlsModified { dilatation } => crate::mls_modified(nodes, by(dilatation), targets),
            Scheme::Radial(radial) => crate::radial(nodes, radial, targets).map(plain),
            Scheme::NaturalNeighbour => crate::natural_neighbour(nodes, targets),
            Scheme::Barycentric => crate::barycentric(self.mesh_of(nodes, mesh)?, targets),
        }
    }

    /// The table with gradients (1/m) of its rows, for strain and stress at `targets` (m): moving least squares, radial bases
    /// and barycentric interpolation (constant in every tetrahedron) have them in closed form; the others have none, or
    /// none at the nodes, and say so.
    pub fn grad_rows(
        self,
        nodes: &[Point3],
        mesh: Option<&Mesh>,
        targets: &[Point3],
    ) -> Result<(GradRows, TransferInfo), InterpError> {
        let by = |factor: f64| Support::Dilatation { factor };
        match self {
            Scheme::MlsLinear { dilatation } => {
                crate::mls_gradients(nodes, Basis::Linear, by(dilatation), targets)
            }
            Scheme::MlsQuadratic { dilatation } => {
                crate::mls_gradients(nodes, Basis::Quadratic, by(dilatation), targets)
            }
            Scheme::MlsModified { dilatation } => {
                crate::mls_modified_gradients(nodes, by(dilatation), targets)
            }
            Scheme::Radial(radial) => {
                Ok((crate::radial_gradients(nodes, radial, targets)?, TransferInfo::default()))
            }
            Scheme::Barycentric => crate::barycentric_gradients(self.mesh_of(nodes, mesh)?, targets),
            Scheme::Nearest
            | Scheme::InverseDistance { .. }
            | Scheme::Shepard { .. }
            | Scheme::NaturalNeighbour => Err(InterpError::NoGradient { scheme: self.name() }),
        }
    }

    /// The mesh, if there is one over these nodes.
    fn mesh_of<'a>(self, nodes: &[Point3], mesh: Option<&'a Mesh>) -> Result<&'a Mesh, InterpError> {
        let mesh = mesh.ok_or(InterpError::NeedsMesh { scheme: self.name() })?;
        let points = mesh.points();
        if points != nodes {
            let first = points.iter().zip(nodes).take_while(|(a, b)| a == b).count();
            return Err(InterpError::MeshMismatch { mesh: points.len(), nodes: nodes.len(), first });
        }
        Ok(mesh)
    }
}
