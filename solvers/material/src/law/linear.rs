//! Small-strain isotropic linear elasticity (Hooke).

use catalogue::{Build, Entry};
use lanes::LANES;
use shape::Matrix3;

use super::moduli::{MODULI, moduli};
use crate::error::MaterialError;
use crate::kinematics::tangent_of;
use crate::lane::{LaneStrain, Lanes};
use crate::material::{Material, Tangent};
use crate::separated::Separated;
use crate::volumetric::Volumetric;

/// Hooke's law `sigma = lambda tr(eps) I + 2 mu eps`, `eps = sym grad u`; moduli in Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    young: f64,
    poisson: f64,
}

pub(super) const ENTRY: Entry<Build<LinearElastic>> = Entry {
    name: "linear",
    meaning: "lambda/2 (tr eps)^2 + mu eps : eps, eps = sym grad u: for small strain and rotation",
    source: "Hooke",
    parameters: MODULI,
    build: |values| {
        let (young, poisson) = moduli(values)?;
        Ok(LinearElastic::new(young, poisson)?)
    },
};

impl LinearElastic {
    /// Builds the law from Young's modulus (Pa, positive) and Poisson's ratio (-1 < nu < 0.5).
    pub fn new(young: f64, poisson: f64) -> Result<LinearElastic, MaterialError> {
        // The form of the test also rejects NaN.
        if !(young > 0.0 && young.is_finite()) {
            return Err(MaterialError::Young { young });
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(MaterialError::Poisson { poisson });
        }
        Ok(LinearElastic { young, poisson })
    }

    /// Young's modulus `E`, Pa.
    pub fn young(&self) -> f64 {
        self.young
    }

    /// Poisson's ratio `nu`.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// First Lame modulus `lambda = E nu / ((1 + nu)(1 - 2 nu))`, Pa.
    pub fn lambda(&self) -> f64 {
        self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// Shear modulus `mu = E / (2 (1 + nu))`, Pa.
    pub fn mu(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Bulk modulus `kappa = E / (3 (1 - 2 nu))`, Pa.
    pub fn bulk(&self) -> f64 {
        self.young / (3.0 * (1.0 - 2.0 * self.poisson))
    }

    /// Returns the stress (3, 3), Pa, at the displacement gradient `H` (3, 3).
    pub fn stress(&self, H: &Matrix3) -> Matrix3 {
        (H + H.transpose()) * self.mu() + Matrix3::identity() * (self.lambda() * H.trace())
    }

    /// Returns the strain energy per volume `(lambda tr(eps)^2 + 2 mu eps : eps) / 2`, J/m^3, at the
    /// displacement gradient `H`.
    pub fn energy_density(&self, H: &Matrix3) -> f64 {
        let eps = (H + H.transpose()) * 0.5;
        0.5 * self.lambda() * H.trace().powi(2) + self.mu() * eps.norm_squared()
    }
}

/// The energy is quadratic and the tangent constant; a rotation counts as strain (see
/// [`Material::is_small_strain`]).
impl Material for LinearElastic {
    fn is_small_strain(&self) -> bool {
        true
    }

    fn energy(&self, H: &Matrix3) -> f64 {
        self.energy_density(H)
    }

    fn stress(&self, H: &Matrix3) -> Matrix3 {
        LinearElastic::stress(self, H)
    }

    fn tangent(&self, _: &Matrix3) -> Tangent {
        let mu = LinearElastic::mu(self);
        let lambda = LinearElastic::lambda(self);
        let delta = Matrix3::identity();
        tangent_of(|i, j, k, l| {
            lambda * delta[(i, j)] * delta[(k, l)]
                + mu * (delta[(i, k)] * delta[(j, l)] + delta[(i, l)] * delta[(j, k)])
        })
    }

    #[inline(always)]
    fn stress_lanes<const FMA: bool>(&self, strain: &LaneStrain, p: &mut [Lanes; 9]) {
        let mu = LinearElastic::mu(self);
        let lambda = LinearElastic::lambda(self);
        for l in 0..LANES {
            let h = strain.lane(l);
            let volume = lambda * strain.invariants[0][l];
            let shear = |i: usize, j: usize| mu * (h[3 * i + j] + h[3 * j + i]);
            let (xy, xz, yz) = (shear(0, 1), shear(0, 2), shear(1, 2));
            (p[0][l], p[1][l], p[2][l]) = (shear(0, 0) + volume, xy, xz);
            (p[3][l], p[4][l], p[5][l]) = (xy, shear(1, 1) + volume, yz);
            (p[6][l], p[7][l], p[8][l]) = (xz, yz, shear(2, 2) + volume);
        }
    }

    fn separated(&self, theta_minus_1: f64) -> Option<Separated> {
        Some(Separated::of_volume(Volumetric::quadratic(Material::bulk(self)), theta_minus_1))
    }

    fn mu(&self) -> f64 {
        LinearElastic::mu(self)
    }

    fn lambda(&self) -> f64 {
        LinearElastic::lambda(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn moduli_out_of_range_are_refused() {
        for young in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(LinearElastic::new(young, 0.3), Err(MaterialError::Young { .. })), "{young}");
        }
        for poisson in [0.5, -1.0, 0.7, f64::NAN] {
            assert!(
                matches!(LinearElastic::new(1.0, poisson), Err(MaterialError::Poisson { .. })),
                "{poisson}"
            );
        }
    }

    #[test]
    fn uniaxial_stress_gives_young_and_poisson() {
        let m = LinearElastic::new(20e3, 0.4).unwrap();
        let s = m.stress(&Matrix3::from_diagonal(&[-0.4, 1.0, -0.4].into()));
        assert!((s - Matrix3::from_diagonal(&[0.0, 20e3, 0.0].into())).norm() < 1e-10 * 20e3);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn stress_is_the_gradient_of_energy(h in prop::array::uniform9(-1.0..1.0f64), poisson in -0.9..0.49f64) {
            let m = LinearElastic::new(3.0, poisson).unwrap();
            let h = Matrix3::from_row_slice(&h);
            let s = m.stress(&h);
            for k in 0..9 {
                let mut d = Matrix3::zeros();
                d[k] = 1e-3;
                // The energy is quadratic, so the central difference is exact except for rounding.
                let slope = (m.energy_density(&(h + d)) - m.energy_density(&(h - d))) / 2e-3;
                prop_assert!((slope - s[k]).abs() < 1e-10 * (1.0 + s.norm()));
            }
        }
    }
}
