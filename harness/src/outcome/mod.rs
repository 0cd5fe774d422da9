//! Results of a run: identity, metrics, times and fields.

mod counters;
mod estimated;
mod face_results;
mod latency;
mod load_step;
mod metrics;
mod plan;
pub mod provenance;
mod rows;
mod states;
pub(crate) mod timing;
mod warning;
mod watch;

use catalogue::Values;
use catalogue::metric::{self, Address};
use geometry::{Matrix3, Point3, Vector3};
use records::{Record, Reference, SurfaceField};

use crate::error::Failure;
pub use counters::Counters;
pub(crate) use estimated::{Estimated, Estimates, SATURATED, corrected};
pub use face_results::{FaceMean, SupportForce};
pub(crate) use latency::FOR_P99;
pub use latency::Latency;
pub use load_step::{LoadStep, ToolStep};
pub use metrics::Metric;
pub(crate) use metrics::push;
pub use plan::{Plan, Stage, StageName};
pub(crate) use rows::run_id;
pub use states::States;
pub(crate) use states::{Moved, State, Tensors, ToolSkin, von_mises};
use timing::Timed;
pub use warning::Warning;
pub use watch::{Stopped, Watch};

/// Identity of a run: a record without size and value.
pub type Identity = Record;

/// Settings of a transfer scheme; `None` if the scheme does not have the setting.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SchemeSettings {
    /// Number of neighbours of each target.
    pub neighbours: Option<u64>,
    /// Power of the distance.
    pub power: Option<f64>,
    /// Ratio of support radius to node spacing.
    pub support_scale: Option<f64>,
    /// Ratio of the width of the radial functions to the mean node spacing.
    pub shape: Option<f64>,
    /// Whether a linear polynomial augments the radial functions.
    pub polynomial: Option<bool>,
}

impl SchemeSettings {
    /// Settings of a scheme from the values of its parameters, defaults included.
    pub fn of(values: &Values) -> SchemeSettings {
        SchemeSettings {
            neighbours: values.get("neighbours").map(|n| n as u64),
            power: values.get("power"),
            support_scale: values.get("support_scale"),
            shape: values.get("shape"),
            polynomial: values.takes("polynomial").then(|| values.flag("polynomial")),
        }
    }
}

/// Sizes of a discretisation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Size {
    /// Number of nodes.
    pub nodes: u64,
    /// Number of elements, or of background cells.
    pub elements: u64,
    /// Number of integration points.
    pub points: u64,
    /// Number of unknowns after elimination of the supports.
    pub dofs: u64,
    /// Mean node spacing, m.
    pub spacing: f64,
}

/// Displacement and stress at a probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Position, m.
    pub x: Point3,
    /// Displacement, m.
    pub u: Vector3,
    /// Stress, Pa; `None` for viscoelastic tissue.
    pub stress: Option<Matrix3>,
    /// Distance from the mesh (m), 0 inside. Values outside are those of the nearest point of the mesh.
    pub outside: f64,
}

