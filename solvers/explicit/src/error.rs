//! Errors of explicit dynamics.

use contact::ContactError;

/// Quadrature point that is inverted, or whose displacements are not numbers.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("quadrature point {point} has det F = {det_f}; it must be positive")]
pub struct InvertedPoint {
    /// Row of the volume quadrature.
    pub point: usize,
    /// Value of `det F` at the point; NaN if a displacement is NaN.
    pub det_f: f64,
}

/// Reason why an explicit computation cannot start or continue.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExplicitError {
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
    /// A region index has no law.
    #[error("point {point} lies in region {region}, but only {laws} laws are given")]
    NoLaw {
        /// Quadrature point.
        point: usize,
        /// Region of the point.
        region: usize,
        /// Number of laws.
        laws: usize,
    },
    /// Forces in single precision were requested for a body that only other kernels evaluate.
    #[error("no kernel in single precision evaluates this element with this dilation and law")]
    NoSinglePrecision,
    /// Sweeps were requested for another table than that of linear tetrahedra.
    #[error("is for tetrahedra with four nodes and standard dilation only")]
    NotTetrahedra,
    /// Conjugate gradients were requested for a body with a projection of the dilation or hourglass control.
    #[error("is for standard dilation without hourglass control only")]
    NotStandard,
    /// Sweeps were requested for another law than the stable neo-Hookean one.
    #[error("region {region} has the law {law}; sweeps are for stable-neo-hookean only")]
    OtherLaw {
        /// The region.
        region: usize,
        /// Name of the law.
        law: &'static str,
    },
    /// Sweeps were requested with a tool that has friction.
    #[error("tool {tool} has friction, which sweeps do not support")]
    Friction {
        /// Index of the tool.
        tool: usize,
    },
    /// A parameter is out of its range.
    #[error("{what} is {value}; it must be {allowed}")]
    BadParameter {
        /// Name of the parameter.
        what: &'static str,
        /// Value of the parameter.
        value: f64,
        /// Allowed values.
        allowed: &'static str,
    },
    /// The lumped mass of a node is not positive: no integration point sees the node, or its values sum to
    /// less than zero.
    #[error("node {node} has lumped mass {mass:e} kg; it must be positive")]
    NodalMass {
        /// The node.
        node: usize,
        /// Mass of the node, kg.
        mass: f64,
    },
    /// A degree of freedom does not exist, or is prescribed twice.
    #[error("node {node}, axis {axis} cannot be prescribed: {why}")]
    BadDof {
        /// The node.
        node: usize,
        /// The axis.
        axis: u8,
        /// Reason.
        why: &'static str,
    },
    /// A point is inverted before the first step.
    #[error(transparent)]
    Inverted(#[from] InvertedPoint),
    /// A point was inverted during the motion.
    #[error("step {step} (t = {time:e} s): {at}")]
    InvertedAt {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// The point and its `det F`.
        at: InvertedPoint,
    },
    /// A displacement or a force is not a number.
    #[error("step {step} (t = {time:e} s): the {what} of node {node} is not finite")]
    NotFinite {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// Name of the quantity.
        what: &'static str,
        /// Node.
        node: usize,
    },
    /// The time step exceeds the critical step: the motion would grow without bound.
    #[error(
        "step {step} (t = {time:e} s): the time step {dt:e} s exceeds the critical time step \
         {critical:e} s"
    )]
    StepTooLarge {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// Time step, s.
        dt: f64,
        /// Critical time step, s.
        critical: f64,
    },
    /// Contact has no meaning in a state during the motion.
    #[error("step {step} (t = {time:e} s): tool[{tool}]: {cause}")]
    ContactAt {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// Index of the tool.
        tool: usize,
        /// Error of the contact.
        cause: ContactError,
    },
    /// A tool is so light that it would jump off the tissue within a step.
    #[error(
        "step {step} (t = {time:e} s): tool {tool} of {mass:e} kg vibrates on its contact stiffness with a \
         critical time step of {critical:e} s, which must be at least twice the time step {dt:e} s: give the \
         tool more mass"
    )]
    LightTool {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// Index of the tool.
        tool: usize,
        /// Mass of the tool, kg.
        mass: f64,
        /// Time step, s.
        dt: f64,
        /// Critical step of the tool, `2 sqrt(m / (k_n A))` with the area in contact, s.
        critical: f64,
    },
    /// The relaxation has not come to rest.
    #[error(
        "the body is not at rest after {steps} steps: estimated relative error {error:e} (tolerance \
         {tolerance:e})"
    )]
    NotRelaxed {
        /// Number of steps made.
        steps: usize,
        /// Estimated relative error.
        error: f64,
        /// Tolerance.
        tolerance: f64,
    },
}
