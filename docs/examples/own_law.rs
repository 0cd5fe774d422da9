//! A user-defined law: energy, stress and tangent, checked against differences.
//!
//! The law of Blatz and Ko for compressible foams, J. Rheol. 6 (1962) 223-251.

use material::{Material, Tangent};
use shape::Matrix3;

// ANCHOR: law
/// The compressible law of Blatz and Ko, `W = mu/2 (I1 - 3 + (J^(-2 b) - 1) / b)`, with
/// `b = nu / (1 - 2 nu)` and mu in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlatzKo {
    mu: f64,
    b: f64,
}

impl Material for BlatzKo {
    fn energy(&self, h: &Matrix3) -> f64 {
        let f = Matrix3::identity() + h;
        0.5 * self.mu * (f.norm_squared() - 3.0 + (f.determinant().powf(-2.0 * self.b) - 1.0) / self.b)
    }

    /// `P = mu (F - J^(-2 b) F^-T)`.
    fn stress(&self, h: &Matrix3) -> Matrix3 {
        let f = Matrix3::identity() + h;
        let g = f.try_inverse().map_or(Matrix3::repeat(f64::NAN), |i| i.transpose());
        self.mu * (f - f.determinant().powf(-2.0 * self.b) * g)
    }

    /// `mu delta_ik delta_jl + mu J^(-2 b) (2 b G_ij G_kl + G_il G_kj)`, `G = F^-T`.
    fn tangent(&self, h: &Matrix3) -> Tangent {
        let f = Matrix3::identity() + h;
        let g = f.try_inverse().map_or(Matrix3::repeat(f64::NAN), |i| i.transpose());
        let s = f.determinant().powf(-2.0 * self.b);
        Tangent::from_fn(|row, column| {
            let (i, j, k, l) = (row % 3, row / 3, column % 3, column / 3);
            let same = if row == column { 1.0 } else { 0.0 };
            self.mu * (same + s * (2.0 * self.b * g[(i, j)] * g[(k, l)] + g[(i, l)] * g[(k, j)]))
        })
    }

    fn mu(&self) -> f64 {
        self.mu
    }

    fn lambda(&self) -> f64 {
        2.0 * self.mu * self.b
    }
}
// ANCHOR_END: law

// ANCHOR: check
fn main() {
    let law = BlatzKo { mu: 8.0e3, b: 0.5 };
    let h = Matrix3::new(0.1, 0.02, -0.05, 0.03, -0.08, 0.04, 0.01, 0.06, 0.12);
    let step = 1e-6;
    let tangent = law.tangent(&h);
    for column in 0..9 {
        let mut d = Matrix3::zeros();
        d[column] = step;
        let energy = (law.energy(&(h + d)) - law.energy(&(h - d))) / (2.0 * step);
        assert!(
            (energy - law.stress(&h)[column]).abs() < 1e-5 * law.mu(),
            "stress is the slope of the energy"
        );
        let stress = (law.stress(&(h + d)) - law.stress(&(h - d))) / (2.0 * step);
        for row in 0..9 {
            assert!(
                (stress[row] - tangent[(row, column)]).abs() < 1e-5 * law.mu(),
                "the tangent is the slope of the stress"
            );
        }
    }
    println!("stress and tangent agree with differences");
}
// ANCHOR_END: check
