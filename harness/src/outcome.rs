//! What one run leaves: who it was, its numbers, its times, its fields.

use catalogue::Values;
use contact::{Tool, ToolState};
use geometry::{Matrix3, Point3, Vector3};
use reports::{Family, PlanEntry, Record, SurfaceField};
use serde::Serialize;

use crate::Failure;
use crate::repeated::Latency;
use crate::timing::{Summary, Timed};
use crate::work::Work;

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

/// One number with its unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Metric {
    /// Name as in records and checks.
    pub name: String,
    /// SI value.
    pub value: f64,
    /// SI unit; `1` for a pure number.
    pub unit: &'static str,
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
}

/// A tool at the end of a load step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolStep {
    /// Way from its start, m.
    pub closure: f64,
    /// Force on the tool, N.
    pub force: Vector3,
    /// Force that it exerts along its way, N.
    pub pushed: f64,
    /// Surface points in contact.
    pub active: u64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

impl ToolStep {
    /// Of the solver's state of a tool.
    pub(crate) fn of(state: &ToolState, tool: &Tool) -> ToolStep {
        ToolStep {
            closure: state.closure,
            force: state.force,
            pushed: -state.force.dot(&tool.along()),
            active: state.active as u64,
            penetration: state.penetration,
        }
    }

    /// Where every tool starts.
    pub const UNTOUCHED: ToolStep = ToolStep {
        closure: 0.0,
        force: Vector3::new(0.0, 0.0, 0.0),
        pushed: 0.0,
        active: 0,
        penetration: 0.0,
    };
}

/// The end of a load step.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadStep {
    /// Part of the loading, 0 to 1.
    pub load: f64,
    /// One per tool of the scene.
    pub tools: Vec<ToolStep>,
    /// Strain energy, J.
    pub strain_energy: Option<f64>,
    /// Smallest volume ratio of all quadrature points.
    pub smallest_j: f64,
    /// Linear systems solved.
    pub iterations: u64,
    /// Displacement at the scene's probes, m.
    pub probes: Vec<Vector3>,
    /// Errors against the reference at the same step.
    pub against: Vec<Metric>,
    /// What else the procedure tells: time and energies in dynamics.
    pub more: Vec<Metric>,
}

impl LoadStep {
    /// Time in dynamics, s.
    pub fn time(&self) -> Option<f64> {
        self.more.iter().find(|m| m.name == "time").map(|m| m.value)
    }

    /// Before anything acts.
    pub(crate) fn at_start(tools: usize) -> LoadStep {
        LoadStep {
            load: 0.0,
            tools: vec![ToolStep::UNTOUCHED; tools],
            strain_energy: Some(0.0),
            smallest_j: 1.0,
            iterations: 0,
            probes: Vec::new(),
            against: Vec::new(),
            more: Vec::new(),
        }
    }
}

/// One stage of a plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Stage {
    /// Name.
    pub stage: &'static str,
    /// Whether it runs.
    pub ran: bool,
    /// Why, or why not.
    pub why: String,
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
    /// Probes, in the scene's order.
    pub probes: Vec<Probe>,
    /// Stages run and skipped.
    pub plan: Vec<Stage>,
    /// Transfers of the result by every scheme asked for.
    pub transfers: Vec<Transfer>,
    /// Surface displacement, where the scene asks for it.
    pub field: Option<SurfaceField>,
    /// What was done for all this.
    pub work: Work,
    /// Names of the tools.
    pub tools: Vec<String>,
    /// The last state told: converged in a static procedure, recorded in dynamics.
    pub last: Option<LoadStep>,
    /// The load steps of a static procedure or the recorded states of dynamics, as far as it came.
    pub steps: Vec<LoadStep>,
    /// The lowest modes of vibration, each with its frequency and what it is compared with.
    pub modes: Vec<Vec<Metric>>,
    /// `ok`; `relaxed` where dynamic relaxation carried what Newton's method could not; or how a run ended early: `stalled` in a static procedure; `inverted`, `step-too-large`, `not-finite` or
    /// `contact-lost` in dynamics.
    pub status: &'static str,
    /// Why Newton's method ended early where relaxation went on to the whole load.
    pub relaxed: Option<Failure>,
    /// Why it ended early; its numbers are then those of the load it carried.
    pub stalled: Option<Failure>,
}

