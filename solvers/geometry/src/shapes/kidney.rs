//! The kidney, a bean-like body: the unit ball bent along its long axis; and its upper half.

use super::{Shape, along, unit_ball, unit_sphere};
use crate::{Point3, Vector3};

/// The kidney `((x - k (y/b)^2)/a)^2 + (y/b)^2 + (z/c)^2 <= 1` with a = k = 160/9 mm, b = 37.5 mm, c = 15 mm.
/// Its dimensions are 40 x 75 x 30 mm along x (lateral), y (long axis) and z (anterior), with the hilum on +x
/// and a volume of `4/3 pi 10^4` mm^3. It is the image of the unit ball under `(X, Y, Z) -> (a X + k Y^2, b
/// Y, c Z)`, a smooth bijection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kidney;

impl Kidney {
    /// Half width `a` of the kidney along x, in metres; also the bend `k`.
    pub const A: f64 = 0.16 / 9.0;
    /// Half length `b` of the kidney along y, in metres.
    pub const B: f64 = 0.0375;
    /// Half thickness `c` of the kidney along z, in metres.
    pub const C: f64 = 0.015;

    /// Image (m) of a point of the unit ball.
    pub fn map(&self, ball: &Point3) -> Point3 {
        Point3::new(Self::A * (ball.x + ball.y * ball.y), Self::B * ball.y, Self::C * ball.z)
    }

    /// Preimage of `p` (m) under [`Kidney::map`], inside the unit ball if `p` is inside the kidney.
    pub fn preimage(&self, p: &Point3) -> Point3 {
        let y = p.y / Self::B;
        Point3::new(p.x / Self::A - y * y, y, p.z / Self::C)
    }
}

impl Shape for Kidney {
    fn volume(&self) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * Self::A * Self::B * Self::C
    }

    /// `((x - k (y/b)^2)/a)^2 + (y/b)^2 + (z/c)^2 - 1`, dimensionless.
    fn level(&self, p: &Point3) -> f64 {
        self.preimage(p).coords.norm_squared() - 1.0
    }

    fn bounds(&self) -> [Point3; 2] {
        // x = a (X + Y^2) with X^2 + Y^2 <= 1 is largest at X = 1/2.
        [Point3::new(-Self::A, -Self::B, -Self::C), Point3::new(1.25 * Self::A, Self::B, Self::C)]
    }

    fn project_to_surface(&self, p: &Point3) -> Point3 {
        self.map(&along(self.preimage(p).coords, 1.0).into())
    }

    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        // The map's Jacobian determinant is a b c everywhere, so the image of a uniform distribution is
        // uniform.
        self.map(&unit_ball(unit).into())
    }

    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        // Area scales by |cof(D) n| = a b c |D^-T n|, where D is the map's gradient; samples are drawn by
        // rejection. On the sphere, |D^-T n|^2 = (X/a)^2 + ((Y - 2 X Y)/b)^2 + (Z/c)^2 is at most 1/c^2.
        loop {
            let n = unit_sphere(unit);
            let stretch =
                Vector3::new(n.x / Self::A, (n.y - 2.0 * n.x * n.y) / Self::B, n.z / Self::C).norm();
            if unit() < stretch * Self::C {
                return self.map(&n.into());
            }
        }
    }
}

/// The half z >= 0 of the [`Kidney`], with the plane z = 0 as a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfKidney;

impl HalfKidney {
    /// Area (m^2) of the curved part, half of the kidney's area, computed numerically.
    const CURVED: f64 = 33.506e-4;
    /// Area (m^2) of the plane face.
    const FACE: f64 = std::f64::consts::PI * Kidney::A * Kidney::B;

    fn above(p: Point3) -> Point3 {
        Point3::new(p.x, p.y, p.z.abs())
    }

    /// A random point of the plane face: the image of the unit disc, whose map scales all areas equally.
    fn on_face(unit: &mut dyn FnMut() -> f64) -> Point3 {
        loop {
            let (x, y) = (2.0 * unit() - 1.0, 2.0 * unit() - 1.0);
            if x * x + y * y < 1.0 {
                return Kidney.map(&Point3::new(x, y, 0.0));
            }
        }
    }
}

impl Shape for HalfKidney {
    fn volume(&self) -> f64 {
        Kidney.volume() / 2.0
    }

    /// The kidney's level function above the plane, combined with `-z/c` below; dimensionless.
    fn level(&self, p: &Point3) -> f64 {
        Kidney.level(p).max(-p.z / Kidney::C)
    }

    fn bounds(&self) -> [Point3; 2] {
        let [low, high] = Kidney.bounds();
        [Point3::new(low.x, low.y, 0.0), high]
    }

    fn project_to_surface(&self, p: &Point3) -> Point3 {
        let on_plane = Point3::new(p.x, p.y, 0.0);
        let inside = Kidney.inside(&on_plane);
        if p.z <= 0.0 {
            return if inside { on_plane } else { Kidney.project_to_surface(&on_plane) };
        }
        let curved = Kidney.project_to_surface(p);
        if inside && p.z < (curved - p).norm() { on_plane } else { curved }
    }

    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        HalfKidney::above(Kidney.volume_sample(unit))
    }

    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        if unit() * (HalfKidney::FACE + HalfKidney::CURVED) < HalfKidney::FACE {
            return HalfKidney::on_face(unit);
        }
        HalfKidney::above(Kidney.surface_sample(unit))
    }

    fn edge_sample(&self, unit: &mut dyn FnMut() -> f64) -> Option<Point3> {
        // (X, Y) on the unit circle moves along (a (-Y + 2 X Y), b X), at most 41 mm; samples are drawn by
        // rejection.
        loop {
            let rim = Kidney.preimage(&Kidney.project_to_surface(&HalfKidney::on_face(unit)));
            let along = (Kidney::A * rim.y * (2.0 * rim.x - 1.0)).hypot(Kidney::B * rim.x);
            if unit() * 0.041 < along {
                return Some(Kidney.map(&rim));
            }
        }
    }
}
