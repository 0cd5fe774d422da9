//! Rigid motion of a tool: a path of legs, on each of which it moves along a straight line or turns about an
//! axis.

use nalgebra::{Rotation3, Unit};
use shape::{Matrix3, Point3, Vector3};

use crate::error::ContactError;

/// Motion of a tool on one leg of its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Motion along a unit vector.
    Along(Vector3),
    /// Turn about an axis.
    About(Turn),
}

impl From<Vector3> for Motion {
    fn from(along: Vector3) -> Motion {
        Motion::Along(along)
    }
}

/// Turn about an axis: after the travel (closure) `c` the angle is `c / arm`, right-handed about the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Point on the axis (the pin of a hinge), m.
    pub pin: Point3,
    /// Unit vector of the axis.
    pub axis: Vector3,
    /// Distance from the axis at which the travel is measured, m.
    pub arm: f64,
}

impl Turn {
    /// Rotation after a travel (m).
    fn after(&self, travel: f64) -> Matrix3 {
        Rotation3::from_axis_angle(&Unit::new_unchecked(self.axis), travel / self.arm).into_inner()
    }
}

/// Position and orientation of a tool at a closure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Rotation (3, 3) from the axes of the shape to those of the world.
    pub rotation: Matrix3,
    /// Position of the shape's origin, m.
    pub place: Point3,
}

impl Pose {
    /// Returns a position (m) in the tool's frame.
    #[inline]
    pub(super) fn local(&self, x: &Point3) -> Vector3 {
        self.rotation.tr_mul(&(x - self.place))
    }

    /// Returns a vector of the tool's frame in the world's axes.
    #[inline]
    pub(super) fn to_world(self, v: &Vector3) -> Vector3 {
        self.rotation * v
    }
}

/// Leg of a tool's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Closure at its start, m.
    pub(super) from: f64,
    /// Position of the shape's origin relative to the start of the path, m.
    pub(super) start: Vector3,
    /// Rotation (3, 3) of the tool relative to the start of the path.
    pub(super) turned: Matrix3,
    /// Motion in the world's axes.
    pub(super) motion: Motion,
    /// Unit direction in which the shape's origin moves at the start; the axis of a turn about the origin.
    pub(super) along: Vector3,
}

impl Leg {
    /// Makes the first leg of a path from the position `at` (m).
    pub(super) fn first(at: &Point3, motion: Motion) -> Result<Leg, ContactError> {
        Leg::at(at, 0.0, Vector3::zeros(), Matrix3::identity(), motion)
    }

    /// Makes the leg that follows after a travel (m) on this one. Its turn is about a line that is fixed to
    /// the tool and given in the tool's position at the start of the path, `at` (m).
    pub(super) fn next(&self, at: &Point3, travel: f64, motion: Motion) -> Result<Leg, ContactError> {
        let (start, turned) = self.reached(at, travel);
        let motion = match motion {
            Motion::Along(_) => motion,
            Motion::About(Turn { pin, axis, arm }) => {
                Motion::About(Turn { pin: at + start + turned * (pin - at), axis: turned * axis, arm })
            }
        };
        Leg::at(at, self.from + travel, start, turned, motion)
    }

    fn at(
        at: &Point3,
        from: f64,
        start: Vector3,
        turned: Matrix3,
        motion: Motion,
    ) -> Result<Leg, ContactError> {
        let along = match motion {
            Motion::Along(along) => along,
            Motion::About(Turn { pin, axis, arm }) => {
                if !(arm > 0.0 && arm.is_finite()) {
                    return Err(ContactError::Size { what: "the arm of a turn", value: arm });
                }
                if !pin.coords.iter().all(|c| c.is_finite()) {
                    return Err(ContactError::Place { what: "the axis of a turn" });
                }
                axis.cross(&(at + start - pin)).try_normalize(1e-9 * arm).unwrap_or(axis)
            }
        };
        let given = if let Motion::About(turn) = motion { turn.axis } else { along };
        let length = given.norm();
        // Written so that a NaN fails.
        if !((length - 1.0).abs() <= 1e-9) {
            return Err(ContactError::Direction { length });
        }
        Ok(Leg { from, start, turned, motion, along })
    }

    /// Position of the shape's origin relative to the start of the path (m), and rotation of the tool, after
    /// a travel (m) on the leg.
    pub(super) fn reached(&self, at: &Point3, travel: f64) -> (Vector3, Matrix3) {
        match self.motion {
            Motion::Along(along) => (self.start + along * travel, self.turned),
            Motion::About(turn) => {
                let by = turn.after(travel);
                (turn.pin - at + by * (at + self.start - turn.pin), by * self.turned)
            }
        }
    }

    /// Motion of the tool on the leg, in the world's axes.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Returns the force (N) in the sense of the travel: the power of a force (N) at `place` (m) with a
    /// moment (N m) about it, per speed of the travel.
    pub(super) fn driving(&self, place: &Point3, force: &Vector3, moment: &Vector3) -> f64 {
        match self.motion {
            Motion::Along(along) => force.dot(&along),
            Motion::About(Turn { pin, axis, arm }) => (moment + (place - pin).cross(force)).dot(&axis) / arm,
        }
    }
}
