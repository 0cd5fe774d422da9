//! Errors of clouds, supports and backgrounds. Lengths are in metres.

use geometry::{CellKind, CloudError, LocateError};
use shape::{Point3, ShapeError};

/// Reason why an approximation or its integration is impossible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EfgError {
    /// Two lists that must have the same length.
    #[error("{what}: {found} given, {expected} are needed (one per node)")]
    Length {
        /// Name of the list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Required length.
        expected: usize,
    },
    /// A cloud with fewer nodes than the basis has terms.
    #[error("the cloud has {found} nodes; the basis needs at least {needed}")]
    TooFewNodes {
        /// Nodes in the cloud.
        found: usize,
        /// Terms of the basis.
        needed: usize,
    },
    /// A node whose coordinates are not finite.
    #[error("node {node} has a coordinate that is not finite")]
    NotFinite {
        /// Node index.
        node: usize,
    },
    /// A support radius that is not a positive number.
    #[error("node {node} has support radius {radius:e} m; a positive one is needed")]
    BadRadius {
        /// Node index.
        node: usize,
        /// Its radius, m.
        radius: f64,
    },
    /// A node without cells, or with flat cells.
    #[error(
        "node {node} has no adjacent cell with a volume; an ellipsoidal support is computed from the adjacent cells"
    )]
    FlatCells {
        /// Node index.
        node: usize,
    },
    /// A parameter outside its range.
    #[error("{what} is {value}; {allowed} is needed")]
    BadParameter {
        /// Name of the parameter.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Description of the allowed values.
        allowed: &'static str,
    },
    /// A point covered by too few nodes, even with the largest allowed enlargement of supports.
    #[error(
        "point {} has {found} neighbours even with supports enlarged {enlargement:.2} \
         times; {needed} are needed",
        shape::position_alone(point)
    )]
    TooFewNeighbours {
        /// Position, m.
        point: Point3,
        /// Number of neighbours found.
        found: usize,
        /// Number of terms of the requested basis.
        needed: usize,
        /// Factor on the support radii at which the neighbours were counted.
        enlargement: f64,
    },
    /// A point whose neighbours do not span the basis (for example because they lie in one plane), even after
    /// all remedies.
    #[error(
        "the {found} neighbours of point {} do not span the linear basis, even with \
         supports enlarged {enlargement:.2} times (do the neighbours lie in one plane?); the requested basis \
         has {needed} terms",
        shape::position_alone(point)
    )]
    SingularMoment {
        /// Position, m.
        point: Point3,
        /// Number of neighbours found.
        found: usize,
        /// Number of terms of the requested basis.
        needed: usize,
        /// Factor on the support radii at the last attempt.
        enlargement: f64,
    },
    /// A point outside the convex hull of its neighbours, at which no positive functions reproduce linear
    /// fields.
    #[error(
        "point {} lies outside the convex hull of its {found} neighbours: after \
         {iterations} Newton steps the weighted mean of the neighbours is still {gap:e} m away \
         (maximum-entropy functions are positive and cannot extrapolate)",
        shape::position_alone(point)
    )]
    OutsideHull {
        /// Position, m.
        point: Point3,
        /// Number of neighbours found.
        found: usize,
        /// Smallest distance (m), over all Newton steps, between the point and the weighted mean of its
        /// neighbours.
        gap: f64,
        /// Largest number of Newton steps, after which the search is given up.
        iterations: usize,
    },
    /// A cell kind that the integration does not support.
    #[error("cell {cell} is a {}; {what} takes {allowed}", kind.name())]
    CellKind {
        /// Cell index.
        cell: usize,
        /// Its kind.
        kind: CellKind,
        /// Integration that refuses the cell.
        what: &'static str,
        /// Supported kinds.
        allowed: &'static str,
    },
    /// A background cell without positive volume at an integration point.
    #[error("background cell {cell} is inverted or flat: det J = {det_j:e} m^3")]
    InvertedCell {
        /// Cell index.
        cell: usize,
        /// Jacobian determinant of the map from the reference cell, m^3.
        det_j: f64,
    },
    /// A facet with no area.
    #[error("face {face} of background cell {cell} has no area")]
    FlatFacet {
        /// Cell index.
        cell: u32,
        /// Face index.
        face: u8,
    },
    /// A number of points for which there is no rule.
    #[error("there is no {what} rule with {points} points; available: {offered}")]
    NoRule {
        /// Shape of the cell or face.
        what: &'static str,
        /// Requested number of points.
        points: usize,
        /// Available numbers of points.
        offered: &'static str,
    },
    /// A grid without a point in the body.
    #[error(
        "none of the {points} grid points lies in the body; the grid spacing {spacing:e} m is too coarse"
    )]
    EmptyGrid {
        /// Number of grid points tested.
        points: usize,
        /// Requested grid spacing, m.
        spacing: f64,
    },
    /// A grid with too many points.
    #[error("a grid spacing of {spacing:e} m gives {points:e} points; at most {limit:e} are allowed")]
    HugeGrid {
        /// Number of grid points that would be needed.
        points: f64,
        /// Requested grid spacing, m.
        spacing: f64,
        /// Largest allowed number of points.
        limit: f64,
    },
    /// Shape functions that cannot be coupled to finite elements.
    #[error("only moving least squares with the linear basis can be coupled to finite elements")]
    NotCoupled,
    /// An invalid list of finite-element nodes.
    #[error(
        "vertex {vertex} of the background mesh cannot be a finite-element node: the mesh has {count} \
         vertices, and the list must be ascending without repetition"
    )]
    BadVertex {
        /// The vertex.
        vertex: u32,
        /// Number of vertices of the background.
        count: usize,
    },
    /// Cells or points that cannot be located.
    #[error(transparent)]
    Locate(#[from] LocateError),
    /// The nodes of a pressure field do not make a cloud.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// A table that violates its own conditions.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
