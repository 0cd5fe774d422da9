use shape::ShapeError;

/// Reason why a table cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FemError {
    /// A cell is inverted or degenerate at one of the requested points.
    #[error(
        "cell {element} is inverted or degenerate: det J = {det_j:e} m^3 at one of its points (must be > 0)"
    )]
    InvertedElement {
        /// Cell index.
        element: usize,
        /// Determinant of the Jacobian `dx/dxi`, m^3.
        det_j: f64,
    },
    /// A facet has no area at one of its points.
    #[error("face {face} of cell {cell} has no area: |dx/ds x dx/dt| = {area:e} m^2 at one of its points")]
    FlatFacet {
        /// Cell index.
        cell: u32,
        /// Face index.
        face: u8,
        /// Norm of the cross product of the tangents, m^2.
        area: f64,
    },
    /// The mesh does not have the facet.
    #[error("face {face} of cell {cell} does not exist (the mesh has {cells} cells)")]
    NoSuchFacet {
        /// Cell index.
        cell: u32,
        /// Face index.
        face: u8,
        /// Number of cells.
        cells: usize,
    },
    /// There is no rule with that number of points.
    #[error("there is no quadrature rule of {points} {counted} for {kind}; available: {known}")]
    NoRule {
        /// Cell or face kind.
        kind: &'static str,
        /// Requested number.
        points: usize,
        /// Meaning of the number: points in all, or points along each axis.
        counted: &'static str,
        /// Available numbers.
        known: String,
    },
    /// A point has a coordinate that is not finite.
    #[error("point {point} has a coordinate that is not finite")]
    NotFinite {
        /// Index into the requested points.
        point: usize,
    },
    /// No cell contains the point.
    #[error(
        "point {point} at {} lies outside the mesh, {} from its surface",
        shape::position_alone(&(*position).into()), shape::length(*distance)
    )]
    Outside {
        /// Index into the requested points.
        point: usize,
        /// Position of the point, m.
        position: [f64; 3],
        /// Distance to the nearest point of the mesh surface, m.
        distance: f64,
    },
    /// A table fails its own checks.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
