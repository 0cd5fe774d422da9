//! The JSON object of one run, for scripts.

use std::collections::BTreeMap;

use catalogue::metric;
use geometry::Vector3;
use records::Reference;
use schemars::JsonSchema;
use serde::Serialize;

use crate::outcome::{Counters, LoadStep, Metric, Outcome, Plan, Probe, Unfinished, Warning};

/// Version of the object, raised by every change that affects its readers.
const FORMAT: u32 = 1;

/// One run as printed by `tissuebench run --format json`.
#[derive(Serialize, JsonSchema)]
pub struct RunObject<'a> {
    /// Version of this object.
    format: u32,
    /// Name of the scene, from its file.
    scene: &'a str,
    method: &'a str,
    /// `ok`; `relaxed` if dynamic relaxation continued from the end of Newton's method. If the run ended
    /// early, its numbers are those of the load reached: `stalled` for a static path; `inverted`,
    /// `step-too-large`, `not-finite` or `contact-lost` in dynamics. If it failed: `bad-input`,
    /// `not-available` or `could-not-run`; for an external solver `refused`, `stalled`, `failed`,
    /// `timed-out`, `not-offered` or `stale`.
    status: &'static str,
    /// Reason for a failure or early end, with file, line and key; absent on success.
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<String>,
    nodes: u64,
    elements: u64,
    dofs: u64,
    metrics: BTreeMap<String, Number>,
    /// Wall-clock time, s.
    phases: BTreeMap<String, f64>,
    /// CPU time of all processors, s, if known.
    cpu_phases: BTreeMap<String, f64>,
    probes: Vec<ProbeObject>,
    /// Rigid tools at the end.
    tools: Vec<ToolObject<'a>>,
    /// Supports at the end.
    supports: Vec<SupportObject<'a>>,
    /// 2-norm of the displacements of all unconstrained unknowns at the end, m (`solution_norm` of FEBio).
    #[serde(skip_serializing_if = "Option::is_none")]
    free_norm: Option<f64>,
    /// Mean displacements of the requested surfaces at the end.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    means: Vec<MeanObject<'a>>,
    /// The lowest modes of vibration.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    modes: Vec<BTreeMap<String, Number>>,
    /// Load steps that a static procedure reached; absent in a linear procedure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    steps: Vec<StepObject<'a>>,
    /// Reference of the metrics, with its own error.
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<&'a Reference>,
    /// Warnings about these numbers; empty without any.
    warnings: &'a [Warning],
    plan: &'a Plan,
    /// Kernel of the internal forces in explicit dynamics or relaxation.
    #[serde(skip_serializing_if = "Option::is_none")]
    force_kernel: Option<&'a str>,
    /// Instruction set of the kernel's SIMD lanes; absent for the scalar loop.
    #[serde(skip_serializing_if = "Option::is_none")]
    lane_path: Option<&'a str>,
    /// Adapter of an external solver, with its settings.
    #[serde(skip_serializing_if = "Option::is_none")]
    adapter: Option<&'a str>,
    /// Solver of the linear equations, or of the modes of vibration.
    #[serde(skip_serializing_if = "Option::is_none")]
    linear_solver: Option<&'a str>,
    /// Operation counts; all 0 in a failed run.
    work: Counters,
}

#[derive(Serialize, JsonSchema)]
struct Number {
    value: f64,
    unit: &'static str,
}

#[derive(Serialize, JsonSchema)]
struct ToolObject<'a> {
    name: &'a str,
    /// Closure, m.
    closure: f64,
    /// Force on the tool, N.
    force: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
struct SupportObject<'a> {
    /// Place of the support, as written in the scene.
    name: &'a str,
    /// Force on the body, N.
    force: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
struct MeanObject<'a> {
    /// Surface, as written in the scene.
    name: &'a str,
    /// Mean displacement, m.
    u: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
struct StepObject<'a> {
    /// Fraction of the loading, 0 to 1; of the duration in dynamics.
    load: f64,
    /// Strain energy, J.
    strain_energy: Option<f64>,
    smallest_j: f64,
    iterations: u64,
    tools: Vec<ToolObject<'a>>,
    /// Displacement at the probes, m.
    probes: Vec<[f64; 3]>,
    /// Force of each support on the body, N.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    supports: Vec<[f64; 3]>,
    /// Mean displacement of each requested surface, m.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    means: Vec<[f64; 3]>,
    /// Numbers of points and surfaces; time and energies in dynamics.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    metrics: BTreeMap<String, Number>,
}

fn tools<'a>(names: &'a [String], step: &LoadStep) -> Vec<ToolObject<'a>> {
    let each = names.iter().zip(&step.tools);
    each.map(|(name, t)| ToolObject { name, closure: t.closure, force: t.force.into() }).collect()
}

