//! What one run leaves: who it was, its numbers, its times, its fields.

mod counters;
mod latency;
mod load_step;
mod places;
mod plan;
pub mod provenance;
mod records;
mod states;
pub(crate) mod timing;
mod warning;
mod watch;

use catalogue::{Values, metric};
use geometry::{Matrix3, Point3, Vector3};
use reports::{Record, Reference, SurfaceField};

use crate::Failure;
pub use counters::Counters;
pub(crate) use latency::FOR_P99;
pub use latency::Latency;
pub use load_step::{LoadStep, ToolStep};
pub use places::{FaceMean, SupportForce};
pub use plan::{Plan, Stage, StageName};
pub(crate) use records::run_id;
pub use states::States;
pub(crate) use states::{State, Tensors, ToolSkin, von_mises};
pub(crate) use timing::Meters;
use timing::Timed;
pub use warning::Warning;
pub use watch::{Stopped, Watch};

/// Which run: its record without size and number.
pub type Identity = Record;

/// Settings of a transfer scheme, as far as it has them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SchemeSettings {
    /// Neighbours of each target.
    pub neighbours: Option<u64>,
    /// Power of the distance.
    pub power: Option<f64>,
    /// Support radius over the node spacing.
    pub support_scale: Option<f64>,
    /// Width of radial functions over the mean node spacing.
    pub shape: Option<f64>,
    /// Whether they have a linear polynomial with them.
    pub polynomial: Option<bool>,
}

impl SchemeSettings {
    /// The values that a scheme's parameters have, defaults included.
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
    /// Nodes.
    pub nodes: u64,
    /// Elements or background cells.
    pub elements: u64,
    /// Integration points.
    pub points: u64,
    /// Unknowns, supports eliminated.
    pub dofs: u64,
    /// Mean node spacing, m.
    pub spacing: f64,
}

/// One number of a run. What is no entry of the catalogue cannot be recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metric {
    /// What it is.
    pub entry: &'static metric::Metric,
    /// Which tool's, support's or face's, where each has one; 0 otherwise.
    pub index: usize,
    /// SI value.
    pub value: f64,
}

impl Metric {
    pub(crate) fn new(entry: &'static metric::Metric, value: f64) -> Metric {
        Metric { entry, index: 0, value }
    }

    pub(crate) fn numbered(entry: &'static metric::Metric, index: usize, value: f64) -> Metric {
        Metric { entry, index, value }
    }

    /// Name as in records and checks.
    pub fn name(&self) -> String {
        self.entry.numbered(self.index)
    }

    /// SI unit; `1` for a bare number.
    pub fn unit(&self) -> &'static str {
        self.entry.unit()
    }
}

/// Adds a number to a list.
pub(crate) fn push(metrics: &mut Vec<Metric>, entry: &'static metric::Metric, value: f64) {
    metrics.push(Metric::new(entry, value));
}

/// Adds a number of one tool to a list.
pub(crate) fn push_numbered(
    metrics: &mut Vec<Metric>,
    entry: &'static metric::Metric,
    tool: usize,
    value: f64,
) {
    metrics.push(Metric::numbered(entry, tool, value));
}

/// Displacement and stress at a probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Position, m.
    pub x: Point3,
    /// Displacement, m.
    pub u: Vector3,
    /// Stress, Pa; unknown in tissue that relaxes.
    pub stress: Option<Matrix3>,
    /// Distance from the mesh (m), 0 inside: values outside are those of its nearest point.
    pub outside: f64,
}

