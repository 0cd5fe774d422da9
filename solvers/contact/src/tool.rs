//! Tool in world coordinates: shape, position, direction of motion and contact law.

use shape::{Matrix3, Point3, Vector3};

use super::law::Response;
use crate::ToolShape;
use crate::error::ContactError;
use crate::law::{ContactLaw, Slip};

/// Rigid tool that moves along a path of straight legs without rotating. The `closure` (m) is the distance
/// that it has travelled along the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    shape: ToolShape,
    at: Point3,
    rotation: Matrix3,
    first: Leg,
    /// Legs after the first, by ascending closure.
    later: Vec<Leg>,
    law: ContactLaw,
    deepest: f64,
}

/// Straight part of a tool's path.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Leg {
    /// Closure at its start, m.
    from: f64,
    /// Displacement of the tool at its start, m.
    start: Vector3,
    /// Unit direction of motion.
    along: Vector3,
}

/// Relative rounding error of a closure: a tool that has just reached the end of a leg is still on this leg.
const ROUNDING: f64 = 1e-12;

/// Contact of one point with one tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointContact {
    /// Traction on the tissue, per undeformed area, Pa.
    pub traction: Vector3,
    /// Tangent `dt/dx` (3, 3), Pa/m; unsymmetric in slip. `dt/dclosure = -(dt/dx) along`.
    pub stiffness: Matrix3,
    /// Friction history to commit if the step converges in this state.
    pub slip: Slip,
    /// Signed distance, m; negative inside the tool.
    pub gap: f64,
    /// Normal pressure per undeformed area, Pa; 0 without contact.
    pub pressure: f64,
    /// Frictional work since the last commit, J per undeformed m^2; never negative.
    pub dissipated: f64,
}

impl Tool {
    /// Makes a tool. `at` (m) is the position of the shape's origin at closure 0, before any displacement.
    /// `rotation` (3, 3) maps the shape's axes to the world's. `along` is the unit direction of motion.
    ///
    /// # Errors
    ///
    /// A length, the position, the rotation or the direction is not valid.
    pub fn new(
        shape: ToolShape,
        at: Point3,
        rotation: Matrix3,
        along: Vector3,
        law: ContactLaw,
    ) -> Result<Tool, ContactError> {
        shape.check()?;
        if !at.coords.iter().all(|c| c.is_finite()) {
            return Err(ContactError::Place { what: "the position" });
        }
        let (deviation, determinant) =
            ((rotation.transpose() * rotation - Matrix3::identity()).amax(), rotation.determinant());
        // Written so that a NaN fails.
        if !(deviation <= 1e-9 && determinant > 0.0) {
            return Err(ContactError::Rotation { deviation, determinant });
        }
        let length = along.norm();
        if !((length - 1.0).abs() <= 1e-9) {
            return Err(ContactError::Direction { length });
        }
        let first = Leg { from: 0.0, start: Vector3::zeros(), along };
        let deepest = 0.5 * shape.inradius();
        Ok(Tool { shape, at, rotation, first, later: Vec::new(), law, deepest })
    }

    /// Bends the path: after the distance `length` (m) from the start of the last leg the tool moves along
    /// the unit vector `along`.
    ///
    /// # Errors
    ///
    /// The length is not positive, or the direction is not valid.
    pub fn then(mut self, length: f64, along: Vector3) -> Result<Tool, ContactError> {
        let norm = along.norm();
        if !((norm - 1.0).abs() <= 1e-9) {
            return Err(ContactError::Direction { length: norm });
        }
        if !(length > 0.0 && length.is_finite()) {
            return Err(ContactError::Leg { length });
        }
        let last = *self.later.last().unwrap_or(&self.first);
        self.later.push(Leg { from: last.from + length, start: last.start + last.along * length, along });
        Ok(self)
    }

