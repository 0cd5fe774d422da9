//! Finite bending: a block bent into a sector of a cylinder, in plane strain.
//!
//! ```text
//! Source      Rivlin (1949), flexure; Ogden, Non-linear Elastic Deformations (1984), ch. 5.2. A compressible
//!             law leads to one ordinary differential equation.
//!
//!    Y ^                      .--.
//!      |---.                .'    '.
//!      |   |      ->       /  .--.  '  angle k Y,  radius r(X),  z = Z
//!      |___|___> X            |__|
//!    -h/2  h/2
//!
//! Field       x = r(X) cos(k Y) - r(0), y = r(X) sin(k Y); stretches r', k r, 1.
//! Equations   dP_r / dX = k P_t(r', k r, 1), P_r = 0 on both faces X = -h/2, h/2.
//! Conditions  faces X = -h/2, h/2 free; planes Y = 0 and Z slip; the exact displacement at another Y.
//! Must hold   displacements converge; the fibre of stretch 1 is not the middle fibre.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::error::ExactError;
use super::hyperelastic::Hyperelastic;
use super::radial::Wall;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// A block bent to a constant curvature.
#[derive(Clone, Debug, PartialEq)]
pub struct FiniteBending {
    law: Hyperelastic,
    curvature: f64,
    wall: Wall,
}

impl FiniteBending {
    /// A block of thickness `h` (m), bent by the angle per length `k` (1/m).
    ///
    /// # Errors
    ///
    /// Values outside of `0 < k h <= 1`, and a bend that the law can't carry.
    pub fn new(law: &Hyperelastic, thickness: f64, curvature: f64) -> Result<FiniteBending, ExactError> {
        let bend = thickness * curvature;
        if !(thickness > 0.0 && thickness.is_finite() && bend > 0.0 && bend <= 1.0) {
            let need = format!("above zero and at most {} 1/m, one over the thickness", 1.0 / thickness);
            return Err(ExactError::BadParameter {
                solution: ENTRY.name,
                name: "curvature",
                value: curvature,
                need,
            });
        }
        // The inner face shortens to a radius below 1 / k. If the radius is too small, the outer face is
        // under pressure.
        let (mut low, mut high) = (1.0 / curvature - thickness, 1.0 / curvature);
        let shoot = |inner: f64| {
            let across = |_: f64, r: f64| [curvature * r, 1.0];
            let balance = |_: f64, stress: [f64; 3]| curvature * stress[1];
            Wall::integrate(law, [-0.5 * thickness, thickness], (inner, 0.0), across, balance)
        };
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if shoot(middle).is_none_or(|(_, pressed)| pressed < 0.0) { low = middle } else { high = middle }
        }
        match shoot(0.5 * (low + high)) {
            Some((wall, _)) => Ok(FiniteBending { law: law.clone(), curvature, wall }),
            None => Err(ExactError::BadParameter {
                solution: ENTRY.name,
                name: "curvature",
                value: curvature,
                need: "so small that the law can carry the stress at the inner face".into(),
            }),
        }
    }

    /// Deformed radius of the fibre at `X`, m.
    pub fn radius(&self, x: f64) -> f64 {
        self.wall.at(x).0
    }

    /// Stretches along the radius, the circumference and z, and the unit vectors of the first two.
    fn state(&self, x: &Point3) -> ([f64; 3], Vector3, Vector3) {
        let (r, slope) = self.wall.at(x.x);
        let (sin, cos) = (self.curvature * x.y).sin_cos();
        ([slope, self.curvature * r, 1.0], Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0))
    }
}

impl Exact for FiniteBending {
    /// Displacement, m; `X` has to lie within the thickness.
    fn displacement(&self, x: &Point3) -> Vector3 {
        let r = self.radius(x.x);
        let angle = self.curvature * x.y;
        Vector3::new(r * angle.cos() - self.radius(0.0) - x.x, r * angle.sin() - x.y, 0.0)
    }

    fn gradient(&self, x: &Point3) -> Matrix3 {
        let ([radial, hoop, axial], out, along) = self.state(x);
        Matrix3::from_columns(&[out * radial, along * hoop, Vector3::z() * axial]) - Matrix3::identity()
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        let (stretch, out, along) = self.state(x);
        let volume = stretch[0] * stretch[1] * stretch[2];
        let principal = self.law.principal_stress(stretch);
        let directions = [out, along, Vector3::z()];
        (0..3).map(|a| directions[a] * directions[a].transpose() * (principal[a] * stretch[a] / volume)).sum()
    }

    fn traction(&self, x: &Point3, normal: &Vector3) -> Vector3 {
        let (stretch, out, along) = self.state(x);
        let [radial, hoop, axial] = self.law.principal_stress(stretch);
        out * (radial * normal.x) + along * (hoop * normal.y) + Vector3::z() * (axial * normal.z)
    }

    fn is_large_strain(&self) -> bool {
        true
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "finite-bending",
    meaning: "a block bent about z into a sector of a cylinder at large strain, in plane strain",
    source: "Rivlin (1949); Ogden, Non-linear Elastic Deformations (1984), ch. 5.2",
    parameters: &[
        Parameter::required("thickness", Dimension::Length, "thickness along x, centred on 0"),
        Parameter::required("curvature", Dimension::Curvature, "angle per undeformed length along y"),
    ],
    build: |medium, values| {
        let [thickness, curvature] = numbers(values, ["thickness", "curvature"])?;
        Ok(Box::new(FiniteBending::new(medium.hyperelastic()?, thickness, curvature)?))
    },
};
