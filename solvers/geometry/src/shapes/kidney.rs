//! A kidney-like bean: the unit ball bent along its long axis.

use crate::Point3;

/// The body `((x - k (y/b)^2)/a)^2 + (y/b)^2 + (z/c)^2 <= 1` with a = k = 160/9 mm, b = 37.5 mm, c = 15 mm: 40 x 75
/// x 30 mm along x (lateral), y (long axis), z (anterior), hilum on +x, volume `4/3 pi 10^4` mm^3. It is the image of
/// the unit ball under `(X, Y, Z) -> (a X + k Y^2, b Y, c Z)`, a smooth bijection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kidney;

impl Kidney {
    /// Half width along x, in metres; also the bend `k`.
    pub const A: f64 = 0.16 / 9.0;
    /// Half length along y, in metres.
    pub const B: f64 = 0.0375;
    /// Half thickness along z, in metres.
    pub const C: f64 = 0.015;

    /// Position (m) of a point of the unit ball.
    pub fn map(&self, ball: &Point3) -> Point3 {
        Point3::new(Self::A * (ball.x + ball.y * ball.y), Self::B * ball.y, Self::C * ball.z)
    }

    /// The point that [`Kidney::map`] takes to `p` (m); inside the unit ball when `p` is inside the kidney.
    pub fn preimage(&self, p: &Point3) -> Point3 {
        let y = p.y / Self::B;
        Point3::new(p.x / Self::A - y * y, y, p.z / Self::C)
    }

    /// The level function `F(p)`: negative inside, 0 on the surface, positive outside. Dimensionless.
    pub fn level(&self, p: &Point3) -> f64 {
        self.preimage(p).coords.norm_squared() - 1.0
    }
}
