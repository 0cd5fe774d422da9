//! A simulator's loop: the scene's loading played up and down in frames, prepared once, each frame timed.

use std::hint::black_box;
use std::time::Instant;

use cases::scene::Repeated;
use contact::ContactSurface;
use geometry::{Point3, Vector3};
use shape::{Rows, Unity};
use statics::{Factored, Frames, Load, NewtonParams, StaticParams, assemble, nodal_forces};

use crate::Failure;
use crate::discretise::Discretisation;
use crate::measure::push;
use crate::outcome::{LoadStep, Metric};
use crate::prepare::Prepared;
use crate::run::Asks;
use crate::setup::Setup;
use crate::statics::with_problem;

/// Frames that a percentile takes to be one of the samples and not the worst.
const FOR_P99: usize = 100;
const FOR_P999: usize = 1000;

/// Seconds per frame.
#[derive(Clone, Debug)]
pub struct Latency {
    /// `repeated`: what is asked for in a frame (the probes and the loaded faces of a linear problem by its condensed
    /// operator, the whole equilibrium under large strain); `repeated-field`: all nodes, by the factor; `condense`: what
    /// makes the operator, once.
    pub phase: &'static str,
    /// One per frame.
    pub seconds: Vec<f64>,
    /// Newton's iterations in all frames.
    pub iterations: usize,
    /// How far the first frame at the whole load is off the path's end: of the first tool's force, or the largest
    /// displacement without tools.
    pub deviation: Option<f64>,
    /// The frame in which the loop broke off, if it did: one that no simulator could use, told without times.
    pub broke_off: Option<usize>,
}

impl Latency {
    /// Statistics with their units, as far as there are frames for them.
    pub fn statistics(&self) -> Vec<(&'static str, &'static str, f64)> {
        if let Some(frame) = self.broke_off {
            return vec![("broke-off", "1", frame as f64)];
        }
        let count = self.seconds.len();
        let mut sorted = self.seconds.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        // The smallest sample that so many are no larger than: a frame that was, not a mean of two.
        let quantile =
            |p: f64| sorted[((p * sorted.len() as f64).ceil() as usize).clamp(1, sorted.len()) - 1];
        let mut told: Vec<_> = [("median", 0.5, 1), ("p99", 0.99, FOR_P99), ("p99.9", 0.999, FOR_P999)]
            .into_iter()
            .filter(|(_, _, least)| count >= *least)
            .map(|(name, p, _)| (name, "s", quantile(p)))
            .collect();
        if count > 1 {
            told.push(("frames", "1", count as f64));
        }
        if self.iterations > 0 {
            told.push(("iterations", "1", self.iterations as f64 / count as f64));
        }
        told.extend(self.deviation.map(|deviation| ("deviation", "1", deviation)));
        told
    }
}

/// Part of the loading in a frame: up from `2 / cycle` to 1 in half a cycle and down again, never to nothing, where a tool
/// driven by force would have none.
fn part(frame: usize, cycle: usize) -> f64 {
    let (half, at) = (cycle / 2, frame % cycle);
    let step = if at < half { at + 1 } else { cycle - at };
    step as f64 / half as f64
}

/// Runs the loop after the first solution, of nodal parameters and the last load step; metrics and deviations say how far
/// it agrees with that.
pub fn repeated(
    ask: &Repeated,
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    (u, last): (&[Vector3], Option<&LoadStep>),
    asks: &Asks,
    metrics: &mut Vec<Metric>,
) -> Result<Vec<Latency>, Failure> {
    match &setup.statics {
        Some(params) => nonlinear(ask, method, setup, params, prepared, (u, last)),
        None => linear(ask, method, setup, prepared, u, asks.probes, metrics),
    }
}

