//! A surface as a body for clouds and clipped grids.

use super::Surface;
use crate::Point3;
use crate::shapes::Shape;

/// Largest number of random points in the bounding box before the centre is used; no body fills so little of
/// its box.
const TRIES: usize = 1_000_000;

impl Shape for Surface {
    fn volume(&self) -> f64 {
        Surface::volume(self)
    }

    fn level(&self, p: &Point3) -> f64 {
        self.signed_distance(p)
    }

    fn bounds(&self) -> [Point3; 2] {
        Surface::bounds(self)
    }

    fn project_to_surface(&self, p: &Point3) -> Point3 {
        self.closest(p).0
    }

    fn volume_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        let [low, high] = Surface::bounds(self);
        let mut draw = || Point3::from(low.coords.zip_map(&high.coords, |a, b| a + (b - a) * unit()));
        let found = (0..TRIES).map(|_| draw()).find(|p| self.signed_distance(p) <= 0.0);
        found.unwrap_or_else(|| self.points()[0])
    }

    fn surface_sample(&self, unit: &mut dyn FnMut() -> f64) -> Point3 {
        let wanted = unit() * self.area();
        let triangle = self.areas.partition_point(|&sum| sum <= wanted).min(self.triangles.len() - 1);
        let [a, b, c] = self.corners(triangle);
        let (u, v) = (unit(), unit());
        // Folds the unit square onto the triangle.
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        a + (b - a) * u + (c - a) * v
    }
}
