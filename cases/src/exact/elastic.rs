//! Isotropic linear elasticity, written out once for the exact solutions.

use super::error::ExactError;
use super::vectors::Matrix3;

/// Young's modulus and Poisson's ratio of an isotropic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    young: f64,
    poisson: f64,
}

impl Elastic {
    /// A material with Young's modulus `young` (Pa) and Poisson's ratio `poisson`.
    ///
    /// # Errors
    ///
    /// Values outside of `young > 0` and `-1 < poisson < 0.5`.
    pub fn new(young: f64, poisson: f64) -> Result<Elastic, ExactError> {
        if !(young > 0.0 && young.is_finite()) {
            return Err(ExactError::Material { what: "young", value: young, need: "a positive number" });
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(ExactError::Material {
                what: "poisson",
                value: poisson,
                need: "above -1 and below 0.5",
            });
        }
        Ok(Elastic { young, poisson })
    }

    /// Young's modulus `E`, Pa.
    pub fn young(&self) -> f64 {
        self.young
    }

    /// Poisson's ratio `nu`.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// First Lame constant `lambda = E nu / ((1 + nu)(1 - 2 nu))`, Pa.
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

    /// Hooke's law `sigma = lambda tr(H) I + mu (H + H^T)`, Pa.
    pub fn stress(&self, gradient: &Matrix3) -> Matrix3 {
        self.lambda() * gradient.trace() * Matrix3::identity() + self.mu() * (gradient + gradient.transpose())
    }
}
