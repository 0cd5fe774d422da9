//! A procedure in steps: its last state, its steps, and their errors against the reference's.

use super::{Request, Solved};
use crate::Failure;
use crate::outcome::{LoadStep, Metric, of_tool, push};
use crate::procedure::StepHistory;

/// Reports the history of a run; returns its steps with their probes and errors.
pub(crate) fn report(
    metrics: &mut Vec<Metric>,
    run: &Solved,
    history: &StepHistory,
    request: &Request,
) -> Result<Vec<LoadStep>, Failure> {
    let StepHistory { steps, fields, last, metrics: of_procedure, failure } = history;
    let mut steps = steps.clone();
    push(metrics, "load-carried", last.load, "1");
    push(metrics, "smallest-j", last.smallest_j, "1");
    push(metrics, "load-steps", steps.len() as f64, "1");
    metrics.extend(of_procedure.iter().cloned());
    for (index, tool) in last.tools.iter().enumerate() {
        push(metrics, &of_tool("closure", index), tool.closure, "m");
        push(metrics, &of_tool("tool-force", index), tool.pushed, "N");
        push(metrics, &of_tool("contact-points", index), tool.active as f64, "1");
    }
    if let Some(deepest) = last.tools.iter().map(|t| t.penetration).reduce(f64::max) {
        push(metrics, "penetration", deepest, "m");
    }
    if !request.probes.is_empty() {
        let (rows, _) = run.prepared.source.at_points(request.probes)?;
        for (step, u) in steps.iter_mut().zip(fields) {
            step.probes = rows.rows().apply(u);
        }
    }
    if let Some(reference) = request.reference {
        for step in &mut steps {
            let same = |other: &&LoadStep| (other.load - step.load).abs() < 1e-9;
            if let Some(of_reference) = reference.steps.iter().find(same) {
                step.against = against(step, of_reference);
            }
        }
        if let (Some(end), None, true) = (steps.last(), failure, reference.finished) {
            metrics.extend(end.against.iter().cloned());
        }
    }
    Ok(steps)
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
