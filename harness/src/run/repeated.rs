//! A simulator's loop: the scene's loading is ramped up and down in frames. The problem is prepared once, and
//! every frame is timed.

use std::hint::black_box;
use std::time::Instant;

use cases::scene::{Procedure, Repeated, Static};
use catalogue::metric;
use geometry::{Point3, Vector3};
use shape::{Rows, Unity};
use statics::{Factored, Load, assemble, nodal_forces};

use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::measure::Solved;
use crate::outcome::{FOR_P99, Latency, Metric, Plan, push};
use crate::prepare::Prepared;
use crate::procedure::{Problem, in_frames, solves};

/// Fraction of the loading in a frame. It rises from `2 / cycle` to 1 in half a cycle and falls again. It
/// never reaches zero, because a force-controlled tool would then have no force.
fn part(frame: usize, cycle: usize) -> f64 {
    let half = cycle / 2;
    let at = frame % cycle;
    let step = if at < half { at + 1 } else { cycle - at };
    step as f64 / half as f64
}

/// Runs the loop after the first solution. Metrics and deviations report how well the loop agrees with that
/// solution.
pub(super) fn repeated(
    ask: &Repeated,
    run: &Solved,
    plan: &Plan,
    probes: &[Point3],
    metrics: &mut Vec<Metric>,
) -> Result<Vec<Latency>, Failure> {
    match &run.setup.procedure {
        Procedure::Static(asked) => nonlinear(ask, run, asked, plan),
        _ => linear(ask, run, probes, metrics),
    }
}

fn linear(
    ask: &Repeated,
    run: &Solved,
    probes: &[Point3],
    metrics: &mut Vec<Metric>,
) -> Result<Vec<Latency>, Failure> {
    let Solved { method, setup, prepared, solution } = *run;
    let u = &solution.u;
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
        latencies.push(Latency::new("condense", vec![start.elapsed().as_secs_f64()]));
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
            push(metrics, &metric::REPEATED_ERROR, gap / largest);
        }
        // Each load has its own phase, so that the frames are not multiples of one solution.
        let share = ask.cycle / (unit.len() + 1);
        latencies.push(timed("repeated", ask, |k| {
            frame(&|l| part(k + l * share, ask.cycle), part(k, ask.cycle), &mut out);
            Ok(0)
        })?);
    }
    let mut forces = vec![Vector3::zeros(); method.nodes().len()];
    // The whole field is timed too, for at most the 100 frames that a 99 % quantile needs, within a tenth of
    // the loop's time limit.
    let ask = Repeated { frames: ask.frames.min(FOR_P99), within: 0.1 * ask.within, ..*ask };
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

/// Rows of the probes and of the mean displacement of each loaded face, which a jaw pressing there would
/// measure.
fn outputs(
    method: &Discretisation,
    prepared: &Prepared,
    probes: &[Point3],
    loads: &[Load],
) -> Result<Rows, Failure> {
    let (mut offsets, mut nodes, mut values) = (vec![0], Vec::new(), Vec::new());
    if !probes.is_empty() {
        let rows = prepared.source.at_points(probes)?.0;
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

fn nonlinear(ask: &Repeated, run: &Solved, asked: &Static, plan: &Plan) -> Result<Vec<Latency>, Failure> {
    let Solved { method, setup, prepared, solution } = *run;
    let problem = Problem { method, setup, prepared, plan, watch: None, probes: &[] };
    let end = solution.history.as_ref().and_then(|history| history.last.tools.first());
    in_frames(&problem, asked, ask.tolerance, |frames| {
        let (mut at, mut deviation) = (0, None);
        let mut latency = timed("repeated", ask, |k| {
            at = k;
            let part = part(k, ask.cycle);
            let step = frames.to(part)?;
            if part == 1.0 && deviation.is_none() {
                let norm = |u: &[Vector3]| u.iter().map(Vector3::norm).fold(0.0, f64::max);
                let (now, then) = match (step.tools.first(), end) {
                    (Some(tool), Some(end)) => (tool.force.norm(), end.force.norm()),
                    _ => (norm(frames.u()), norm(&solution.u)),
                };
                deviation = (then > 0.0).then(|| (now / then - 1.0).abs());
            }
            Ok(solves(&step) as usize)
        });
        if let Ok(latency) = &mut latency {
            latency.deviation = deviation;
        }
        let broke_off = || Latency { broke_off: Some(at), ..Latency::new("repeated", Vec::new()) };
        vec![latency.unwrap_or_else(|_| broke_off())]
    })
}

/// Times each frame until all are done or the time limit is reached. `frame` returns its number of
/// iterations.
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
    Ok(Latency { iterations, ..Latency::new(phase, seconds) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_loading_goes_up_and_down_and_never_to_nothing() {
        let parts: Vec<f64> = (0..9).map(|k| part(k, 8)).collect();
        assert_eq!(parts, [0.25, 0.5, 0.75, 1.0, 1.0, 0.75, 0.5, 0.25, 0.25]);
    }
}
