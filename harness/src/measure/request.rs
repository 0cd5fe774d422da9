//! What a scene requests of every run.

use cases::scene::Repeated;
use geometry::{Point3, Vector3};
use interp::Scheme;

use crate::Failure;
use crate::outcome::{LoadStep, Metric, SchemeSettings, Warning, Watch};

/// How often a run is repeated for its timings: at least once, until `seconds` are spent or `most` is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// Most repeats.
    pub most: usize,
    /// Time to spend, s.
    pub seconds: f64,
}

impl Repeats {
    /// No repeat.
    pub const ONCE: Repeats = Repeats { most: 1, seconds: 0.0 };
}

/// Displacement (m) of a finished run at any points (m).
pub type Evaluate = Box<dyn Fn(&[Point3]) -> Result<Vec<Vector3>, Failure> + Send + Sync>;

/// The displacement that errors are measured against where no exact solution is known.
pub struct Reference {
    /// Which method made it.
    pub method: String,
    /// Its nodes.
    pub nodes: usize,
    /// Displacement at the scene's target points, m.
    pub targets: Vec<Vector3>,
    /// Its load steps, where the procedure has some.
    pub steps: Vec<LoadStep>,
    /// Whether it reached the whole load; if not, only its steps are compared with.
    pub finished: bool,
    /// What is to be said against it.
    pub warnings: Vec<Warning>,
    /// How far it is off itself.
    pub own: OwnError,
    /// Evaluates the reference at any point, m; a stored one knows only the targets.
    pub at: Option<Evaluate>,
}

/// The own error of a reference, as far as it is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnError {
    /// Relative errors; a smaller one of a run says nothing.
    pub band: Vec<Metric>,
    /// The solutions by whose distance they are estimated.
    pub by: Vec<String>,
    /// Why nothing is known; empty where something is.
    pub unknown: String,
}

impl OwnError {
    /// Adds a distance to what is known already.
    pub(crate) fn add(&mut self, distance: Metric) {
        let same = |m: &&mut Metric| m.entry == distance.entry && m.index == distance.index;
        match self.band.iter_mut().find(same) {
            Some(known) => known.value += distance.value,
            None => self.band.push(distance),
        }
    }
}

/// What a scene requests of every run.
#[derive(Clone, Copy)]
pub(crate) struct Request<'a> {
    /// Probe positions, m.
    pub(crate) probes: &'a [Point3],
    /// Points where displacements are compared; the method's own nodes if empty.
    pub(crate) targets: &'a [Point3],
    /// Transfer schemes that interpolate a cloud's displacement to the targets.
    pub(crate) schemes: &'a [(SchemeSettings, Scheme)],
    /// Whether the surface displacement is kept for pictures.
    pub(crate) picture: bool,
    /// Whether the body is kept at all recorded states.
    pub(crate) states: bool,
    /// Repeats of the timed part.
    pub(crate) repeats: Repeats,
    /// The reference, where one is known.
    pub(crate) reference: Option<&'a Reference>,
    /// The secondary reference, if the scene names one.
    pub(crate) beside: Option<&'a Reference>,
    /// The same cloud integrated by another rule, which errors of integration are measured from.
    pub(crate) integrated: Option<&'a Reference>,
    /// The loop of frames after the first solution, if it is to run.
    pub(crate) repeated: Option<&'a Repeated>,
    /// Who waits for it.
    pub(crate) watch: Option<&'a Watch>,
}

impl<'a> Request<'a> {
    /// One solution, compared with nothing.
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
            watch: None,
        }
    }

    /// The same for a run that may have ended early: ends are compared only where both are whole.
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
