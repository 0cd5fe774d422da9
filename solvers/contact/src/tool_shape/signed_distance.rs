//! The interface of all shapes.

use catalogue::{Dimension, Kind, Parameter, Range};
use shape::{Matrix3, Vector3};

use crate::error::ContactError;

pub(super) const RADIUS: Parameter =
    Parameter::required("radius", Dimension::Length, "radius").within(Range::Positive);
pub(super) const LENGTH: Parameter =
    Parameter::required("length", Dimension::Length, "length").within(Range::Positive);
pub(super) const AXIS: Parameter =
    Parameter::optional("axis", Dimension::None, "axis; along z unless given").of(Kind::Vector);

/// Part of the tool's size within which a point counts as lying on a centre, an axis or a core: the direction
/// to it is noise.
pub(super) const MEDIAL: f64 = 1e-12;

/// Signed distance with its derivatives at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Signed distance, m; negative inside.
    pub value: f64,
    /// Unit gradient, away from the tool.
    pub gradient: Vector3,
    /// Hessian (3, 3), 1/m: the curvature of the level set through the point.
    pub hessian: Matrix3,
}

/// Shape of a tool, in its own frame. Lengths are in metres.
pub(super) trait Shape {
    /// Returns the signed distance and its gradient.
    fn foot(&self, p: &Vector3) -> (f64, Vector3);

    /// Returns the Hessian of the distance (3, 3), 1/m.
    fn hessian(&self, p: &Vector3) -> Matrix3;

    /// Returns the half extents of a box about the origin that contains the shape; infinite for an unbounded
    /// shape.
    fn half_extents(&self) -> Vector3;

    /// Returns the radius of the largest ball inside.
    fn inradius(&self) -> f64;

    /// Returns points whose convex hull is the shape, for pictures of it next to a body of size `body`.
    fn outline(&self, body: f64) -> Vec<Vector3>;

    /// Returns the default direction of the z axis of the tool's frame; `None` if the frame has the axes of
    /// the scene by default.
    fn axis(&self, _along: Vector3) -> Option<Vector3> {
        None
    }

    /// Returns the area of the face that presses if the tool moves along a direction, m^2; `None` if it has
    /// no such face.
    fn face_area(&self, _along: &Vector3) -> Option<f64> {
        None
    }

    /// Whether the shape is convex, and with it the distance along a line.
    fn is_convex(&self) -> bool {
        true
    }

    /// Checks the lengths.
    fn check(&self) -> Result<(), ContactError>;
}

/// Checks that a length is positive and finite; written so that a NaN fails.
pub(super) fn size(what: &'static str, value: f64) -> Result<(), ContactError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ContactError::Size { what, value }) }
}
