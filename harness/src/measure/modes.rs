//! Modes of free vibration, and their comparison with exact modes.

use cases::exact::Vibrations;
use catalogue::{metric, warning};
use explicit::point_masses;
use geometry::{Point3, Vector3};
use shape::VolumeRows;

use super::hourglass::shear;
use super::hourglass_control;
use super::solved::Solved;
use crate::error::Failure;
use crate::outcome::{Metric, Warning, push};
use crate::procedure::Vibration;

/// Fraction of the lowest exact frequency below which a mode is spurious.
const SLOW: f64 = 0.9;
/// Fraction of the frequency of a shear wave across the body below which a mode is rigid. Rounding leaves
/// 1e-6.
pub(super) const RIGID: f64 = 1e-3;
/// Fraction of the shear wave's squared frequency below which a mode's squared frequency is rounding.
/// Rounding leaves 1e-10; a cantilever 1000 times as long as thick has 1e-8.
const NO_ENERGY: f64 = 1e-9;
/// Ratio of squared frequencies above which a mode is an artefact of the method: that of the mode's shape
/// under finer integration, over the mode's own.
const UNSEEN: f64 = 4.0;
/// Multiple of the exact frequency up to which its mode is searched.
const FAST: f64 = 1.5;
/// Smallest overlap with the span of the exact modes for a mode to count as one of them.
const ALIKE: f64 = 0.5;

/// Metrics, modes and warnings of a modal analysis.
pub(crate) struct Modes {
    pub(crate) metrics: Vec<Metric>,
    pub(crate) dofs: usize,
    pub(crate) modes: Vec<Vec<Metric>>,
    pub(crate) warnings: Vec<Warning>,
}

/// Reports counts, and comparisons with exact vibrations if the scene names them.
pub(crate) fn report(run: &Solved, vibration: &Vibration) -> Result<Modes, Failure> {
    let Vibration { modes, count, mass } = vibration;
    let setup = run.setup;
    let omega: Vec<f64> = modes.squared.iter().map(|s| s.max(0.0).sqrt()).collect();
    let count = omega.len().min(*count);
    let mut metrics = Vec::new();
    push(&mut metrics, &metric::MASS, *mass);
    push(&mut metrics, &metric::RESIDUAL, modes.residual);
    let rigid = RIGID * modes.scale.sqrt();
    push(&mut metrics, &metric::RIGID_MODES, omega.iter().filter(|&&w| w < rigid).count() as f64);
    if modes.are_all() {
        push(&mut metrics, &metric::MASSLESS, modes.massless as f64);
    }
    if let (Some(fastest), true, 0) = (omega.last(), modes.are_all(), modes.massless) {
        push(&mut metrics, &metric::CRITICAL_STEP, 2.0 / fastest);
    }
    let exact = setup.exact.as_ref().and_then(|exact| exact.vibrations());
    let lowest = exact.and_then(|exact| exact.lowest(count)).unwrap_or_default();
    if let Some(first) = lowest.first() {
        push(&mut metrics, &metric::SLOW_MODES, omega.iter().filter(|&&w| w < SLOW * first).count() as f64);
        let errors = omega.iter().zip(&lowest).map(|(w, e)| (w / e - 1.0).abs());
        push(&mut metrics, &metric::SPECTRUM_ERROR, errors.fold(0.0, f64::max));
    }
    if let Some(exact) = exact {
        // There may be many slow modes, which come first.
        let near = omega.iter().take_while(|&&w| w < FAST * exact.omega()).count();
        let (shares, dimension) = shares(run, &modes.shapes[..near], exact)?;
        let mut nearest: Vec<usize> = (0..near).collect();
        nearest.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
        nearest.truncate(dimension);
        // A multiple exact frequency may split into several; the worst of them is reported.
        let least = nearest.iter().map(|&n| shares[n]).fold(f64::INFINITY, f64::min);
        let ratios = nearest.iter().map(|&n| omega[n] / exact.omega());
        if let Some(worst) = ratios.max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())) {
            push(&mut metrics, &metric::MODE_OVERLAP, least);
            if nearest.len() == dimension && least > ALIKE {
                push(&mut metrics, &metric::FREQUENCY_RATIO, worst);
                push(&mut metrics, &metric::FREQUENCY_ERROR, (worst - 1.0).abs());
            }
        }
    }
    let each = (0..count).map(|n| {
        let mut metrics = Vec::new();
        push(&mut metrics, &metric::MODE, (n + 1) as f64);
        push(&mut metrics, &metric::OMEGA, omega[n]);
        push(&mut metrics, &metric::FREQUENCY, omega[n] / std::f64::consts::TAU);
        if let Some(exact) = lowest.get(n) {
            push(&mut metrics, &metric::OMEGA_RATIO, omega[n] / exact);
        }
        metrics
    });
    let warnings = without_energy(run, modes, count)?.into_iter().collect();
    Ok(Modes { modes: each.collect(), metrics, dofs: modes.dofs, warnings })
}

