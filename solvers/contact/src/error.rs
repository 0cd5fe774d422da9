//! Errors in the definition of a tool and in contact.

use shape::{Point3, position_alone};

/// Reason why a tool cannot be made, or why contact has no meaning in a state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// A length of a tool is not positive.
    #[error("{what} of the tool is {value} m; it must be positive and finite")]
    Size {
        /// Name of the length.
        what: &'static str,
        /// Value of the length, m.
        value: f64,
    },
    /// The rounding radius of a box is negative or too large for the box.
    #[error(
        "the rounding radius of the box is {radius} m; it must be between 0 and the smallest half extent, \
         {half} m"
    )]
    Rounding {
        /// Given rounding radius, m.
        radius: f64,
        /// Smallest half extent, m.
        half: f64,
    },
    /// The rotation matrix of a tool is not a rotation.
    #[error(
        "the tool's rotation R deviates from R^T R = I by {deviation:e} (limit 1e-9); det R = \
         {determinant}"
    )]
    Rotation {
        /// Largest entry of `|R^T R - I|`.
        deviation: f64,
        /// Determinant.
        determinant: f64,
    },
    /// The direction of a tool is not a unit vector.
    #[error("the direction of the tool has length {length}; it must be a unit vector (within 1e-9)")]
    Direction {
        /// Length of the direction vector.
        length: f64,
    },
    /// A leg of the path of a tool has no length.
    #[error("a leg of the tool's path has length {length} m; it must be positive")]
    Leg {
        /// Length of the leg, m.
        length: f64,
    },
    /// A position or a closure is not finite.
    #[error("{what} of the tool is not finite")]
    Place {
        /// Name of the value.
        what: &'static str,
    },
    /// A modulus of the contact law is not positive.
    #[error("the contact {what} is {value} Pa/m; it must be positive and finite")]
    Modulus {
        /// Penalty or stick slope.
        what: &'static str,
        /// Value of the modulus, Pa/m.
        value: f64,
    },
    /// The coefficient of friction is negative, zero or not finite.
    #[error(
        "the coefficient of friction is {value}; it must be positive and finite (leave it out for \
         frictionless contact)"
    )]
    Friction {
        /// Given coefficient.
        value: f64,
    },
    /// An array has the wrong length.
    #[error("{what}: {found} given, {expected} needed")]
    Length {
        /// Name of the array.
        what: &'static str,
        /// Length of the array.
        found: usize,
        /// Required length.
        expected: usize,
    },
    /// A displacement is NaN or infinite.
    #[error("the displacement of node {node} is not finite")]
    NotFinite {
        /// The node.
        node: usize,
    },
    /// A point is so deep in a tool that it would soon be pushed out on the far side.
    #[error(
        "surface point {point} lies {penetration:e} m inside the tool (limit {limit:e} m, half the tool's \
         inradius): a smaller step or a larger penalty is needed"
    )]
    PassedThrough {
        /// The point (the lowest, if there are several).
        point: usize,
        /// Penetration of the point, m.
        penetration: f64,
        /// The limit, m.
        limit: f64,
    },
    /// A tool passes through the surface within one step and touches nothing afterwards.
    #[error(
        "the surface near {} would pass through the tool in this step, as deep as \
         {depth:.3e} m below the tool's surface: the step moves tool and body by {travel:.3e} m relative to \
         each other; a smaller step is needed",
        position_alone(at)
    )]
    JumpedOver {
        /// Depth along the path, m.
        depth: f64,
        /// Final position of the surface point, m.
        at: Point3,
        /// Path length of the point relative to the tool in the step, m.
        travel: f64,
    },
    /// A tool overlaps the body but touches no point of its surface.
    #[error(
        "the tool overlaps the body by {depth:.3e} m near {} but touches no contact \
         point, so the contact force is zero: the nearest contact point is {apart:.3e} m away; a finer \
         surface is needed",
        position_alone(at)
    )]
    Overlap {
        /// Depth, m.
        depth: f64,
        /// Location of that depth, m.
        at: Point3,
        /// Distance to the nearest contact point in the undeformed body, m.
        apart: f64,
    },
    /// A tool pushes out of the body from within.
    #[error(
        "{:.0} % of the tool's force acts outwards from inside the body, at surface point {point} near \
         {}: the tool has slipped between the contact points; a finer surface is needed",
        100.0 * share, position_alone(at)
    )]
    WithinBody {
        /// Part of the force that pushes outwards, 0 to 1.
        share: f64,
        /// First such point (the lowest, if there are several).
        point: usize,
        /// Position of that point, m.
        at: Point3,
    },
}

impl ContactError {
    /// Whether a smaller step of the tool may help: the tool went too deep, or right through the surface.
    pub fn is_too_far(&self) -> bool {
        matches!(self, ContactError::PassedThrough { .. } | ContactError::JumpedOver { .. })
    }
}
