//! Results of a procedure.

use contact::ContactHistory;
use explicit::KernelInfo;
use geometry::Vector3;
use shape::Resultant;
use statics::{Modes, SolveInfo};

use crate::error::Failure;
use crate::outcome::{LoadStep, Metric};

/// Result of a procedure. It has no nodal parameters if the procedure does not solve for a displacement.
#[derive(Default)]
pub(crate) struct Solution {
    /// Nodal parameters at the end, m.
    pub(crate) u: Vec<Vector3>,
    /// Parameters of the method's own pressure field at the end, Pa, tension positive; empty without such a
    /// field.
    pub(crate) pressure: Vec<f64>,
    /// Force of the nodal supports on each node at the end, N; empty if unknown, as after a relaxation.
    pub(crate) reaction: Vec<Vector3>,
    /// Contact history of each tool at the last equilibrium of a static procedure.
    pub(crate) contact: Vec<ContactHistory>,
    /// Resultant of each support's forces on the body at the end of a linear procedure.
    pub(crate) supports: Vec<Resultant>,
    /// Number of unknowns, pressures included.
    pub(crate) dofs: usize,
    /// Relative residual of the last static equilibrium.
    pub(crate) residual: Option<f64>,
    /// Solver information of a linear procedure.
    pub(crate) linear: Option<SolveInfo>,
    /// Name of the iterative solver of Newton's tangents, if one was used.
    pub(crate) tangents: Option<&'static str>,
    /// Whether a linear procedure should have been solved by iterations but needed a factor.
    pub(crate) not_iterated: bool,
    /// Smallest stabilisation factor of Nitsche's method, if Nitsche's method constrains the body in a linear
    /// procedure.
    pub(crate) needed_nitsche_factor: Option<f64>,
    /// Largest kinetic energy of parameters without that of the displacement, divided by the largest kinetic
    /// energy, in explicit dynamics of a cloud.
    pub(crate) spurious_motion: Option<f64>,
    /// Expected correct decimal digits of a linear solution.
    pub(crate) digits: Option<f64>,
    /// History of a procedure with steps.
    pub(crate) history: Option<StepHistory>,
    /// Modes of a modal analysis.
    pub(crate) vibration: Option<Vibration>,
    /// Whether a prediction found no equilibrium and is that of the linearised problem.
    pub(crate) linearised: bool,
    /// Kernel that evaluated the internal forces of explicit dynamics or relaxation.
    pub(crate) forces: Option<KernelInfo>,
    /// Failure that ended Newton's method early, if relaxation continued to the whole load.
    pub(crate) relaxed: Option<Failure>,
    /// Properties of the external program that solved the problem.
    pub(crate) program: Option<OfProgram>,
}

/// Solution of another method, carried over to the nodes and points of a problem.
pub(crate) struct Carried<'a> {
    pub(crate) from: &'a Solution,
    /// Displacement of the nodes, m.
    pub(crate) u: &'a [Vector3],
    /// Parameters of the problem's pressure field, Pa, tension positive.
    pub(crate) pressure: &'a [f64],
    /// The other method's contact point next to each contact point.
    pub(crate) nearest: &'a [u32],
}

impl Carried<'_> {
    /// Fraction of the loading that was reached.
    pub(crate) fn load(&self) -> f64 {
        self.from.history.as_ref().map_or(1.0, |history| history.last.load)
    }
}

/// Load steps of a static path or recorded states of a motion, up to the end that was reached.
pub(crate) struct StepHistory {
    /// Ends of the scene's load steps, or its recorded states.
    pub(crate) steps: Vec<LoadStep>,
    /// Nodal parameters at each step or state, m.
    pub(crate) fields: Vec<Vec<Vector3>>,
    /// Last converged or recorded state, which need not be one of `steps`.
    pub(crate) last: LoadStep,
    /// Metrics of the whole history.
    pub(crate) metrics: Vec<Metric>,
    /// Failure that ended the run early, if any.
    pub(crate) failure: Option<Failure>,
}

impl Solution {
    /// Name of the solver of the linear system or the eigenproblem, or of the external program; `None` for
    /// other procedures.
    pub(crate) fn solver(&self) -> Option<&str> {
        if let Some(program) = &self.program {
            return program.version.as_deref();
        }
        let of_vibration = self.vibration.as_ref().map(|vibration| vibration.modes.solver());
        self.linear.as_ref().map(|info| info.path.name()).or(of_vibration).or(self.tangents)
    }

    /// Resultant of each support's forces on the body at the end; empty if unknown.
    pub(crate) fn support_forces(&self) -> &[Resultant] {
        self.history.as_ref().map_or(&self.supports, |history| &history.last.supports)
    }

    /// Time at the end: in dynamics in seconds, otherwise the fraction of the loading.
    pub(crate) fn time(&self) -> f64 {
        self.history.as_ref().map_or(1.0, |history| history.last.time().unwrap_or(history.last.load))
    }

    /// Whether the whole load was reached, which is always true for a linear procedure.
    pub(crate) fn is_whole(&self) -> bool {
        self.history.as_ref().is_none_or(|history| history.failure.is_none())
    }
}

/// Vibration modes and the mass of the body.
pub(crate) struct Vibration {
    pub(crate) modes: Modes,
    /// Number of modes to report.
    pub(crate) count: usize,
    /// Mass of the body, kg.
    pub(crate) mass: f64,
}

/// Properties of the external program that solved the problem.
#[derive(Clone, Debug, Default)]
pub(crate) struct OfProgram {
    /// Peak memory of all its processes together, bytes.
    pub(crate) memory: u64,
    /// Name and version, if the program reports them.
    pub(crate) version: Option<String>,
}
