//! A bar pulled at its end: d'Alembert's waves between a fixed and a free end.
//!
//! ```text
//! Source      d'Alembert's solution of the wave equation (Graff, Wave Motion in Elastic Solids, 1975, ch.
//!             2.1 and 2.4). A fixed end reflects a wave with the opposite sign, a free end with the same
//!             sign.
//!
//!   |//+--------------------------------+
//!   +//|                                | ==> p(t)      p = p0 t / T until T, then p0; at once with T = 0
//!    //+--------------------------------+
//!      x = 0                          x = L             sides on frictionless walls
//!
//! Field       c^2 = M / rho,  M = lambda + 2 mu,  s = L - x,  Q(t) = integral_0^t p,  u_y = u_z = 0,
//!             u_x = c / M sum_n (-1)^n (Q(t - (2 n L + s) / c) - Q(t - (2 (n + 1) L - s) / c)).
//! Conditions  from rest; u_x = 0 on x = 0, traction p on x = L, no shear and no motion across the sides.
//! Must hold   rho u'' = div sigma between the fronts. After a sudden pull the end moves linearly from 0 to
//!             twice the static p0 L / M and back, with a period of 4 L / c.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Longitudinal waves in a bar without lateral motion, from its end at `x = L`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarWave {
    elastic: Elastic,
    pull: f64,
    length: f64,
    density: f64,
    over: f64,
    time: f64,
}

/// The function of the pull that is summed over the waves.
#[derive(Clone, Copy)]
enum Of {
    Integral,
    Value,
    Rate,
}

impl BarWave {
    /// A bar at time 0 with the given length (m) and density (kg/m^3). The pull `p0` (Pa) grows over `over`
    /// (s; 0 for a sudden pull).
    ///
    /// # Errors
    ///
    /// A length or density that is not positive, or a negative `over`.
    pub fn new(
        elastic: Elastic,
        pull: f64,
        [length, density]: [f64; 2],
        over: f64,
    ) -> Result<BarWave, ExactError> {
        for (name, value) in [("length", length), ("density", density)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: ENTRY.name, name, value, need });
            }
        }
        if !(over >= 0.0) {
            let need = "zero or above".into();
            return Err(ExactError::BadParameter { solution: ENTRY.name, name: "over", value: over, need });
        }
        Ok(BarWave { elastic, pull, length, density, over, time: 0.0 })
    }

    fn modulus(&self) -> f64 {
        self.elastic.lambda() + 2.0 * self.elastic.mu()
    }

    /// Speed of the waves `c`, m/s.
    pub fn speed(&self) -> f64 {
        (self.modulus() / self.density).sqrt()
    }

    /// The pull `p` at time `t` (Pa), its integral since 0 (Pa s) or its rate (Pa/s).
    fn pulled(&self, of: Of, t: f64) -> f64 {
        let part = match of {
            _ if t <= 0.0 => 0.0,
            Of::Integral if t < self.over => 0.5 * t * t / self.over,
            Of::Value if t < self.over => t / self.over,
            Of::Rate if t < self.over => 1.0 / self.over,
            Of::Integral => t - 0.5 * self.over,
            Of::Value => 1.0,
            Of::Rate => 0.0,
        };
        self.pull * part
    }

    /// `sum_n (-1)^n (f(t - (2 n L + s) / c) + sign f(t - (2 (n + 1) L - s) / c))`, with `f` the chosen
    /// function of the pull.
    fn waves(&self, of: Of, x: f64, sign: f64) -> f64 {
        let c = self.speed();
        let from_end = self.length - x;
        let passages = (0.5 * self.time * c / self.length).ceil() as usize;
        let wave = |n: usize| {
            let far = 2.0 * n as f64 * self.length;
            let out = self.pulled(of, self.time - (far + from_end) / c);
            let back = self.pulled(of, self.time - (far + 2.0 * self.length - from_end) / c);
            (if n.is_multiple_of(2) { 1.0 } else { -1.0 }) * (out + sign * back)
        };
        (0..=passages).map(wave).sum()
    }
}

impl Exact for BarWave {
    fn displacement(&self, p: &Point3) -> Vector3 {
        Vector3::new(self.speed() / self.modulus() * self.waves(Of::Integral, p.x, -1.0), 0.0, 0.0)
    }

    fn gradient(&self, p: &Point3) -> Matrix3 {
        let mut h = Matrix3::zeros();
        h[(0, 0)] = self.waves(Of::Value, p.x, 1.0) / self.modulus();
        h
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        self.elastic.stress(&self.gradient(x))
    }

    fn body_force(&self, p: &Point3) -> Vector3 {
        Vector3::new(-self.waves(Of::Rate, p.x, -1.0) / self.speed(), 0.0, 0.0)
    }

    fn at(&self, time: f64) -> Option<Box<dyn Exact>> {
        Some(Box::new(BarWave { time, ..*self }))
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "bar-wave",
    meaning: "waves in a bar under a traction on its end x = L",
    source: "d'Alembert; Graff, Wave Motion in Elastic Solids (1975), ch. 2",
    parameters: &[
        Parameter::required("pull", Dimension::Pressure, "final traction along x on the end"),
        Parameter::required("length", Dimension::Length, "length along x, from 0"),
        Parameter::required("density", Dimension::Density, "mass per volume"),
        Parameter::default("over", Dimension::Time, 0.0, "time over which the traction grows"),
    ],
    build: |medium, values| {
        let [pull, length, density, over] = numbers(values, ["pull", "length", "density", "over"])?;
        Ok(Box::new(BarWave::new(medium.elastic, pull, [length, density], over)?))
    },
};
