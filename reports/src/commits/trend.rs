//! Trends of accuracy and time over commits, and the steps that exceed noise.

use std::fmt;

use records::{Pair, Paired, difference};
use serde::Serialize;

use super::summary::Summary;
use crate::compare::{Comparison, Ratio};

/// Relative change of an error that counts. Smaller changes may be the last bits of another compiler.
const TOLERANCE: f64 = 1e-6;
/// Error below which the result is zero up to rounding, dimensionless or in m; its changes do not count.
const ROUNDING: f64 = 1e-10;

/// Results of a study on one machine over commits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trend {
    /// File name of the study or scene.
    pub source: String,
    /// Processor and number of threads.
    pub machine: String,
    /// Points of the commits, oldest first.
    pub points: Vec<Point>,
}

/// Results of one commit; consecutive results of the same commit are combined.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// Number of the first file.
    pub number: u32,
    /// The commit, with `+` appended if the source was changed since.
    pub commit: String,
    /// Label given when the results were added; empty without one.
    pub label: String,
    /// Number of results added.
    pub results: usize,
    /// Whether the machine was quiet at the start of each result; `None` if unknown.
    pub quiet: Option<bool>,
    /// Number of runs.
    pub runs: usize,
    /// Number of checks that did not hold.
    pub checks_failed: usize,
    /// CPU time of one pass over all runs, s, with the shortest repeat of each.
    pub seconds: f64,
    /// Ratio of the CPU time to that of the first commit, for the runs that both have.
    pub seconds_ratio: Option<f64>,
    /// Geometric mean of the ratios of all errors to those of the first commit, for the errors that both
    /// have.
    pub error_ratio: Option<f64>,
    /// Changes since the previous commit; `None` for the first.
    pub step: Option<Step>,
}

impl Trend {
    /// Name in a legend.
    pub fn label(&self) -> String {
        format!("{}, {}", self.source, self.machine)
    }
}

impl Point {
    /// The label, or else the first twelve digits of the commit and its `+`.
    pub fn name(&self) -> String {
        if !self.label.is_empty() {
            return self.label.clone();
        }
        self.commit.chars().take(12).chain(self.commit.chars().skip(12).filter(|c| *c == '+')).collect()
    }

    /// Whether an error has changed significantly since the previous commit.
    pub fn errors_moved(&self) -> bool {
        self.step.as_ref().is_some_and(|step| !step.worse.is_empty() || !step.better.is_empty())
    }

    /// Whether a time has changed significantly since the previous commit.
    pub fn times_moved(&self) -> bool {
        self.step.as_ref().is_some_and(|step| !step.called.is_empty())
    }

    /// Numbers of significant changes, such as `2 errors worse, 1 time faster`; empty without any.
    pub fn moved(&self) -> String {
        let Some(step) = &self.step else { return String::new() };
        let slower = step.called.iter().filter(|ratio| ratio.ratio > 1.0).count();
        let counts = [
            (step.worse.len(), "error", "worse"),
            (step.better.len(), "error", "better"),
            (slower, "time", "slower"),
            (step.called.len() - slower, "time", "faster"),
        ];
        let counted = counts.into_iter().filter(|(count, ..)| *count > 0).map(|(count, what, how)| {
            let plural = if count == 1 { "" } else { "s" };
            format!("{count} {what}{plural} {how}")
        });
        counted.collect::<Vec<_>>().join(", ")
    }
}

/// Changes from one commit to the next.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Step {
    /// Errors that have increased, the largest increase first.
    pub worse: Vec<ErrorStep>,
    /// Errors that have decreased, the largest decrease first.
    pub better: Vec<ErrorStep>,
    /// Number of runs that no longer exist.
    pub lost: usize,
    /// Number of new runs.
    pub new: usize,
    /// Ratio of all times after to before, with the limit of noise; `None` for too few runs.
    pub times: Option<Ratio>,
    /// Significant changes of times: of all runs, and of phases, cases, methods and single runs.
    pub called: Vec<Ratio>,
}

/// A change of an error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorStep {
    /// Name of the run.
    pub run: String,
    /// Name of the error.
    pub quantity: String,
    /// Value before, SI.
    pub before: f64,
    /// Value after, SI.
    pub after: f64,
}

impl fmt::Display for ErrorStep {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "{}: {} {:.4e} -> {:.4e}", self.run, self.quantity, self.before, self.after)
    }
}

impl Step {
    /// Whether any change is significant.
    pub fn is_marked(&self) -> bool {
        !self.worse.is_empty() || !self.better.is_empty() || !self.called.is_empty()
    }

