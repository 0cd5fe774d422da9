//! What is solved in time, how, and what comes out.

use contact::ContactCounts;
use material::Prony;
use shape::Vector3;

use super::{Energy, Mass, Ramps, TimeError};
use crate::{NewtonParams, StaticProblem, StaticWork, Step};

/// A body driven in real time.
#[derive(Clone, Debug)]
pub struct TimeProblem<'a> {
    /// The body with full loads, prescribed displacements and tools.
    pub body: &'a StaticProblem<'a>,
    /// How they grow.
    pub ramps: Ramps,
    /// Mass and start; none for a quasi-static motion.
    pub inertia: Option<Inertia<'a>>,
    /// Relaxation of the deviatoric stress of each law; empty in an elastic body.
    pub relaxation: &'a [Option<Prony>],
}

/// Mass, damping and the state at the start.
#[derive(Clone, Copy, Debug)]
pub struct Inertia<'a> {
    /// Mass matrix.
    pub mass: &'a Mass,
    /// Damping `c M v`, `c` in 1/s.
    pub damping: f64,
    /// Displacement at the start, m; empty for none. Held degrees of freedom have their own.
    pub displacement: &'a [Vector3],
    /// Velocity at the start, m/s; empty for rest.
    pub velocity: &'a [Vector3],
}

/// How time is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeParams {
    /// Time to reach, s.
    pub end: f64,
    /// Number of equal steps at whose ends results are wanted. Steps are never longer; a step that fails is halved.
    pub steps: usize,
    /// Part of a step below which cutting back is given up.
    pub smallest: f64,
    /// Local error of a displacement that a step may make, m; steps that make more are cut back. Only with inertia.
    pub accuracy: Option<f64>,
    /// Spectral radius at infinite frequency, 0 to 1: 1 dissipates nothing, 0 kills in one step what a step cannot
    /// resolve. Contact wants less than 1.
    pub rho_inf: f64,
    /// Newton's method.
    pub newton: NewtonParams,
    /// Uzawa iterations of the augmented Lagrangian per step; 0 for a plain penalty.
    pub augmentations: usize,
}

/// Displacement (m), velocity (m/s) and acceleration (m/s^2) of every node, the last two zero without inertia, and the
/// force of the supports on it (N), zero in free degrees of freedom.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Motion {
    pub u: Vec<Vector3>,
    pub v: Vec<Vector3>,
    pub a: Vec<Vector3>,
    pub reaction: Vec<Vector3>,
}

/// A converged step.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeStep {
    /// Time in s, iterations, tools. Its energy is that of the laws without relaxation.
    pub step: Step,
    /// The balance of energy.
    pub energy: Energy,
    /// Estimate of the step's local error, m.
    pub error: f64,
}

/// What a solution in time gave: everything up to its end, and why it ended if that was early.
#[derive(Clone, Debug)]
pub struct TimePath {
    /// Converged steps in order. One at time 0 is first where a quasi-static body is loaded at once.
    pub steps: Vec<TimeStep>,
    /// Nodal parameters after the last converged step.
    pub motion: Motion,
    /// Pressure parameters (mixed method), Pa.
    pub pressure: Vec<f64>,
    /// Steps that failed and were cut back.
    pub cut_back: usize,
    /// What the contact search did and skipped.
    pub counts: ContactCounts,
    /// Work in all.
    pub work: StaticWork,
    /// Why it ended early, if it did.
    pub failure: Option<TimeError>,
}

impl TimePath {
    /// The time reached, s.
    pub fn time(&self) -> f64 {
        self.steps.last().map_or(0.0, |s| s.step.time)
    }
}

impl TimeProblem<'_> {
    /// Looks at everything that Newton's method does not look at itself.
    pub(super) fn check(&self, params: &TimeParams) -> Result<(), TimeError> {
        let refuse = |what, value, need| Err(TimeError::Parameter { what, value, need });
        if !(params.end > 0.0 && params.end.is_finite()) {
            return refuse("the end", params.end, "it must be positive and finite");
        }
        if !(params.smallest > 0.0) {
            return refuse("the smallest part of a step", params.smallest, "it must be positive");
        }
        if !(params.rho_inf >= 0.0 && params.rho_inf <= 1.0) {
            return refuse("rho_inf", params.rho_inf, "it must be between 0 and 1");
        }
        if let Some(value) = params.accuracy.filter(|a| !(*a > 0.0)) {
            return refuse("the accuracy", value, "it must be positive");
        }
        let Ramps { loads, supports, tools } = self.ramps;
        for over in [loads, supports, tools].into_iter().filter_map(super::Ramp::over) {
            if !(over > 0.0) {
                return refuse("the duration of a ramp", over, "it must be positive");
            }
        }
        let laws = self.body.solid.laws.len();
        if !self.relaxation.is_empty() && self.relaxation.len() != laws {
            let value = self.relaxation.len() as f64;
            return refuse("the number of relaxations", value, "there must be one for each law, or none");
        }
        let Some(inertia) = &self.inertia else { return Ok(()) };
        if !(inertia.damping >= 0.0 && inertia.damping.is_finite()) {
            return refuse("the damping", inertia.damping, "it must not be negative");
        }
        let jump = self.body.fixed.iter().find(|f| f.value != 0.0);
        if let (None, Some(jump)) = (supports.over(), jump) {
            return refuse("a support put on at once", jump.value, "a body with mass needs time to follow");
        }
        let nodes = self.body.nodes.len();
        let check = crate::body::check_len;
        check("nodes of the mass table", inertia.mass.node_count(), nodes)?;
        for (what, field) in [
            ("displacements at the start", inertia.displacement),
            ("velocities at the start", inertia.velocity),
        ] {
            if !field.is_empty() {
                check(what, field.len(), nodes)?;
            }
        }
        Ok(())
    }
}
