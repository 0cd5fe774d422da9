//! Comparisons and properties of a finished run: errors, maxima, energies, counts, probes.

mod comparison;
mod dead_pressure;
mod displacement;
mod energies;
mod estimate;
mod exact_fit;
mod face_results;
mod few_cells;
mod goal;
mod hourglass;
mod hourglass_control;
mod large_strain;
pub(crate) mod mean_pressure;
mod modes;
pub(crate) mod norms;
mod over_time;
mod patch;
mod penetration;
mod picture;
mod points;
mod probe_history;
mod probes;
mod request;
mod solved;
mod states;
mod step_history;
mod stress;
mod surface;
mod transfer;
mod warnings;

use cases::exact::Exact;
use catalogue::metric;
use geometry::Vector3;
use material::{Law, Material as _};
use shape::Layout;
use statics::LinearBody;

use crate::discretise::Essential;
use crate::error::Failure;
use crate::outcome::{Metric, push};
use crate::prepare::Prepared;
use comparison::{against, push_difference};
use norms::{difference, norms, relative};

pub(crate) use displacement::{displacement, free_norm};
pub(crate) use energies::energies;
pub(crate) use estimate::{estimates, frequencies};
pub(crate) use face_results::places;
pub(crate) use goal::number;
pub(crate) use modes::report as report_modes;
pub(crate) use over_time::over_time;
pub(crate) use picture::picture;
pub(crate) use points::{check as check_points, points};
pub(crate) use probe_history::metrics as probe_history;
pub(crate) use probes::{check_probes, probe_errors, probes};
pub(crate) use request::Request;
pub use request::{OwnError, Reference, Repeats};
pub(crate) use solved::{Field, Solved};
pub(crate) use states::states;
pub(crate) use step_history::report as report_steps;
pub(crate) use stress::Recovered;
pub(crate) use surface::surface;
pub(crate) use transfer::transfers;
pub(crate) use warnings::warnings;

/// Adds errors, maxima, energies and counts to the metrics.
pub(crate) fn measure(
    metrics: &mut Vec<Metric>,
    run: &Solved,
    field: &Field,
    recovered: Option<&Recovered>,
    request: &Request,
) -> Result<(), Failure> {
    let Solved { method, setup, prepared, solution } = *run;
    if let Some(exact) = setup.exact.as_deref() {
        errors_in_the_volume(metrics, run, recovered, exact)?;
    }
    errors_at_targets(metrics, run, &field.values, request);
    for (axis, of) in metric::MAX.components().into_iter().enumerate() {
        push(metrics, of, field.values.iter().fold(0.0, |m: f64, u| m.max(u[axis].abs())));
    }
    push(metrics, &metric::MAX, field.values.iter().fold(0.0, |m: f64, u| m.max(u.norm())));
    push(metrics, &metric::TARGETS_OUTSIDE, field.outside as f64);
    if let Some(energy) = strain_energy(run)? {
        push(metrics, &metric::STRAIN_ENERGY, energy);
        if let Some(part) = hourglass_control::part(run, energy) {
            push(metrics, &metric::HOURGLASS_ENERGY, part);
        }
    }
    if let Some(residual) = solution.residual {
        push(metrics, &metric::RESIDUAL, residual);
    }
    if let Some(info) = &solution.linear {
        push(metrics, &metric::FACTOR_NONZEROS, info.factor_nonzeros as f64);
        if let Some(iterations) = &info.iterations {
            push(metrics, &metric::LINEAR_ITERATIONS, iterations.count as f64);
            push(metrics, &metric::OPERATOR_COMPLEXITY, iterations.complexity);
        }
        if info.eliminated + info.dropped > 0 {
            push(metrics, &metric::CONSTRAINTS_ELIMINATED, info.eliminated as f64);
            push(metrics, &metric::CONSTRAINTS_DROPPED, info.dropped as f64);
        }
    }
    if let Essential::Coupling(coupled) = &method.essential {
        push(metrics, &metric::FINITE_ELEMENT_NODES, coupled.vertices.len() as f64);
    }
    let resultant = prepared.resultant(&solution.u);
    for (axis, of) in metric::LOAD.components().into_iter().enumerate() {
        push(metrics, of, resultant[axis]);
    }
    if let Some(needed) = solution.needed_nitsche_factor {
        push(metrics, &metric::NITSCHE_FACTOR_NEEDED, needed);
    }
    if let Some(j) = smallest_fine_j(run)? {
        push(metrics, &metric::SMALLEST_FINE_J, j);
    }
    if let Some([gap, _]) = prepared.support_gap(&solution.u) {
        push(metrics, &metric::SUPPORT_GAP, gap);
    }
    if let Some((jump, _)) = recovered.and_then(Recovered::jump) {
        push(metrics, &metric::STRESS_JUMP, jump);
    }
    of_tables(metrics, prepared);
    Ok(())
}

