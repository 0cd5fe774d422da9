//! Tables of checks, failed runs and skipped stages.

use std::collections::{BTreeMap, BTreeSet};

use records::RunSet;

use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Table of every check: failures first, then known failures, checks that were not run, and passes.
pub(super) fn checks(set: &RunSet) -> Table {
    let mut table = Table::new(
        "checks",
        "Checks",
        "Every bound on a number, in SI units, and its verdict",
        &[
            ("status", Words),
            ("case", Words),
            ("method", Words),
            ("number", Words),
            ("value", Number),
            ("bound", Words),
            ("reason", Words),
        ],
    );
    let order = ["fail", "known-failure", "not-run", "pass"];
    let mut checks: Vec<_> = set.checks.iter().collect();
    checks.sort_by_key(|c| order.iter().position(|o| *o == c.status.name()));
    for c in checks {
        table.row(&[
            Cell::Text(c.status.name()),
            Cell::Text(&c.case),
            Cell::Text(&once(&c.method)),
            Cell::Text(&c.metric),
            Cell::Digits(c.value, digits(&c.bound)),
            Cell::Text(&c.bound),
            Cell::Text(&c.reason),
        ]);
    }
    table
}

/// Number of digits of the bound, at least four. With fewer digits, a value could appear to violate a bound
/// that it meets.
fn digits(bound: &str) -> usize {
    let mantissa = |word: &str| {
        let number = word.split(['e', 'E']).next().unwrap_or_default();
        number.parse::<f64>().ok().map(|_| number.chars().filter(char::is_ascii_digit).count())
    };
    bound.split_whitespace().filter_map(mantissa).max().unwrap_or(0).max(4)
}

/// The words of a method without repetitions, because the method of an element often has its name.
fn once(method: &str) -> String {
    let mut words: Vec<&str> = method.split_whitespace().collect();
    words.dedup();
    words.join(" ")
}

/// Table of the runs that ended early, those without numbers first.
pub(super) fn failures(set: &RunSet) -> Table {
    let mut table = Table::new(
        "failed-runs",
        "Runs that ended early",
        "Runs without numbers, or with numbers for a part of the load only, and the reason. A partial run appears in \
         tables and figures of the states that it reached, but not in comparisons of the errors of complete runs",
        &[("result", Words), ("case", Words), ("method", Words), ("load [1]", Number), ("reason", Words)],
    );
    let mut failures: Vec<_> = set.failures.iter().collect();
    failures.sort_by_key(|f| f.carried.is_some());
    for f in failures {
        table.row(&[
            Cell::Text(if f.carried.is_some() { "partial" } else { "none" }),
            Cell::Text(&f.case),
            Cell::Text(&f.method),
            Cell::Digits(f.carried, 3),
            Cell::Text(&f.reason),
        ]);
    }
    table
}

/// Table of the warnings about the numbers of runs.
pub(super) fn warnings(set: &RunSet) -> Table {
    let mut table = Table::new(
        "warnings",
        "Warnings",
        "Runs whose numbers need care, and the reason; `tissuebench list warnings` explains the codes",
        &[
            ("case", Words),
            ("method", Words),
            ("warning", Words),
            ("value", Number),
            ("unit", Words),
            ("what", Words),
        ],
    );
    for reference in &set.references {
        for text in &reference.warnings {
            let method = format!("reference {}", reference.method);
            let case = Cell::Text(&reference.case);
            let none = Cell::Text("");
            table.row(&[
                case,
                Cell::Text(&method),
                none,
                Cell::Digits(None, 3),
                Cell::Text(""),
                Cell::Text(text),
            ]);
        }
    }
    for w in &set.warnings {
        let place = if w.place.is_empty() { String::new() } else { format!("{}: ", w.place) };
        table.row(&[
            Cell::Text(&w.case),
            Cell::Text(&w.method),
            Cell::Text(&w.code),
            Cell::Digits(Some(w.value), 3),
            Cell::Text(&w.unit),
            Cell::Text(&format!("{place}{}", w.message)),
        ]);
    }
    table
}

/// Table of the stages, with the number of runs in which each ran or was skipped, by reason.
pub(super) fn plan(set: &RunSet) -> Table {
    let mut table = Table::new(
        "plan",
        "Stages run and skipped",
        "Stages of all runs, with the reason for which each stage was run or skipped",
        &[("stage", Words), ("outcome", Words), ("because", Words), ("runs", Number)],
    );
    let mut counts: BTreeMap<(&str, bool, String), (u64, BTreeSet<u64>)> = BTreeMap::new();
    for p in &set.plans {
        let (pattern, number) = pattern(&p.why);
        let (count, numbers) = counts.entry((&p.stage, !p.ran, pattern)).or_default();
        *count += 1;
        numbers.extend(number);
    }
    for ((stage, skipped, why), (count, numbers)) in counts {
        let outcome = if skipped { "skipped" } else { "run" };
        let span = match (numbers.first(), numbers.last()) {
            (Some(low), Some(high)) if low < high => format!("{low} to {high}"),
            (Some(only), _) => only.to_string(),
            _ => String::new(),
        };
        let why = why.replacen(GAP, &span, 1);
        table.row(&[Cell::Text(stage), Cell::Text(outcome), Cell::Text(&why), Cell::Count(count)]);
    }
    table
}

/// Placeholder for the only whole number of a reason.
const GAP: char = '\u{fffc}';

/// A reason with a placeholder for its only whole number, and this number. Reasons that differ only in a
/// count share a row.
fn pattern(why: &str) -> (String, Option<u64>) {
    let words: Vec<&str> = why.split(' ').collect();
    let numbers: Vec<(usize, u64)> =
        words.iter().enumerate().filter_map(|(i, w)| Some((i, w.parse().ok()?))).collect();
    match numbers[..] {
        [(at, number)] => {
            let gap = GAP.to_string();
            let words = words.iter().enumerate().map(|(i, w)| if i == at { gap.as_str() } else { w });
            (words.collect::<Vec<_>>().join(" "), Some(number))
        }
        _ => (why.to_string(), None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use records::Failure;

    #[test]
    fn a_value_shows_the_digits_of_its_bound() {
        assert_eq!(digits("from 1.743135e-2 to 1.743145e-2"), 7);
        assert_eq!(digits("at most 1e-12"), 4);
    }

    #[test]
    fn a_partial_run_is_told_from_one_without_numbers() {
        let run = |method: &str, carried| Failure {
            case: "jaws".into(),
            method: method.into(),
            reason: "stalled".into(),
            carried,
            ..Failure::default()
        };
        let set = RunSet { failures: vec![run("tet10", Some(0.578)), run("efg", None)], ..RunSet::default() };
        assert_eq!(
            failures(&set).shown(),
            [["none", "jaws", "efg", "—", "stalled"], ["partial", "jaws", "tet10", "0.578", "stalled"]]
        );
    }

    #[test]
    fn reasons_that_differ_in_a_count_are_one() {
        let entry = |why: &str| records::PlanEntry {
            case: "a".into(),
            method: "b".into(),
            stage: "supports".into(),
            ran: true,
            why: why.into(),
        };
        let plans = ["of 83 nodes", "of 1331 nodes", "of 166 nodes", "nu = 0.3 < 0.45"].map(entry).to_vec();
        let table = plan(&RunSet { plans, ..RunSet::default() });
        assert_eq!(
            table.shown(),
            [["supports", "run", "nu = 0.3 < 0.45", "1"], ["supports", "run", "of 83 to 1331 nodes", "3"]]
        );
        assert_eq!(once("tet4 tet4 216 nodes"), "tet4 216 nodes");
    }
}
