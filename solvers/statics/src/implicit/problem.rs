//! Problem, parameters and result of implicit dynamics.

use contact::ContactCounts;
use material::Prony;
use shape::{Resultant, Vector3};

use super::energy::Energy;
use super::error::TimeError;
use super::mass::Mass;
use crate::nonlinear::{NewtonParams, StaticProblem, StaticWork, Step};

/// A body whose loads, supports and tools follow curves over physical time.
#[derive(Clone, Debug)]
pub struct TimeProblem<'a> {
    /// The body with full loads, prescribed displacements and tools.
    pub body: &'a StaticProblem<'a>,
    /// Mass and initial state; `None` for a quasi-static motion.
    pub inertia: Option<Inertia<'a>>,
    /// Relaxation of the deviatoric stress of each law; empty for an elastic body.
    pub relaxation: &'a [Option<Prony>],
}

/// Mass, damping and the initial state.
#[derive(Clone, Copy, Debug)]
pub struct Inertia<'a> {
    /// Mass matrix.
    pub mass: &'a Mass,
    /// Factor `c` of the mass-proportional damping force `c M v`, 1/s.
    pub damping: f64,
    /// Factor `beta` of the stiffness-proportional damping force `beta K v`, s, with the tangent `K` of the internal
    /// forces in the current state.
    pub stiffness_damping: f64,
    /// Initial displacement, m; empty for zero. Constrained degrees of freedom take their prescribed values.
    pub displacement: &'a [Vector3],
    /// Initial velocity, m/s; empty for rest.
    pub velocity: &'a [Vector3],
}

/// Parameters of time stepping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeParams {
    /// Time to reach, s.
    pub end: f64,
    /// Number of equal output intervals. Steps are never longer; a step that fails is halved.
    pub steps: usize,
    /// Smallest step as a fraction of the output interval; shorter steps are given up.
    pub smallest: f64,
    /// Largest local error of a displacement in a step, m; steps with larger errors are cut back. Only with
    /// inertia.
    pub accuracy: Option<f64>,
    /// Spectral radius at infinite frequency, 0 to 1. With 1 nothing is dissipated; with 0 unresolved
    /// frequencies vanish in one step. Contact needs a value below 1.
    pub rho_inf: f64,
    /// `alpha` of the method of Hilber, Hughes and Taylor in place of `rho_inf`, -1/3 to 0. With 0 it is
    /// Newmark's trapezoidal rule.
    pub alpha: Option<f64>,
    /// Parameters of Newton's method.
    pub newton: NewtonParams,
    /// Uzawa iterations of the augmented Lagrangian per step; 0 for a plain penalty.
    pub augmentations: usize,
}

/// Displacement (m), velocity (m/s) and acceleration (m/s^2) of every node, the reaction force of the supports
/// (N), and the force of each surface constrained by penalty, without damping. Velocity and acceleration are zero
/// without inertia; the reaction is zero in free degrees of freedom.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Motion {
    pub u: Vec<Vector3>,
    pub v: Vec<Vector3>,
    pub a: Vec<Vector3>,
    pub reaction: Vec<Vector3>,
    pub penalties: Vec<Resultant>,
}

/// A converged step.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeStep {
    /// Record of the step (its time in s, Newton iterations, tools). [`Step::energy`] is the strain energy of
    /// the laws without relaxation.
    pub step: Step,
    /// Energy balance.
    pub energy: Energy,
    /// Estimate of the step's local error, m.
    pub error: f64,
}

/// Result of implicit dynamics up to its end, with the reason of an early end.
#[derive(Clone, Debug)]
pub struct TimePath {
    /// Converged steps in order. The first is at time 0 if a quasi-static body is loaded at once.
    pub steps: Vec<TimeStep>,
    /// Nodal parameters after the last converged step.
    pub motion: Motion,
    /// Pressure parameters of the mixed method, Pa.
    pub pressure: Vec<f64>,
    /// Number of steps that failed and were cut back.
    pub cut_back: usize,
    /// Counters of the contact search.
    pub counts: ContactCounts,
    /// Counters of the whole solution.
    pub work: StaticWork,
    /// Reason of an early end.
    pub failure: Option<TimeError>,
}

impl TimePath {
    /// Time reached, s.
    pub fn time(&self) -> f64 {
        self.steps.last().map_or(0.0, |s| s.step.time)
    }
}

impl TimeProblem<'_> {
    /// Checks the inputs that Newton's method does not check itself.
    pub(super) fn check(&self, params: &TimeParams) -> Result<(), TimeError> {
        let refuse = |what, value, need| Err(TimeError::Parameter { what, value, need });
        if !(params.end > 0.0 && params.end.is_finite()) {
            return refuse("the end time", params.end, "it must be positive and finite");
        }
        if !(params.smallest > 0.0) {
            return refuse("the smallest step fraction", params.smallest, "it must be positive");
        }
        if !(params.rho_inf >= 0.0 && params.rho_inf <= 1.0) {
            return refuse("rho_inf", params.rho_inf, "it must be between 0 and 1");
        }
        if let Some(value) = params.alpha.filter(|alpha| !(*alpha >= -1.0 / 3.0 && *alpha <= 0.0)) {
            return refuse("alpha", value, "it must be between -1/3 and 0");
        }
        if let Some(value) = params.accuracy.filter(|a| !(*a > 0.0)) {
            return refuse("the accuracy", value, "it must be positive");
        }
        let laws = self.body.solid.laws.len();
        if !self.relaxation.is_empty() && self.relaxation.len() != laws {
            let value = self.relaxation.len() as f64;
            return refuse("the number of relaxations", value, "give one for each law, or none");
        }
        let Some(inertia) = &self.inertia else { return Ok(()) };
        if !(inertia.damping >= 0.0 && inertia.damping.is_finite()) {
            return refuse("the damping", inertia.damping, "it must not be negative");
        }
        let beta = inertia.stiffness_damping;
        if !(beta >= 0.0 && beta.is_finite()) {
            return refuse("the stiffness-proportional damping", beta, "it must not be negative");
        }
        if beta > 0.0 && !inertia.velocity.is_empty() {
            let need =
                "a body with an initial velocity has forces of damping at the start, which are not computed";
            return refuse("the stiffness-proportional damping", beta, need);
        }
        if beta > 0.0 && self.relaxation.iter().any(Option::is_some) {
            let need = "tissue that relaxes has rates of its own";
            return refuse("the stiffness-proportional damping", beta, need);
        }
        let at_start = |index: usize| self.body.curves.fixed.of(index).value(0.0);
        let fixed = self.body.fixed.iter().enumerate();
        if let Some((_, jump)) = fixed.into_iter().find(|(i, f)| f.value * at_start(*i) != 0.0) {
            return refuse(
                "the displacement of a support at the start",
                jump.value,
                "a body with mass needs a curve that starts at 0",
            );
        }
        let nodes = self.body.nodes.len();
        let check = crate::body::check_len;
        check("nodes of the mass table", inertia.mass.node_count(), nodes)?;
        for (what, field) in
            [("initial displacements", inertia.displacement), ("initial velocities", inertia.velocity)]
        {
            if !field.is_empty() {
                check(what, field.len(), nodes)?;
            }
        }
        Ok(())
    }
}
