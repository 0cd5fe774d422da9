//! A law at a point of a body, in the axes of its material there.

use shape::{Matrix3, Vector3};

use crate::kinematics::add_right;
use crate::law::Law;
use crate::material::{Material, Tangent};
use crate::separated::Separated;

/// A law with the axes of the material at a point.
///
/// A law that depends on directions is written in these axes. With the axes as columns of `Q`, the law has the
/// energy `W(Q^T H Q)`, the stress `Q P(Q^T H Q) Q^T` and a tangent turned in the same way. Small gradients keep
/// their digits, because `H` is turned, not `F`.
#[derive(Clone, Copy, Debug)]
pub struct AtPoint<'a> {
    law: &'a Law,
    /// Axes of a law that depends on them.
    axes: Option<&'a Matrix3>,
    /// Axes of the material, whose first is the fibre of the active stress.
    fibre: Option<&'a Matrix3>,
    /// Active stress along the fibre, Pa.
    active: f64,
}

impl<'a> AtPoint<'a> {
    /// Builds the law at a point. The columns of `axes` are the orthonormal directions of fibre, sheet and
    /// normal; `None` stands for the coordinate axes.
    pub fn new(law: &'a Law, axes: Option<&'a Matrix3>) -> AtPoint<'a> {
        AtPoint { law, axes: axes.filter(|_| law.has_axes()), fibre: axes, active: 0.0 }
    }

    /// Adds an active stress `T` (Pa) along the fibre: the second Piola-Kirchhoff stress `T f x f`, with the energy
    /// `T/2 (|F f|^2 - 1)`.
    pub fn contracting(self, active: f64) -> AtPoint<'a> {
        AtPoint { active, ..self }
    }

    /// Direction of the fibre.
    fn fibre(&self) -> Vector3 {
        self.fibre.map_or_else(Vector3::x, |axes| axes.column(0).into())
    }

    /// Active stress `T F f x f` alone, Pa: the first Piola-Kirchhoff stress.
    pub fn active_stress(&self, H: &Matrix3) -> Matrix3 {
        let f = self.fibre();
        (f + H * f) * (self.active * f).transpose()
    }

    /// Energy of the active stress alone, `T/2 (|F f|^2 - 1)`, Pa.
    pub fn active_energy(&self, H: &Matrix3) -> f64 {
        let f = self.fibre();
        let stretched = H * f;
        0.5 * self.active * (2.0 * f.dot(&stretched) + stretched.norm_squared())
    }

    /// Adds the tangent `T delta_ik f_j f_l` of the active stress, Pa.
    fn add_active_tangent(&self, tangent: &mut Tangent) {
        if self.active != 0.0 {
            let f = self.fibre();
            add_right(tangent, &(f * (self.active * f).transpose()));
        }
    }

    /// The law in its own axes.
    pub fn law(&self) -> &'a Law {
        self.law
    }
}

/// Returns the tangent of a stress `Q P Q^T` for the tangent of `P` with respect to `Q^T H Q`.
fn turned(tangent: &Tangent, Q: &Matrix3) -> Tangent {
    // (Q x Q) with the column-major index of a matrix: vec(Q A Q^T) = (Q x Q) vec(A).
    let K = Q.kronecker(Q);
    K * tangent * K.transpose()
}

impl Material for AtPoint<'_> {
    fn is_small_strain(&self) -> bool {
        self.law.is_small_strain()
    }

    fn energy(&self, H: &Matrix3) -> f64 {
        let passive = match self.axes {
            None => self.law.energy(H),
            Some(Q) => self.law.energy(&(Q.transpose() * H * Q)),
        };
        if self.active == 0.0 { passive } else { passive + self.active_energy(H) }
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        let passive = match self.axes {
            None => self.law.stress(H),
            Some(Q) => Q * self.law.stress(&(Q.transpose() * H * Q)) * Q.transpose(),
        };
        if self.active == 0.0 { passive } else { passive + self.active_stress(H) }
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        let mut tangent = match self.axes {
            None => self.law.tangent(H),
            Some(Q) => turned(&self.law.tangent(&(Q.transpose() * H * Q)), Q),
        };
        self.add_active_tangent(&mut tangent);
        tangent
    }

    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let (mut stress, mut tangent) = match self.axes {
            None => self.law.stress_and_tangent(H),
            Some(Q) => {
                let (stress, tangent) = self.law.stress_and_tangent(&(Q.transpose() * H * Q));
                (Q * stress * Q.transpose(), turned(&tangent, Q))
            }
        };
        if self.active != 0.0 {
            stress += self.active_stress(H);
            self.add_active_tangent(&mut tangent);
        }
        (stress, tangent)
    }

    /// A law with an active stress is not separable: the stretch of the fibre changes with the volume.
    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        if self.active == 0.0 { self.law.separated(theta_minus_1) } else { None }
    }

    fn mu(&self) -> f64 {
        Material::mu(self.law)
    }

    fn lambda(&self) -> f64 {
        Material::lambda(self.law)
    }
}