/// Warning of modes whose frequency is far too low, often zero, because of the quadrature or the mass. A
/// mode's shape has the squared frequency of its strain energy under finer integration over its consistent
/// mass. Alternating shapes have strain between the points of means and of reduced quadrature, and almost no
/// displacement in a cloud whose lumped mass moves. Modes beyond the reported `count` are examined until one
/// is sound.
fn without_energy(run: &Solved, modes: &statics::Modes, count: usize) -> Result<Option<Warning>, Failure> {
    let density = run.setup.density()?;
    let own = &run.prepared.volume;
    let (fine, fine_region) = run.prepared.fine_volume()?;
    let hidden = |shape: &[Vector3]| {
        let of = |rows: &VolumeRows, region: &[u16]| {
            shear(run.setup, rows.at(), rows.weights(), region, shape, true)
        };
        of(&fine, &fine_region)
            - of(&own.rows, &own.region)
            - hourglass_control::energy(run.setup, own, shape)
    };
    let masses = point_masses(&fine, &density, &fine_region)?;
    let inertia = |shape: &[Vector3]| {
        let each = fine.rows().apply(shape).into_iter().zip(&masses);
        each.map(|(u, m)| m * u.norm_squared()).sum::<f64>()
    };
    let mut worst: Option<[f64; 2]> = None;
    let mut unseen = 0;
    for (n, (shape, &square)) in modes.shapes.iter().zip(&modes.squared).enumerate() {
        let square = square.max(0.0);
        // The shape is scaled to unit mass.
        let finer = (square + 2.0 * hidden(shape)) / inertia(shape);
        if finer > UNSEEN * square.max(NO_ENERGY * modes.scale) {
            worst.get_or_insert([square, finer]);
            unseen += 1;
        } else if n >= count && square > NO_ENERGY * modes.scale {
            break;
        }
    }
    Ok(worst.map(|squares| {
        let [own, finer] = squares.map(|square| square.sqrt() / std::f64::consts::TAU);
        let message = format!(
            "{unseen} of the lowest modes have less than half the frequency that their shape has with finer integration and a \
             consistent mass: the first of them has {own:.4} Hz instead of {finer:.4} Hz. The integration or the lumped mass does not see \
             their shape; use full integration, more points, more stabilisation, or another mass"
        );
        Warning::new(&warning::ZERO_ENERGY_MODES, unseen as f64, "method", message)
    }))
}

/// Overlap of each mode with the span of the exact modes of one frequency (the squared cosine in L2 over the
/// body), and the number of these exact modes.
fn shares(
    run: &Solved,
    shapes: &[Vec<Vector3>],
    exact: &dyn Vibrations,
) -> Result<(Vec<f64>, usize), Failure> {
    let (fine, _) = run.prepared.fine_volume()?;
    let weights = fine.weights();
    let inner = |a: &[Vector3], b: &[Vector3]| -> f64 {
        weights.iter().zip(a.iter().zip(b)).map(|(w, (a, b))| w * a.dot(b)).sum()
    };
    let at: Vec<Vec<Vector3>> = fine.points().iter().map(|x: &Point3| exact.shapes(x)).collect();
    let mut span: Vec<Vec<Vector3>> = Vec::new();
    for k in 0..at.first().map_or(0, Vec::len) {
        let mut field: Vec<Vector3> = at.iter().map(|shapes| shapes[k]).collect();
        for other in &span {
            let part = inner(other, &field);
            field.iter_mut().zip(other).for_each(|(f, o)| *f -= o * part);
        }
        let size = inner(&field, &field).sqrt();
        field.iter_mut().for_each(|f| *f /= size);
        span.push(field);
    }
    let share = |shape: &Vec<Vector3>| {
        let field = fine.rows().apply(shape);
        let within: f64 = span.iter().map(|other| inner(other, &field).powi(2)).sum();
        within / inner(&field, &field)
    };
    Ok((shapes.iter().map(share).collect(), span.len()))
}
