//! A simulator's loop in real time: the loading passes once at each rate, every frame is timed against its
//! deadline, and its forces and displacements are compared with the converged path at the same time.

use std::time::Instant;

use cases::scene::RealTime;
use catalogue::{metric, warning};
use geometry::{Point3, Vector3};
use shape::Rows;

use crate::error::Failure;
use crate::measure::{Request, Solved};
use crate::outcome::{Latency, LoadStep, Outcome, ToolStep, Warning, push};
use crate::procedure::{Advance, FrameEnd, Loop, Problem};

/// Part of the frames whose errors are below the reported one.
const QUANTILE: f64 = 0.99;

/// Runs the loop at each rate after the first solution, and adds times, errors and warnings to the outcome.
///
/// # Errors
/// Errors of the problem before its first frame.
pub(super) fn real_time(
    outcome: &mut Outcome,
    run: &Solved,
    ask: &RealTime,
    request: &Request,
) -> Result<(), Failure> {
    let Solved { method, setup, prepared, .. } = *run;
    let points: &[Point3] = request.probes;
    let rows = prepared.source.at_points(points)?.0;
    let probes: &Rows = rows.rows();
    let plan = outcome.plan.clone();
    let problem = Problem { method, setup, prepared, plan: &plan, watch: None, probes: points };
    let of_loop = Loop { problem, probes, ask };
    let reference = request.reference.filter(|reference| reference.finished && !reference.steps.is_empty());
    let path = Path::new(reference.map_or(&outcome.steps, |reference| &reference.steps));
    for (index, &rate) in ask.rates.iter().enumerate() {
        let count = ask.frames(&setup.procedure, rate);
        let mut played = of_loop.paced(count, |advance| Played::new(count, ask.within, advance))?;
        if let Some(why) = &played.ended {
            let frames = played.latency.seconds.len();
            let message =
                format!("at {rate} frames per second the loop ended after {frames} of {count} frames: {why}");
            let warning = Warning::new(&warning::LOOP_ENDED, frames as f64, "loop", message);
            outcome.warnings.push(warning);
        } else {
            let [force, probe] = path.errors(&played.ends);
            for (of, error) in [(&metric::LOOP_FORCE_ERROR, force), (&metric::LOOP_PROBE_ERROR, probe)] {
                if let Some(error) = error {
                    push(&mut outcome.metrics, of.at(index), error);
                }
            }
        }
        played.latency.phase = format!("loop-{rate}").into();
        played.latency.deadline = Some(1.0 / rate as f64);
        outcome.latencies.push(played.latency);
    }
    Ok(())
}

/// The frames of one rate.
struct Played {
    latency: Latency,
    /// Part of the loading at the end of each frame, with its results.
    ends: Vec<(f64, FrameEnd)>,
    /// Reason why the loop ended early.
    ended: Option<String>,
}

impl Played {
    fn new(count: usize, within: f64, advance: &mut Advance) -> Played {
        let mut latency = Latency::new("", Vec::with_capacity(count));
        let (mut ends, mut ended) = (Vec::with_capacity(count), None);
        let mut touched = false;
        let began = Instant::now();
        for frame in 1..=count {
            if began.elapsed().as_secs_f64() > within {
                ended = Some(format!("{within} s have passed (loop.within)"));
                break;
            }
            let part = frame as f64 / count as f64;
            let before = Instant::now();
            let end = match advance(part) {
                Ok(end) => end,
                Err(failure) => {
                    latency.broke_off = Some(frame);
                    ended = Some(failure.to_string());
                    break;
                }
            };
            let seconds = before.elapsed().as_secs_f64();
            let touches = end.tools.iter().any(|tool| tool.active > 0);
            if touches && !touched {
                latency.touch = Some(latency.touch.map_or(seconds, |longest: f64| longest.max(seconds)));
            }
            touched = touches;
            latency.iterations += end.iterations;
            latency.seconds.push(seconds);
            ends.push((part, end));
        }
        Played { latency, ends, ended }
    }
}

/// Converged path of a loading, linear between its steps.
struct Path<'a> {
    steps: &'a [LoadStep],
    /// Force of a tool that is compared: a stored reference has that along the direction of travel alone.
    force: fn(&ToolStep) -> Vector3,
    /// Largest force of each tool, N.
    forces: Vec<f64>,
    /// Largest displacement of all probes, m.
    displacement: f64,
}

