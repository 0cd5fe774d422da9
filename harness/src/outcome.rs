//! What one run leaves: who it was, its numbers, its times, its fields.

use geometry::{Matrix3, Point3, Vector3};
use mechanics::{Tool, ToolState};
use reports::{PlanEntry, Record, SurfaceField};
use serde::Serialize;

use crate::Failure;
use crate::repeated::Latency;
use crate::timing::Summary;
use crate::work::Work;

/// The identity of a run: what distinguishes it from every other one.
#[derive(Clone, Debug, PartialEq)]
pub struct Identity {
    /// Scene name: the file's stem.
    pub case: String,
    /// Method id.
    pub method: String,
    /// `fem` or `efg`.
    pub family: &'static str,
    /// Element or kernel.
    pub variant: String,
    /// Further settings, `key=value` joined by `;`, sorted by key.
    pub parameters: String,
    /// Poisson's ratio of the first material.
    pub poisson: f64,
    /// Refinement level; 0 where the size was given otherwise.
    pub level: u32,
    /// Seed of jitter and cloud.
    pub seed: u64,
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
    /// Settings, as in [`Identity::parameters`].
    pub parameters: String,
    /// Errors and counts.
    pub metrics: Vec<Metric>,
    /// Seconds to build the table and to pack it for repeated use.
    pub build: Summary,
    /// Seconds to apply the packed table to one field.
    pub apply: Summary,
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
    /// Seconds per phase; the last entry is the total.
    pub phases: Vec<(&'static str, Summary)>,
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
        let mut records: Vec<Record> =
            self.metrics.iter().map(|m| self.record(&m.name, m.unit, "", "value", m.value)).collect();
        for (phase, summary) in &self.phases {
            records.extend(self.times(phase, summary));
        }
        for latency in &self.latencies {
            let told = latency.statistics().into_iter();
            records.extend(told.map(|(s, unit, value)| self.record("time", unit, latency.phase, s, value)));
        }
        records.push(self.record("memory", "B", "", "value", self.memory as f64));
        for transfer in &self.transfers {
            records.extend(self.transfer_records(transfer));
        }
        records.extend(self.step_records());
        for (number, metrics) in self.modes.iter().enumerate() {
            let phase = format!("mode-{}", number + 1);
            records.extend(metrics.iter().map(|m| self.record(&m.name, m.unit, &phase, "value", m.value)));
        }
        records
    }

    /// The history, under the phases `step-0` (the start) to `step-N`. The first tool's numbers are
    /// `closure` and `tool-force`, the second's `closure-2` and `tool-force-2`.
    fn step_records(&self) -> Vec<Record> {
        let mut rows = Vec::new();
        if !self.steps.is_empty() {
            for index in 0..self.tools.len() {
                rows.push(self.record(&of_tool("closure", index), "m", "step-0", "value", 0.0));
                rows.push(self.record(&of_tool("tool-force", index), "N", "step-0", "value", 0.0));
            }
        }
        // Dynamics starts from rest and undeformed: no time, no energy.
        if let Some(first) = self.steps.first().filter(|step| !step.more.is_empty()) {
            if first.strain_energy.is_some() {
                rows.push(self.record("strain-energy", "J", "step-0", "value", 0.0));
            }
            for metric in first.more.iter().filter(|m| m.unit == "s" || m.unit == "J") {
                rows.push(self.record(&metric.name, metric.unit, "step-0", "value", 0.0));
            }
        }
        for (number, step) in self.steps.iter().enumerate() {
            let phase = format!("step-{}", number + 1);
            let mut push = |name: &str, unit: &str, value: f64| {
                rows.push(self.record(name, unit, &phase, "value", value))
            };
            push("load-carried", "1", step.load);
            if let Some(energy) = step.strain_energy {
                push("strain-energy", "J", energy);
            }
            push("smallest-j", "1", step.smallest_j);
            if step.iterations > 0 {
                push("newton-iterations", "1", step.iterations as f64);
            }
            for (index, tool) in step.tools.iter().enumerate() {
                push(&of_tool("closure", index), "m", tool.closure);
                push(&of_tool("tool-force", index), "N", tool.pushed);
                push(&of_tool("contact-points", index), "1", tool.active as f64);
            }
            for metric in step.more.iter().chain(&step.against) {
                push(&metric.name, metric.unit, metric.value);
            }
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

    fn record(&self, quantity: &str, unit: &str, phase: &str, statistic: &str, value: f64) -> Record {
        let (identity, size) = (&self.identity, &self.size);
        Record {
            case: identity.case.clone(),
            method: identity.method.clone(),
            family: identity.family.into(),
            variant: identity.variant.clone(),
            parameters: identity.parameters.clone(),
            poisson: identity.poisson,
            level: identity.level,
            nodes: size.nodes,
            elements: size.elements,
            points: size.points,
            dofs: size.dofs,
            spacing: size.spacing,
            seed: identity.seed,
            quantity: quantity.into(),
            unit: unit.into(),
            phase: phase.into(),
            statistic: statistic.into(),
            value,
        }
    }

    fn times(&self, phase: &str, summary: &Summary) -> Vec<Record> {
        [("median", summary.median), ("spread", summary.spread), ("min", summary.min)]
            .into_iter()
            .map(|(statistic, value)| self.record("time", "s", phase, statistic, value))
            .collect()
    }

    fn transfer_records(&self, transfer: &Transfer) -> Vec<Record> {
        let mut rows: Vec<Record> =
            transfer.metrics.iter().map(|m| self.record(&m.name, m.unit, "", "value", m.value)).collect();
        rows.extend(self.times("prepare", &transfer.build));
        rows.extend(self.times("transfer", &transfer.apply));
        // One method id may stand for many kernels: without theirs, transfers from two of them would be one row.
        let from = format!("from={};kernel={}", self.identity.method, self.identity.variant);
        let parameters =
            if transfer.parameters.is_empty() { from } else { format!("{from};{}", transfer.parameters) };
        for row in &mut rows {
            row.family = "interp".into();
            row.variant = transfer.scheme.clone();
            row.method = transfer.scheme.clone();
            row.parameters = parameters.clone();
            row.points = transfer.targets as u64;
        }
        rows
    }
}

/// The name of a tool's quantity: the bare one for the first tool, numbered from 2 for the others.
pub fn of_tool(quantity: &str, index: usize) -> String {
    if index == 0 { quantity.into() } else { format!("{quantity}-{}", index + 1) }
}
