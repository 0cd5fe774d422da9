//! The interface of all schemes.

use catalogue::{Dimension, Parameter, Range};
use efg::Support;
use geometry::Mesh;
use shape::{GradRows, Point3, PointRows};

use crate::error::InterpError;

/// Counts of special cases of a transfer; none of them is an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TransferInfo {
    /// Number of extrapolated targets, outside the mesh (barycentric) or outside the convex hull of the nodes
    /// (natural neighbour). Other schemes always report 0.
    pub outside: usize,
    /// Number of targets for which the plain formula was replaced: by an enlarged support (Shepard, moving
    /// least squares), by a regularised or reduced basis (moving least squares), or by a linear field fitted
    /// to the natural neighbours, because rounding spoilt the Voronoi volumes (natural neighbour).
    pub fallbacks: usize,
}

/// Source of a field: its nodes, and the mesh of the nodes if there is a mesh.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    /// Node positions, m.
    pub nodes: &'a [Point3],
    pub(crate) mesh: Option<&'a Mesh>,
}

impl<'a> Source<'a> {
    /// Returns the mesh, or an error if there is none or if its points differ from the nodes.
    pub fn mesh(self, scheme: &'static str) -> Result<&'a Mesh, InterpError> {
        let mesh = self.mesh.ok_or(InterpError::NeedsMesh { scheme })?;
        let points = mesh.points();
        if points != self.nodes {
            let first = points.iter().zip(self.nodes).take_while(|(a, b)| a == b).count();
            return Err(InterpError::MeshMismatch { mesh: points.len(), nodes: self.nodes.len(), first });
        }
        Ok(mesh)
    }
}

/// Behaviour of a scheme.
pub(crate) trait Transfer {
    /// Returns the name of the entry.
    fn name(&self) -> &'static str;

    /// Degree of the polynomials that are transferred exactly; `None` if not even constants are.
    fn exact_degree(&self) -> Option<usize>;

    /// Whether a target at a node takes that node's value.
    fn interpolates(&self) -> bool;

    /// Builds the table from the nodes to `targets` (m).
    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError>;

    /// Builds the table with gradients (1/m), or returns an error if there are none in closed form.
    fn grad_rows(&self, _: Source, _: &[Point3]) -> Result<(GradRows, TransferInfo), InterpError> {
        Err(InterpError::NoGradient { scheme: self.name() })
    }
}

/// Returns the rule of support radii that are a multiple of the mean spacing.
pub(crate) fn scaled(factor: f64) -> Support {
    Support::Dilatation { factor }
}

/// Returns the parameter of this multiple.
pub(crate) const fn support_scale(default: f64) -> Parameter {
    Parameter::default(
        "support_scale",
        Dimension::None,
        default,
        "ratio of support radius to mean node spacing",
    )
    .within(Range::Positive)
}
