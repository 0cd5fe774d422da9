//! First bending vibration of a slender cantilever by beam theory: a period, not a field.
//!
//! ```text
//! Source      Huang, J. Appl. Mech. 28 (1961) 579-584: Timoshenko's beam, clamped and free.
//!
//!   |//+-----------------------------+   ^ v
//!   +//|                             |           square section of side D, length L, r^2 = D^2 / (12 L^2)
//!    //+-----------------------------+
//!
//! Period      2 pi / omega,  omega = b sqrt(E I / (rho A)) / L^2,  b the root near 1.8751^2 of
//!             2 + (b^2 (r^2 - s^2)^2 + 2) cosh(b alpha) cos(b beta)
//!               - b (r^2 + s^2) / sqrt(1 - b^2 r^2 s^2) sinh(b alpha) sin(b beta) = 0,
//!             (alpha, beta)^2 = (-+ (r^2 + s^2) + sqrt((r^2 - s^2)^2 + 4 / b^2)) / 2,  s^2 = r^2 E / (k G).
//! Conditions  small amplitude; k = 5/6, and nu = 0 so that the clamp constrains only the rotation.
//! Must hold   longer than Euler and Bernoulli's by 7.9 D^2 / (12 L^2) to first order, 0.66 % at L = 10 D.
//! ```

use super::elastic::Elastic;

/// A clamped beam of square section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VibratingCantilever {
    /// Material.
    pub elastic: Elastic,
    /// Density, kg/m^3.
    pub density: f64,
    /// Length, m.
    pub length: f64,
    /// Side of the section, m.
    pub side: f64,
}

/// First root of `cos x cosh x = -1`.
const ROOT: f64 = 1.875_104_068_711_961;

impl VibratingCantilever {
    /// Period by Euler and Bernoulli, s: without shear and rotary inertia.
    pub fn bernoulli(&self) -> f64 {
        self.period_of(ROOT * ROOT)
    }

    /// Period by Timoshenko, s.
    pub fn timoshenko(&self) -> f64 {
        let slender = (self.side / self.length).powi(2) / 12.0;
        let shear = slender * self.elastic.young() / (5.0 / 6.0 * self.elastic.mu());
        let equation = |b: f64| {
            let root = ((slender - shear).powi(2) + 4.0 / (b * b)).sqrt();
            let [alpha, beta] = [-1.0, 1.0].map(|sign| (0.5 * (root + sign * (slender + shear))).sqrt());
            let sum = b * b * (slender - shear).powi(2) + 2.0;
            let both = b * (slender + shear) / (1.0 - b * b * slender * shear).sqrt();
            2.0 + sum * (b * alpha).cosh() * (b * beta).cos() - both * (b * alpha).sinh() * (b * beta).sin()
        };
        let (mut low, mut high) = (0.5 * ROOT * ROOT, 1.1 * ROOT * ROOT);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if equation(low) * equation(middle) <= 0.0 { high = middle } else { low = middle }
        }
        self.period_of(0.5 * (low + high))
    }

    fn period_of(&self, b: f64) -> f64 {
        let speed = (self.elastic.young() / self.density / 12.0).sqrt() * self.side;
        2.0 * std::f64::consts::PI * self.length * self.length / (b * speed)
    }
}
