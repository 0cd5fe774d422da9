//! Reports of a procedure with steps: its last state, its steps, and their errors against the reference's
//! steps.

use catalogue::metric;

use super::request::Request;
use super::solved::Solved;
use crate::error::Failure;
use crate::outcome::{LoadStep, Metric, push};
use crate::procedure::StepHistory;

/// Adds the metrics of a run's history; returns the steps with their probes and errors.
pub(crate) fn report(
    metrics: &mut Vec<Metric>,
    run: &Solved,
    history: &StepHistory,
    request: &Request,
) -> Result<Vec<LoadStep>, Failure> {
    let StepHistory { steps, fields, last, metrics: of_procedure, failure } = history;
    let mut steps = steps.clone();
    push(metrics, &metric::LOAD_CARRIED, last.load);
    push(metrics, &metric::SMALLEST_J, last.smallest_j);
    if let Some(reduced) = &run.prepared.reduced {
        push(metrics, &metric::TRAINING_DISTANCE, reduced.distance(&history.fields));
        push(metrics, &metric::SAMPLED_CELLS, reduced.cells);
        push(metrics, &metric::SAMPLING_ERROR, reduced.error);
    }
    push(metrics, &metric::LOAD_STEPS, steps.len() as f64);
    metrics.extend(of_procedure);
    for (index, tool) in last.tools.iter().enumerate() {
        push(metrics, metric::CLOSURE.at(index), tool.closure);
        push(metrics, metric::TOOL_FORCE.at(index), tool.pushed);
        push(metrics, metric::CONTACT_POINTS.at(index), tool.active as f64);
    }
    if let Some(deepest) = last.tools.iter().map(|t| t.penetration).reduce(f64::max) {
        push(metrics, &metric::PENETRATION, deepest);
    }
    if !request.probes.is_empty() {
        let (rows, _) = run.prepared.source.at_points(request.probes)?;
        for (step, u) in steps.iter_mut().zip(fields) {
            step.probes = rows.rows().apply(u);
        }
    }
    if let Some(reference) = request.reference {
        let largest = Largest::of(&reference.steps);
        for step in &mut steps {
            let same = |other: &&LoadStep| (other.load - step.load).abs() < 1e-9;
            if let Some(of_reference) = reference.steps.iter().find(same) {
                step.against = against(step, of_reference, &largest);
            }
        }
        if let (Some(end), None, true) = (steps.last(), failure, reference.finished) {
            metrics.extend(&end.against);
        }
    }
    if let (Some(exact), Some(tool), None) = (run.setup.contact, last.tools.first(), failure) {
        push(metrics, metric::TOOL_FORCE_ERROR.at(0), (tool.pushed / exact.force - 1.0).abs());
        // ANCHOR: contact_radius_error
        push(metrics, &metric::CONTACT_RADIUS_ERROR, ((tool.area / exact.area).sqrt() - 1.0).abs());
        // ANCHOR_END: contact_radius_error
    }
    Ok(steps)
}

/// Fraction of the largest value on the reference's path below which a value is rounding.
const ROUNDING: f64 = 1e-12;
/// The same for forces of tools, which are known to the residual of Newton's method: after a tool has let go,
/// 1e-8 of its full force may remain.
const FORCE: f64 = 1e-7;

/// Largest values on a path.
struct Largest {
    /// Largest force of any tool, N.
    force: f64,
    /// Strain energy, J.
    energy: f64,
}

impl Largest {
    fn of(steps: &[LoadStep]) -> Largest {
        let forces = steps.iter().flat_map(|step| &step.tools).map(|tool| tool.pushed.abs());
        let energies = steps.iter().filter_map(|step| step.strain_energy);
        Largest { force: forces.fold(0.0, f64::max), energy: energies.fold(0.0, f64::max) }
    }
}

/// Errors of a step against the reference's step at the same load fraction: relative errors of every tool's
/// force and of the strain energy, and the largest difference of the displacements at the probes, m.
fn against(step: &LoadStep, reference: &LoadStep, largest: &Largest) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for (index, (tool, other)) in step.tools.iter().zip(&reference.tools).enumerate() {
        if other.pushed.abs() > FORCE * largest.force {
            push(&mut metrics, metric::TOOL_FORCE_ERROR.at(index), (tool.pushed / other.pushed - 1.0).abs());
        }
    }
    let known = reference.strain_energy.filter(|energy| *energy > ROUNDING * largest.energy);
    if let (Some(energy), Some(other)) = (step.strain_energy, known) {
        push(&mut metrics, &metric::STRAIN_ENERGY_ERROR, (energy / other - 1.0).abs());
    }
    let distances = step.probes.iter().zip(&reference.probes).map(|(u, v)| (u - v).norm());
    if let Some(largest) = distances.reduce(f64::max) {
        push(&mut metrics, &metric::PROBE_DIFFERENCE, largest);
    }
    metrics
}
