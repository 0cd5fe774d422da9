//! What can be wrong with a tool, and what can go wrong in contact.

use shape::Point3;

/// Why a tool cannot be made, or why contact has no meaning in a state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// A length of a tool that must be positive.
    #[error("{what} of the tool is {value} m; it must be positive and finite")]
    Size {
        /// Which length.
        what: &'static str,
        /// Its value, m.
        value: f64,
    },
    /// A box rounded by more than it has, or by less than nothing.
    #[error(
        "the box's edges are rounded by {radius} m; it must be between 0 and the least half extent, {half} m"
    )]
    Rounding {
        /// Rounding radius given, m.
        radius: f64,
        /// Least half extent, m.
        half: f64,
    },
    /// A matrix that turns the tool and is no rotation.
    #[error("the tool's rotation misses R^T R = I by {deviation:e} (limit 1e-9), det R = {determinant}")]
    Rotation {
        /// Largest entry of `|R^T R - I|`.
        deviation: f64,
        /// Determinant.
        determinant: f64,
    },
    /// A direction that is not a unit vector.
    #[error("the tool closes along a vector of length {length}; it must be 1 (within 1e-9)")]
    Direction {
        /// Its length.
        length: f64,
    },
    /// A position or a closure that is not finite.
    #[error("{what} of the tool is not finite")]
    Place {
        /// Which one.
        what: &'static str,
    },
    /// A modulus of the contact law that must be positive.
    #[error("the contact {what} is {value} Pa/m; it must be positive and finite")]
    Modulus {
        /// Penalty or stick slope.
        what: &'static str,
        /// Its value, Pa/m.
        value: f64,
    },
    /// A coefficient of friction below zero, or none at all.
    #[error(
        "the coefficient of friction is {value}; it must be positive and finite (without friction: none)"
    )]
    Friction {
        /// The coefficient given.
        value: f64,
    },
    /// Two arrays that should be of one length.
    #[error("{what}: {found} given, {expected} needed")]
    Length {
        /// Which array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it needs.
        expected: usize,
    },
    /// A NaN or an infinity in the displacement.
    #[error("the displacement of node {node} is not finite")]
    NotFinite {
        /// The node.
        node: usize,
    },
    /// A point so deep in a tool that it would soon be pushed out on the far side.
    #[error(
        "surface point {point} is {penetration:e} m deep in the tool (limit {limit:e} m, half its inradius): \
         a smaller step or a larger penalty is needed"
    )]
    PassedThrough {
        /// The point (the lowest, if there are several).
        point: usize,
        /// Its penetration, m.
        penetration: f64,
        /// The limit, m.
        limit: f64,
    },
    /// A tool that a step takes over the surface, to where nothing touches it.
    #[error(
        "the surface near ({:.4}, {:.4}, {:.4}) m would go straight through the tool, {depth:.3e} m below its surface on the way: \
         they move {travel:.3e} m against each other in this step, and a smaller one is needed",
        at.x, at.y, at.z
    )]
    JumpedOver {
        /// Depth on the way, m.
        depth: f64,
        /// Where the point of the surface is in the end, m.
        at: Point3,
        /// Its way in the step as seen from the tool, m.
        travel: f64,
    },
    /// A tool that stands in the body and meets no point of its surface.
    #[error(
        "it overlaps the body by {depth:.3e} m near ({:.4}, {:.4}, {:.4}) m and touches no contact point, so without any force: \
         the nearest one is {apart:.3e} m from there, and a finer surface is needed",
        at.x, at.y, at.z
    )]
    Overlap {
        /// Depth, m.
        depth: f64,
        /// Where that is, m.
        at: Point3,
        /// Distance to the nearest contact point in the undeformed body, m.
        apart: f64,
    },
    /// A tool that pushes out of the body from within.
    #[error(
        "{:.0} % of the tool's force push out of the body from within, at surface point {point} near ({:.4}, {:.4}, {:.4}) m: it has \
         slipped through between the points of the surface, and a finer surface is needed",
        100.0 * share, at.x, at.y, at.z
    )]
    WithinBody {
        /// Part of the force that does.
        share: f64,
        /// The point where it does (the lowest, if there are several).
        point: usize,
        /// Where that is, m.
        at: Point3,
    },
}

impl ContactError {
    /// Whether a smaller step of the tool may do: it went too deep, or all the way through.
    pub fn is_too_far(&self) -> bool {
        matches!(self, ContactError::PassedThrough { .. } | ContactError::JumpedOver { .. })
    }
}
