//! Phases timed apart, over repeats, and the peak of memory.

use std::time::Instant;

/// The phases every run is told in, in order.
pub const PHASES: [&str; 6] = ["refine", "prepare", "assemble", "factor", "solve", "transfer"];

/// Seconds spent per phase, one entry per repeat.
#[derive(Clone, Debug, Default)]
pub struct Timings {
    phases: Vec<(&'static str, Vec<f64>)>,
}

impl Timings {
    /// Runs `work` and books its time under `phase`.
    pub fn time<T>(&mut self, phase: &'static str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.book(phase, start.elapsed().as_secs_f64());
        result
    }

    pub(crate) fn book(&mut self, phase: &'static str, seconds: f64) {
        match self.phases.iter_mut().find(|(name, _)| *name == phase) {
            Some((_, list)) => list.push(seconds),
            None => self.phases.push((phase, vec![seconds])),
        }
    }

    /// Phases in the order they first ran, with their summaries.
    pub fn summaries(&self) -> Vec<(&'static str, Summary)> {
        self.phases.iter().map(|(name, list)| (*name, Summary::of(list))).collect()
    }

    /// Sum of one repeat's phases, summarised over the repeats that all phases share; parts of a phase are none.
    pub fn total(&self) -> Summary {
        let phases = || self.phases.iter().filter(|(name, _)| PHASES.contains(name)).map(|(_, list)| list);
        let repeats = phases().map(Vec::len).min().unwrap_or(0);
        let totals: Vec<f64> = (0..repeats).map(|r| phases().map(|list| list[r]).sum()).collect();
        Summary::of(&totals)
    }
}

/// Median, interquartile range and minimum of repeated timings, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Median.
    pub median: f64,
    /// Interquartile range.
    pub spread: f64,
    /// Smallest.
    pub min: f64,
}

impl Summary {
    /// Times a factor.
    pub fn times(&self, factor: f64) -> Summary {
        Summary { median: self.median * factor, spread: self.spread * factor, min: self.min * factor }
    }

    /// Quantiles by linear interpolation between order statistics; zero for no samples.
    fn of(samples: &[f64]) -> Summary {
        let mut sorted = samples.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let quantile = |p: f64| match sorted.len() {
            0 => 0.0,
            n => {
                let at = p * (n - 1) as f64;
                let (low, high) = (at.floor() as usize, at.ceil() as usize);
                sorted[low] + (at - low as f64) * (sorted[high] - sorted[low])
            }
        };
        Summary { median: quantile(0.5), spread: quantile(0.75) - quantile(0.25), min: quantile(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_of_five_samples() {
        let s = Summary::of(&[5.0, 1.0, 2.0, 4.0, 3.0]);
        assert_eq!(s, Summary { median: 3.0, spread: 2.0, min: 1.0 });
    }

    #[test]
    fn a_total_counts_only_whole_repeats() {
        let mut t = Timings::default();
        t.book("prepare", 1.0);
        t.book("solve", 2.0);
        t.book("prepare", 10.0);
        assert_eq!(t.total().median, 3.0);
    }
}
