//! What a procedure comes to.

use explicit::KernelInfo;
use geometry::Vector3;
use statics::SolveInfo;

use super::external::OfProgram;
use super::modes::Vibration;
use crate::Failure;
use crate::outcome::{LoadStep, Metric};

/// What a procedure comes to; without nodal parameters where it solves for no displacement.
#[derive(Default)]
pub(crate) struct Solution {
    /// Nodal parameters at the end, m.
    pub(crate) u: Vec<Vector3>,
    /// Parameters of the method's own pressure field there, Pa, tension positive; empty without one.
    pub(crate) pressure: Vec<f64>,
    /// Force of each support on the body at the end of a linear procedure, N.
    pub(crate) supports: Vec<Vector3>,
    /// Unknowns, pressures included.
    pub(crate) dofs: usize,
    /// Relative residual of the last equilibrium of a procedure at rest.
    pub(crate) residual: Option<f64>,
    /// Of a linear procedure.
    pub(crate) linear: Option<SolveInfo>,
    /// Whether a linear procedure was to iterate, and needed a factor.
    pub(crate) not_iterated: bool,
    /// Factor that Nitsche's method needs here, where it holds the body in a linear procedure.
    pub(crate) needed_nitsche_factor: Option<f64>,
    /// Decimal digits to be expected of a linear solution.
    pub(crate) digits: Option<f64>,
    /// Of a procedure in steps.
    pub(crate) history: Option<StepHistory>,
    /// Of vibrations.
    pub(crate) vibration: Option<Vibration>,
    /// What evaluated the internal forces of explicit dynamics or relaxation.
    pub(crate) forces: Option<KernelInfo>,
    /// Why Newton's method ended early where relaxation continued to the whole load.
    pub(crate) relaxed: Option<Failure>,
    /// Of a program outside this one that solved.
    pub(crate) program: Option<OfProgram>,
}

/// The load steps of a path or the recorded states of a motion, as far as it came.
pub(crate) struct StepHistory {
    /// The ends of the scene's load steps, or its recorded states.
    pub(crate) steps: Vec<LoadStep>,
    /// Nodal parameters at each of them, m.
    pub(crate) fields: Vec<Vec<Vector3>>,
    /// The last converged or recorded state, among them or not.
    pub(crate) last: LoadStep,
    /// Numbers of the whole.
    pub(crate) metrics: Vec<Metric>,
    /// Why it ended early, if it did.
    pub(crate) failure: Option<Failure>,
}

impl Solution {
    /// What solved the linear system, or the eigenproblem, of a procedure that has one.
    pub(crate) fn solver(&self) -> Option<&str> {
        if let Some(program) = &self.program {
            return program.version.as_deref();
        }
        let of_vibration = self.vibration.as_ref().map(|vibration| vibration.modes.solver());
        self.linear.as_ref().map(|info| info.path.name()).or(of_vibration)
    }

    /// Force of each support on the body at the end, N; none where it is not known.
    pub(crate) fn support_forces(&self) -> &[Vector3] {
        self.history.as_ref().map_or(&self.supports, |history| &history.last.supports)
    }

    /// Whether the whole load was reached; a linear procedure has no less.
    pub(crate) fn is_whole(&self) -> bool {
        self.history.as_ref().is_none_or(|history| history.failure.is_none())
    }
}
