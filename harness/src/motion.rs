//! What dynamics came to, explicit or implicit.

use explicit::KernelInfo;
use geometry::Vector3;

use crate::Failure;
use crate::outcome::{LoadStep, Metric};

/// A motion, whole or ended early.
pub struct Motion {
    /// Nodal parameters at the end, m: of the last state that was recorded (explicit) or converged (implicit).
    pub u: Vec<Vector3>,
    /// Parameters of the method's own pressure field there, Pa, tension positive; empty without one.
    pub pressure: Vec<f64>,
    /// Unknowns: degrees of freedom that move freely, pressures included.
    pub dofs: usize,
    /// Recorded states.
    pub steps: Vec<LoadStep>,
    /// Nodal parameters at each of them, m.
    pub fields: Vec<Vec<Vector3>>,
    /// The last one.
    pub last: LoadStep,
    /// Numbers of the whole motion.
    pub metrics: Vec<Metric>,
    /// What evaluated the internal forces of explicit dynamics.
    pub forces: Option<KernelInfo>,
    /// Why it ended early, if it did.
    pub failure: Option<Failure>,
}