impl<'a> Path<'a> {
    fn new(steps: &'a [LoadStep]) -> Path<'a> {
        let tools = steps.first().map_or(0, |step| step.tools.len());
        let has_vectors =
            steps.iter().flat_map(|step| &step.tools).any(|tool| tool.force != Vector3::zeros());
        let force = match has_vectors {
            true => |tool: &ToolStep| tool.force,
            false => |tool: &ToolStep| Vector3::new(tool.pushed, 0.0, 0.0),
        };
        let largest = |k: usize| steps.iter().map(|step| force(&step.tools[k]).norm()).fold(0.0, f64::max);
        let probes = steps.iter().flat_map(|step| &step.probes);
        Path {
            force,
            forces: (0..tools).map(largest).collect(),
            displacement: probes.map(Vector3::norm).fold(0.0, f64::max),
            steps,
        }
    }

    /// Errors of the force and of the displacement that 99 % of the frames keep, relative to the largest of
    /// the path.
    fn errors(&self, ends: &[(f64, FrameEnd)]) -> [Option<f64>; 2] {
        let (mut forces, mut probes) = (Vec::new(), Vec::new());
        for (part, end) in ends {
            let each =
                end.tools.iter().zip(&self.forces).enumerate().filter(|(_, (_, largest))| **largest > 0.0);
            let error = |(k, (tool, largest)): (usize, (&ToolStep, &f64))| {
                let path = self.at(*part, |step| (self.force)(&step.tools[k]), Vector3::zeros());
                ((self.force)(tool) - path).norm() / largest
            };
            forces.extend(each.map(error).reduce(f64::max));
            let known = self.steps.first().is_some_and(|step| step.probes.len() == end.probes.len());
            let each = end.probes.iter().enumerate().filter(|_| known && self.displacement > 0.0);
            let error = |(k, u): (usize, &Vector3)| {
                (u - self.at(*part, |step| step.probes[k], Vector3::zeros())).norm() / self.displacement
            };
            probes.extend(each.map(error).reduce(f64::max));
        }
        [forces, probes].map(kept)
    }

    /// Value of the path at a part of the loading; `start` before the loading.
    fn at<T>(&self, part: f64, value: impl Fn(&LoadStep) -> T, start: T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        let next = self.steps.partition_point(|step| step.load < part).min(self.steps.len() - 1);
        let (from, before) = match next {
            0 => (0.0, start),
            next => (self.steps[next - 1].load, value(&self.steps[next - 1])),
        };
        let ahead = ((part - from) / (self.steps[next].load - from)).min(1.0);
        before * (1.0 - ahead) + value(&self.steps[next]) * ahead
    }
}

/// The value that 99 % of all values do not exceed.
fn kept(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let rank = (QUANTILE * values.len() as f64).ceil() as usize;
    values.get(rank.saturating_sub(1)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(load: f64, pushed: f64, moved: f64) -> LoadStep {
        let tool = ToolStep { force: Vector3::new(0.0, 0.0, pushed), ..ToolStep::UNTOUCHED };
        LoadStep {
            load,
            tools: vec![tool],
            probes: vec![Vector3::new(moved, 0.0, 0.0)],
            ..LoadStep::at_start(0)
        }
    }

    fn frame(part: f64, pushed: f64, moved: f64) -> (f64, FrameEnd) {
        let LoadStep { tools, probes, .. } = step(part, pushed, moved);
        (part, FrameEnd { tools, probes, iterations: 1 })
    }

    #[test]
    fn a_frame_is_held_against_the_path_at_its_own_time() {
        let steps = [step(0.5, 2.0, 1.0), step(1.0, 4.0, 2.0)];
        let path = Path::new(&steps);
        assert_eq!(path.errors(&[frame(0.25, 1.0, 0.5), frame(0.75, 3.0, 1.5)]), [Some(0.0), Some(0.0)]);
        // Relative to the largest of the path: 4 N and 2 m.
        assert_eq!(path.errors(&[frame(0.25, 2.0, 0.5), frame(1.0, 4.0, 1.5)]), [Some(0.25), Some(0.25)]);
        assert_eq!(path.errors(&[]), [None, None]);
    }

    #[test]
    fn a_path_without_vectors_is_compared_along_the_direction_of_travel() {
        let along = |mut step: LoadStep, pushed: f64| {
            step.tools[0] = ToolStep { pushed, ..ToolStep::UNTOUCHED };
            step
        };
        let steps = [along(step(1.0, 0.0, 1.0), 4.0)];
        let (part, mut end) = frame(1.0, 9.0, 1.0);
        end.tools[0].pushed = 3.0;
        assert_eq!(Path::new(&steps).errors(&[(part, end)]), [Some(0.25), Some(0.0)]);
    }

    #[test]
    fn one_frame_in_a_hundred_may_be_worse() {
        assert_eq!(kept((1..=100).map(f64::from).collect()), Some(99.0));
        assert_eq!(kept(vec![1.0, 2.0]), Some(2.0));
    }

    #[test]
    fn frames_that_begin_to_touch_are_told_apart_and_a_failure_ends_the_loop() {
        let active = [0, 1, 2, 0, 3];
        let mut next = active.iter();
        let played = Played::new(6, 60.0, &mut |part| match next.next() {
            Some(&active) => {
                let (_, mut end) = frame(part, 0.0, 0.0);
                end.tools[0].active = active;
                Ok(end)
            }
            None => Err(Failure::Run("no equilibrium".into())),
        });
        assert_eq!(played.latency.seconds.len(), 5);
        let [_, first, .., second] = played.latency.seconds[..] else { panic!() };
        assert_eq!(played.latency.touch, Some(f64::max(first, second)));
        assert_eq!(played.ended.as_deref(), Some("no equilibrium"));
        assert_eq!(Played::new(3, -1.0, &mut |part| Ok(frame(part, 0.0, 0.0).1)).ends.len(), 0);
    }
}
