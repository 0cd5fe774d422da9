//! Comparison of times before and after as paired ratios; only changes beyond noise are reported.
//!
//! A phase of a run is paired with itself. Its time is the shortest of its repeats, in CPU time if known,
//! which other programs disturb least. The common ratio of all runs belongs to the machine and the program.
//! It is reported if it exceeds the drift of machines, which is 2.2 % between results unless more pairs of
//! results show a smaller drift. The remaining ratio of each phase is compared with the scatter of all
//! phases.

use std::collections::{BTreeMap, HashMap};

use catalogue::metric;
use records::{Record, RunSet};
use serde::Serialize;

use super::statistics::{scale, student, trimmed_mean};

/// Smallest time compared, s; shorter times are dominated by the clock.
const SHORTEST: f64 = 20e-6;
/// Drift of a machine between two results (a standard deviation; 1.4 and 3.2 % over twenty runs, with two to
/// eight other busy processes), and its weight as a number of observations in addition to the pairs' own.
const DRIFT: f64 = 0.022;
const DRIFT_WEIGHT: usize = 8;
/// Probability of reporting the whole, or a group, by mistake.
const RISK: f64 = 0.025;
const GROUP_RISK: f64 = 0.002;
/// Smallest relevant changes: of the whole, and of a part for one pair of results and for several.
const WHOLE_LEAST: f64 = 0.02;
const PART_LEAST: [f64; 2] = [0.05, 0.03];
/// Number of standard deviations of the runs' scatter beyond which a group is reported, and of the phases'
/// scatter beyond which a single phase is. Their tails are those of Student's t with three degrees of
/// freedom, not of a Gaussian.
const GROUP_SIGMAS: f64 = 3.5;
const SINGLE_SIGMAS: f64 = 6.0;
/// Smallest total time of the repeats of a phase, s, for a report from a single pair of results. All repeats
/// of a shorter phase may have been disturbed by the same other program. On a machine with concurrent builds,
/// 104 of 6218 phases were reported by mistake, all of them shorter.
const SPAN: f64 = 0.05;
/// Smallest number of phases in a group, and of runs for any report on times.
const FEWEST: usize = 6;
/// Number of phases of similar duration whose scatter is estimated together.
const NEIGHBOURS: usize = 50;

/// Result of a comparison of times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Number of pairs of results.
    pub pairs: usize,
    /// Number of runs whose times are compared.
    pub runs: usize,
    /// Ratio of all runs together; absent if there are too few.
    pub whole: Option<Ratio>,
    /// Ratios of phases, cases and methods, relative to the common ratio.
    pub groups: Vec<Ratio>,
    /// Number of single phases of runs that were tested, relative to the common ratio.
    pub tested: usize,
    /// Ratios that exceed noise.
    pub called: Vec<Ratio>,
}

/// Set of times that a ratio belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// All runs.
    Whole,
    /// A phase of all runs.
    Phase,
    /// All runs of a case.
    Case,
    /// All runs of a method.
    Method,
    /// One phase of one run.
    Run,
}

/// Ratio of a time after to the time before.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// Set of times of the ratio.
    pub scope: Scope,
    /// Name of this set.
    pub name: String,
    /// Number of phases of runs in the mean.
    pub count: usize,
    /// Ratio after over before, relative to the common ratio except for the whole.
    pub ratio: f64,
    /// Ratio above which, or below whose inverse, the change is reported.
    pub limit: f64,
    /// Whether the change is reported.
    pub called: bool,
}

impl Ratio {
    fn new(scope: Scope, name: &str, count: usize, log: f64, limit: f64) -> Ratio {
        let ratio = log.exp();
        let called = log.abs() > limit;
        Ratio { scope, name: name.into(), count, ratio, limit: limit.exp(), called }
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, out: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(out, "{}: {:.3}, noise to {:.3}", self.name, self.ratio, self.limit)
    }
}

/// One phase of one run in all pairs.
struct Cell {
    run: String,
    case: String,
    method: String,
    phase: String,
    name: String,
    /// Time before in the first pair, s.
    seconds: f64,
    /// Logarithm of the ratio after over before, for each pair.
    logs: Vec<f64>,
    /// Times of the repeats before and after, for each pair, s.
    repeats: Vec<[Vec<f64>; 2]>,
}

impl Cell {
    fn mean(&self) -> f64 {
        self.logs.iter().sum::<f64>() / self.logs.len() as f64
    }

