//! Rigid tools as signed distances, each in its own frame: negative inside, gradient a unit vector pointing out.
//!
//! Outside and near the surface the distances are exact. On the medial axis, where the nearest point is not unique,
//! one of them is taken (the files say which) and the Hessian's infinite part is left out: no NaN anywhere.

mod capsule;
mod cylinder;
mod plate;
mod rounded_box;
mod sphere;

use shape::{Matrix3, Point3, Vector3};

use crate::ContactError;

/// A centre, axis or core is met within this part of the tool's size: there the direction to it is noise.
const MEDIAL: f64 = 1e-12;

/// A rigid tool in its own frame. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToolShape {
    /// The half space `z <= 0`: a plate without end or thickness, its face looking along +z.
    Plate,
    /// A box about the origin, all edges and corners rounded.
    RoundedBox {
        /// Half extents, rounding included.
        half: [f64; 3],
        /// Rounding radius, from 0 to the least half extent.
        radius: f64,
    },
    /// A ball about the origin.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// A cylinder about the z axis with flat ends and sharp rims. A `half_length` far beyond the body makes a roller.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Half its length.
        half_length: f64,
    },
    /// The points within `radius` of a segment of the z axis.
    Capsule {
        /// Radius.
        radius: f64,
        /// Half the length of the segment: the whole capsule reaches `half_length + radius`.
        half_length: f64,
    },
}

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

    /// Signed distance and gradient only.
    #[inline]
    pub fn foot(&self, p: &Vector3) -> (f64, Vector3) {
        match *self {
            ToolShape::Plate => plate::foot(p),
            ToolShape::RoundedBox { half, radius } => rounded_box::foot(half, radius, p),
            ToolShape::Sphere { radius } => sphere::foot(radius, p),
            ToolShape::Cylinder { radius, half_length } => cylinder::foot(radius, half_length, p),
            ToolShape::Capsule { radius, half_length } => capsule::foot(radius, half_length, p),
        }
    }

    /// Hessian only (3, 3), 1/m.
    #[inline]
    pub fn hessian(&self, p: &Vector3) -> Matrix3 {
        match *self {
            ToolShape::Plate => plate::hessian(),
            ToolShape::RoundedBox { half, radius } => rounded_box::hessian(half, radius, p),
            ToolShape::Sphere { radius } => sphere::hessian(radius, p),
            ToolShape::Cylinder { radius, half_length } => cylinder::hessian(radius, half_length, p),
            ToolShape::Capsule { radius, half_length } => capsule::hessian(radius, half_length, p),
        }
    }

    /// Lowest and highest corner of a box (tool's frame) that holds the tool; infinite for a plate, but for its face.
    pub fn bounds(&self) -> (Point3, Point3) {
        let half = match *self {
            ToolShape::Plate => {
                let far = f64::INFINITY;
                return (Point3::new(-far, -far, -far), Point3::new(far, far, 0.0));
            }
            ToolShape::RoundedBox { half, .. } => Vector3::from(half),
            ToolShape::Sphere { radius } => Vector3::repeat(radius),
            ToolShape::Cylinder { radius, half_length } => Vector3::new(radius, radius, half_length),
            ToolShape::Capsule { radius, half_length } => Vector3::new(radius, radius, half_length + radius),
        };
        (Point3::from(-half), Point3::from(half))
    }

    /// Radius of the largest ball inside, m: nothing is deeper than that. Infinite for a plate.
    pub fn inradius(&self) -> f64 {
        match *self {
            ToolShape::Plate => f64::INFINITY,
            ToolShape::RoundedBox { half, .. } => half[0].min(half[1]).min(half[2]),
            ToolShape::Cylinder { radius, half_length } => radius.min(half_length),
            ToolShape::Sphere { radius } | ToolShape::Capsule { radius, .. } => radius,
        }
    }

    pub(super) fn check(&self) -> Result<(), ContactError> {
        let size = |what, value: f64| {
            // Written so that a NaN fails.
            if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ContactError::Size { what, value }) }
        };
        match *self {
            ToolShape::Plate => Ok(()),
            ToolShape::RoundedBox { half, radius } => {
                half.iter().try_for_each(|&h| size("a half extent", h))?;
                let half = self.inradius();
                if radius >= 0.0 && radius <= half {
                    Ok(())
                } else {
                    Err(ContactError::Rounding { radius, half })
                }
            }
            ToolShape::Sphere { radius } => size("the radius", radius),
            ToolShape::Cylinder { radius, half_length } | ToolShape::Capsule { radius, half_length } => {
                size("the radius", radius)?;
                size("the half length", half_length)
            }
        }
    }
}
