//! What a finished run is told in: errors, maxima, energies, counts, probes.

use geometry::{Matrix3, Point3, Vector3};
use material::{Law, Material as _};
use statics::Body;

use crate::Failure;
use crate::discretise::{Discretisation, Efg, Essential};
use crate::mean_pressure::cauchy;
use crate::norms::{self, difference, exact_at, norms, relative};
use crate::outcome::{Metric, Probe};
use crate::prepare::Prepared;
use crate::run::{Asks, Solution};
use crate::setup::Setup;

/// Errors, maxima, energies, counts.
pub(crate) fn measure(
    metrics: &mut Vec<Metric>,
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    solution: &Solution,
    (field, outside): (Vec<Vector3>, usize),
    asks: &Asks,
) -> Result<(), Failure> {
    let body = Body {
        nodes: method.nodes(),
        volume: &prepared.volume.rows,
        materials: &setup.materials,
        region: &prepared.volume.region,
        dilation: prepared.volume.groups.as_ref(),
    };
    // Stresses are compared with Hooke's; a pressure field of its own is another stress than the displacement's.
    let hooke =
        setup.laws.iter().all(Law::is_small_strain) && prepared.volume.pressure.is_none() && !setup.relaxes();
    if let (Some(exact), false) = (&setup.exact, hooke) {
        let (fine, region) = method.error_rows(&prepared.volume)?;
        if let Some(value) = norms::l2(&fine, &solution.u, exact.as_ref()) {
            push(metrics, "l2", value, "1");
        }
        // A solution at large strain states the stress of the body's own law; a projected dilation has another.
        let own = prepared.volume.groups.is_none() && prepared.volume.pressure.is_none() && !setup.relaxes();
        if own && exact.is_large_strain() {
            let value = norms::stress(&setup.laws, &fine, &region, &solution.u, exact.as_ref());
            value.into_iter().for_each(|value| push(metrics, "stress", value, "1"));
        }
    }
    if let (Some(exact), true) = (&setup.exact, hooke) {
        let (fine, region) = method.error_rows(&prepared.volume)?;
        let n = norms(&body, &fine, &region, &solution.u, exact.as_ref())?;
        for (name, value) in
            [("l2", n.l2), ("energy", n.energy), ("pressure", n.pressure), ("stress", n.stress)]
        {
            if let Some(value) = value {
                push(metrics, name, value, "1");
            }
        }
    }
    let points = if asks.targets.is_empty() { method.nodes() } else { asks.targets };
    let against = match (&setup.exact, asks.reference) {
        (Some(exact), _) => Some(exact_at(exact.as_ref(), points)),
        (None, Some(reference)) => Some(reference.targets.clone()),
        (None, None) => None,
    };
    if let Some(integrated) = asks.integrated {
        push_difference(metrics, "integration-rms", &field, &integrated.targets);
        if let Some(against) = &against {
            push_difference(metrics, "discretisation-rms", &integrated.targets, against);
        }
    }
    if let Some(against) = against {
        push_difference(metrics, "rms", &field, &against);
        push(metrics, "max-error", difference(&field, &against).max, "m");
        if let Some(relative) = relative(&field, &against) {
            push(metrics, "relative-rms", relative.rms, "1");
            push(metrics, "relative-max", relative.max, "1");
            push(metrics, "peak-error", relative.peak, "1");
        }
    }
    if let Some(beside) = asks.beside {
        push_difference(metrics, "beside-rms", &field, &beside.targets);
    }
    for (axis, name) in ["max-x", "max-y", "max-z"].into_iter().enumerate() {
        push(metrics, name, field.iter().fold(0.0, |m: f64, u| m.max(u[axis].abs())), "m");
    }
    push(metrics, "max", field.iter().fold(0.0, |m: f64, u| m.max(u.norm())), "m");
    push(metrics, "targets-outside", outside as f64, "1");
    let energy = match (&solution.path, &solution.motion) {
        (Some(path), _) => path.last.strain_energy,
        (_, Some(motion)) => motion.last.strain_energy,
        (None, None) => Some(statics::strain_energy(&body, &solution.u)?),
    };
    if let Some(energy) = energy {
        push(metrics, "strain-energy", energy, "J");
    }
    if solution.motion.is_none() {
        push(metrics, "residual", solution.residual, "1");
    }
    if let Some(info) = &solution.info {
        push(metrics, "factor-nonzeros", info.factor_nonzeros as f64, "1");
        if info.eliminated + info.dropped > 0 {
            push(metrics, "constraints-eliminated", info.eliminated as f64, "1");
            push(metrics, "constraints-dropped", info.dropped as f64, "1");
        }
    }
    if let Discretisation::Efg(Efg { essential: Essential::Coupling(coupled), .. }) = method {
        push(metrics, "finite-element-nodes", coupled.vertices.len() as f64, "1");
    }
    let resultant = prepared.resultant();
    for (axis, name) in ["load-x", "load-y", "load-z"].into_iter().enumerate() {
        push(metrics, name, resultant[axis], "N");
    }
    of_tables(metrics, prepared);
    Ok(())
}