    fn between(before: &[Summary], after: &[Summary]) -> Step {
        let mut step = Step::default();
        let (Some(old), Some(new)) = (before.last(), after.last()) else { return step };
        step.lost = old.runs.keys().filter(|run| !new.runs.contains_key(*run)).count();
        step.new = new.runs.keys().filter(|run| !old.runs.contains_key(*run)).count();
        for change in errors(old, new) {
            let (a, b) = (change.before, change.after);
            if (a - b).abs() > TOLERANCE * a.abs().max(b.abs()) && a.max(b) > ROUNDING {
                if b > a { &mut step.worse } else { &mut step.better }.push(change);
            }
        }
        let size =
            |e: &ErrorStep| (e.after.max(f64::MIN_POSITIVE) / e.before.max(f64::MIN_POSITIVE)).ln().abs();
        for list in [&mut step.worse, &mut step.better] {
            list.sort_by(|a, b| size(b).total_cmp(&size(a)));
        }
        let pairs: Vec<_> = before.iter().zip(after).map(|(a, b)| (a.times(), b.times())).collect();
        if let Some(times) = Comparison::of(&pairs, TOLERANCE, true).times {
            (step.times, step.called) = (times.whole, times.called);
        }
        step
    }
}

/// Errors that two results have in common.
fn errors(old: &Summary, new: &Summary) -> Vec<ErrorStep> {
    let found = difference(&old.errors(), &new.errors()).paired.into_iter();
    let both = |Paired { run, quantity, pairs, .. }: Paired| {
        let Pair { before: Some(before), after: Some(after) } = *pairs.first()? else { return None };
        Some(ErrorStep { run, quantity, before, after })
    };
    found.filter_map(both).collect()
}

/// Trends of results, in the order in which they were added.
pub(super) fn trends(all: Vec<(u32, Summary)>) -> Vec<Trend> {
    let mut found: Vec<(String, String, Vec<Added>)> = Vec::new();
    for (number, summary) in all {
        let source = summary.source.clone();
        let machine = machine(&summary);
        let at = found.iter().position(|(s, m, _)| *s == source && *m == machine).unwrap_or_else(|| {
            found.push((source, machine, Vec::new()));
            found.len() - 1
        });
        let commits = &mut found[at].2;
        match commits.last_mut() {
            // Two results of changed sources need not be of the same source.
            Some(last)
                if !summary.program.dirty
                    && last.commit == summary.program.revision()
                    && last.label == summary.label =>
            {
                last.results.push(summary);
            }
            _ => {
                let commit = summary.program.revision();
                let label = summary.label.clone();
                commits.push(Added { number, commit, label, results: vec![summary] });
            }
        }
    }
    found
        .into_iter()
        .map(|(source, machine, commits)| Trend { source, machine, points: points(&commits) })
        .collect()
}

/// Consecutive results of one commit.
struct Added {
    number: u32,
    commit: String,
    label: String,
    results: Vec<Summary>,
}

fn machine(summary: &Summary) -> String {
    let machine = &summary.machine;
    format!("{}, {}, {} threads", machine.cpu, machine.instructions, machine.threads)
}

fn points(commits: &[Added]) -> Vec<Point> {
    let mut points = Vec::new();
    for (at, added) in commits.iter().enumerate() {
        let first = &commits[0];
        let (Some(oldest), Some(newest)) = (first.results.last(), added.results.last()) else { continue };
        let known: Option<Vec<bool>> = added.results.iter().map(|result| result.machine.quiet).collect();
        let seconds = newest.runs.keys().filter_map(|run| shortest(added, run)).sum();
        let both = newest.runs.keys().filter_map(|run| Some((shortest(first, run)?, shortest(added, run)?)));
        let (old, new) = both.fold((0.0, 0.0), |(old, new), (a, b)| (old + a, new + b));
        let before = at.checked_sub(1).map(|before| &commits[before].results);
        points.push(Point {
            number: added.number,
            commit: added.commit.clone(),
            label: added.label.clone(),
            results: added.results.len(),
            quiet: known.map(|quiet| quiet.into_iter().all(|quiet| quiet)),
            runs: newest.runs.len(),
            checks_failed: newest.checks_failed,
            seconds,
            seconds_ratio: (old > 0.0).then_some(new / old),
            error_ratio: error_ratio(oldest, newest),
            step: before.map(|before| Step::between(before, &added.results)),
        });
    }
    points
}

/// Time of a run, s: the shortest of all results of a commit.
fn shortest(added: &Added, run: &str) -> Option<f64> {
    added.results.iter().filter_map(|result| result.total(run)).reduce(f64::min)
}