fn numbers<'a>(metrics: impl IntoIterator<Item = &'a Metric>) -> BTreeMap<String, Number> {
    metrics.into_iter().map(|m| (m.name(), Number { value: m.value, unit: m.unit() })).collect()
}

fn arrays(vectors: &[Vector3]) -> Vec<[f64; 3]> {
    vectors.iter().map(|&v| v.into()).collect()
}

#[derive(Serialize, JsonSchema)]
struct ProbeObject {
    x: [f64; 3],
    u: [f64; 3],
    /// Cauchy stress, Pa: xx, yy, zz, xy, yz, zx.
    stress: Option<[f64; 6]>,
    /// Distance from the mesh, m; 0 inside.
    outside: f64,
}

impl<'a> RunObject<'a> {
    /// Returns the object of a finished run; times are medians over its repeats.
    pub fn finished(outcome: &'a Outcome) -> RunObject<'a> {
        let mut metrics = numbers(&outcome.metrics);
        let memory = &metric::MEMORY;
        metrics.insert(memory.name.into(), Number { value: outcome.memory as f64, unit: memory.unit() });
        if let Some(bytes) = outcome.process_memory {
            metrics.insert("memory-process".into(), Number { value: bytes as f64, unit: "B" });
        }
        let frames = outcome.latencies.iter().flat_map(|latency| {
            let times = latency.statistics().into_iter().filter(|(_, unit, _)| *unit == "s");
            times.map(|(name, _, seconds)| match name {
                "median" => (latency.phase.to_string(), seconds),
                _ => (format!("{}-{name}", latency.phase), seconds),
            })
        });
        RunObject {
            format: FORMAT,
            scene: &outcome.identity.case,
            method: &outcome.identity.method,
            status: outcome.status,
            message: outcome.stalled.as_ref().or(outcome.relaxed.as_ref()).map(ToString::to_string),
            nodes: outcome.size.nodes,
            elements: outcome.size.elements,
            dofs: outcome.size.dofs,
            metrics,
            phases: (outcome.phases.iter())
                .map(|timed| (timed.phase.into(), timed.summary().median))
                .chain(frames)
                .collect(),
            cpu_phases: (outcome.phases.iter())
                .filter_map(|timed| Some((timed.phase.into(), timed.cpu_median()?)))
                .collect(),
            probes: outcome
                .probes
                .iter()
                .map(|p| ProbeObject {
                    x: p.x.coords.into(),
                    u: p.u.into(),
                    outside: p.outside,
                    stress: p.stress.as_ref().map(Probe::components),
                })
                .collect(),
            tools: outcome.last.as_ref().map_or_else(Vec::new, |last| tools(&outcome.tools, last)),
            supports: (outcome.supports.iter())
                .map(|s| SupportObject { name: &s.name, force: s.resultant.force.into() })
                .collect(),
            free_norm: outcome.free_norm,
            means: outcome.means.iter().map(|m| MeanObject { name: &m.name, u: m.u.into() }).collect(),
            modes: outcome.modes.iter().map(numbers).collect(),
            steps: outcome
                .steps
                .iter()
                .map(|step| StepObject {
                    load: step.load,
                    strain_energy: step.strain_energy,
                    smallest_j: step.smallest_j,
                    iterations: step.iterations,
                    tools: tools(&outcome.tools, step),
                    probes: arrays(&step.probes),
                    supports: step.supports.iter().map(|sum| sum.force.into()).collect(),
                    means: arrays(&step.means),
                    metrics: numbers(step.points.iter().chain(&step.more)),
                })
                .collect(),
            reference: outcome.reference.as_ref(),
            warnings: &outcome.warnings,
            plan: &outcome.plan,
            force_kernel: outcome.identity.force_kernel.as_deref(),
            lane_path: outcome.identity.lane_path.as_deref(),
            adapter: outcome.identity.adapter.as_deref(),
            linear_solver: outcome.identity.linear_solver.as_deref(),
            work: outcome.counters,
        }
    }

    /// Returns the object of a failed run, with its plan and size.
    pub fn failed(scene: &'a str, method: &'a str, run: &'a Unfinished) -> RunObject<'a> {
        RunObject {
            format: FORMAT,
            scene,
            method,
            status: run.failure.status(),
            message: Some(run.failure.to_string()),
            nodes: run.size.nodes,
            elements: run.size.elements,
            dofs: run.size.dofs,
            metrics: BTreeMap::new(),
            phases: BTreeMap::new(),
            cpu_phases: BTreeMap::new(),
            probes: Vec::new(),
            tools: Vec::new(),
            supports: Vec::new(),
            free_norm: None,
            means: Vec::new(),
            modes: Vec::new(),
            steps: Vec::new(),
            reference: None,
            warnings: &[],
            plan: &run.plan,
            force_kernel: None,
            lane_path: None,
            adapter: None,
            linear_solver: None,
            work: Counters::default(),
        }
    }
}
