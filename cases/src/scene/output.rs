//! Output, reference and checks of a scene.

use std::path::PathBuf;

use super::method::{MeshFile, Size};
use super::model::Place;
use crate::exact::SolutionEntry;
use catalogue::Values;
use catalogue::metric::Metric;

/// Output of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Points at which results are reported, in metres.
    pub probes: Vec<[f64; 3]>,
    /// Parts of the surface whose mean displacement is reported.
    pub means: Vec<Place>,
    /// Transfers of the nodal displacements to other points.
    pub transfers: Vec<Transfer>,
    /// Id of the secondary reference: a method that every run is also compared with at the targets.
    pub beside: Option<String>,
    /// Repetition of the loading in frames.
    pub repeated: Option<Repeated>,
}

/// A simulator's loop: prepared once, the loading goes up and down frame by frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeated {
    /// Total number of frames.
    pub frames: usize,
    /// Frames of one cycle up and down.
    pub cycle: usize,
    /// Time after which no further frame starts, s.
    pub within: f64,
    /// Relative residual of a frame; the procedure's tolerance if `None`.
    pub tolerance: Option<f64>,
}

/// A transfer of nodal displacements to other points.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// Target points.
    pub to: Target,
    /// The scheme and the values of its parameters; `None` for the solver's own rows.
    pub scheme: Option<(interp::Scheme, Values)>,
}

/// Target points of a transfer.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The nodes of the reference method.
    ReferenceNodes,
    /// The probes.
    Probes,
    /// The nodes of a mesh file.
    File(MeshFile),
}

/// Reference that results are compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// An exact solution.
    Exact {
        /// Entry of the solution.
        entry: &'static SolutionEntry,
        /// Parameters of the solution.
        values: Values,
    },
    /// A method of this scene.
    Method {
        /// Id of the method.
        id: String,
        /// Size of the reference run, if it differs from the method's own size.
        size: Option<Size>,
    },
    /// A stored record.
    Record(PathBuf),
}

/// A bound on the results.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The metric.
    pub metric: &'static Metric,
    /// Ids of the methods that the check applies to; empty for all.
    pub methods: Vec<String>,
    /// The bound, in the SI unit of the metric.
    pub bound: Bound,
    /// Location in the file, `file:line`.
    pub at: String,
}

/// Bound of a metric.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound {
    /// A range: passes if no value is outside.
    Within {
        /// Smallest allowed value.
        at_least: Option<f64>,
        /// Largest allowed value.
        at_most: Option<f64>,
    },
    /// A known defect: the value is reported as not passing, and the check holds only while the value is in
    /// the band.
    KnownBand {
        /// Low end.
        low: f64,
        /// High end.
        high: f64,
        /// Reason why the method can't do better.
        reason: String,
    },
}
