//! Times per frame of a simulator's loop, and their statistics.

use std::borrow::Cow;

/// Fewest frames for a 99 % quantile, which with fewer would be the slowest frame.
pub(crate) const FOR_P99: usize = 100;
const FOR_P999: usize = 1000;

/// Times per frame of a phase of the loop.
#[derive(Clone, Debug)]
pub struct Latency {
    /// Name of the phase. `repeated` is the requested output of a frame: for a linear problem the probes and
    /// the loaded faces, by the condensed operator; under large strain the whole equilibrium.
    /// `repeated-field` is the solution at all nodes with the factored matrix. `condense` is the construction
    /// of the operator, once. `loop-30` is the loop in real time with 30 frames per second.
    pub phase: Cow<'static, str>,
    /// Time of each frame, s.
    pub seconds: Vec<f64>,
    /// Newton iterations in all frames.
    pub iterations: usize,
    /// Relative deviation of the first frame at the whole load from the end of the load path, in the first
    /// tool's force; without tools, in the largest displacement.
    pub deviation: Option<f64>,
    /// Frame at which the loop failed, if any. No simulator could use such a loop, so no times are reported.
    pub broke_off: Option<usize>,
    /// Time between two frames of a loop in real time, s.
    pub deadline: Option<f64>,
    /// Longest time of a frame in which a tool begins to touch, s: until its force is felt.
    pub touch: Option<f64>,
}

impl Latency {
    /// Times of the frames of a phase.
    pub(crate) fn new(phase: impl Into<Cow<'static, str>>, seconds: Vec<f64>) -> Latency {
        Latency {
            phase: phase.into(),
            seconds,
            iterations: 0,
            deviation: None,
            broke_off: None,
            deadline: None,
            touch: None,
        }
    }

    /// Statistics as name, unit and value. Each needs its number of frames: with too few for `p99` the
    /// slowest frame is reported as `max`.
    pub fn statistics(&self) -> Vec<(&'static str, &'static str, f64)> {
        if let Some(frame) = self.broke_off {
            return vec![("broke-off", "1", frame as f64)];
        }
        let count = self.seconds.len();
        let mut sorted = self.seconds.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        // The quantile is an actual frame, not the mean of two.
        let quantile =
            |p: f64| sorted[((p * sorted.len() as f64).ceil() as usize).clamp(1, sorted.len()) - 1];
        let mut reported: Vec<_> = [("median", 0.5, 1), ("p99", 0.99, FOR_P99), ("p99.9", 0.999, FOR_P999)]
            .into_iter()
            .filter(|(_, _, least)| count >= *least)
            .map(|(name, p, _)| (name, "s", quantile(p)))
            .collect();
        if count > 1 {
            if count < FOR_P99 || self.deadline.is_some() {
                reported.push(("max", "s", sorted[count - 1]));
            }
            reported.push(("frames", "1", count as f64));
        }
        if self.iterations > 0 {
            reported.push(("iterations", "1", self.iterations as f64 / count as f64));
        }
        reported.extend(self.deviation.map(|deviation| ("deviation", "1", deviation)));
        if let Some(deadline) = self.deadline {
            let is_late = |seconds: &f64| *seconds > deadline;
            let late = self.seconds.iter().filter(|seconds| is_late(seconds)).count();
            let run = self.seconds.chunk_by(|a, b| is_late(a) == is_late(b)).filter(|run| is_late(&run[0]));
            reported.push(("misses", "1", 1e3 * late as f64 / count as f64));
            reported.push(("longest-run", "1", run.map(<[f64]>::len).max().unwrap_or(0) as f64));
            reported.extend(self.touch.map(|touch| ("touch", "s", touch)));
        }
        reported
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_need_their_frames() {
        let of = |n: usize| Latency {
            iterations: 2 * n,
            ..Latency::new("repeated", (1..=n).rev().map(|s| s as f64).collect())
        };
        let (frames, iterations) = (("frames", "1", 4.0), ("iterations", "1", 2.0));
        assert_eq!(of(4).statistics(), [("median", "s", 2.0), ("max", "s", 4.0), frames, iterations]);
        assert_eq!(of(1).statistics(), [("median", "s", 1.0), ("iterations", "1", 2.0)]);
        assert_eq!(of(100).statistics()[..2], [("median", "s", 50.0), ("p99", "s", 99.0)]);
        assert_eq!(of(1000).statistics()[1..3], [("p99", "s", 990.0), ("p99.9", "s", 999.0)]);
        let broken = Latency { broke_off: Some(7), ..of(100) };
        assert_eq!(broken.statistics(), [("broke-off", "1", 7.0)]);
    }

    #[test]
    fn frames_beyond_the_deadline_are_misses() {
        let seconds = vec![1.0, 3.0, 2.5, 2.0, 4.0, 1.0, 3.0, 3.0];
        let paced = Latency { deadline: Some(2.0), touch: Some(2.5), ..Latency::new("loop-1", seconds) };
        assert_eq!(
            paced.statistics()[1..],
            [
                ("max", "s", 4.0),
                ("frames", "1", 8.0),
                ("misses", "1", 625.0),
                ("longest-run", "1", 2.0),
                ("touch", "s", 2.5)
            ]
        );
        let none = Latency { deadline: Some(4.0), ..paced };
        assert_eq!(none.statistics()[3..5], [("misses", "1", 0.0), ("longest-run", "1", 0.0)]);
    }
}
