//! Resultants of forces.

use crate::{Point3, Vector3};

/// Force (N) and moment about the coordinate origin (N m) of several forces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// Sum of the forces, N.
    pub force: Vector3,
    /// Sum of their moments about the coordinate origin, N m.
    pub moment: Vector3,
}

impl Resultant {
    /// Adds a force (N) at a position (m).
    pub fn add(&mut self, x: &Point3, force: &Vector3) {
        self.force += force;
        self.moment += x.coords.cross(force);
    }

    /// Returns the moment about a point (m), N m.
    pub fn about(&self, point: &Point3) -> Vector3 {
        self.moment - point.coords.cross(&self.force)
    }
}

impl std::ops::Add for Resultant {
    type Output = Resultant;

    fn add(self, other: Resultant) -> Resultant {
        Resultant { force: self.force + other.force, moment: self.moment + other.moment }
    }
}

impl std::iter::Sum for Resultant {
    fn sum<I: Iterator<Item = Resultant>>(each: I) -> Resultant {
        each.fold(Resultant::default(), |sum, one| sum + one)
    }
}
