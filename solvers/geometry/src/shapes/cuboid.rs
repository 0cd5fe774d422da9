//! The axis-parallel box.

use super::Shape;
use crate::{Point3, Vector3};

/// An axis-parallel box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Lowest corner (m).
    pub min: Point3,
    /// Highest corner (m).
    pub max: Point3,
}

impl Cuboid {
    fn size(&self) -> Vector3 {
        self.max - self.min
    }

    /// The point at a fraction of each side; exact at 0 and 1.
    fn at(&self, share: [f64; 3]) -> Point3 {
        Point3::from(Vector3::from_fn(|d, _| match share[d] {
            1.0 => self.max[d],
            s => self.min[d] + s * self.size()[d],
        }))
    }
}

/// A random index 0, 1 or 2 with probabilities proportional to `sizes`.
fn pick(sizes: [f64; 3], unit: &mut dyn FnMut() -> f64) -> usize {
    let u = unit() * (sizes[0] + sizes[1] + sizes[2]);
    if u < sizes[0] {
        0
    } else if u < sizes[0] + sizes[1] {
        1
    } else {
        2
    }
}

impl Shape for Cuboid {
    fn volume(&self) -> f64 {
        self.size().product()
    }

    fn level(&self, p: &Point3) -> f64 {
        let half = 0.5 * self.size();
        let q = (p - nalgebra::center(&self.min, &self.max)).abs() - half;
        q.map(|c| c.max(0.0)).norm() + q.max().min(0.0)
    }

    fn bounds(&self) -> [Point3; 2] {
        [self.min, self.max]
    }

    fn project_to_surface(&self, p: &Point3) -> Point3 {
        let mut q = Point3::from(Vector3::from_fn(|d, _| p[d].clamp(self.min[d], self.max[d])));
        if q == *p {
            // Inside, move to the nearest of the six faces.
            let mut best = (f64::INFINITY, 0, 0.0);
            for d in 0..3 {
                for side in [self.min[d], self.max[d]] {
                    if (p[d] - side).abs() < best.0 {
                        best = ((p[d] - side).abs(), d, side);
                    }
                }
            }
            q[best.1] = best.2;
        }
        q
    }

    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        self.at([unit(), unit(), unit()])
    }

    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        let s = self.size();
        let axis = pick([s.y * s.z, s.x * s.z, s.x * s.y], unit);
        let mut share = [unit(), unit(), unit()];
        share[axis] = share[axis].round();
        self.at(share)
    }

    fn corners(&self) -> Vec<Point3> {
        (0..8).map(|c| self.at([c & 1, c >> 1 & 1, c >> 2 & 1].map(f64::from))).collect()
    }

    fn edge_sample(&self, unit: &mut dyn FnMut() -> f64) -> Option<Point3> {
        let s = self.size();
        let axis = pick([s.x, s.y, s.z], unit);
        let mut share = [unit(), unit(), unit()];
        for d in (0..3).filter(|&d| d != axis) {
            share[d] = share[d].round();
        }
        Some(self.at(share))
    }
}
