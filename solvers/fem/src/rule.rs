//! Quadrature of each kind of cell and face, by name or by number of points.

use geometry::quadrature::{self, Parts, Rule, TET_RULES, TRI_RULES};
use geometry::{CellKind, FaceKind};

use crate::FemError;

/// Largest number of Gauss points along an axis; a larger number is taken for a typing error.
const MOST_PER_AXIS: usize = 16;

/// Volume quadrature for each kind of cell: points per cell for tets (one of [`TET_RULES`]), points along
/// each axis for hexahedra (1 to 16).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VolumeRule {
    tet4: usize,
    tet10: usize,
    hex8: usize,
    hex20: usize,
}

impl VolumeRule {
    /// Full integration, exact for the stiffness of an affine cell: tet4 1 point, tet10 4, hex8 2 x 2 x 2,
    /// hex20 3 x 3 x 3.
    pub const STANDARD: VolumeRule = VolumeRule { tet4: 1, tet10: 4, hex8: 2, hex20: 3 };

    /// Integration of at least one order more, for error norms against solutions that the cells cannot
    /// represent: tet4 14 points (degree 5), tet10 24 (degree 6), hex8 3 x 3 x 3, hex20 4 x 4 x 4.
    pub const FINE: VolumeRule = VolumeRule { tet4: 14, tet10: 24, hex8: 3, hex20: 4 };

    /// Returns the rule with another number of points for one kind of cell: `points` per cell (tets) or along
    /// each axis (hexahedra).
    ///
    /// # Errors
    ///
    /// [`FemError::NoRule`] if there is no such rule.
    pub fn with(self, kind: CellKind, points: usize) -> Result<VolumeRule, FemError> {
        check(kind.name(), kind.is_tet(), points, &TET_RULES)?;
        Ok(match kind {
            CellKind::Tet4 => VolumeRule { tet4: points, ..self },
            CellKind::Tet10 => VolumeRule { tet10: points, ..self },
            CellKind::Hex8 => VolumeRule { hex8: points, ..self },
            CellKind::Hex20 => VolumeRule { hex20: points, ..self },
        })
    }

    /// Number of points in a cell of this kind.
    pub fn points(&self, kind: CellKind) -> usize {
        let n = self.number(kind);
        if kind.is_tet() { n } else { n * n * n }
    }

    pub(crate) fn rule(&self, kind: CellKind) -> Result<Rule<3>, FemError> {
        let n = self.number(kind);
        if kind.is_tet() {
            quadrature::tet(n).ok_or_else(|| no_rule(kind.name(), true, n, &TET_RULES))
        } else {
            Ok(quadrature::hex(n))
        }
    }

    fn number(&self, kind: CellKind) -> usize {
        match kind {
            CellKind::Tet4 => self.tet4,
            CellKind::Tet10 => self.tet10,
            CellKind::Hex8 => self.hex8,
            CellKind::Hex20 => self.hex20,
        }
    }
}

/// Surface quadrature for each kind of face: points per face for triangles (one of [`TRI_RULES`]), points
/// along each axis for quadrilaterals (1 to 16).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceRule {
    tri3: usize,
    tri6: usize,
    quad4: usize,
    quad8: usize,
}

impl SurfaceRule {
    /// Integration that is exact for a traction of the face's own order on a flat straight-sided face: tri3 3
    /// points, tri6 6, quad4 2 x 2, quad8 3 x 3.
    pub const STANDARD: SurfaceRule = SurfaceRule { tri3: 3, tri6: 6, quad4: 2, quad8: 3 };

    /// Integration for tractions that are not polynomials of low order: tri3 7 points (degree 5), tri6 16
    /// (degree 8), quad4 4 x 4, quad8 5 x 5.
    pub const FINE: SurfaceRule = SurfaceRule { tri3: 7, tri6: 16, quad4: 4, quad8: 5 };

    /// Returns the rule with another number of points for one kind of face: `points` per face (triangles) or
    /// along each axis (quadrilaterals).
    ///
    /// # Errors
    ///
    /// [`FemError::NoRule`] if there is no such rule.
    pub fn with(self, kind: FaceKind, points: usize) -> Result<SurfaceRule, FemError> {
        check(face_name(kind), is_triangle(kind), points, &TRI_RULES)?;
        Ok(match kind {
            FaceKind::Tri3 => SurfaceRule { tri3: points, ..self },
            FaceKind::Tri6 => SurfaceRule { tri6: points, ..self },
            FaceKind::Quad4 => SurfaceRule { quad4: points, ..self },
            FaceKind::Quad8 => SurfaceRule { quad8: points, ..self },
        })
    }

    /// Number of points on a face of this kind.
    pub fn points(&self, kind: FaceKind) -> usize {
        let n = self.number(kind);
        if is_triangle(kind) { n } else { n * n }
    }

    pub(crate) fn rule(&self, kind: FaceKind) -> Result<Rule<2>, FemError> {
        let n = self.number(kind);
        if is_triangle(kind) {
            quadrature::tri(n).ok_or_else(|| no_rule(face_name(kind), true, n, &TRI_RULES))
        } else {
            Ok(quadrature::quad(n))
        }
    }

    /// Returns the rule on parts of a face.
    pub(crate) fn divided(&self, kind: FaceKind, parts: Parts) -> Result<Rule<2>, FemError> {
        let whole = self.rule(kind)?;
        Ok(if is_triangle(kind) { parts.tri(&whole) } else { parts.quad(&whole) })
    }

    fn number(&self, kind: FaceKind) -> usize {
        match kind {
            FaceKind::Tri3 => self.tri3,
            FaceKind::Tri6 => self.tri6,
            FaceKind::Quad4 => self.quad4,
            FaceKind::Quad8 => self.quad8,
        }
    }
}

fn is_triangle(kind: FaceKind) -> bool {
    kind.corner_count() == 3
}

fn face_name(kind: FaceKind) -> &'static str {
    match kind {
        FaceKind::Tri3 => "tri3",
        FaceKind::Tri6 => "tri6",
        FaceKind::Quad4 => "quad4",
        FaceKind::Quad8 => "quad8",
    }
}

fn check(kind: &'static str, simplex: bool, points: usize, known: &[(usize, usize)]) -> Result<(), FemError> {
    let found =
        if simplex { known.iter().any(|r| r.0 == points) } else { (1..=MOST_PER_AXIS).contains(&points) };
    if found { Ok(()) } else { Err(no_rule(kind, simplex, points, known)) }
}

fn no_rule(kind: &'static str, simplex: bool, points: usize, known: &[(usize, usize)]) -> FemError {
    if simplex {
        let known: Vec<String> = known.iter().map(|r| r.0.to_string()).collect();
        FemError::NoRule { kind, points, counted: "points", known: known.join(", ") }
    } else {
        FemError::NoRule { kind, points, counted: "points per axis", known: format!("1 to {MOST_PER_AXIS}") }
    }
}