impl Probe {
    /// Components xx, yy, zz, xy, yz and zx of a stress, Pa.
    pub(crate) fn components(stress: &Matrix3) -> [f64; 6] {
        [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(|at| stress[at])
    }
}

/// Transfer of this run's displacement to the target points by one scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// Name of the scheme; `own-rows` for the method's own shape functions.
    pub scheme: String,
    /// Settings of the scheme.
    pub settings: SchemeSettings,
    /// Errors and counts.
    pub metrics: Vec<Metric>,
    /// Times to build the table and pack it for repeated use (`prepare`), and to apply it to one field
    /// (`transfer`).
    pub times: Vec<Timed>,
    /// Number of targets.
    pub targets: usize,
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Identity of the run.
    pub identity: Identity,
    /// Sizes of the discretisation.
    pub size: Size,
    /// Metrics, which are bitwise equal in two runs with the same input.
    pub metrics: Vec<Metric>,
    /// Times per phase and repeat, the total included.
    pub phases: Vec<Timed>,
    /// Wall-clock time of a first pass that was discarded because it touched its memory for the first time,
    /// s.
    pub first_use: Option<f64>,
    /// Times per frame of the loop after the first solution, if the scene requests the loop.
    pub latencies: Vec<Latency>,
    /// Peak memory allocated in the run beyond its input, bytes.
    pub memory: u64,
    /// Peak memory of the whole process during the run, bytes; `None` if the system does not report it.
    pub process_memory: Option<u64>,
    /// Probes, in the scene's order.
    pub probes: Vec<Probe>,
    /// Stages that ran or were skipped.
    pub plan: Plan,
    /// Transfers of the result by each requested scheme.
    pub transfers: Vec<Transfer>,
    /// Surface displacement, if requested.
    pub field: Option<SurfaceField>,
    /// The body at the recorded states, if requested.
    pub states: Option<States>,
    /// Counters of the run's operations.
    pub counters: Counters,
    /// Names of the tools.
    pub tools: Vec<String>,
    /// Forces of the supports at the end.
    pub supports: Vec<SupportForce>,
    /// 2-norm of the displacements of all unconstrained unknowns at the end, m; `None` without a
    /// displacement.
    pub free_norm: Option<f64>,
    /// Mean displacement of faces at the end.
    pub means: Vec<FaceMean>,
    /// The last state reported: converged in a static procedure, recorded in dynamics.
    pub last: Option<LoadStep>,
    /// The load steps of a static procedure or the recorded states of dynamics, up to the end that the run
    /// reached.
    pub steps: Vec<LoadStep>,
    /// The lowest vibration modes, each with its frequency and its comparisons.
    pub modes: Vec<Vec<Metric>>,
    /// Status of the run. `ok`; `relaxed` if dynamic relaxation reached the load that Newton's method could
    /// not reach; or the cause of an early end: `stalled` in a static procedure, `inverted`,
    /// `step-too-large`, `not-finite` or `contact-lost` in dynamics.
    pub status: &'static str,
    /// Failure that ended Newton's method early, if relaxation continued to the whole load.
    pub relaxed: Option<Failure>,
    /// Failure that ended the run early. The results are then those of the load that the run reached.
    pub stalled: Option<Failure>,
    /// Warnings about the results.
    pub warnings: Vec<Warning>,
    /// Reference that the run is compared with.
    pub reference: Option<Reference>,
    /// Quantities beside their predictions, if requested.
    pub(crate) estimates: Option<Estimates>,
    /// Part of the error of output.error_of that each cell causes per volume, over the mean of the body;
    /// empty unless traced.
    pub(crate) error_source: Vec<f64>,
}

/// Failed run without results.
#[derive(Clone, Debug)]
pub struct Unfinished {
    /// Reason for the failure.
    pub failure: Failure,
    /// Planned stages; empty if the run failed before they were known.
    pub plan: Plan,
    /// Numbers of nodes and elements as far as they were known; the other sizes are 0.
    pub size: Size,
}

impl From<Failure> for Unfinished {
    fn from(failure: Failure) -> Unfinished {
        Unfinished { failure, plan: Plan::default(), size: Size::default() }
    }
}

impl Outcome {
    /// Outcome without results, of which only the identity, the sizes and the plan are known.
    pub(crate) fn new(identity: Identity, size: Size, plan: Plan) -> Outcome {
        Outcome {
            identity,
            size,
            metrics: Vec::new(),
            phases: Vec::new(),
            first_use: None,
            latencies: Vec::new(),
            memory: 0,
            process_memory: None,
            probes: Vec::new(),
            plan,
            transfers: Vec::new(),
            field: None,
            states: None,
            counters: Counters::default(),
            tools: Vec::new(),
            supports: Vec::new(),
            free_norm: None,
            means: Vec::new(),
            last: None,
            steps: Vec::new(),
            modes: Vec::new(),
            status: "ok",
            relaxed: None,
            stalled: None,
            warnings: Vec::new(),
            reference: None,
            estimates: None,
            error_source: Vec::new(),
        }
    }

    /// Inserts the scene's warnings before those of the run, and adds the number of all warnings to the
    /// metrics.
    pub(crate) fn warn(&mut self, of_scene: Vec<Warning>) {
        self.warnings.splice(0..0, of_scene);
        push(&mut self.metrics, &metric::WARNINGS, self.warnings.len() as f64);
    }

    /// Total time of the run.
    pub fn total(&self) -> Option<&Timed> {
        self.phases.iter().find(|timed| timed.phase == "total")
    }

    /// Value of a metric by name, such as `rms-x` or `tool-force-2`.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.value(metric::find(name)?)
    }

    /// Value of a metric, in SI units.
    pub fn value(&self, of: impl Into<Address>) -> Option<f64> {
        let of = of.into();
        self.metrics.iter().find(|m| m.of == of).map(|m| m.value)
    }

    /// Whether the run is the reference method, which does not differ from itself. An exact solution is not a
    /// method.
    pub(crate) fn is_reference(&self) -> bool {
        self.value(&metric::RELATIVE_RMS) == Some(0.0) && self.value(&metric::L2).is_none()
    }
}