fn linear(
    ask: &Repeated,
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    u: &[Vector3],
    probes: &[Point3],
    metrics: &mut Vec<Metric>,
) -> Result<Vec<Latency>, Failure> {
    let (loads, weak) = (prepared.loads(), prepared.weak());
    let problem = prepared.problem(method.nodes(), setup, &loads, &weak);
    let factored = prepared.factor(assemble(&problem)?)?;
    let unit: Vec<Vec<Vector3>> = (loads.iter())
        .map(|load| nodal_forces(&prepared.volume.rows, std::slice::from_ref(load)))
        .collect::<Result<_, _>>()?;
    let mut latencies = Vec::new();
    let outputs = outputs(method, prepared, probes, &loads)?;
    if !outputs.is_empty() {
        let start = Instant::now();
        let loaded: Vec<u32> = (0..method.nodes().len() as u32)
            .filter(|&node| unit.iter().any(|f| f[node as usize] != Vector3::zeros()))
            .collect();
        let condensed = factored.condense(&outputs, &loaded)?;
        latencies.push(Latency {
            phase: "condense",
            seconds: vec![start.elapsed().as_secs_f64()],
            iterations: 0,
            broke_off: None,
            deviation: None,
        });
        let unit: Vec<Vec<Vector3>> =
            unit.iter().map(|f| loaded.iter().map(|&node| f[node as usize]).collect()).collect();
        let mut forces = vec![Vector3::zeros(); loaded.len()];
        let mut out = vec![Vector3::zeros(); outputs.len()];
        let mut frame = |parts: &dyn Fn(usize) -> f64, supports: f64, out: &mut [Vector3]| {
            forces.fill(Vector3::zeros());
            for (l, unit) in unit.iter().enumerate() {
                let part = parts(l);
                forces.iter_mut().zip(unit).for_each(|(f, u)| *f += u * part);
            }
            condensed.apply(black_box(&forces), supports, black_box(out));
        };
        frame(&|_| 1.0, 1.0, &mut out);
        let direct = outputs.apply(u);
        let largest = direct.iter().map(Vector3::norm).fold(0.0, f64::max);
        let gap = out.iter().zip(&direct).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        if largest > 0.0 {
            push(metrics, "repeated-error", gap / largest, "1");
        }
        // Every load at a part of its own: not a multiple of one solution.
        let share = ask.cycle / (unit.len() + 1);
        latencies.push(timed("repeated", ask, |k| {
            frame(&|l| part(k + l * share, ask.cycle), part(k, ask.cycle), &mut out);
            Ok(0)
        })?);
    }
    let mut forces = vec![Vector3::zeros(); method.nodes().len()];
    // Told beside: what 99 % of the frames take, and no more than a fiftieth of the time that the loop may take.
    let ask = Repeated { frames: ask.frames.min(FOR_P99), within: 0.02 * ask.within, ..*ask };
    let share = ask.cycle / (unit.len() + 1);
    latencies.push(timed("repeated-field", &ask, |k| {
        forces.fill(Vector3::zeros());
        for (l, unit) in unit.iter().enumerate() {
            let part = part(k + l * share, ask.cycle);
            forces.iter_mut().zip(unit).for_each(|(f, u)| *f += u * part);
        }
        field(&factored, &forces, part(k, ask.cycle))
    })?);
    Ok(latencies)
}

fn field(factored: &Factored, forces: &[Vector3], supports: f64) -> Result<usize, Failure> {
    black_box(factored.solve_forces(forces, supports)?);
    Ok(0)
}

/// The probes, and the mean displacement of each loaded face: what a jaw that presses there would tell.
fn outputs(
    method: &Discretisation,
    prepared: &Prepared,
    probes: &[Point3],
    loads: &[Load],
) -> Result<Rows, Failure> {
    let (mut offsets, mut nodes, mut values) = (vec![0], Vec::new(), Vec::new());
    if !probes.is_empty() {
        let rows = method.at_points(&prepared.volume, probes)?.0;
        for probe in 0..probes.len() {
            let (at, value) = rows.rows().row(probe);
            nodes.extend_from_slice(at);
            values.extend_from_slice(value);
            offsets.push(nodes.len());
        }
    }
    for load in loads {
        let (Load::Traction { surface, .. } | Load::Pressure { surface, .. }) = load else { continue };
        let area: f64 = surface.weights().iter().sum();
        let mut mean = vec![0.0; method.nodes().len()];
        for (q, w) in surface.weights().iter().enumerate() {
            let (at, value) = surface.rows().row(q);
            at.iter().zip(value).for_each(|(&node, v)| mean[node as usize] += w * v / area);
        }
        for (node, value) in mean.into_iter().enumerate().filter(|(_, v)| *v != 0.0) {
            nodes.push(node as u32);
            values.push(value);
        }
        offsets.push(nodes.len());
    }
    Ok(Rows::new(method.nodes().len(), offsets, nodes, values, Unity::NotPromised)?)
}

