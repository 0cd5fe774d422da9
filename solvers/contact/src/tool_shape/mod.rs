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

    /// The surface as quadrangles, for pictures beside a body of that extent (m): those of a grid on the box that holds the tool, drawn
    /// towards its middle. Edges of boxes stay edges.
    pub fn skin(&self, body: f64) -> (Vec<Vector3>, Vec<[u32; 4]>) {
        let outline = self.outline(body);
        let low = outline.iter().fold(Vector3::repeat(f64::INFINITY), |low, p| low.inf(p));
        let high = outline.iter().fold(Vector3::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let (mut points, quads) = outline::cube();
        for point in &mut points {
            let way = point.component_mul(&half);
            let is_inside = |part: f64| self.foot(&(middle + way * part)).0 < 0.0;
            // Of a tool without end the box is what is drawn.
            let (mut inside, mut outside) = (0.0, 1.0);
            if !is_inside(1.0) {
                for _ in 0..40 {
                    let part = 0.5 * (inside + outside);
                    *(if is_inside(part) { &mut inside } else { &mut outside }) = part;
                }
            }
            *point = middle + way * outside;
        }
        (points, quads)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skins_lie_on_their_shapes_and_look_outwards() {
        let shapes: [ToolShape; 3] = [
            Sphere { radius: 0.01 }.into(),
            RoundedBox { half: [0.01, 0.02, 0.005], radius: 0.002 }.into(),
            Capsule { radius: 0.004, half_length: 0.02 }.into(),
        ];
        for shape in shapes {
            let (points, quads) = shape.skin(0.1);
            let far = points.iter().map(|p| shape.foot(p).0.abs()).fold(0.0, f64::max);
            assert!(far < 1e-12, "{}: {far}", shape.name());
            let mut volume = 0.0;
            for [a, b, c, d] in quads.iter().map(|quad| quad.map(|k| points[k as usize])) {
                let normal = (c - a).cross(&(d - b));
                let middle = (a + b + c + d) / 4.0;
                assert!(shape.foot(&middle).1.dot(&normal) > 0.0, "{}", shape.name());
                volume += middle.dot(&normal) / 6.0;
            }
            // A ball of the same surface for scale: corners cut 1 to 3 % off.
            let ball = 4.0 / 3.0 * std::f64::consts::PI * shape.inradius().powi(3);
            assert!(volume > 0.95 * ball, "{}: {volume} of {ball}", shape.name());
        }
    }

    #[test]
    fn a_tool_without_end_is_drawn_beside_its_body() {
        let (points, _) = ToolShape::from(Plate).skin(0.1);
        let top = points.iter().map(|p| p.z).fold(f64::MIN, f64::max);
        assert!(top.abs() < 1e-15 && points.iter().all(|p| p.norm() < 1.0), "{top}");
    }
}
