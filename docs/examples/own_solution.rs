//! A user-defined exact solution: torsion of a bar, checked against equilibrium.

use cases::exact::{Elastic, Exact, Matrix3, Point3, Vector3};

// ANCHOR: solution
/// A bar along z, twisted by `twist` (rad/m): `u = twist (-y z, x z, 0)`. A circular bar has free sides.
pub struct Torsion {
    elastic: Elastic,
    twist: f64,
}

impl Exact for Torsion {
    fn displacement(&self, x: &Point3) -> Vector3 {
        self.twist * Vector3::new(-x.y * x.z, x.x * x.z, 0.0)
    }

    fn gradient(&self, x: &Point3) -> Matrix3 {
        self.twist * Matrix3::new(0.0, -x.z, -x.y, x.z, 0.0, x.x, 0.0, 0.0, 0.0)
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }
}
// ANCHOR_END: solution

// ANCHOR: check
fn main() {
    let bar = Torsion { elastic: Elastic::new(20e3, 0.3).expect("sound moduli"), twist: 2.0 };
    let x = Point3::new(0.01, -0.004, 0.03);
    let step = 1e-5;
    let mut divergence = Vector3::zeros();
    for axis in 0..3 {
        let mut d = Vector3::zeros();
        d[axis] = step;
        let slope = (bar.displacement(&(x + d)) - bar.displacement(&(x - d))) / (2.0 * step);
        assert!((slope - bar.gradient(&x).column(axis)).norm() < 1e-9, "the gradient is that of the field");
        divergence += (bar.stress(&(x + d)).column(axis) - bar.stress(&(x - d)).column(axis)) / (2.0 * step);
    }
    assert!(divergence.norm() < 1e-6, "without body forces stresses balance");
    let side = Vector3::new(x.x, x.y, 0.0).normalize();
    assert!(bar.traction(&x, &side).norm() < 1e-9, "a circular bar's side is free");
    println!("gradient, balance and free sides hold");
}
// ANCHOR_END: check