fn error_ratio(first: &Summary, now: &Summary) -> Option<f64> {
    let logs: Vec<f64> = errors(first, now)
        .iter()
        .filter(|e| e.before > ROUNDING && e.after > ROUNDING)
        .map(|e| (e.after / e.before).ln())
        .collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::commits::RunNumbers;
    use records::{Machine, Program};

    /// Results of `count` runs, each of about `seconds` with some scatter, and with an error.
    fn results(commit: &str, count: usize, seconds: f64, error: f64) -> Summary {
        let run = |k: usize| {
            let time = |repeat: usize| seconds * (1.0 + 0.01 * ((7 * k + 3 * repeat) % 5) as f64);
            let numbers = RunNumbers {
                case: "block".into(),
                method: format!("m{k}"),
                errors: BTreeMap::from([("rms".into(), error)]),
                seconds: BTreeMap::from([("total".into(), vec![time(0), time(1), time(2)])]),
                ..RunNumbers::default()
            };
            (format!("block m{k}"), numbers)
        };
        Summary {
            source: "verify.toml".into(),
            program: Program { commit: commit.into(), ..Program::default() },
            machine: Machine { cpu: "a".into(), quiet: Some(true), ..Machine::default() },
            runs: (0..count).map(run).collect(),
            ..Summary::default()
        }
    }

    #[test]
    fn a_slow_down_and_a_worse_error_are_marked_and_noise_is_not() {
        let all = [
            results("a", 12, 0.1, 1e-3),
            results("b", 12, 0.101, 1e-3),
            results("c", 12, 0.15, 1e-3),
            results("d", 12, 0.15, 2e-3),
        ];
        let found = trends((1..).zip(all).collect());
        assert_eq!(found.len(), 1);
        let steps: Vec<&Step> = found[0].points.iter().filter_map(|point| point.step.as_ref()).collect();
        assert_eq!(steps.len(), 3);
        assert!(!steps[0].is_marked(), "{:?}", steps[0]);
        assert!(steps[1].times.as_ref().unwrap().called && steps[1].worse.is_empty());
        assert_eq!((steps[2].worse.len(), steps[2].called.len()), (12, 0));
        let last = found[0].points.last().unwrap();
        assert!((last.error_ratio.unwrap() - 2.0).abs() < 1e-12, "{last:?}");
        assert!((last.seconds_ratio.unwrap() - 1.5).abs() < 1e-9);
    }

    #[test]
    fn results_of_a_commit_count_together_and_another_machine_is_another_trend() {
        let mut elsewhere = results("b", 12, 0.1, 1e-3);
        elsewhere.machine.threads = 8;
        let mut busy = results("a", 12, 0.2, 1e-3);
        busy.machine.quiet = Some(false);
        let all = [results("a", 12, 0.1, 1e-3), busy, elsewhere];
        let found = trends((1..).zip(all).collect());
        assert_eq!(found.len(), 2);
        let point = &found[0].points[0];
        assert_eq!((found[0].points.len(), point.results, point.quiet), (1, 2, Some(false)));
        assert!((point.seconds - 12.0 * 0.1).abs() < 0.05);
        assert_eq!(trends(Vec::new()), []);
    }

    #[test]
    fn an_error_that_grows_from_nothing_is_worse_and_rounding_is_not() {
        let all = [1e-16, 4e-16, 1e-3].map(|error| results(&error.to_string(), 8, 0.1, error));
        let found = trends((1..).zip(all).collect());
        let steps = found[0].points.iter().filter_map(|point| point.step.as_ref());
        assert_eq!(steps.map(|step| step.worse.len()).collect::<Vec<_>>(), [0, 8]);
    }

    #[test]
    fn changed_sources_are_never_the_same() {
        let mut changed = results("a", 8, 0.1, 1e-3);
        changed.program.dirty = true;
        let found = trends((1..).zip([changed.clone(), changed]).collect());
        let points: Vec<_> = found[0].points.iter().map(|point| (point.name(), point.results)).collect();
        assert_eq!(points, [("a+".to_string(), 1), ("a+".to_string(), 1)]);
    }

    #[test]
    fn runs_that_come_and_go_are_counted() {
        let found = trends((1..).zip([results("a", 8, 0.1, 1.0), results("b", 10, 0.1, 1.0)]).collect());
        let step = found[0].points[1].step.as_ref().unwrap();
        assert_eq!((step.lost, step.new), (0, 2));
        assert!((found[0].points[1].seconds_ratio.unwrap() - 1.0).abs() < 1e-9);
    }
}
