//! Times of separate phases over repeats.

use std::time::Instant;

use cpu_time::ProcessTime;
use reports::{Seconds, Took};

use super::counters::Counters;

/// The phases of every run whose times are compared, in order.
pub const PHASES: [&str; 6] = ["refine", "prepare", "assemble", "factor", "solve", "transfer"];

/// Times of one phase, one entry per repeat.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timed {
    /// Name of the phase.
    pub phase: &'static str,
    /// Wall-clock times, s.
    pub wall: Vec<f64>,
    /// CPU times of all threads of the process, s; empty if unknown.
    pub cpu: Vec<f64>,
}

impl Timed {
    /// Medians of both clocks.
    pub fn took(&self) -> Took {
        Took { wall: self.summary().median, cpu: self.cpu_median() }
    }

    /// Summary of the wall-clock times.
    pub fn summary(&self) -> Summary {
        Summary::of(&self.wall)
    }

    /// Time by the given clock, by which runs are compared, s.
    pub fn by(&self, seconds: Seconds) -> f64 {
        let wall = self.summary();
        match seconds {
            Seconds::Wall => wall.median,
            Seconds::Cpu => self.cpu_median().unwrap_or(wall.median),
            Seconds::Least => wall.min,
        }
    }

    /// Median of the CPU times, s; `None` if they are unknown.
    pub fn cpu_median(&self) -> Option<f64> {
        (!self.cpu.is_empty()).then(|| Summary::of(&self.cpu).median)
    }

    /// Separate phase that takes a constant fraction of this phase's time.
    pub fn part(&self, phase: &'static str, factor: f64) -> Timed {
        let scaled = |all: &[f64]| all.iter().map(|t| t * factor).collect();
        Timed { phase, wall: scaled(&self.wall), cpu: scaled(&self.cpu) }
    }
}

/// Times per phase.
#[derive(Clone, Debug, Default)]
pub struct Timings {
    phases: Vec<Timed>,
}

impl Timings {
    /// Runs `work` and adds its time to `phase`.
    pub fn time<T>(&mut self, phase: &'static str, work: impl FnOnce() -> T) -> T {
        let cpu = ProcessTime::try_now().ok();
        let start = Instant::now();
        let result = work();
        let wall = start.elapsed().as_secs_f64();
        let spent = cpu.and_then(|cpu| cpu.try_elapsed().ok()).map(|t| t.as_secs_f64());
        let timed = self.of(phase);
        timed.wall.push(wall);
        timed.cpu.extend(spent);
        result
    }

    /// Adds a wall-clock time (s) that was measured elsewhere.
    pub(crate) fn book(&mut self, phase: &'static str, seconds: f64) {
        self.of(phase).wall.push(seconds);
    }

    /// Adds a wall-clock time and, if known, a CPU time (s) that were measured elsewhere.
    pub(crate) fn book_both(&mut self, phase: &'static str, seconds: f64, cpu: Option<f64>) {
        let timed = self.of(phase);
        timed.wall.push(seconds);
        timed.cpu.extend(cpu);
    }

    /// Runs `work` and adds its time to `phase`, without the times that it adds to other phases itself.
    pub(crate) fn time_rest<T>(&mut self, phase: &'static str, work: impl FnOnce(&mut Timings) -> T) -> T {
        let mut inner = Timings::default();
        let mut outer = Timings::default();
        let result = outer.time(phase, || work(&mut inner));
        let all = |of: fn(&Timed) -> &[f64]| inner.phases.iter().flat_map(of).sum::<f64>();
        let (wall, cpu) = (all(|timed| &timed.wall), all(|timed| &timed.cpu));
        let rest = &mut outer.phases[0];
        rest.wall.iter_mut().for_each(|t| *t = (*t - wall).max(0.0));
        rest.cpu.iter_mut().for_each(|t| *t = (*t - cpu).max(0.0));
        for Timed { phase, wall, cpu } in inner.phases.into_iter().chain(outer.phases) {
            let timed = self.of(phase);
            timed.wall.extend(wall);
            timed.cpu.extend(cpu);
        }
        result
    }

    /// Wall-clock time of all phases and repeats, s.
    pub(crate) fn wall(&self) -> f64 {
        self.phases.iter().flat_map(|timed| &timed.wall).sum()
    }

    /// Merges the last two entries of a phase, for a pass that went through the phase twice.
    pub(crate) fn join(&mut self, phase: &'static str) {
        let timed = self.of(phase);
        for entries in [&mut timed.wall, &mut timed.cpu] {
            if entries.len() > 1
                && let Some(last) = entries.pop()
            {
                entries.last_mut().into_iter().for_each(|before| *before += last);
            }
        }
    }