/// A scheme's transfer of this run's displacement to the reference nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// Scheme name; `own-rows` for the method's own shape functions.
    pub scheme: String,
    /// Its settings.
    pub settings: SchemeSettings,
    /// Errors and counts.
    pub metrics: Vec<Metric>,
    /// Seconds to build the table and to pack it for repeated use (`prepare`), and to apply it to one field (`transfer`).
    pub times: Vec<Timed>,
    /// Number of targets.
    pub targets: usize,
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Who.
    pub identity: Identity,
    /// How large.
    pub size: Size,
    /// Numbers that two runs of one input share to the bit.
    pub metrics: Vec<Metric>,
    /// Seconds per phase and repeat, the total among them.
    pub phases: Vec<Timed>,
    /// Seconds per frame of the loop after the first solution, where the scene asks for one.
    pub latencies: Vec<Latency>,
    /// Most memory allocated at once in the run beyond its input, bytes.
    pub memory: u64,
    /// Most memory that the whole process had during the run, bytes; `None` where the system does not say.
    pub process_memory: Option<u64>,
    /// Probes, in the scene's order.
    pub probes: Vec<Probe>,
    /// Stages run and skipped.
    pub plan: Plan,
    /// Transfers of the result by every scheme asked for.
    pub transfers: Vec<Transfer>,
    /// Surface displacement, where the scene asks for it.
    pub field: Option<SurfaceField>,
    /// The body at the recorded states, where that was asked for.
    pub states: Option<States>,
    /// Counts of what was done for all this.
    pub counters: Counters,
    /// Names of the tools.
    pub tools: Vec<String>,
    /// Forces of the supports at the end.
    pub supports: Vec<SupportForce>,
    /// Mean displacement of faces at the end.
    pub means: Vec<FaceMean>,
    /// The last state reported: converged in a static procedure, recorded in dynamics.
    pub last: Option<LoadStep>,
    /// The load steps of a static procedure or the recorded states of dynamics, as far as it came.
    pub steps: Vec<LoadStep>,
    /// The lowest modes of vibration, each with its frequency and what it is compared with.
    pub modes: Vec<Vec<Metric>>,
    /// `ok`; `relaxed` where dynamic relaxation reached the load that Newton's method could not; or how a run ended early:
    /// `stalled` in a static procedure; `inverted`, `step-too-large`, `not-finite` or `contact-lost` in dynamics.
    pub status: &'static str,
    /// Why Newton's method ended early where relaxation went on to the whole load.
    pub relaxed: Option<Failure>,
    /// Why it ended early; its numbers are then those of the load it reached.
    pub stalled: Option<Failure>,
    /// What is to be said against its numbers.
    pub warnings: Vec<Warning>,
    /// The reference of its numbers.
    pub reference: Option<Reference>,
}

/// A run that gave no numbers.
#[derive(Clone, Debug)]
pub struct Unfinished {
    /// Why.
    pub failure: Failure,
    /// Stages it would have run and skipped; empty if it failed before they were known.
    pub plan: Plan,
    /// Nodes and elements as far as they were made, the rest 0.
    pub size: Size,
}

impl From<Failure> for Unfinished {
    fn from(failure: Failure) -> Unfinished {
        Unfinished { failure, plan: Plan::default(), size: Size::default() }
    }
}

impl Outcome {
    /// A run of which nothing but its sizes is known yet.
    pub(crate) fn new(identity: Identity, size: Size, plan: Plan) -> Outcome {
        Outcome {
            identity,
            size,
            metrics: Vec::new(),
            phases: Vec::new(),
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
            means: Vec::new(),
            last: None,
            steps: Vec::new(),
            modes: Vec::new(),
            status: "ok",
            relaxed: None,
            stalled: None,
            warnings: Vec::new(),
            reference: None,
        }
    }

    /// Adds warnings of the scene before those of the run, and counts all.
    pub(crate) fn warn(&mut self, of_scene: Vec<Warning>) {
        self.warnings.splice(0..0, of_scene);
        push(&mut self.metrics, &metric::WARNINGS, self.warnings.len() as f64);
    }

    /// Time of the whole run.
    pub fn total(&self) -> Option<&Timed> {
        self.phases.iter().find(|timed| timed.phase == "total")
    }

    /// One metric's value.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name() == name).map(|m| m.value)
    }
}
