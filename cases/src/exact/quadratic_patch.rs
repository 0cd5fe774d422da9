//! Quadratic field: the patch test of quadratic elements and bases.
//!
//! ```text
//! Source      manufactured: Navier's equation (lambda + mu) grad div u + mu lap u + b = 0 for a quadratic u.
//!
//!      +-------+        +--.----+
//!      |  . .  |   ->   |   . .  \      u_i = x . C_i x / 2,  C_i symmetric (1/m)
//!      | .   . |         \ .   .  |     b constant
//!      +-------+          `------'
//!
//! Conditions  the exact displacement on the boundary (or traction on a part), the constant body force
//!             inside.
//! Must hold   quadratic elements and quadratic bases with consistent integration return the field to
//!             rounding; linear ones converge at order 2 (displacement) and 1 (energy). The body force grows
//!             with lambda near nu = 0.5.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::solution::{Exact, SolutionEntry};
use super::vectors::{Matrix3, Point3, Vector3};

/// `u_i = x . C_i x / 2` with the constant body force that balances it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticPatch {
    elastic: Elastic,
    second: [Matrix3; 3],
    force: Vector3,
}

/// `C_i` of the generic field, per unit amplitude: eighteen independent entries, none zero.
const GENERIC: [[f64; 6]; 3] = [
    // xx, yy, zz, xy, xz, yz
    [1.0, -0.6, 0.4, 0.3, -0.5, 0.7],
    [-0.8, 0.9, 0.5, -0.4, 0.6, -0.2],
    [0.3, -0.7, 1.2, 0.8, -0.9, 0.1],
];

impl QuadraticPatch {
    /// The field with the second derivatives `C_i = grad grad u_i` (1/m); only their symmetric parts count.
    pub fn new(elastic: Elastic, second: [Matrix3; 3]) -> QuadraticPatch {
        let second = second.map(|c| 0.5 * (c + c.transpose()));
        let laplacian = Vector3::from_fn(|i, _| second[i].trace());
        let grad_div = Vector3::from_fn(|k, _| (0..3).map(|i| second[i][(i, k)]).sum());
        let force = -((elastic.lambda() + elastic.mu()) * grad_div + elastic.mu() * laplacian);
        QuadraticPatch { elastic, second, force }
    }

    /// A field with all second derivatives nonzero, scaled by `amplitude` (1/m).
    pub fn generic(elastic: Elastic, amplitude: f64) -> QuadraticPatch {
        let second = GENERIC
            .map(|[xx, yy, zz, xy, xz, yz]| amplitude * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz));
        QuadraticPatch::new(elastic, second)
    }
}

impl Exact for QuadraticPatch {
    fn displacement(&self, x: &Point3) -> Vector3 {
        Vector3::from_fn(|i, _| 0.5 * x.coords.dot(&(self.second[i] * x.coords)))
    }

    fn gradient(&self, x: &Point3) -> Matrix3 {
        let rows = self.second.map(|c| (c * x.coords).transpose());
        Matrix3::from_rows(&rows)
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }

    fn body_force(&self, _x: &Point3) -> Vector3 {
        self.force
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "quadratic-patch",
    meaning: "a quadratic displacement with the body force that balances it",
    source: "",
    parameters: &[Parameter::default(
        "amplitude",
        Dimension::Curvature,
        1.0,
        "scale of the second derivatives of the displacement",
    )],
    build: |medium, values| {
        Ok(Box::new(QuadraticPatch::generic(medium.elastic, values.number("amplitude")?)))
    },
};
