//! Seconds per frame of a loop, and what they come to.

/// Frames that a percentile takes to be one of the samples and not the worst.
pub(crate) const FOR_P99: usize = 100;
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
    /// The frame in which the loop broke off, if it did: one that no simulator could use, reported without times.
    pub broke_off: Option<usize>,
}

impl Latency {
    /// Statistics with their units, as far as there are frames for them; of too few for `p99` the slowest, `max`.
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
        let mut reported: Vec<_> = [("median", 0.5, 1), ("p99", 0.99, FOR_P99), ("p99.9", 0.999, FOR_P999)]
            .into_iter()
            .filter(|(_, _, least)| count >= *least)
            .map(|(name, p, _)| (name, "s", quantile(p)))
            .collect();
        if count > 1 {
            if count < FOR_P99 {
                reported.push(("max", "s", sorted[count - 1]));
            }
            reported.push(("frames", "1", count as f64));
        }
        if self.iterations > 0 {
            reported.push(("iterations", "1", self.iterations as f64 / count as f64));
        }
        reported.extend(self.deviation.map(|deviation| ("deviation", "1", deviation)));
        reported
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(of(4).statistics(), [("median", "s", 2.0), ("max", "s", 4.0), frames, iterations]);
        assert_eq!(of(1).statistics(), [("median", "s", 1.0), ("iterations", "1", 2.0)]);
        assert_eq!(of(100).statistics()[..2], [("median", "s", 50.0), ("p99", "s", 99.0)]);
        assert_eq!(of(1000).statistics()[1..3], [("p99", "s", 990.0), ("p99.9", "s", 999.0)]);
        let broken = Latency { broke_off: Some(7), ..of(100) };
        assert_eq!(broken.statistics(), [("broke-off", "1", 7.0)]);
    }
}