/// A run that gave no numbers.
#[derive(Clone, Debug)]
pub struct Unfinished {
    /// Why.
    pub failure: Failure,
    /// Stages it would have run and skipped; empty if it failed before they were known.
    pub plan: Vec<Stage>,
    /// Nodes and elements as far as they were made, the rest 0.
    pub size: Size,
}

impl From<Failure> for Unfinished {
    fn from(failure: Failure) -> Unfinished {
        Unfinished { failure, plan: Vec::new(), size: Size::default() }
    }
}

impl Outcome {
    /// One metric's value.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.metrics.iter().find(|m| m.name == name).map(|m| m.value)
    }

    /// The run as rows of the long table.
    pub fn records(&self) -> Vec<Record> {
        let own = self.row();
        let mut rows: Vec<Record> = self.metrics.iter().map(|m| number(&own, m)).collect();
        self.phases.iter().for_each(|timed| rows.extend(times(&own, timed)));
        for latency in &self.latencies {
            let phase = Record { quantity: "time".into(), phase: latency.phase.into(), ..own.clone() };
            rows.extend(latency.statistics().into_iter().map(|(statistic, unit, value)| Record {
                unit: unit.into(),
                statistic: statistic.into(),
                value,
                ..phase.clone()
            }));
        }
        rows.push(number(&own, &metric("memory", self.memory as f64, "B")));
        self.transfers.iter().for_each(|transfer| rows.extend(self.transfer_records(&own, transfer)));
        rows.extend(self.step_records(&own));
        for (index, metrics) in self.modes.iter().enumerate() {
            let mode = Record { mode: Some(index as u64 + 1), ..own.clone() };
            rows.extend(metrics.iter().map(|m| number(&mode, m)));
        }
        rows
    }

    /// What all rows of the run share.
    fn row(&self) -> Record {
        let size = &self.size;
        let own = Record {
            nodes: size.nodes,
            elements: size.elements,
            points: size.points,
            dofs: size.dofs,
            spacing: size.spacing,
            ..self.identity.clone()
        };
        Record { run: run_id(&own), ..own }
    }

    /// The history, from step 0, the start. The first tool's numbers are `closure` and `tool-force`, the second's `closure-2` and
    /// `tool-force-2`.
    fn step_records(&self, own: &Record) -> Vec<Record> {
        let at = |step: usize| Record { step: Some(step as u64), ..own.clone() };
        let mut rows = Vec::new();
        let start = at(0);
        if !self.steps.is_empty() {
            for index in 0..self.tools.len() {
                rows.push(number(&start, &metric(&of_tool("closure", index), 0.0, "m")));
                rows.push(number(&start, &metric(&of_tool("tool-force", index), 0.0, "N")));
            }
        }
        // Dynamics starts from rest and undeformed: no time, no energy.
        if let Some(first) = self.steps.first().filter(|step| !step.more.is_empty()) {
            if first.strain_energy.is_some() {
                rows.push(number(&start, &metric("strain-energy", 0.0, "J")));
            }
            for known in first.more.iter().filter(|m| m.unit == "s" || m.unit == "J") {
                rows.push(number(&start, &metric(&known.name, 0.0, known.unit)));
            }
        }
        for (index, step) in self.steps.iter().enumerate() {
            let here = at(index + 1);
            rows.extend(of_step(step).iter().map(|m| number(&here, m)));
        }
        rows
    }

    /// The plan as rows for the report.
    pub fn plan_entries(&self) -> Vec<PlanEntry> {
        self.plan
            .iter()
            .map(|stage| PlanEntry {
                case: self.identity.case.clone(),
                method: self.identity.method.clone(),
                stage: stage.stage.into(),
                ran: stage.ran,
                why: stage.why.clone(),
            })
            .collect()
    }

    /// A transfer is a run of its own: by its scheme, from this method.
    fn transfer_records(&self, own: &Record, transfer: &Transfer) -> Vec<Record> {
        let SchemeSettings { neighbours, power, support_scale, shape, polynomial } = transfer.settings;
        let row = Record {
            case: own.case.clone(),
            purpose: own.purpose,
            published: own.published.clone(),
            method: transfer.scheme.clone(),
            series: transfer.scheme.clone(),
            family: Family::Interp,
            variant: transfer.scheme.clone(),
            from: Some(own.method.clone()),
            // One method id may stand for many kernels.
            kernel: Some(own.variant.clone()),
            neighbours,
            power,
            support_scale,
            shape,
            polynomial,
            points: transfer.targets as u64,
            poisson: own.poisson,
            level: own.level,
            nodes: own.nodes,
            elements: own.elements,
            dofs: own.dofs,
            spacing: own.spacing,
            seed: own.seed,
            ..Record::default()
        };
        // Settings of the method that a scheme's row has no column for tell its runs apart all the same.
        let row = Record { run: digest(&format!("{} {}", own.run, run_id(&row))), ..row };
        let mut rows: Vec<Record> = transfer.metrics.iter().map(|m| number(&row, m)).collect();
        transfer.times.iter().for_each(|timed| rows.extend(times(&row, timed)));
        rows
    }
}