fn nonlinear(
    ask: &Repeated,
    method: &Discretisation,
    setup: &Setup,
    params: &StaticParams,
    prepared: &Prepared,
    (u, last): (&[Vector3], Option<&LoadStep>),
) -> Result<Vec<Latency>, Failure> {
    let end = last.and_then(|last| last.tools.first());
    let contact = prepared.contact.as_ref().map(ContactSurface::new);
    with_problem(method, setup, prepared, contact.as_ref(), |problem| {
        let tolerance = ask.tolerance.unwrap_or(params.newton.tolerance);
        let params = StaticParams { newton: NewtonParams { tolerance, ..params.newton }, ..*params };
        let mut frames = Frames::new(problem, &params)?;
        let (mut at, mut deviation) = (0, None);
        let mut latency = timed("repeated", ask, |k| {
            at = k;
            let part = part(k, ask.cycle);
            let step = frames.to(part)?;
            if part == 1.0 && deviation.is_none() {
                let norm = |u: &[Vector3]| u.iter().map(Vector3::norm).fold(0.0, f64::max);
                let (now, then) = match (step.tools.first(), end) {
                    (Some(tool), Some(end)) => (tool.force.norm(), end.force.norm()),
                    _ => (norm(frames.u()), norm(u)),
                };
                deviation = (then > 0.0).then(|| (now / then - 1.0).abs());
            }
            Ok(step.iterations.iter().filter(|i| i.length > 0.0).count())
        });
        if let Ok(latency) = &mut latency {
            latency.deviation = deviation;
        }
        let broke_off = Latency {
            phase: "repeated",
            seconds: Vec::new(),
            iterations: 0,
            broke_off: Some(at),
            deviation: None,
        };
        Ok(vec![latency.unwrap_or(broke_off)])
    })
}

/// Times each frame, which tells its iterations, until all are done or the time is spent.
fn timed(
    phase: &'static str,
    ask: &Repeated,
    mut frame: impl FnMut(usize) -> Result<usize, Failure>,
) -> Result<Latency, Failure> {
    let (mut seconds, mut iterations) = (Vec::with_capacity(ask.frames), 0);
    let start = Instant::now();
    for k in 0..ask.frames {
        if k > 0 && start.elapsed().as_secs_f64() > ask.within {
            break;
        }
        let before = Instant::now();
        iterations += frame(k)?;
        seconds.push(before.elapsed().as_secs_f64());
    }
    Ok(Latency { phase, seconds, iterations, broke_off: None, deviation: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_loading_goes_up_and_down_and_never_to_nothing() {
        let parts: Vec<f64> = (0..9).map(|k| part(k, 8)).collect();
        assert_eq!(parts, [0.25, 0.5, 0.75, 1.0, 1.0, 0.75, 0.5, 0.25, 0.25]);
    }

    #[test]
    fn percentiles_need_their_frames() {
        let of = |n: usize| Latency {
            phase: "repeated",
            seconds: (1..=n).rev().map(|s| s as f64).collect(),
            iterations: 2 * n,
            broke_off: None,
            deviation: None,
        };
        let (frames, iterations) = (("frames", "1", 4.0), ("iterations", "1", 2.0));
        assert_eq!(of(4).statistics(), [("median", "s", 2.0), frames, iterations]);
        assert_eq!(of(100).statistics()[..2], [("median", "s", 50.0), ("p99", "s", 99.0)]);
        assert_eq!(of(1000).statistics()[1..3], [("p99", "s", 990.0), ("p99.9", "s", 999.0)]);
        let broken = Latency { broke_off: Some(7), ..of(100) };
        assert_eq!(broken.statistics(), [("broke-off", "1", 7.0)]);
    }
}
