//! A law with another form of its volumetric energy.

use shape::Matrix3;

use crate::kinematics::volume_change;
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::split::{add_dilation_hessian, cofactor, flat};
use crate::volumetric::Volumetric;

/// A law whose volumetric energy is given apart from the rest `L` of the law.
#[derive(Clone, Debug, PartialEq)]
pub struct WithVolumetric<L> {
    rest: Box<L>,
    volume: Volumetric,
}

impl<L> WithVolumetric<L> {
    /// Builds the law from a law of bulk modulus 0 and its volumetric energy.
    pub(super) fn new(rest: L, volume: Volumetric) -> WithVolumetric<L> {
        WithVolumetric { rest: Box::new(rest), volume }
    }

    /// The law without its volumetric energy.
    pub fn rest(&self) -> &L {
        &self.rest
    }

    /// The volumetric energy.
    pub fn volume(&self) -> Volumetric {
        self.volume
    }
}

impl<L: Material> Material for WithVolumetric<L> {
    fn has_axes(&self) -> bool {
        self.rest.has_axes()
    }

    fn has_sheets(&self) -> bool {
        self.rest.has_sheets()
    }

    fn energy(&self, H: &Matrix3) -> f64 {
        self.rest.energy(H) + self.volume.derivatives(volume_change(H))[0]
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        self.rest.stress(H) + cofactor(false, H) * self.volume.derivatives(volume_change(H))[1]
    }

    fn tangent(&self, H: &Matrix3) -> Tangent {
        self.stress_and_tangent(H).1
    }

    /// Adds `U'' cof F x cof F + U' d(cof F)/dF` to the tangent of the rest.
    fn stress_and_tangent(&self, H: &Matrix3) -> (Matrix3, Tangent) {
        let (P, mut tangent) = self.rest.stress_and_tangent(H);
        let [_, slope, second] = self.volume.derivatives(volume_change(H));
        let cof = cofactor(false, H);
        let of = flat(&cof);
        tangent += of * of.transpose() * second;
        add_dilation_hessian(false, H, slope, &mut tangent);
        (P + cof * slope, tangent)
    }

    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        let Separated { A, U } = self.rest.separated(theta_minus_1)?;
        let volume = self.volume.derivatives(theta_minus_1);
        Some(Separated { A, U: std::array::from_fn(|d| U[d] + volume[d]) })
    }

    fn mu(&self) -> f64 {
        self.rest.mu()
    }

    fn lambda(&self) -> f64 {
        self.rest.lambda() + self.volume.bulk
    }
}
