//! Errors between a problem and its solution.

use algebra::AlgebraError;

use crate::rigid_mode::RigidMode;

/// Reason why a problem has no (trustworthy) solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// Two arrays that should have the same length.
    #[error("{what}: {found} given, {expected} needed")]
    Length {
        /// Name of the array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Required length.
        expected: usize,
    },
    /// A NaN or an infinity in the input.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// Name of the quantity.
        what: &'static str,
        /// Index of the value.
        index: usize,
    },
    /// A node index beyond the number of nodes.
    #[error("{what} names node {node}, but there are only {nodes} nodes")]
    NodeOutOfRange {
        /// Name of the input that refers to the node.
        what: &'static str,
        /// The node.
        node: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// An axis other than 0, 1, 2.
    #[error("{what} names axis {axis}; the axes are 0, 1 and 2")]
    BadAxis {
        /// Name of the input that refers to the axis.
        what: &'static str,
        /// The axis.
        axis: u8,
    },
    /// A region index beyond the materials.
    #[error("point {point} lies in region {region}, but only {materials} materials are given")]
    NoMaterial {
        /// Quadrature point.
        point: usize,
        /// Its region.
        region: usize,
        /// Number of materials.
        materials: usize,
    },
    /// One degree of freedom fixed at two values.
    #[error("node {node} is fixed along axis {axis} at {first} m and at {second} m")]
    Conflict {
        /// The node.
        node: usize,
        /// The axis.
        axis: u8,
        /// First value, m.
        first: f64,
        /// Second value, m.
        second: f64,
    },
    /// A constraint row that no free degree of freedom can satisfy.
    #[error(
        "constraint row {row} has no free term, and the sum of its prescribed terms differs from its \
         value by {gap:e}"
    )]
    Inconsistent {
        /// Row index.
        row: usize,
        /// Value minus the sum of the prescribed terms.
        gap: f64,
    },
    /// A constraint row that depends on the others but prescribes a different value.
    #[error("constraint row {row} depends linearly on the others and contradicts them by {gap:e}")]
    Dependent {
        /// Row index.
        row: usize,
        /// Value of the linear combination of this row with the others that should vanish.
        gap: f64,
    },
    /// A parameter of a weak support that must be positive.
    #[error("weak support {support}: {what} is {value}; it must be positive and finite")]
    BadWeak {
        /// Index of the support.
        support: usize,
        /// Name of the parameter.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A dilation group without positive volume.
    #[error("dilation group {group} has volume {volume:e} m^3; it must be positive")]
    GroupVolume {
        /// Group index.
        group: usize,
        /// Its volume.
        volume: f64,
    },
    /// A node to which no integration point contributes and that is not fixed along every axis.
    #[error("node {node} has no stiffness: no integration point contributes to it")]
    OrphanNode {
        /// The node.
        node: usize,
    },
    /// The supports leave the body (or a piece of it) free to move rigidly.
    #[error("rigid motion is left free: {}{}", list(modes), piece(*node, *piece_nodes, *nodes))]
    RigidMotion {
        /// The free motions.
        modes: Vec<RigidMode>,
        /// Lowest node of the piece that can move.
        node: usize,
        /// Number of nodes that move.
        piece_nodes: usize,
        /// Number of nodes in all.
        nodes: usize,
    },
    /// A zero or negative pivot although no rigid motion is free. Either the integration is too poor
    /// (zero-energy modes), or parts of the body are joined by a hinge only.
    #[error(
        "the stiffness matrix is not positive definite although no rigid motion is free; possible causes: \
         zero-energy modes of a reduced integration, or parts joined only along an edge or at a point"
    )]
    NotPositiveDefinite,
    /// Conjugate gradients over the nodal parameters, which cannot enforce constraint rows.
    #[error("{rows} constraint rows need a direct solver; the iterative solver does not support constraints")]
    RowsNeedFactor {
        /// Number of rows.
        rows: usize,
    },
    /// As [`SolveError::NotPositiveDefinite`], with Nitsche supports whose stabilisation is too small.
    #[error(
        "the stiffness matrix with Nitsche supports is not positive definite: gamma = {gamma} is too small \
         (or the boundary quadrature too coarse); raise gamma"
    )]
    NotCoercive {
        /// The smallest stabilisation factor among the supports.
        gamma: f64,
    },
    /// A motion without stiffness and mass, whose frequency is undefined.
    #[error(
        "some motion has neither stiffness nor mass, so its frequency is undefined; integrate the stiffness \
         or the mass with more points"
    )]
    NoFrequency,
    /// The linear system could not be solved.
    #[error(transparent)]
    Algebra(#[from] AlgebraError),
}

fn list(modes: &[RigidMode]) -> String {
    modes.iter().map(|m| m.to_string()).collect::<Vec<_>>().join(", ")
}

fn piece(node: usize, piece_nodes: usize, nodes: usize) -> String {
    if piece_nodes == nodes {
        String::new()
    } else {
        format!(" (of the piece of {piece_nodes} nodes that contains node {node})")
    }
}
