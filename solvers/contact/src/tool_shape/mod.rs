//! Rigid tools as signed distances, each in its own frame: negative inside, gradient a unit vector pointing
//! out.
//!
//! Each shape has a file with its distance and its [`Entry`], and a line in the list below; the surface of a
//! file has no entry. Outside and near the surface the distances are exact. On the medial axis the nearest
//! point is not unique. One of the nearest points is taken there (each file states which), and the infinite
//! part of the Hessian is left out, so that no value is NaN.

mod outline;
mod rounded_surface;
mod signed_distance;

use catalogue::{Build, Entry};
use shape::{Matrix3, Point3, Vector3};

pub use self::rounded_surface::RoundedSurface;
pub use self::signed_distance::Distance;
use self::signed_distance::Shape;
use crate::error::ContactError;

/// Shape of tools that scene files can name.
pub type ToolShapeEntry = Entry<Build<ToolShape>>;

/// Declares the modules of the shapes, the enum that dispatches to them without a call through a pointer, and
/// the slice of their entries.
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

        /// Rigid tool in its own frame.
        #[derive(Clone, Debug, PartialEq)]
        #[allow(missing_docs)] // each is its type
        pub enum ToolShape {
            $($shape($shape),)*
            RoundedSurface(RoundedSurface),
        }

        /// Every shape, in the order of tables.
        pub static TOOL_SHAPES: &[ToolShapeEntry] =
            &[$($file::ENTRY.built_by(|values| Ok(($file::ENTRY.build)(values)?.into()))),*];

        impl ToolShape {
            /// Returns the name used in scene files and tables.
            pub fn name(&self) -> &'static str {
                match self {
                    $(ToolShape::$shape(_) => $file::ENTRY.name,)*
                    ToolShape::RoundedSurface(_) => "rounded-surface",
                }
            }

            /// Returns the signed distance (m, negative inside) and its unit gradient at the position `p`
            /// (m).
            #[inline]
            pub fn foot(&self, p: &Vector3) -> (f64, Vector3) {
                match self {
                    $(ToolShape::$shape(shape) => shape.foot(p),)*
                    ToolShape::RoundedSurface(shape) => shape.foot(p),
                }
            }

            /// Returns the Hessian of the distance (3, 3), 1/m, at the position `p` (m).
            #[inline]
            pub fn hessian(&self, p: &Vector3) -> Matrix3 {
                match self {
                    $(ToolShape::$shape(shape) => shape.hessian(p),)*
                    ToolShape::RoundedSurface(shape) => shape.hessian(p),
                }
            }

            fn shape(&self) -> &dyn Shape {
                match self {
                    $(ToolShape::$shape(shape) => shape,)*
                    ToolShape::RoundedSurface(shape) => shape,
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

impl From<RoundedSurface> for ToolShape {
    fn from(shape: RoundedSurface) -> ToolShape {
        ToolShape::RoundedSurface(shape)
    }
}

impl ToolShape {
    /// Returns signed distance, gradient and Hessian at the position `p` (m), all in the tool's frame.
    pub fn distance(&self, p: &Vector3) -> Distance {
        let (value, gradient) = self.foot(p);
        Distance { value, gradient, hessian: self.hessian(p) }
    }

    /// Returns the lowest and highest corner (m) of a box that contains the tool, in the tool's frame. The
    /// box of a half space is infinite, but ends at the face `z = 0`.
    pub fn bounds(&self) -> (Point3, Point3) {
        let half = self.shape().half_extents();
        let low = if self.is_endless() { Vector3::repeat(f64::NEG_INFINITY) } else { -half };
        (Point3::from(low), Point3::from(half))
    }

    /// Whether the shape is unbounded.
    pub fn is_endless(&self) -> bool {
        self.shape().half_extents().iter().any(|half| half.is_infinite())
    }

    /// Returns the radius of the largest ball inside, m: no point is deeper. Infinite for a plate.
    pub fn inradius(&self) -> f64 {
        self.shape().inradius()
    }

    /// Whether the shape is convex, and with it the distance along a line.
    pub(super) fn is_convex(&self) -> bool {
        self.shape().is_convex()
    }

    /// Returns points (m, in the tool's frame) whose convex hull is that of the tool, for pictures. A plate,
    /// which is unbounded, is drawn as a slab as wide as the body, `body` (m).
    pub fn outline(&self, body: f64) -> Vec<Vector3> {
        self.shape().outline(body)
    }

    /// Returns the surface as points (m, in the tool's frame) and quadrangles, for pictures. A plate, which
    /// is unbounded, is drawn as a slab as wide as the body, `body` (m). For other shapes, a grid on the
    /// bounding box of the tool is projected towards the middle of the box. Edges of boxes stay edges. The
    /// triangles of a surface are quadrangles whose last two corners are the same.
    pub fn skin(&self, body: f64) -> (Vec<Vector3>, Vec<[u32; 4]>) {
        if let ToolShape::RoundedSurface(surface) = self {
            let (points, triangles) = surface.skin();
            return (points, triangles.into_iter().map(|[a, b, c]| [a, b, c, c]).collect());
        }
        let outline = self.outline(body);
        let low = outline.iter().fold(Vector3::repeat(f64::INFINITY), |low, p| low.inf(p));
        let high = outline.iter().fold(Vector3::repeat(f64::NEG_INFINITY), |high, p| high.sup(p));
        let middle = (low + high) / 2.0;
        let half = (high - low) / 2.0;
        let (mut points, quads) = outline::cube();
        for point in &mut points {
            let way = point.component_mul(&half);
            let is_inside = |part: f64| self.foot(&(middle + way * part)).0 < 0.0;
            // An unbounded tool is drawn as its box.
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

    /// Returns the default direction of the z axis of the tool's frame: the direction of motion `along` (unit
    /// vector) for a plate, the scene's z axis for a cylinder or capsule. Returns `None` for other shapes,
    /// whose frame has the axes of the scene by default.
    pub fn axis(&self, along: Vector3) -> Option<Vector3> {
        self.shape().axis(along)
    }

    /// Returns the area of the face that presses if the tool moves along a unit vector, m^2; `None` if it has
    /// no such face.
    pub fn face_area(&self, along: &Vector3) -> Option<f64> {
        self.shape().face_area(along)
    }

    pub(super) fn check(&self) -> Result<(), ContactError> {
        self.shape().check()
    }
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
            // A ball of radius `inradius` gives the scale; the flat cells cut 1 to 3 % off.
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
