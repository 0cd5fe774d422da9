//! A procedure in steps: its last state, its history, and their errors against the reference's.

use geometry::Vector3;

use crate::Failure;
use crate::discretise::Discretisation;
use crate::measure::push;
use crate::motion::Motion;
use crate::outcome::{LoadStep, Metric, of_tool};
use crate::prepare::Prepared;
use crate::run::Asks;
use crate::statics::Path;

/// A procedure in steps, as it came out of its solver.
pub(crate) struct Course {
    steps: Vec<LoadStep>,
    fields: Vec<Vec<Vector3>>,
    last: LoadStep,
    metrics: Vec<Metric>,
    failure: Option<Failure>,
}

impl From<Path> for Course {
    fn from(path: Path) -> Course {
        let Path { steps, fields, last, iterations, cut_backs, limit, failure, relaxed, .. } = path;
        let mut metrics = Vec::new();
        if let Some(limit) = &limit {
            push(&mut metrics, "limit-load", limit.load, "1");
            for (index, tool) in limit.tools.iter().enumerate() {
                push(&mut metrics, &of_tool("limit-closure", index), tool.closure, "m");
                push(&mut metrics, &of_tool("limit-tool-force", index), tool.pushed, "N");
            }
        }
        push(&mut metrics, "newton-iterations", iterations as f64, "1");
        push(&mut metrics, "cut-backs", cut_backs as f64, "1");
        let failure = match relaxed {
            None => failure.map(Failure::from),
            Some(relaxed) => {
                push(&mut metrics, "relaxation-steps", relaxed.made as f64, "1");
                relaxed.failure.map(Failure::from)
            }
        };
        Course { steps, fields, last, metrics, failure }
    }
}

impl From<Motion> for Course {
    fn from(motion: Motion) -> Course {
        let Motion { steps, fields, last, metrics, failure, .. } = motion;
        Course { steps, fields, last, metrics, failure }
    }
}

/// What a procedure in steps left: its last state, its load steps with their errors against the reference's, and why it ended
/// early.
pub(crate) type History = (Option<LoadStep>, Vec<LoadStep>, Option<Failure>);

/// Measures it.
pub(crate) fn history(
    metrics: &mut Vec<Metric>,
    method: &Discretisation,
    prepared: &Prepared,
    course: Course,
    asks: &Asks,
) -> Result<History, Failure> {
    let Course { mut steps, fields, last, metrics: of_procedure, failure } = course;
    push(metrics, "load-carried", last.load, "1");
    push(metrics, "smallest-j", last.smallest_j, "1");
    push(metrics, "load-steps", steps.len() as f64, "1");
    metrics.extend(of_procedure);
    for (index, tool) in last.tools.iter().enumerate() {
        push(metrics, &of_tool("closure", index), tool.closure, "m");
        push(metrics, &of_tool("tool-force", index), tool.pushed, "N");
        push(metrics, &of_tool("contact-points", index), tool.active as f64, "1");
    }
    if let Some(deepest) = last.tools.iter().map(|t| t.penetration).reduce(f64::max) {
        push(metrics, "penetration", deepest, "m");
    }
    if !asks.probes.is_empty() {
        let (rows, _) = method.at_points(&prepared.volume, asks.probes)?;
        for (step, u) in steps.iter_mut().zip(&fields) {
            step.probes = rows.rows().apply(u);
        }
    }
    if let Some(reference) = asks.reference {
        for step in &mut steps {
            let same = |other: &&LoadStep| (other.load - step.load).abs() < 1e-9;
            if let Some(of_reference) = reference.steps.iter().find(same) {
                step.against = against(step, of_reference);
            }
        }
        if let (Some(end), None, true) = (steps.last(), &failure, reference.finished) {
            metrics.extend(end.against.iter().cloned());
        }
    }
    Ok((Some(last), steps, failure))
}

/// Errors of one step against the reference's at the same part of the load: of every tool's force and of the strain energy,
/// relative, and the largest of the displacements at the probes.
fn against(step: &LoadStep, reference: &LoadStep) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for (index, (tool, other)) in step.tools.iter().zip(&reference.tools).enumerate() {
        if other.pushed != 0.0 {
            push(
                &mut metrics,
                &of_tool("tool-force-error", index),
                (tool.pushed / other.pushed - 1.0).abs(),
                "1",
            );
        }
    }
    if let (Some(energy), Some(other)) = (step.strain_energy, reference.strain_energy.filter(|e| *e > 0.0)) {
        push(&mut metrics, "strain-energy-error", (energy / other - 1.0).abs(), "1");
    }
    let distances = step.probes.iter().zip(&reference.probes).map(|(u, v)| (u - v).norm());
    if let Some(largest) = distances.reduce(f64::max) {
        push(&mut metrics, "probe-difference", largest, "m");
    }
    metrics
}
