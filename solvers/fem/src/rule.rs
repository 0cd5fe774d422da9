//! Quadrature of each kind of cell and face, by name or by number of points.

use geometry::quadrature::{self, Parts, Rule, TRI_RULES};
use geometry::{CellKind, FaceKind};

use crate::error::FemError;

/// Largest number of Gauss points along an axis of a face; a larger number is taken for a typing error.
const MOST_PER_AXIS: usize = 16;

/// Volume quadrature: the number of points in a cell of each kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VolumeRule([usize; CellKind::ALL.len()]);

impl VolumeRule {
    /// Full integration, exact for the stiffness of an affine cell.
    pub const STANDARD: VolumeRule = VolumeRule::of(false);

    /// Integration of at least one order more, for error norms against solutions that the cells cannot
    /// represent.
    pub const FINE: VolumeRule = VolumeRule::of(true);

    const fn of(fine: bool) -> VolumeRule {
        let mut points = [0; CellKind::ALL.len()];
        let mut at = 0;
        while at < points.len() {
            let offered = &CellKind::ALL[at].entry().points;
            points[at] = if fine { offered.fine } else { offered.full };
            at += 1;
        }
        VolumeRule(points)
    }

    /// Returns full integration, but reduced integration for the kinds that are in use with it.
    pub fn reduced() -> VolumeRule {
        let points = CellKind::ALL.map(|kind| kind.entry().points);
        VolumeRule(points.map(|points| points.reduced.map_or(points.full, |rule| rule.0)))
    }

    /// Returns the rule with another number of points for one kind of cell.
    ///
    /// # Errors
    ///
    /// [`FemError::NoRule`] if there is no such rule.
    pub fn with(mut self, kind: CellKind, points: usize) -> Result<VolumeRule, FemError> {
        self.0[kind as usize] = points;
        self.rule(kind)?;
        Ok(self)
    }

    /// Number of points in a cell of this kind.
    pub fn points(&self, kind: CellKind) -> usize {
        self.0[kind as usize]
    }

    pub(crate) fn rule(&self, kind: CellKind) -> Result<Rule<3>, FemError> {
        let points = self.points(kind);
        let cell = kind.entry().cell;
        (cell.rule)(points).ok_or_else(|| FemError::NoRule {
            kind: kind.name(),
            points,
            counted: "points",
            known: cell.rules.into(),
        })
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
        check(kind.name(), kind.is_triangle(), points, &TRI_RULES)?;
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
        if kind.is_triangle() { n } else { n * n }
    }

    pub(crate) fn rule(&self, kind: FaceKind) -> Result<Rule<2>, FemError> {
        let n = self.number(kind);
        if kind.is_triangle() {
            quadrature::tri(n).ok_or_else(|| no_rule(kind.name(), true, n, &TRI_RULES))
        } else {
            Ok(quadrature::quad(n))
        }
    }

    /// Returns the rule on parts of a face.
    pub(crate) fn divided(&self, kind: FaceKind, parts: Parts) -> Result<Rule<2>, FemError> {
        let whole = self.rule(kind)?;
        Ok(if kind.is_triangle() { parts.tri(&whole) } else { parts.quad(&whole) })
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
