//! A free cube that vibrates in Lame's modes, which keep the volume at any Poisson's ratio.
//!
//! ```text
//! Source      Lame, Lecons sur la theorie mathematique de l'elasticite des corps solides (1852);
//!             Ekstein & Schiffman, J. Appl. Phys. 27 (1956) 405-412: free vibrations of isotropic cubes.
//!
//!       ^ y
//!     L +-------+
//!       | <-  ^ |            side L from the origin, free all around; each face across the axis keeps its
//!       | v  -> |            plane, the other four turn about the axis in alternating directions
//!     0 +-------+--> x
//!       0       L
//!
//! Field       u = A cos(omega t) (cos kx sin ky, -sin kx cos ky, 0),  k = pi / L; two more about x and y
//! Frequency   omega^2 = 2 k^2 mu / rho
//! Conditions  div u = 0 and du_x/dy + du_y/dx = 0, so that sigma = 2 mu diag(du_x/dx, du_y/dy, 0), both
//!             -+ A k sin kx sin ky: zero on all faces.
//! Must hold   three modes of this frequency, which are not orthogonal: the integral of u_z . u_x is -4 /
//!             pi^2 of that of u_z^2.
//! ```

use std::f64::consts::PI;

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::solution::{Exact, SolutionEntry, Vibrations, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Lame's mode about z. As a field it is fixed at its largest amplitude until [`Exact::at`] sets a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LameCube {
    elastic: Elastic,
    side: f64,
    density: f64,
    amplitude: f64,
    time: f64,
}

impl LameCube {
    /// A cube at time 0 with the given side (m), density (kg/m^3) and amplitude (m).
    ///
    /// # Errors
    ///
    /// A side or density that is not positive.
    pub fn new(elastic: Elastic, side: f64, density: f64, amplitude: f64) -> Result<LameCube, ExactError> {
        for (name, value) in [("side", side), ("density", density)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: ENTRY.name, name, value, need });
            }
        }
        Ok(LameCube { elastic, side, density, amplitude, time: 0.0 })
    }

    fn now(&self) -> f64 {
        self.amplitude * (self.omega() * self.time).cos()
    }

    /// Displacement of the mode about an axis, with amplitude 1.
    fn about(&self, axis: usize, p: &Point3) -> Vector3 {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let [(sin_a, cos_a), (sin_b, cos_b)] = [a, b].map(|axis| (PI / self.side * p[axis]).sin_cos());
        let mut u = Vector3::zeros();
        (u[a], u[b]) = (cos_a * sin_b, -sin_a * cos_b);
        u
    }
}

impl Exact for LameCube {
    fn displacement(&self, p: &Point3) -> Vector3 {
        self.about(2, p) * self.now()
    }

    fn gradient(&self, p: &Point3) -> Matrix3 {
        let k = PI / self.side;
        let [(sin_x, cos_x), (sin_y, cos_y)] = [p.x, p.y].map(|x| (k * x).sin_cos());
        let (normal, shear) = (sin_x * sin_y, cos_x * cos_y);
        Matrix3::new(-normal, shear, 0.0, -shear, normal, 0.0, 0.0, 0.0, 0.0) * (k * self.now())
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }

    fn body_force(&self, p: &Point3) -> Vector3 {
        self.displacement(p) * (self.density * self.omega().powi(2))
    }

    fn at(&self, time: f64) -> Option<Box<dyn Exact>> {
        Some(Box::new(LameCube { time, ..*self }))
    }

    fn vibrations(&self) -> Option<&dyn Vibrations> {
        Some(self)
    }
}

impl Vibrations for LameCube {
    fn omega(&self) -> f64 {
        PI / self.side * (2.0 * self.elastic.mu() / self.density).sqrt()
    }

    fn shapes(&self, x: &Point3) -> Vec<Vector3> {
        (0..3).map(|axis| self.about(axis, x)).collect()
    }

    fn lowest(&self, _count: usize) -> Option<Vec<f64>> {
        None
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "lame-cube",
    meaning: "Lame's vibration of a free cube",
    source: "Lame (1852)",
    parameters: &[
        Parameter::required("side", Dimension::Length, "side of the cube, one corner at the origin"),
        Parameter::required("density", Dimension::Density, "mass per volume"),
        Parameter::default("amplitude", Dimension::Length, 1e-3, "largest displacement"),
    ],
    build: |medium, values| {
        let [side, density, amplitude] = numbers(values, ["side", "density", "amplitude"])?;
        Ok(Box::new(LameCube::new(medium.elastic, side, density, amplitude)?))
    },
};