/// What the rows of a method are like: the volume they integrate, neighbours, conditioning, fallbacks.
pub(crate) fn of_tables(metrics: &mut Vec<Metric>, prepared: &Prepared) {
    push(metrics, "volume", prepared.volume.rows.weights().iter().sum(), "m^3");
    if let Some(mls) = &prepared.volume.mls {
        push(metrics, "neighbours-min", mls.neighbours_min as f64, "1");
        push(metrics, "neighbours-mean", mls.neighbours_mean, "1");
        push(metrics, "neighbours-max", mls.neighbours_max as f64, "1");
        push(metrics, "condition-median", mls.condition_median, "1");
        push(metrics, "condition-max", mls.condition_max, "1");
        push(metrics, "fallbacks", mls.fallbacks() as f64, "1");
        push(metrics, "fallbacks-enlarged", mls.enlarged as f64, "1");
        push(metrics, "fallbacks-regularised", mls.regularised as f64, "1");
        push(metrics, "fallbacks-reduced", mls.reduced as f64, "1");
    }
    if let Some(error) = prepared.volume.volume_error {
        push(metrics, "volume-error", error, "1");
    }
}

/// RMS of a difference per direction (`NAME-x` and so on) and of the magnitude (`NAME`).
pub(crate) fn push_difference(metrics: &mut Vec<Metric>, name: &str, field: &[Vector3], against: &[Vector3]) {
    let d = difference(field, against);
    for (axis, value) in ["x", "y", "z"].into_iter().zip(d.rms) {
        push(metrics, &format!("{name}-{axis}"), value, "m");
    }
    push(metrics, name, d.rms_magnitude, "m");
}

/// Displacement and stress at the points asked for.
pub(crate) fn probes(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    u: &[Vector3],
    points: &[Point3],
) -> Result<Vec<Probe>, Failure> {
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let rows = method.gradients_at(&prepared.volume, points)?;
    // Stresses at probes are pointwise, of the first region's law unless the body has one only. What relaxes has them of
    // its past, which is followed at quadrature points only.
    let stress: Vec<Option<Matrix3>> = if setup.is_linear() {
        statics::stress(&rows, u, &setup.materials, &[])?.into_iter().map(Some).collect()
    } else {
        let known = |h: &Matrix3| (!setup.relaxes()).then(|| cauchy(&setup.laws[0], h));
        rows.displacement_gradients(u).iter().map(known).collect()
    };
    let field = rows.rows().apply(u);
    Ok(points.iter().zip(field).zip(stress).map(|((&x, u), stress)| Probe { x, u, stress }).collect())
}

pub(crate) fn push(metrics: &mut Vec<Metric>, name: &str, value: f64, unit: &'static str) {
    metrics.push(Metric { name: name.into(), value, unit });
}
