//! What a scene reports, what it compares with, and what must hold.

use std::path::PathBuf;

use super::method::{MeshFile, Size};
use super::model::Place;
use crate::exact::SolutionEntry;
use catalogue::Values;
use catalogue::metric::Metric;

/// What a scene reports.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Points to report, in metres.
    pub probes: Vec<[f64; 3]>,
    /// Parts of the surface whose mean displacement is reported.
    pub means: Vec<Place>,
    /// Transfers of the nodal displacements to other points.
    pub transfers: Vec<Transfer>,
    /// Id of a method that every run is compared with at the targets, beside the reference.
    pub beside: Option<String>,
    /// The loading repeated in frames.
    pub repeated: Option<Repeated>,
}

/// A simulator's loop: the loading goes up and down, a frame at a time, prepared once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeated {
    /// Frames in all.
    pub frames: usize,
    /// Frames of one way up and down.
    pub cycle: usize,
    /// Time after which no further frame is started, s.
    pub within: f64,
    /// Relative residual of a frame, where it is not the procedure's.
    pub tolerance: Option<f64>,
}

/// A transfer of nodal displacements to other points.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// The points.
    pub to: Target,
    /// The scheme and the values of its parameters; `None` for the solver's own rows.
    pub scheme: Option<(interp::Scheme, Values)>,
}

/// Points of a transfer.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The nodes of the reference method.
    ReferenceNodes,
    /// The probes.
    Probes,
    /// The nodes of a mesh file.
    File(MeshFile),
}

/// What results are compared with.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// An exact solution.
    Exact {
        /// Which one.
        entry: &'static SolutionEntry,
        /// Its parameters.
        values: Values,
    },
    /// A method of this scene.
    Method {
        /// Its id.
        id: String,
        /// Another size to run it at.
        size: Option<Size>,
    },
    /// A stored record.
    Record(PathBuf),
}

/// What must hold of the results.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The metric.
    pub metric: &'static Metric,
    /// Ids of the methods it holds for; all of them where empty.
    pub methods: Vec<String>,
    /// The bound, in the SI unit of the metric.
    pub bound: Bound,
    /// Its place, `file:line`.
    pub at: String,
}

/// Bound of a metric.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound {
    /// Passes if no value is beyond.
    Within {
        /// Smallest value allowed.
        at_least: Option<f64>,
        /// Largest value allowed.
        at_most: Option<f64>,
    },
    /// A known defect: the value is reported as not passing, and the check holds only while it stays in the band.
    KnownBand {
        /// Low end.
        low: f64,
        /// High end.
        high: f64,
        /// Why the method can't do better.
        reason: String,
    },
}