/// Id of the run that a row belongs to: of its case, method, settings and size, so that it is the same in every study.
pub(crate) fn run_id(row: &Record) -> String {
    let size = (row.poisson.to_bits(), row.level, row.nodes, row.elements, row.seed);
    digest(&format!("{:?}", (&row.case, &row.method, row.family, &row.variant, row.settings(), size)))
}

fn digest(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_hex()[..16].to_string()
}

fn metric(name: &str, value: f64, unit: &'static str) -> Metric {
    Metric { name: name.into(), value, unit }
}

/// A plain value as a row.
fn number(row: &Record, metric: &Metric) -> Record {
    Record {
        quantity: metric.name.clone(),
        unit: metric.unit.into(),
        statistic: "value".into(),
        value: metric.value,
        ..row.clone()
    }
}

/// Every repeat of a phase on the wall's clock and of the processors, and what they come to.
fn times(row: &Record, timed: &Timed) -> Vec<Record> {
    let of = |quantity: &str, statistic: &str, repeat: Option<usize>, value: f64| Record {
        quantity: quantity.into(),
        unit: "s".into(),
        phase: timed.phase.into(),
        statistic: statistic.into(),
        repeat: repeat.map(|r| r as u64 + 1),
        value,
        ..row.clone()
    };
    let Summary { median, spread, min } = timed.summary();
    let mut rows: Vec<Record> = [("median", median), ("spread", spread), ("min", min)]
        .map(|(statistic, value)| of("time", statistic, None, value))
        .into();
    rows.extend(timed.cpu_median().map(|median| of("cpu-time", "median", None, median)));
    for (quantity, all) in [("time", &timed.wall), ("cpu-time", &timed.cpu)] {
        rows.extend(all.iter().enumerate().map(|(r, &value)| of(quantity, "repeat", Some(r), value)));
    }
    rows
}

/// What is recorded of a step.
fn of_step(step: &LoadStep) -> Vec<Metric> {
    let mut all = vec![metric("load-carried", step.load, "1")];
    all.extend(step.strain_energy.map(|energy| metric("strain-energy", energy, "J")));
    all.push(metric("smallest-j", step.smallest_j, "1"));
    if step.iterations > 0 {
        all.push(metric("newton-iterations", step.iterations as f64, "1"));
    }
    for (index, tool) in step.tools.iter().enumerate() {
        all.push(metric(&of_tool("closure", index), tool.closure, "m"));
        all.push(metric(&of_tool("tool-force", index), tool.pushed, "N"));
        all.push(metric(&of_tool("contact-points", index), tool.active as f64, "1"));
    }
    all.extend(step.more.iter().chain(&step.against).cloned());
    all
}

/// The name of a tool's quantity: the bare one for the first tool, numbered from 2 for the others.
pub fn of_tool(quantity: &str, index: usize) -> String {
    if index == 0 { quantity.into() } else { format!("{quantity}-{}", index + 1) }
}
