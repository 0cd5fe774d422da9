//! Requested outputs and comparisons of a run, and the reference.

use cases::scene::{RealTime, Repeated};
use geometry::{Point3, Vector3};
use interp::Scheme;

use crate::error::Failure;
use crate::outcome::{LoadStep, Metric, SchemeSettings, Warning, Watch};

/// Repeats of a run for its timings. A run is made at least once, and repeated until `seconds` are spent or
/// `most` runs are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// Largest number of runs.
    pub most: usize,
    /// Time to spend, s.
    pub seconds: f64,
}

impl Repeats {
    /// A single run without repeats.
    pub const ONCE: Repeats = Repeats { most: 1, seconds: 0.0 };
}

/// Function that evaluates the displacement (m) of a finished run at any points (m).
pub type Evaluate = Box<dyn Fn(&[Point3]) -> Result<Vec<Vector3>, Failure> + Send + Sync>;

/// Reference displacement, from which errors are measured if there is no exact solution.
pub struct Reference {
    /// Id of the method that computed the reference.
    pub method: String,
    /// Number of nodes.
    pub nodes: usize,
    /// Displacement at the scene's target points, m.
    pub targets: Vec<Vector3>,
    /// Load steps; empty if the procedure has none.
    pub steps: Vec<LoadStep>,
    /// Whether the reference reached the whole load; if not, runs are compared only at its steps.
    pub finished: bool,
    /// Warnings about the reference.
    pub warnings: Vec<Warning>,
    /// Estimate of the reference's own error.
    pub own: OwnError,
    /// Evaluates the reference at any points; `None` for a stored reference, which has values only at the
    /// targets.
    pub at: Option<Evaluate>,
}

/// Estimate of the own error of a reference.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnError {
    /// Relative errors of the reference. A run's error below them has no meaning.
    pub band: Vec<Metric>,
    /// Solutions from whose distance the errors are estimated.
    pub by: Vec<String>,
    /// Reason why there is no estimate; empty if there is one.
    pub unknown: String,
}

impl OwnError {
    /// Adds a distance to the estimate. Distances of the same metric are summed.
    pub(crate) fn add(&mut self, distance: Metric) {
        let same = |m: &&mut Metric| m.of == distance.of;
        match self.band.iter_mut().find(same) {
            Some(known) => known.value += distance.value,
            None => self.band.push(distance),
        }
    }
}

/// Outputs and comparisons of a run.
#[derive(Clone, Copy)]
pub(crate) struct Request<'a> {
    /// Probe positions, m.
    pub(crate) probes: &'a [Point3],
    /// Points where displacements are compared; the method's own nodes if empty.
    pub(crate) targets: &'a [Point3],
    /// Transfer schemes that interpolate a method's displacement to the targets.
    pub(crate) schemes: &'a [(SchemeSettings, Scheme)],
    /// Whether the surface displacement is kept for pictures.
    pub(crate) picture: bool,
    /// Whether the body is kept at all recorded states.
    pub(crate) states: bool,
    /// Repeats of the timed part.
    pub(crate) repeats: Repeats,
    /// Reference, if there is one.
    pub(crate) reference: Option<&'a Reference>,
    /// Secondary reference, if the scene names one.
    pub(crate) beside: Option<&'a Reference>,
    /// Solution of the same cloud with another integration rule, from which errors of integration are
    /// measured.
    pub(crate) integrated: Option<&'a Reference>,
    /// Simulator's loop after the first solution, if the loop is to run.
    pub(crate) repeated: Option<&'a Repeated>,
    /// Loop in real time after the first solution, if it is to run.
    pub(crate) real_time: Option<&'a RealTime>,
    /// Observer of the run.
    pub(crate) watch: Option<&'a Watch>,
}

impl<'a> Request<'a> {
    /// Request for a solution without comparisons.
    pub(crate) fn alone(probes: &'a [Point3], targets: &'a [Point3]) -> Request<'a> {
        Request {
            probes,
            targets,
            schemes: &[],
            picture: false,
            states: false,
            repeats: Repeats::ONCE,
            reference: None,
            beside: None,
            integrated: None,
            repeated: None,
            real_time: None,
            watch: None,
        }
    }

    /// Same request for a run that may have ended early. Ends are compared only if the run (`whole`) and the
    /// reference reached the whole load.
    pub(crate) fn at_end(&self, whole: bool) -> Request<'a> {
        let kept = |reference: Option<&'a Reference>| reference.filter(|r| whole && r.finished);
        Request {
            reference: kept(self.reference),
            beside: kept(self.beside),
            integrated: kept(self.integrated),
            ..*self
        }
    }
}
