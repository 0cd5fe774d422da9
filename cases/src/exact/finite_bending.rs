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
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Intervals across the thickness: the error of fourth-order Runge-Kutta is below 1e-10 of the radius.
const INTERVALS: usize = 100;

/// A block bent to a constant curvature.
#[derive(Clone, Debug, PartialEq)]
pub struct FiniteBending {
    law: Hyperelastic,
    curvature: f64,
    thickness: f64,
    /// Radius `r` (m) and slope `r'` at the ends of the intervals.
    radius: Vec<(f64, f64)>,
}

impl FiniteBending {
    /// A block of thickness `h` (m), bent by the angle per length `k` (1/m).
    ///
    /// # Errors
    ///
    /// Values outside of `0 < k h <= 1`.
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
        let shoot = |start: f64| shoot(law, thickness, curvature, start);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if shoot(middle).1 < 0.0 { low = middle } else { high = middle }
        }
        Ok(FiniteBending { law: law.clone(), curvature, thickness, radius: shoot(0.5 * (low + high)).0 })
    }

    /// Deformed radius of the fibre at `X`, m.
    pub fn radius(&self, x: f64) -> f64 {
        self.fibre(x).0
    }

    /// Radius (m) and slope at `X`, from the cubic through both ends of the interval.
    fn fibre(&self, x: f64) -> (f64, f64) {
        let step = self.thickness / INTERVALS as f64;
        let at = (x / self.thickness + 0.5) * INTERVALS as f64;
        let k = (at.max(0.0) as usize).min(INTERVALS - 1);
        let (a, da) = self.radius[k];
        let (b, db) = self.radius[k + 1];
        let t = at - k as f64;
        let s = 1.0 - t;
        let value =
            s * s * ((1.0 + 2.0 * t) * a + t * step * da) + t * t * ((1.0 + 2.0 * s) * b - s * step * db);
        let slope = 6.0 * s * t * (b - a) / step + s * (1.0 - 3.0 * t) * da + t * (1.0 - 3.0 * s) * db;
        (value, slope)
    }

    /// Stretches along the radius, the circumference and z, and the unit vectors of the first two.
    fn state(&self, x: &Point3) -> ([f64; 3], Vector3, Vector3) {
        let (r, slope) = self.fibre(x.x);
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

/// Integrates from the inner face with `r = start` and `P_r = 0`; returns `(r, r')` across the thickness and
/// `P_r` at the outer face, Pa.
fn shoot(law: &Hyperelastic, thickness: f64, curvature: f64, start: f64) -> (Vec<(f64, f64)>, f64) {
    let step = thickness / INTERVALS as f64;
    // (r', dP_r/dX) of a state (r, P_r).
    let slope = |(r, pressed): (f64, f64)| {
        let hoop = curvature * r;
        let radial = radial_stretch(law, hoop, pressed);
        (radial, curvature * law.principal_stress([radial, hoop, 1.0])[1])
    };
    let shifted = |(r, p): (f64, f64), (dr, dp): (f64, f64), by: f64| (r + by * dr, p + by * dp);
    let mut state = (start, 0.0);
    let mut path = vec![(start, slope(state).0)];
    for _ in 0..INTERVALS {
        let k1 = slope(state);
        let k2 = slope(shifted(state, k1, 0.5 * step));
        let k3 = slope(shifted(state, k2, 0.5 * step));
        let k4 = slope(shifted(state, k3, step));
        let mean = |f: &dyn Fn((f64, f64)) -> f64| (f(k1) + 2.0 * (f(k2) + f(k3)) + f(k4)) / 6.0;
        state = shifted(state, (mean(&|k| k.0), mean(&|k| k.1)), step);
        path.push((state.0, slope(state).0));
    }
    (path, state.1)
}

/// Radial stretch between 1/8 and 8 at which the radial stress is `pressed`, by bisection.
fn radial_stretch(law: &Hyperelastic, hoop: f64, pressed: f64) -> f64 {
    let (mut low, mut high) = (0.125, 8.0);
    for _ in 0..56 {
        let middle = 0.5 * (low + high);
        if law.principal_stress([middle, hoop, 1.0])[0] < pressed { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