    /// Whether the repeats took long enough, or exist in several pairs, to be distinguished from a
    /// disturbance by another program.
    fn is_distinguished(&self) -> bool {
        let span = |times: &Vec<f64>| times.iter().sum::<f64>();
        self.repeats.len() > 1 || self.repeats.iter().flatten().all(|times| span(times) >= SPAN)
    }

    /// Whether in every pair all repeats after lie on one side of all repeats before, shifted by the common
    /// ratio.
    fn is_apart(&self, common: &[f64], slower: bool) -> bool {
        let ends = |times: &[f64]| {
            times.iter().fold((f64::MAX, 0.0f64), |(low, high), &t| (low.min(t), high.max(t)))
        };
        self.repeats.iter().zip(common).all(|([before, after], common)| {
            let before = ends(before);
            let after = ends(after);
            let common = common.exp();
            if slower { after.0 > before.1 * common } else { after.1 < before.0 * common }
        })
    }
}

impl Times {
    /// Compares the times of pairs of results, before and after a change.
    pub(super) fn of(pairs: &[(RunSet, RunSet)]) -> Times {
        let cells = cells(pairs);
        let totals: Vec<&Cell> = cells.iter().filter(|cell| cell.phase == TOTAL).collect();
        let mut times = Times {
            pairs: pairs.len(),
            runs: totals.len(),
            whole: None,
            groups: Vec::new(),
            tested: 0,
            called: Vec::new(),
        };
        if totals.len() < FEWEST {
            return times;
        }
        let common = common(&totals, pairs.len());
        let drift = common.iter().sum::<f64>() / common.len() as f64;
        let whole = whole(&totals, &common, drift);
        let beside: Vec<f64> = cells.iter().map(|cell| cell.mean() - drift).collect();
        times.groups = groups(&cells, &beside, pairs.len());
        let singles = singles(&cells, &beside, &common);
        times.tested = singles.len();
        let all = std::iter::once(&whole).chain(&times.groups).chain(&singles);
        times.called = all.filter(|ratio| ratio.called).cloned().collect();
        times.whole = Some(whole);
        times
    }
}

const TOTAL: &str = "total";

/// Logarithm of the common ratio of all runs, in each pair.
fn common(totals: &[&Cell], pairs: usize) -> Vec<f64> {
    let of = |pair: usize| totals.iter().map(|cell| cell.logs[pair]).collect::<Vec<f64>>();
    (0..pairs).map(|pair| trimmed_mean(&of(pair)).map_or(0.0, |found| found.mean)).collect()
}

/// Ratio of all runs, with a limit from the drift of the machine and the scatter of the runs.
fn whole(totals: &[&Cell], common: &[f64], drift: f64) -> Ratio {
    let pairs = common.len();
    let own: f64 = common.iter().map(|c| (c - drift).powi(2)).sum();
    let freedom = pairs - 1 + DRIFT_WEIGHT;
    let deviation = ((own + DRIFT_WEIGHT as f64 * DRIFT * DRIFT) / freedom as f64).sqrt();
    let of_machine = student(freedom, RISK) * deviation / (pairs as f64).sqrt();
    let means: Vec<f64> = totals.iter().map(|cell| cell.mean()).collect();
    let of_runs = trimmed_mean(&means).map_or(0.0, |found| found.band(RISK));
    let limit = WHOLE_LEAST.max(of_machine).max(of_runs);
    Ratio::new(Scope::Whole, "all runs", totals.len(), drift, limit)
}

/// Ratios of phases, cases and methods with at least six phases of runs, relative to the common ratio.
fn groups(cells: &[Cell], beside: &[f64], pairs: usize) -> Vec<Ratio> {
    let mut of_run: HashMap<&str, Vec<f64>> = HashMap::new();
    let mut groups: BTreeMap<(u8, &str), (Scope, Vec<usize>)> = BTreeMap::new();
    for (at, cell) in cells.iter().enumerate().filter(|(_, cell)| cell.phase != TOTAL) {
        of_run.entry(&cell.run).or_default().push(beside[at]);
        let names = [(Scope::Phase, &cell.phase), (Scope::Case, &cell.case), (Scope::Method, &cell.method)];
        for (scope, name) in names {
            groups.entry((scope as u8, name)).or_insert((scope, Vec::new())).1.push(at);
        }
    }
    let means: Vec<f64> = of_run.values().map(|all| all.iter().sum::<f64>() / all.len() as f64).collect();
    let run_scale = scale(&means);
    let least = PART_LEAST[usize::from(pairs > 2)];
    let each = groups.into_iter().filter_map(|((_, name), (scope, members))| {
        let values: Vec<f64> = members.iter().map(|&at| beside[at]).collect();
        let found = trimmed_mean(&values).filter(|_| values.len() >= FEWEST)?;
        let mut runs: Vec<&str> = members.iter().map(|&at| cells[at].run.as_str()).collect();
        runs.sort_unstable();
        runs.dedup();
        // The phases of one run are correlated, so the number of runs decides, not the number of phases.
        let of_runs = GROUP_SIGMAS * run_scale / (runs.len() as f64).sqrt();
        let limit = least.max(found.band(GROUP_RISK)).max(of_runs);
        Some(Ratio::new(scope, name, values.len(), found.mean, limit))
    });
    each.collect()
}

