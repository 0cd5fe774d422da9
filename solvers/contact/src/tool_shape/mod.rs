//! Rigid tools as signed distances, each in its own frame: negative inside, gradient a unit vector pointing out.
//!
//! Each shape is a file with its distance and its [`ToolShapeEntry`], and a line of the list below. Outside and near the
//! surface the distances are exact. On the medial axis, where the nearest point is not unique, one of them is taken (the
//! files say which) and the Hessian's infinite part is left out: no NaN anywhere.

mod outline;

use catalogue::{Dimension, Entry, Kind, Parameter, Problem, Range, Values};
use shape::{Matrix3, Point3, Vector3};

use crate::ContactError;

/// A shape of tools that scene files can name.
pub type ToolShapeEntry = Entry<fn(&Values) -> Result<ToolShape, Problem>>;

/// A centre, axis or core is met within this part of the tool's size: there the direction to it is noise.
const MEDIAL: f64 = 1e-12;

/// What a shape is, in its own frame. Lengths in metres.
trait Shape {
    /// Signed distance and its gradient.
    fn foot(&self, p: &Vector3) -> (f64, Vector3);

    /// Hessian of the distance (3, 3), 1/m.
    fn hessian(&self, p: &Vector3) -> Matrix3;

    /// Half of a box about the origin that holds the shape; infinite where it has no end.
    fn half_extents(&self) -> Vector3;

    /// Radius of the largest ball inside.
    fn inradius(&self) -> f64;

    /// Points whose convex hull is the shape, for pictures beside a body of that extent.
    fn outline(&self, body: f64) -> Vec<Vector3>;

    /// Where the z axis of the frame points unless a scene says, of a tool that closes along a direction; `None` for a shape
    /// that stands along the axes of the scene.
    fn axis(&self, _along: Vector3) -> Option<Vector3> {
        None
    }

    /// Area of the face that presses where the tool closes along a direction, m^2; `None` without a face of its own.
    fn face_area(&self, _along: &Vector3) -> Option<f64> {
        None
    }

    /// Refuses lengths that make no shape.
    fn check(&self) -> Result<(), ContactError>;
}

/// Declares the files of the shapes, the closed enum that tells them apart without a call through a pointer, and the slice of
/// their entries.
macro_rules! tool_shapes {
    ($($file:ident::$shape:ident,)*) => {
        $(
            mod $file;
            pub use $file::$shape;
            impl From<$shape> for ToolShape {
                fn from(shape: $shape) -> ToolShape {
                    ToolShape::$shape(shape)
                }
            }
        )*

        /// A rigid tool in its own frame.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs)] // each is its type
        pub enum ToolShape {
            $($shape($shape),)*
        }

        /// Every shape, in the order tables list them.
        pub static TOOL_SHAPES: &[ToolShapeEntry] = &[$($file::ENTRY),*];

        impl ToolShape {
            /// The name used in scene files and tables.
            pub fn name(&self) -> &'static str {
                match self {
                    $(ToolShape::$shape(_) => $file::ENTRY.name,)*
                }
            }

            /// Signed distance and gradient only.
            #[inline]
            pub fn foot(&self, p: &Vector3) -> (f64, Vector3) {
                match self {
                    $(ToolShape::$shape(shape) => shape.foot(p),)*
                }
            }

            /// Hessian only (3, 3), 1/m.
            #[inline]
            pub fn hessian(&self, p: &Vector3) -> Matrix3 {
                match self {
                    $(ToolShape::$shape(shape) => shape.hessian(p),)*
                }
            }

            fn shape(&self) -> &dyn Shape {
                match self {
                    $(ToolShape::$shape(shape) => shape,)*
                }
            }
        }
    };
}

tool_shapes! {
    plate::Plate,
    rounded_box::RoundedBox,
    sphere::Sphere,
    cylinder::Cylinder,
    capsule::Capsule,
}

const RADIUS: Parameter = Parameter::required("radius", Dimension::Length, "radius").within(Range::Positive);
const LENGTH: Parameter = Parameter::required("length", Dimension::Length, "length").within(Range::Positive);
const AXIS: Parameter =
    Parameter::optional("axis", Dimension::None, "axis; along z unless given").of(Kind::Vector);

/// Signed distance with its derivatives, at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Signed distance, m; negative inside.
    pub value: f64,
    /// Unit gradient, away from the tool.
    pub gradient: Vector3,
    /// Hessian (3, 3), 1/m: the curvature of the level set through the point.
    pub hessian: Matrix3,
}

impl ToolShape {
    /// Signed distance, gradient and Hessian at `p`, all in the tool's frame.
    pub fn distance(&self, p: &Vector3) -> Distance {
        let (value, gradient) = self.foot(p);
        Distance { value, gradient, hessian: self.hessian(p) }
    }

    /// Lowest and highest corner of a box (tool's frame) that holds the tool; infinite for a half space, but for its face.
    pub fn bounds(&self) -> (Point3, Point3) {
        let half = self.shape().half_extents();
        let low = if self.is_endless() { Vector3::repeat(f64::NEG_INFINITY) } else { -half };
        (Point3::from(low), Point3::from(half))
    }

    /// Whether the shape has no end.
    pub fn is_endless(&self) -> bool {
        self.shape().half_extents().iter().any(|half| half.is_infinite())
    }

    /// Radius of the largest ball inside, m: nothing is deeper than that. Infinite for a plate.
    pub fn inradius(&self) -> f64 {
        self.shape().inradius()
    }

    /// Points whose convex hull is the tool, for pictures beside a body of that extent (m).
    pub fn outline(&self, body: f64) -> Vec<Vector3> {
        self.shape().outline(body)
    }

    /// Where the z axis of the frame points unless a scene says, of a tool that closes along a unit vector; `None` for a shape
    /// that stands along the axes of the scene.
    pub fn axis(&self, along: Vector3) -> Option<Vector3> {
        self.shape().axis(along)
    }

    /// Area of the face that presses where the tool closes along a unit vector, m^2; `None` without a face of its own.
    pub fn face_area(&self, along: &Vector3) -> Option<f64> {
        self.shape().face_area(along)
    }

    pub(super) fn check(&self) -> Result<(), ContactError> {
        self.shape().check()
    }
}

/// Refuses a length that is none; written so that a NaN fails.
fn size(what: &'static str, value: f64) -> Result<(), ContactError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ContactError::Size { what, value }) }
}
