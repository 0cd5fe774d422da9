//! Checks, failed runs, and what the plans skipped.

use std::collections::BTreeMap;

use crate::record::RunSet;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Every bound: failures first, then known failures, what wasn't run, and what held.
pub(super) fn checks(set: &RunSet) -> Table {
    let mut table = Table::new(
        "checks",
        "Checks",
        "Every bound on a number, in SI units, and whether it held",
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
            Cell::Text(&c.method),
            Cell::Text(&c.metric),
            Cell::Scientific(c.value),
            Cell::Text(&c.bound),
            Cell::Text(&c.reason),
        ]);
    }
    table
}

/// Runs that gave no numbers.
pub(super) fn failures(set: &RunSet) -> Table {
    let mut table = Table::new(
        "failed-runs",
        "Failed runs",
        "Runs that gave no numbers, and why",
        &[("case", Words), ("method", Words), ("reason", Words)],
    );
    for f in &set.failures {
        table.row(&[Cell::Text(&f.case), Cell::Text(&f.method), Cell::Text(&f.reason)]);
    }
    table
}

/// How often each stage ran or was skipped, by reason.
pub(super) fn plan(set: &RunSet) -> Table {
    let mut table = Table::new(
        "plan",
        "Stages run and skipped",
        "Over all runs: each stage with the reason it ran or was skipped",
        &[("stage", Words), ("outcome", Words), ("because", Words), ("runs", Number)],
    );
    let mut counts: BTreeMap<(&str, bool, &str), u64> = BTreeMap::new();
    for p in &set.plans {
        *counts.entry((&p.stage, !p.ran, &p.why)).or_default() += 1;
    }
    for ((stage, skipped, why), count) in counts {
        let outcome = if skipped { "skipped" } else { "run" };
        table.row(&[Cell::Text(stage), Cell::Text(outcome), Cell::Text(why), Cell::Count(count)]);
    }
    table
}
