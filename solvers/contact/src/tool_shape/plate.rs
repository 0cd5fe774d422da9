//! Half space `z <= 0`, with the distance `sd = z`.

use catalogue::{Build, Dimension, Entry, Kind, Parameter};
use shape::{Matrix3, Vector3};

use super::outline;
use super::signed_distance::Shape;
use crate::error::ContactError;

/// Half space `z <= 0`: a plate of unlimited extent and thickness, whose face points along +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate;

const AXIS: Parameter = Parameter::optional(
    "axis",
    Dimension::None,
    "outward normal of the face; the direction of motion unless given",
)
.of(Kind::Vector);

pub(super) const ENTRY: Entry<Build<Plate>> = Entry {
    name: "plate",
    meaning: "a half space, bounded by an infinite flat face",
    source: "",
    parameters: &[AXIS],
    build: |_| Ok(Plate),
};

impl Shape for Plate {
    #[inline]
    fn foot(&self, p: &Vector3) -> (f64, Vector3) {
        (p.z, Vector3::z())
    }

    #[inline]
    fn hessian(&self, _: &Vector3) -> Matrix3 {
        Matrix3::zeros()
    }

    fn half_extents(&self) -> Vector3 {
        Vector3::new(f64::INFINITY, f64::INFINITY, 0.0)
    }

    fn inradius(&self) -> f64 {
        f64::INFINITY
    }

    /// Returns a slab as wide as the body.
    fn outline(&self, body: f64) -> Vec<Vector3> {
        let half = 0.5 * body;
        let corners = vec![Vector3::new(half, half, 0.0), Vector3::new(half, half, -0.1 * half)];
        outline::mirrored(corners, [true, true, false])
    }

    fn axis(&self, along: Vector3) -> Option<Vector3> {
        Some(along)
    }

    fn check(&self) -> Result<(), ContactError> {
        Ok(())
    }
}
