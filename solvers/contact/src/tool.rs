//! Tool in world coordinates: shape, position, direction of motion and contact law.

use shape::{Matrix3, Point3, Vector3};

use super::law::Response;
use crate::ToolShape;
use crate::error::ContactError;
use crate::law::{ContactLaw, Slip};
use crate::motion::{Leg, Motion, Pose};

/// Rigid tool that moves along a path of legs: straight ones, and turns about an axis. The `closure` (m) is
/// the distance that it has travelled along the path; a turn counts at the arm of [`Turn`](crate::Turn).
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    shape: ToolShape,
    at: Point3,
    rotation: Matrix3,
    first: Leg,
    /// Legs after the first, by ascending closure.
    later: Vec<Leg>,
    /// Whether it turns on any leg.
    turns: bool,
    law: ContactLaw,
    deepest: f64,
}

/// Relative rounding error of a closure: a tool that has just reached the end of a leg is still on this leg.
const ROUNDING: f64 = 1e-12;

/// Largest turn of a tool, rad, during which a point that is at rest moves straight relative to the tool: the
/// arc then differs from its chord by 1/2000 of its radius.
const PART: f64 = 0.0625;

/// Contact of one point with one tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointContact {
    /// Traction on the tissue, per undeformed area, Pa.
    pub traction: Vector3,
    /// Tangent `dt/dx` (3, 3), Pa/m; unsymmetric in slip. On a straight leg `dt/dclosure = -(dt/dx) along`.
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
    /// `rotation` (3, 3) maps the shape's axes to the world's. `motion` is the unit direction of motion, or a
    /// turn.
    ///
    /// # Errors
    ///
    /// A length, the position, the rotation or the direction is not valid.
    pub fn new(
        shape: ToolShape,
        at: Point3,
        rotation: Matrix3,
        motion: impl Into<Motion>,
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
        let first = Leg::first(&at, motion.into())?;
        let deepest = 0.5 * shape.inradius();
        let turns = matches!(first.motion, Motion::About(_));
        Ok(Tool { shape, at, rotation, first, later: Vec::new(), turns, law, deepest })
    }

    /// Bends the path: after the distance `length` (m) from the start of the last leg the tool moves along a
    /// unit vector, or turns about a line that is fixed to the tool and given at the start of the path.
    ///
    /// # Errors
    ///
    /// The length is not positive, or the motion is not valid.
    pub fn then(mut self, length: f64, motion: impl Into<Motion>) -> Result<Tool, ContactError> {
        if !(length > 0.0 && length.is_finite()) {
            return Err(ContactError::Leg { length });
        }
        let next = self.later.last().unwrap_or(&self.first).next(&self.at, length, motion.into())?;
        self.later.push(next);
        self.turns |= matches!(next.motion, Motion::About(_));
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

    /// Unit direction in which the shape's origin moves on the first leg, of the whole motion if the path is
    /// straight: at the start of a turn; its axis if the origin lies on the axis.
    pub fn along(&self) -> Vector3 {
        self.first.along
    }

    /// Whether the tool moves along one straight line.
    pub fn is_straight(&self) -> bool {
        self.later.is_empty() && !self.turns
    }

    /// Whether the tool turns on any leg of its path.
    pub fn turns(&self) -> bool {
        self.turns
    }

    /// Legs of the path, each with the tool's pose at its start.
    pub fn legs(&self) -> impl Iterator<Item = (Pose, &Leg)> {
        std::iter::once(&self.first).chain(&self.later).map(|leg| {
            let rotation = leg.turned * self.rotation;
            (Pose { rotation, place: self.at + leg.start }, leg)
        })
    }

    /// Closures (m) at which the path bends: those at the start of every leg but the first.
    pub fn bends(&self) -> impl Iterator<Item = f64> {
        self.later.iter().map(|leg| leg.from)
    }

    /// Displacement of the shape's origin at a closure (m), m.
    pub fn displacement(&self, closure: f64) -> Vector3 {
        // Contact asks for it at every point, and most paths are straight.
        if self.is_straight() {
            return self.first.along * closure;
        }
        let leg = self.leg(closure);
        leg.reached(&self.at, closure - leg.from).0
    }

    /// Position of the shape's origin at a closure (m), m.
    pub fn place(&self, closure: f64) -> Point3 {
        self.at + self.displacement(closure)
    }

    /// Position and orientation at a closure (m).
    #[inline]
    pub fn pose(&self, closure: f64) -> Pose {
        if !self.turns {
            return Pose { rotation: self.rotation, place: self.place(closure) };
        }
        let leg = self.leg(closure);
        let (moved, turned) = leg.reached(&self.at, closure - leg.from);
        Pose { rotation: turned * self.rotation, place: self.at + moved }
    }

    /// Returns the force (N) that the tool exerts in the sense of its travel at a closure (m), given the force
    /// (N) on the tool and the moment (N m) about its origin. On a turn this is the moment about the axis over
    /// the arm.
    pub fn driving_force(&self, closure: f64, force: &Vector3, moment: &Vector3) -> f64 {
        -self.leg(closure).driving(&self.place(closure), force, moment)
    }

    /// Returns the largest change of the distance between the tool and a place per travel, for places that are
    /// up to `beyond` (m) farther from the axis of any turn than the farthest of some positions (m). This is 1
    /// for bounded tools, whose arm is that of their farthest point.
    pub fn rate(&self, positions: impl Iterator<Item = Point3> + Clone, beyond: f64) -> f64 {
        if !self.turns || !self.shape.is_endless() {
            return 1.0;
        }
        let of_leg = |leg: &Leg| match leg.motion {
            Motion::Along(_) => 1.0,
            Motion::About(turn) => {
                let farthest = positions.clone().map(|x| turn.axis.cross(&(x - turn.pin)).norm());
                (farthest.fold(0.0, f64::max) + beyond) / turn.arm
            }
        };
        std::iter::once(&self.first).chain(&self.later).map(of_leg).fold(1.0, f64::max)
    }

    /// Returns the number of parts of a step between two closures (m) in each of which the tool turns by at
    /// most [`PART`]; 1 for a tool that does not turn.
    pub(super) fn parts(&self, [from, to]: [f64; 2]) -> usize {
        let of_leg = |leg: &Leg| match leg.motion {
            Motion::Along(_) => 1.0,
            Motion::About(turn) => ((to - from).abs() / turn.arm / PART).ceil(),
        };
        std::iter::once(&self.first).chain(&self.later).map(of_leg).fold(1.0, f64::max) as usize
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
        let Pose { rotation, place } = self.pose(closure);
        let (_, corner) = self.shape.bounds();
        let half = if self.shape.is_endless() {
            Vector3::repeat(f64::INFINITY)
        } else {
            rotation.abs() * corner.coords
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
        let breadth = |rotation: &Matrix3, across: &Vector3| {
            let across = rotation.tr_mul(across);
            let (low, high) = (outline.iter().map(|p| across.dot(p)))
                .fold((0.0f64, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
            0.5 * (high - low)
        };
        let of_direction = |rotation: &Matrix3, along: &Vector3| {
            let turned = Tool::turned_to(along);
            let across = |turn: f64| turned * Vector3::new(turn.cos(), turn.sin(), 0.0);
            let each = (0..24).map(|k| breadth(rotation, &across((7.5 * f64::from(k)).to_radians())));
            each.fold(f64::INFINITY, f64::min)
        };
        let of_leg = |(pose, leg): (Pose, &Leg)| match leg.motion {
            Motion::Along(along) => of_direction(&pose.rotation, &along),
            // The places of the tool move in all directions across the axis.
            Motion::About(turn) => {
                let turned = Tool::turned_to(&turn.axis);
                let way = |turn: f64| turned * Vector3::new(turn.cos(), turn.sin(), 0.0);
                let each = (0..12).map(|k| way((15.0 * f64::from(k)).to_radians()));
                each.map(|way| of_direction(&pose.rotation, &way)).fold(f64::INFINITY, f64::min)
            }
        };
        self.legs().map(of_leg).fold(f64::INFINITY, f64::min)
    }

    /// Evaluates contact at the current position `x` (m), from the last committed history. `augmented` is the
    /// multiplier of the augmented Lagrangian, Pa; 0 for a plain penalty.
    pub fn contact(&self, closure: f64, x: &Point3, history: &Slip, augmented: f64) -> PointContact {
        let pose = self.pose(closure);
        let p = pose.local(x);
        let (gap, normal) = self.shape.foot(&p);
        match self.law.respond(gap, &normal, &p, history, augmented) {
            Some(response) => PointContact {
                traction: pose.to_world(&response.traction),
                stiffness: self.stiffness(&pose, &response, &p, &normal),
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
        if self.turns {
            return self.pose(closure).local(x);
        }
        self.rotation.tr_mul(&(x - self.place(closure)))
    }

    /// Returns `dt/dx` in the world's axes.
    #[inline]
    pub(super) fn stiffness(
        &self,
        pose: &Pose,
        response: &Response,
        p: &Vector3,
        normal: &Vector3,
    ) -> Matrix3 {
        let tangent = self.law.tangent(response, normal, &self.shape.hessian(p));
        pose.rotation * tangent * pose.rotation.transpose()
    }
}
