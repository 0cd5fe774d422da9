//! What can go wrong in explicit dynamics.

use contact::ContactError;

/// A quadrature point that is inside out, or whose displacements are not numbers.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("quadrature point {point} has det F = {det_f}; it must be positive")]
pub struct InvertedPoint {
    /// Row of the volume quadrature.
    pub point: usize,
    /// `det F` there; NaN where a displacement is.
    pub det_f: f64,
}

/// Why an explicit computation cannot start or go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExplicitError {
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
    /// A region index beyond the laws.
    #[error("point {point} lies in region {region}, but there are {laws} laws")]
    NoLaw {
        /// Quadrature point.
        point: usize,
        /// Its region.
        region: usize,
        /// Number of laws.
        laws: usize,
    },
    /// A parameter out of its range.
    #[error("{what} is {value}; it must be {allowed}")]
    BadParameter {
        /// Which parameter.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A node whose lumped mass is not positive: no integration point sees it, or its values sum to less than zero.
    #[error("node {node} has lumped mass {mass:e} kg; it must be positive")]
    NodalMass {
        /// The node.
        node: usize,
        /// Its mass, kg.
        mass: f64,
    },
    /// A degree of freedom that is not there, or is prescribed twice.
    #[error("node {node}, axis {axis} cannot be prescribed: {why}")]
    BadDof {
        /// The node.
        node: usize,
        /// The axis.
        axis: u8,
        /// Why not.
        why: &'static str,
    },
    /// A point inside out before the first step.
    #[error(transparent)]
    Inverted(#[from] InvertedPoint),
    /// A point turned inside out on the way.
    #[error("step {step} (t = {time:e} s): {at}")]
    InvertedAt {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// The point and its `det F`.
        at: InvertedPoint,
    },
    /// A displacement or a force that is not a number.
    #[error("step {step} (t = {time:e} s): the {what} of node {node} is not finite")]
    NotFinite {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// Which quantity.
        what: &'static str,
        /// Node.
        node: usize,
    },
    /// A time step beyond the critical one: the motion would grow without bound.
    #[error("step {step} (t = {time:e} s): the time step {dt:e} s exceeds the critical {critical:e} s")]
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
    /// Contact without meaning in a state on the way.
    #[error("step {step} (t = {time:e} s): tool[{tool}]: {cause}")]
    ContactAt {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// Index of the tool.
        tool: usize,
        /// Why.
        cause: ContactError,
    },
    /// A tool so light that it would jump off what it touches within a step.
    #[error(
        "step {step} (t = {time:e} s): tool {tool} of {mass:e} kg swings on its contact with a critical step of \
         {critical:e} s; it must be at least twice the time step {dt:e} s: give it more mass"
    )]
    LightTool {
        /// Step.
        step: usize,
        /// Time, s.
        time: f64,
        /// Its index.
        tool: usize,
        /// Its mass, kg.
        mass: f64,
        /// Time step, s.
        dt: f64,
        /// `2 sqrt(m / (k_n A))` with the area in contact, s.
        critical: f64,
    },
    /// A relaxation that has not come to rest.
    #[error("not at rest after {steps} steps: estimated relative error {error:e} (tolerance {tolerance:e})")]
    NotRelaxed {
        /// Steps made.
        steps: usize,
        /// Estimated relative error.
        error: f64,
        /// Tolerance.
        tolerance: f64,
    },
}
