//! Probe histories in dynamics: errors against an exact motion, and the period of a vibration.

use cases::exact::Exact;
use catalogue::metric;
use geometry::{Point3, Vector3};

use crate::outcome::{LoadStep, Metric};

/// Metrics of the probes' displacement over all recorded states of a complete motion.
/// The damping ratio is that of a body that is `damped`.
pub(crate) fn metrics(
    steps: &[LoadStep],
    exact: Option<&dyn Exact>,
    probes: &[Point3],
    damped: bool,
) -> Vec<Metric> {
    let states: Vec<(f64, &[Vector3])> =
        steps.iter().filter_map(|step| Some((step.time()?, step.probes.as_slice()))).collect();
    let first: Vec<(f64, Vector3)> =
        states.iter().filter_map(|(time, probes)| Some((*time, *probes.first()?))).collect();
    let damping = if damped { damping_ratio(&first) } else { None };
    [
        (&metric::HISTORY_ERROR, error(&states, exact, probes)),
        (&metric::PERIOD, period(&first)),
        (&metric::DAMPING_RATIO, damping),
    ]
    .into_iter()
    .filter_map(|(entry, value)| Some(Metric::new(entry, value?)))
    .collect()
}

/// Largest error over the largest exact displacement; `None` without an exact solution that moves.
fn error(states: &[(f64, &[Vector3])], exact: Option<&dyn Exact>, probes: &[Point3]) -> Option<f64> {
    let (mut error, mut largest) = (0.0f64, 0.0f64);
    for (time, found) in states {
        let exact = exact?.at(*time)?;
        for (x, u) in probes.iter().zip(*found) {
            let expected = exact.displacement(x);
            let off = (u - expected).norm();
            // `max` would drop a NaN.
            error = if off > error || off.is_nan() { off } else { error };
            largest = largest.max(expected.norm());
        }
    }
    (largest > 0.0).then(|| error / largest)
}

/// Part of critical damping at which a point vibrates: `L / sqrt(pi^2 + L^2)` with the mean logarithm `L` of the
/// ratio of successive swings, from one extreme to the next, along its largest displacement. `None` with fewer than
/// two swings; of four and more the second half counts. A swing does not depend on the position of rest, which only tells the extremes apart: it is the mean
/// of the last half of the motion.
fn damping_ratio(states: &[(f64, Vector3)]) -> Option<f64> {
    let farthest = states.iter().map(|s| s.1).max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
    let way: Vec<f64> = states.iter().map(|s| s.1.dot(&farthest)).collect();
    let late = &way[way.len() / 2..];
    let rest = late.iter().sum::<f64>() / late.len() as f64;
    let mut extremes = Vec::new();
    let mut first = None;
    for k in 1..way.len() {
        if (way[k - 1] < rest) == (way[k] < rest) {
            continue;
        }
        // Only a half of the motion between two passages through the position of rest has its extreme.
        if let Some(first) = first.replace(k) {
            extremes.push(extreme(&way, first, k, way[first] < rest));
        }
    }
    let swings: Vec<f64> = extremes.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    // Higher modes of a vibration that starts suddenly have faded in the second half.
    let swings = &swings[if swings.len() >= 4 { swings.len() / 2 } else { 0 }..];
    let (first, last) = (swings.first()?, swings.last()?);
    if swings.len() < 2 || !(*last > 0.0) {
        return None;
    }
    let decrement = (first / last).ln() / (swings.len() - 1) as f64;
    Some(decrement / std::f64::consts::PI.hypot(decrement))
}

/// Lowest or highest value of `way[first..end]`, by the parabola through three equally spaced states.
fn extreme(way: &[f64], first: usize, end: usize, lowest: bool) -> f64 {
    let sign = if lowest { -1.0 } else { 1.0 };
    let most = (first..end).max_by(|a, b| (sign * way[*a]).total_cmp(&(sign * way[*b]))).unwrap_or(first);
    if most == 0 || most + 1 == way.len() {
        return way[most];
    }
    let (before, at, after) = (way[most - 1], way[most], way[most + 1]);
    let (slope, bend) = (0.5 * (after - before), after - 2.0 * at + before);
    if bend == 0.0 { at } else { at - 0.5 * slope * slope / bend }
}

