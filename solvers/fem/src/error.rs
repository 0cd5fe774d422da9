use shape::ShapeError;

/// What keeps a table from being built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FemError {
    /// A cell that is turned inside out or flat at one of the points asked for.
    #[error(
        "cell {element} is inverted or degenerate: det J = {det_j:e} m^3 at one of its points (must be > 0)"
    )]
    InvertedElement {
        /// Cell index.
        element: usize,
        /// Determinant of the Jacobian `dx/dxi`, m^3.
        det_j: f64,
    },
    /// A facet without area at one of its points.
    #[error("face {face} of cell {cell} has no area: |dx/ds x dx/dt| = {area:e} m^2 at one of its points")]
    FlatFacet {
        /// Cell index.
        cell: u32,
        /// Face index.
        face: u8,
        /// Norm of the cross product of the tangents, m^2.
        area: f64,
    },
    /// A facet that the mesh does not have.
    #[error("face {face} of cell {cell} does not exist (the mesh has {cells} cells)")]
    NoSuchFacet {
        /// Cell index.
        cell: u32,
        /// Face index.
        face: u8,
        /// Number of cells.
        cells: usize,
    },
    /// A number of points for which there is no rule.
    #[error("no quadrature rule of {points} {counted} for {kind}; there are {known}")]
    NoRule {
        /// Cell or face kind.
        kind: &'static str,
        /// The number asked for.
        points: usize,
        /// What the number counts: points in all, or points along each axis.
        counted: &'static str,
        /// The numbers there are.
        known: String,
    },
    /// A point with a coordinate that is not a finite number.
    #[error("point {point} has a coordinate that is not finite")]
    NotFinite {
        /// Index into the points asked for.
        point: usize,
    },
    /// A point that no cell contains.
    #[error(
        "point {point} at ({:e}, {:e}, {:e}) m lies outside the mesh, {distance:e} m from its surface",
        position[0], position[1], position[2]
    )]
    Outside {
        /// Index into the points asked for.
        point: usize,
        /// Its position, m.
        position: [f64; 3],
        /// Distance to the nearest point of the mesh surface, m.
        distance: f64,
    },
    /// A table that fails its own checks.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