/// Strain energy at the end, J, if it is known.
fn strain_energy(run: &Solved) -> Result<Option<f64>, Failure> {
    let Solved { method, setup, prepared, solution } = *run;
    if let Some(history) = &solution.history {
        return Ok(history.last.strain_energy);
    }
    let body = LinearBody {
        nodes: method.nodes(),
        volume: &prepared.volume.rows,
        materials: &setup.materials,
        region: &prepared.volume.region,
        dilation: prepared.volume.groups.as_ref(),
    };
    Ok(Some(statics::strain_energy(&body, &solution.u)?))
}

/// Smallest volume ratio J at the points of the finer quadrature; `None` at small strain. Under-integrated
/// elements can fold between their own points. In linear tetrahedra J is constant, so their own points
/// suffice.
fn smallest_fine_j(run: &Solved) -> Result<Option<f64>, Failure> {
    let Solved { setup, prepared, solution, .. } = *run;
    if solution.history.is_none() || setup.laws.iter().all(Law::is_small_strain) {
        return Ok(None);
    }
    let own = &prepared.volume.rows;
    if own.layout() == Layout::LinearTetrahedra {
        return Ok(Some(own.at().smallest_volume_ratio(&solution.u)));
    }
    let mut smallest = f64::INFINITY;
    prepared.source.fine_blocks(&mut |rows| {
        smallest = smallest.min(rows.at().smallest_volume_ratio(&solution.u));
    })?;
    Ok(Some(smallest))
}

/// Adds the norms of the error over the body against an exact solution.
fn errors_in_the_volume(
    metrics: &mut Vec<Metric>,
    run: &Solved,
    recovered: Option<&Recovered>,
    exact: &dyn Exact,
) -> Result<(), Failure> {
    let (fine, region) = run.prepared.fine_volume()?;
    let n = norms(run, recovered, &fine, &region, exact);
    let found = [
        (&metric::L2, n.l2),
        (&metric::ENERGY, n.energy),
        (&metric::PRESSURE, n.pressure),
        (&metric::STRESS, n.stress),
    ];
    for (entry, value) in found {
        if let Some(value) = value {
            push(metrics, entry, value);
        }
    }
    Ok(())
}

/// Adds the differences from an exact solution or the references at the points where displacements are
/// compared.
fn errors_at_targets(metrics: &mut Vec<Metric>, run: &Solved, field: &[Vector3], request: &Request) {
    let against = against(run, request);
    if let Some(integrated) = request.integrated {
        push_difference(metrics, &metric::INTEGRATION_RMS, field, &integrated.targets);
        if let Some(against) = &against {
            push_difference(metrics, &metric::DISCRETISATION_RMS, &integrated.targets, against);
        }
    }
    if let Some(against) = against {
        push_difference(metrics, &metric::RMS, field, &against);
        push(metrics, &metric::MAX_ERROR, difference(field, &against).max);
        if let Some(relative) = relative(field, &against) {
            push(metrics, &metric::RELATIVE_RMS, relative.rms);
            push(metrics, &metric::RELATIVE_MAX, relative.max);
            push(metrics, &metric::PEAK_ERROR, relative.peak);
        }
    }
    if let Some(beside) = request.beside {
        push_difference(metrics, &metric::BESIDE_RMS, field, &beside.targets);
    }
}

/// Adds properties of the method's tables: integrated volume, neighbours, conditioning, fallbacks.
pub(crate) fn of_tables(metrics: &mut Vec<Metric>, prepared: &Prepared) {
    push(metrics, &metric::VOLUME, prepared.volume.rows.weights().iter().sum());
    for (entry, value) in &prepared.volume.diagnostics {
        push(metrics, *entry, *value);
    }
}