/// Single phases of runs that far exceed the scatter of phases of similar duration and whose repeats do not
/// overlap with those before.
fn singles(cells: &[Cell], beside: &[f64], common: &[f64]) -> Vec<Ratio> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by(|&a, &b| cells[a].seconds.total_cmp(&cells[b].seconds));
    let sorted: Vec<f64> = order.iter().map(|&at| beside[at]).collect();
    let all = scale(beside);
    let near = |rank: usize| {
        let count = NEIGHBOURS.min(sorted.len());
        let low = rank.saturating_sub(count / 2).min(sorted.len() - count);
        scale(&sorted[low..low + count])
    };
    let one = |(rank, &at): (usize, &usize)| {
        let cell = &cells[at];
        let log = beside[at];
        let limit = PART_LEAST[0].max(SINGLE_SIGMAS * all.max(near(rank)));
        let mut ratio = Ratio::new(Scope::Run, &cell.name, 1, log, limit);
        ratio.called &= cell.is_apart(common, log > 0.0);
        ratio
    };
    let tested = order.iter().enumerate().filter(|(_, at)| cells[**at].is_distinguished());
    tested.map(one).collect()
}

/// Phases that have times in all results.
fn cells(pairs: &[(RunSet, RunSet)]) -> Vec<Cell> {
    let timed: Vec<[BTreeMap<(&str, &str), Timed>; 2]> =
        pairs.iter().map(|(a, b)| [timed(&a.records), timed(&b.records)]).collect();
    let Some([first, _]) = timed.first() else { return Vec::new() };
    let cell = |(key, one): (&(&str, &str), &Timed)| {
        let mut repeats = Vec::new();
        for [before, after] in &timed {
            repeats.push([before.get(key)?.best(), after.get(key)?.best()]);
        }
        let shortest = |times: &Vec<f64>| times.iter().copied().fold(f64::MAX, f64::min);
        let short = repeats.iter().flatten().any(|times| times.is_empty() || shortest(times) < SHORTEST);
        let log = |[before, after]: &[Vec<f64>; 2]| (shortest(after) / shortest(before)).ln();
        (!short).then(|| Cell {
            run: one.is.run.clone(),
            case: one.is.case.clone(),
            method: one.is.method.clone(),
            phase: one.is.phase.clone(),
            name: name(one.is),
            seconds: shortest(&repeats[0][0]),
            logs: repeats.iter().map(log).collect(),
            repeats,
        })
    };
    first.iter().filter_map(cell).collect()
}

/// Name of a phase: case, method, size and Poisson's ratio of the run, and the phase.
fn name(r: &Record) -> String {
    let mut name = format!("{} {}", r.case, r.method);
    if r.level > 0 {
        name += &format!(" level {}", r.level);
    }
    format!("{name} {} nodes nu={} {}", r.nodes, r.poisson, r.phase)
}

/// Times of the repeats of a phase, s.
struct Timed<'a> {
    is: &'a Record,
    wall: Vec<f64>,
    cpu: Vec<f64>,
}

impl Timed<'_> {
    /// CPU times if known, otherwise wall times.
    fn best(&self) -> Vec<f64> {
        if self.cpu.is_empty() { self.wall.clone() } else { self.cpu.clone() }
    }
}

fn timed(records: &[Record]) -> BTreeMap<(&str, &str), Timed<'_>> {
    let mut found: BTreeMap<(&str, &str), Timed> = BTreeMap::new();
    let repeat = |r: &&Record| r.statistic == "repeat" && r.step.is_none() && !r.phase.is_empty();
    for r in records.iter().filter(repeat) {
        let timed = found.entry((r.run.as_str(), r.phase.as_str()));
        let timed = timed.or_insert(Timed { is: r, wall: Vec::new(), cpu: Vec::new() });
        if r.is(&metric::TIME) {
            timed.wall.push(r.value);
        } else if r.is(&metric::CPU_TIME) {
            timed.cpu.push(r.value);
        }
    }
    found
}

#[cfg(test)]
mod tests;
