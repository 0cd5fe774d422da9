//! The record of a step, and the counters of a solution.

use contact::ToolState;

use super::newton::Iteration;

/// A converged step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Load fraction, 0 to 1.
    pub time: f64,
    /// Whether results are requested at the end of this step (a multiple of `1 / steps`).
    pub wanted: bool,
    /// Newton iterations of the step.
    pub iterations: Vec<Iteration>,
    /// Whether the body gave way in this step, as in snap-through: there was no equilibrium nearby, so the
    /// solver followed the energy downhill with an indefinite tangent, further than the Newton step. In a
    /// search for a limit point the flag is also set if the nearest equilibrium was unstable and the solver
    /// continued to a stable equilibrium.
    pub gave_way: bool,
    /// Whether the step ends in a stable equilibrium: the last tangent (with friction, its symmetric part)
    /// was positive definite. An unstable equilibrium lies beyond a limit or bifurcation point, and the body
    /// would leave it by itself.
    pub stable: bool,
    /// States of the tools.
    pub tools: Vec<ToolState>,
    /// Strain energy, J.
    pub energy: f64,
    /// Smallest J of all quadrature points.
    pub smallest: f64,
}

impl Step {
    /// Whether the step took so few iterations that the next step may be longer.
    pub(crate) fn is_quick(&self) -> bool {
        self.iterations.len() <= 6
    }
}

/// Counters of a static solution, including failed steps and discarded trials.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StaticWork {
    /// Number of assembled tangents: one per iteration.
    pub assemblies: u64,
    /// Number of numeric factorisations, more than assemblies if tangents are not definite.
    pub factorisations: u64,
    /// Number of linear systems solved: one per iteration. With a pressure field, every trial whose residual
    /// did not fall adds one.
    pub solves: u64,
    /// Number of iterations of the linear solver, with a factor kept from another tangent or with sliding
    /// friction.
    pub inner: u64,
    /// Number of force evaluations, one per trial state.
    pub forces: u64,
}