/// Mean time (s) between passages of a point, initially at rest, through the middle of its range along its
/// largest displacement; `None` with fewer than two passages. The displacement is interpolated linearly
/// between states.
fn period(states: &[(f64, Vector3)]) -> Option<f64> {
    let farthest = states.iter().map(|s| s.1).max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
    let way: Vec<(f64, f64)> =
        std::iter::once((0.0, 0.0)).chain(states.iter().map(|(time, u)| (*time, u.dot(&farthest)))).collect();
    let (low, high) = way.iter().fold((0.0f64, 0.0f64), |(low, high), (_, s)| (low.min(*s), high.max(*s)));
    let middle = 0.5 * (low + high);
    let passages: Vec<f64> = way
        .windows(2)
        .filter(|pair| pair[0].1 < middle && pair[1].1 >= middle)
        .map(|pair| {
            let ((t, s), (next, after)) = (pair[0], pair[1]);
            t + (next - t) * (middle - s) / (after - s)
        })
        .collect();
    let (first, last) = (passages.first()?, passages.last()?);
    (passages.len() > 1).then(|| (last - first) / (passages.len() - 1) as f64)
}

#[cfg(test)]
mod tests {
    use cases::exact::{BarWave, Elastic, PureBending};

    use super::*;

    #[test]
    fn errors_are_relative_to_the_largest_exact_displacement() {
        let elastic = Elastic::new(20e3, 0.3).unwrap();
        let bar = BarWave::new(elastic, 100.0, [0.1, 1000.0], 0.0).unwrap();
        let probes = [0.1, 0.04].map(|x| Point3::new(x, 0.0, 0.0));
        let found = |part: f64, at_end: f64| {
            let states = [0.01, 0.02, 0.03].map(|t| {
                let u = probes.map(|x| bar.at(t).unwrap().displacement(&x) * part);
                (t, [u[0] + Vector3::new(0.0, if t > 0.025 { at_end } else { 0.0 }, 0.0), u[1]])
            });
            let states: Vec<(f64, &[Vector3])> = states.iter().map(|(t, u)| (*t, u.as_slice())).collect();
            error(&states, Some(&bar), &probes).unwrap()
        };
        assert_eq!(found(1.0, 0.0), 0.0);
        assert!((found(0.99, 0.0) - 0.01).abs() < 1e-12);
        let largest = bar.at(0.03).unwrap().displacement(&probes[0]).norm();
        assert!((found(1.0, 0.1 * largest) - 0.1).abs() < 1e-12);
        assert!(found(1.0, f64::NAN).is_nan());
        let still = PureBending::new(elastic, 0.5);
        assert_eq!(error(&[(0.01, &[Vector3::zeros(); 2])], Some(&still), &probes), None);
    }

    #[test]
    fn a_damping_ratio_is_that_of_the_decaying_swing() {
        let found = |zeta: f64, per_period: f64, periods: f64| {
            let omega = 20.0;
            let free = omega * (1.0 - zeta * zeta).sqrt();
            let states: Vec<(f64, Vector3)> = (1..=(per_period * periods) as usize)
                .map(|k| {
                    let t = 2.0 * std::f64::consts::PI / free * k as f64 / per_period;
                    let swing = (free * t).cos() + zeta * omega / free * (free * t).sin();
                    let x = 2e-3 * (1.0 - (-zeta * omega * t).exp() * swing);
                    (t, Vector3::new(0.0, -x, 0.5 * x))
                })
                .collect();
            damping_ratio(&states)
        };
        for zeta in [0.005, 0.05, 0.2] {
            let ratio = found(zeta, 40.0, 5.5).unwrap();
            assert!((ratio / zeta - 1.0).abs() < 2e-3, "{ratio} {zeta}");
        }
        assert_eq!((found(0.05, 40.0, 1.4), damping_ratio(&[])), (None, None));
    }

    #[test]
    fn a_period_is_that_of_the_swing() {
        let swing = |per_period: usize, periods: f64| -> Option<f64> {
            let states: Vec<(f64, Vector3)> = (1..=(per_period as f64 * periods) as usize)
                .map(|k| {
                    let t = 0.3 * k as f64 / per_period as f64;
                    let angle = 2.0 * std::f64::consts::PI * t / 0.3;
                    (t, Vector3::new(0.0, -2e-3 * (1.0 - angle.cos()), 1e-3))
                })
                .collect();
            period(&states)
        };
        // With equal steps, every passage has the same position between two states.
        assert!((swing(40, 3.5).unwrap() / 0.3 - 1.0).abs() < 1e-12);
        assert!((swing(37, 3.5).unwrap() / 0.3 - 1.0).abs() < 1e-12);
        assert_eq!((swing(40, 1.2), period(&[])), (None, None));
        // A piecewise linear motion whose first rise takes two unequal steps: passages at 0.1, 0.5 and 0.9 s.
        let ways = [(0.05, 0.5), (0.2, 2.0), (0.4, 0.0), (0.6, 2.0), (0.8, 0.0), (1.0, 2.0)];
        let found = period(&ways.map(|(t, x)| (t, Vector3::new(x, 0.0, 0.0)))).unwrap();
        assert!((found - 0.4).abs() < 1e-12, "{found}");
    }
}