    /// Returns a rotation that maps the z axis to the unit vector `axis`, the normal of a plate's face or the
    /// axis of a cylinder. The rotation about `axis` itself is free: the shortest rotation is taken, and half
    /// a turn about x for `-z`.
    pub fn turned_to(axis: &Vector3) -> Matrix3 {
        nalgebra::Rotation3::rotation_between(&Vector3::z(), axis)
            .unwrap_or_else(|| nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI))
            .into_inner()
    }

    /// The shape.
    pub fn shape(&self) -> &ToolShape {
        &self.shape
    }

    /// The contact law.
    pub fn law(&self) -> &ContactLaw {
        &self.law
    }

    /// Unit direction of the first leg: of the whole motion, if the path is straight.
    pub fn along(&self) -> Vector3 {
        self.first.along
    }

    /// Unit direction of the leg on which the tool is at a closure (m); at a bend that of the leg before it.
    pub fn along_at(&self, closure: f64) -> Vector3 {
        self.leg(closure).along
    }

    /// Whether the tool moves along one straight line.
    pub fn is_straight(&self) -> bool {
        self.later.is_empty()
    }

    /// Position of the shape's origin (m) at the start of each leg of the path, and the leg's unit direction.
    pub fn legs(&self) -> impl Iterator<Item = (Point3, Vector3)> {
        std::iter::once(&self.first).chain(&self.later).map(|leg| (self.at + leg.start, leg.along))
    }

    /// Displacement of the tool at a closure (m), m.
    pub fn displacement(&self, closure: f64) -> Vector3 {
        // Contact asks for it at every point, and most paths are straight.
        if self.is_straight() {
            return self.first.along * closure;
        }
        let leg = self.leg(closure);
        leg.start + leg.along * (closure - leg.from)
    }

    /// Position of the shape's origin at a closure (m), m.
    pub fn place(&self, closure: f64) -> Point3 {
        self.at + self.displacement(closure)
    }

    fn leg(&self, closure: f64) -> &Leg {
        let passed = self.later.iter().take_while(|leg| leg.from * (1.0 + ROUNDING) < closure);
        passed.last().unwrap_or(&self.first)
    }

    /// Depth beyond which a point is an error, m: half the inradius. At the inradius the nearest face
    /// changes, and the point would be pushed out on the far side.
    pub fn deepest(&self) -> f64 {
        self.deepest
    }

    /// Lowest and highest corner (m) of a box along the world's axes that contains the tool at a closure (m);
    /// infinite for a plate.
    pub fn bounds(&self, closure: f64) -> (Point3, Point3) {
        let place = self.place(closure);
        let (_, corner) = self.shape.bounds();
        let half = if self.shape.is_endless() {
            Vector3::repeat(f64::INFINITY)
        } else {
            self.rotation.abs() * corner.coords
        };
        (place - half, place + half)
    }

    /// Half of the smallest breadth across a direction of motion, m; infinite for a plate. The tool can slip
    /// between contact points whose spacing exceeds the whole breadth.
    pub fn half_breadth(&self) -> f64 {
        if self.shape.is_endless() {
            return f64::INFINITY;
        }
        let outline = self.shape.outline(0.0);
        let breadth = |across: &Vector3| {
            let across = self.rotation.tr_mul(across);
            let (low, high) = (outline.iter().map(|p| across.dot(p)))
                .fold((0.0f64, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
            0.5 * (high - low)
        };
        let of_leg = |(_, along): (Point3, Vector3)| {
            let turned = Tool::turned_to(&along);
            let across = |turn: f64| turned * Vector3::new(turn.cos(), turn.sin(), 0.0);
            (0..24).map(|k| breadth(&across((7.5 * f64::from(k)).to_radians()))).fold(f64::INFINITY, f64::min)
        };
        self.legs().map(of_leg).fold(f64::INFINITY, f64::min)
    }

    /// Evaluates contact at the current position `x` (m), from the last committed history. `augmented` is the
    /// multiplier of the augmented Lagrangian, Pa; 0 for a plain penalty.
    pub fn contact(&self, closure: f64, x: &Point3, history: &Slip, augmented: f64) -> PointContact {
        let p = self.local(closure, x);
        let (gap, normal) = self.shape.foot(&p);
        match self.law.respond(gap, &normal, &p, history, augmented) {
            Some(response) => PointContact {
                traction: self.rotation * response.traction,
                stiffness: self.stiffness(&response, &p, &normal),
                slip: response.slip,
                gap,
                pressure: response.pressure,
                dissipated: response.dissipated,
            },
            None => PointContact {
                traction: Vector3::zeros(),
                stiffness: Matrix3::zeros(),
                slip: Slip::NONE,
                gap,
                pressure: 0.0,
                dissipated: 0.0,
            },
        }
    }

    /// Returns the signed distance (m) of the current position `x` (m) from the tool at a closure (m);
    /// negative inside.
    pub fn gap(&self, closure: f64, x: &Point3) -> f64 {
        self.shape.foot(&self.local(closure, x)).0
    }

    /// Returns the position in the tool's frame.
    #[inline]
    pub(super) fn local(&self, closure: f64, x: &Point3) -> Vector3 {
        self.rotation.tr_mul(&(x - self.place(closure)))
    }

    #[inline]
    pub(super) fn to_world(&self, v: &Vector3) -> Vector3 {
        self.rotation * v
    }

    /// Returns `dt/dx` in the world's axes.
    #[inline]
    pub(super) fn stiffness(&self, response: &Response, p: &Vector3, normal: &Vector3) -> Matrix3 {
        self.rotation * self.law.tangent(response, normal, &self.shape.hessian(p)) * self.rotation.transpose()
    }
}
