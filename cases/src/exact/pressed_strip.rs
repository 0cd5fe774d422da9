//! A slender strip bent by a pressure that follows it, by the elastica: the place of its end, not a field.
//!
//! ```text
//! Source      Euler's elastica; Bisshopp and Drucker, Q. Appl. Math. 3 (1945) 272-275, with a load that stays
//!             normal to the strip.
//!
//!   |/+---------------------------+  clamped at s = 0, free at s = L
//!     ^  ^  ^  ^  p  ^  ^  ^  ^  ^   on the deformed lower face
//!
//! Equations   theta' = M / (E I), M' = -V, N' = V theta', V' = -N theta' - q, per width; N = V = M = 0 at L.
//!             The pressed face is longer than the middle: q = p (1 + theta' h / 2).
//! Conditions  inextensible; nu = 0, or a modulus E / (1 - nu^2) in plane strain.
//! Must hold   the pressure turns with the strip, so the shape does not depend on its direction: the equations
//!             are integrated from the free end and turned back.
//! ```

use super::vectors::Vector3;

/// Steps of fourth-order Runge-Kutta: an error below 1e-10 of the length.
const STEPS: usize = 1000;

/// A clamped strip along x, pressed towards +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressedStrip {
    /// Young's modulus, Pa.
    pub young: f64,
    /// Length, m.
    pub length: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Pressure, Pa.
    pub pressure: f64,
}

impl PressedStrip {
    /// Displacement of the end, m.
    pub fn end(&self) -> Vector3 {
        let bending = self.young * self.thickness.powi(3) / 12.0;
        let h = -self.length / STEPS as f64;
        // theta, M, N, V, x, z.
        let slope = |y: [f64; 6]| {
            let [theta, moment, normal, shear, ..] = y;
            let curvature = moment / bending;
            let load = self.pressure * (1.0 + 0.5 * curvature * self.thickness);
            let turned = -normal * curvature - load;
            [curvature, -shear, shear * curvature, turned, theta.cos(), theta.sin()]
        };
        let mut y = [0.0; 6];
        for _ in 0..STEPS {
            let shifted = |by: [f64; 6], part: f64| std::array::from_fn(|k| y[k] + part * h * by[k]);
            let k1 = slope(y);
            let k2 = slope(shifted(k1, 0.5));
            let k3 = slope(shifted(k2, 0.5));
            let k4 = slope(shifted(k3, 1.0));
            y = std::array::from_fn(|k| y[k] + h / 6.0 * (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]));
        }
        // The clamp is at y, the end at zero: turned back by the angle of the clamp.
        let ([sin, cos], [x, z]) = ([y[0].sin(), y[0].cos()], [-y[4], -y[5]]);
        Vector3::new(cos * x + sin * z - self.length, 0.0, cos * z - sin * x)
    }
}