    fn of(&mut self, phase: &'static str) -> &mut Timed {
        let known = self.phases.iter().position(|timed| timed.phase == phase);
        let at = known.unwrap_or_else(|| {
            self.phases.push(Timed { phase, ..Timed::default() });
            self.phases.len() - 1
        });
        &mut self.phases[at]
    }

    /// Phases in the order they first ran.
    pub fn phases(&self) -> &[Timed] {
        &self.phases
    }

    /// Total time of each repeat that all phases have. Parts of a phase are not added.
    pub fn total(&self) -> Timed {
        let sums = |of: fn(&Timed) -> &[f64]| -> Vec<f64> {
            let phases = || self.phases.iter().filter(|timed| PHASES.contains(&timed.phase)).map(of);
            let repeats = phases().map(<[f64]>::len).min().unwrap_or(0);
            (0..repeats).map(|r| phases().map(|list| list[r]).sum()).collect()
        };
        Timed { phase: "total", wall: sums(|timed| &timed.wall), cpu: sums(|timed| &timed.cpu) }
    }
}

/// Meters of a run: times, counters, and values found once for all passes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meters {
    /// Times, one entry per pass.
    pub(crate) timings: Timings,
    /// Wall-clock time of the discarded first pass, which touched its memory for the first time, s.
    pub(crate) first_use: Option<f64>,
    /// Counters of one pass.
    pub(crate) counters: Counters,
    /// Smallest stabilisation factor of Nitsche's method, found once for all passes.
    pub(crate) needed_nitsche_factor: Option<f64>,
    /// Expected correct decimal digits of a linear solution, found once for all passes.
    pub(crate) digits: Option<f64>,
}

/// Median, interquartile range and minimum of repeated timings, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Median, s.
    pub median: f64,
    /// Interquartile range, s.
    pub spread: f64,
    /// Minimum, s.
    pub min: f64,
}

impl Summary {
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
        assert_eq!(t.total().wall, [3.0]);
    }

    #[test]
    fn the_rest_of_a_phase_leaves_out_what_it_times_itself() {
        let mut t = Timings::default();
        let pause = || std::thread::sleep(std::time::Duration::from_millis(20));
        t.time_rest("measure", |t| {
            pause();
            t.book("transfer", 0.01);
        });
        let [transfer, measure] = t.phases() else { panic!("two phases") };
        assert_eq!((transfer.phase, &transfer.wall[..]), ("transfer", &[0.01][..]));
        assert!(measure.phase == "measure" && measure.wall[0] >= 0.01, "{:?}", measure.wall);
        assert!((t.wall() - 0.01 - measure.wall[0]).abs() < 1e-12);
    }

    #[test]
    fn a_phase_that_a_pass_goes_through_twice_counts_once() {
        let mut t = Timings::default();
        t.book("prepare", 1.0);
        t.book("factor", 2.0);
        t.book("factor", 3.0);
        t.join("factor");
        assert_eq!(t.phases()[1].wall, [5.0]);
        t.join("prepare");
        assert_eq!(t.phases()[0].wall, [1.0]);
    }

    /// If two phases were swapped, both would still have times.
    #[test]
    fn a_time_is_booked_under_its_own_phase() {
        let mut t = Timings::default();
        PHASES.into_iter().enumerate().for_each(|(seconds, phase)| t.book(phase, seconds as f64));
        PHASES.into_iter().enumerate().for_each(|(seconds, phase)| t.book(phase, 10.0 + seconds as f64));
        for (seconds, (timed, phase)) in t.phases().iter().zip(PHASES).enumerate() {
            assert_eq!((timed.phase, &timed.wall[..]), (phase, &[seconds as f64, 10.0 + seconds as f64][..]));
        }
    }

    #[test]
    fn cpu_seconds_are_those_of_the_work_and_not_of_waiting() {
        let mut t = Timings::default();
        t.time("solve", || std::thread::sleep(std::time::Duration::from_millis(20)));
        let solve = &t.phases()[0];
        assert!(solve.wall[0] >= 0.02);
        // Other tests of this process may run at the same time on all threads.
        assert!(solve.cpu.iter().all(|&cpu| cpu >= 0.0) && solve.cpu.len() <= 1);
        let begin = Instant::now();
        t.time("factor", || {
            while begin.elapsed().as_secs_f64() < 0.05 {
                std::hint::black_box(0);
            }
        });
        assert!(t.phases()[1].cpu_median().is_none_or(|cpu| cpu > 0.0));
        assert_eq!(t.total().cpu.len(), solve_repeats(&t));
    }

    fn solve_repeats(t: &Timings) -> usize {
        t.phases().iter().map(|timed| timed.cpu.len()).min().unwrap_or(0)
    }
}
