//! The wall of a heart's left ventricle: the part below a plane of the shell between two ellipsoids about the z
//! axis.

use super::{GenerateError, check_positive, cylinder, surfaces};
use crate::Point3;
use crate::element::CellKind;
use crate::mesh::Mesh;

/// The shell between two ellipsoids about the z axis, centred on the origin, below the plane z = `base`. The
/// apex points to -z.
///
/// A point at the depth `t` of the wall (0 inside, 1 outside) lies on the ellipsoid whose radii are linear in
/// `t`. Source: Land et al., Proc. R. Soc. A 471 (2015) 20150641, problems 2 and 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ventricle {
    /// Radius across and half length along z of the inner ellipsoid, m.
    pub inner: [f64; 2],
    /// Radius across and half length along z of the outer ellipsoid, m.
    pub outer: [f64; 2],
    /// Height of the cut, m.
    pub base: f64,
}

impl Ventricle {
    /// Radius across and half length of the ellipsoid at a depth, m.
    pub fn radii(&self, depth: f64) -> [f64; 2] {
        [0, 1].map(|k| self.inner[k] + depth * (self.outer[k] - self.inner[k]))
    }

    /// Returns the depth of a point (m), by bisection; 0 or 1 outside the wall.
    pub fn depth(&self, p: &Point3) -> f64 {
        // The level falls with the depth, because both radii grow.
        let level = |depth: f64| {
            let [across, along] = self.radii(depth);
            (p.x * p.x + p.y * p.y) / (across * across) + p.z * p.z / (along * along) - 1.0
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if level(middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Point at a place of the unit disc, whose centre is the apex and whose rim is the base, and a depth.
    fn at(&self, [x, y]: [f64; 2], depth: f64) -> Point3 {
        let [across, along] = self.radii(depth);
        let r = x.hypot(y);
        // Angle from the apex.
        let whole = std::f64::consts::PI - (self.base / along).acos();
        let angle = r * whole;
        let out = if r > 0.0 { across * angle.sin() / r } else { across * whole };
        Point3::new(out * x, out * y, -along * angle.cos())
    }
}

/// Meshes a [`Ventricle`] with `cells = [across, through]`: hexahedra along each side of the core around the
/// apex, which has `(across + 1) / 2` layers around it, and through the wall. Facet groups:
/// [`surfaces::VENTRICLE`]. Quadratic nodes lie on the ellipsoids.
///
/// # Errors
/// Radii that do not grow from the inside to the outside, a base at or beyond an end of the inner ellipsoid, or
/// a number of cells out of range.
pub fn ventricle_mesh(kind: CellKind, wall: &Ventricle, cells: [usize; 2]) -> Result<Mesh, GenerateError> {
    for k in 0..2 {
        check_positive("an inner radius", wall.inner[k])?;
        check_positive("the thickness of the wall", wall.outer[k] - wall.inner[k])?;
    }
    check_positive("the depth of the inner ellipsoid below the base", wall.inner[1] - wall.base.abs())?;
    let [base, inner, outer] = surfaces::VENTRICLE;
    // The bottom of the cylinder becomes the outside, so that cells keep their orientation.
    cylinder::upright(kind, cells, 1.0, [base, outer, inner], |disc, z| wall.at(disc, 1.0 - z))
}
