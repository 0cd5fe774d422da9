//! Table of a study over commits.

use crate::commits::Trend;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Table with a row for each commit of each trend.
pub(super) fn over_commits(trends: &[Trend]) -> Table {
    let mut table = Table::new(
        "over-commits",
        "Commits",
        "Processor seconds of one pass over all runs, with the shortest repeat of each run; times and errors also \
         relative to the first commit, over the runs of both commits. Outside noise, relative to the previous commit: \
         errors that changed by more than a millionth, and times that a comparison of both commits reports",
        &[
            ("study", Words),
            ("machine", Words),
            ("number", Number),
            ("commit", Words),
            ("quiet", Words),
            ("runs", Number),
            ("checks failed", Number),
            ("CPU [s]", Number),
            ("CPU over the first [1]", Number),
            ("errors over the first [1]", Number),
            ("outside noise", Words),
        ],
    );
    for (trend, point) in trends.iter().flat_map(|trend| trend.points.iter().map(move |point| (trend, point)))
    {
        let quiet = point.quiet.map_or("not known", |quiet| if quiet { "yes" } else { "no" });
        table.row(&[
            Cell::Text(&trend.source),
            Cell::Text(&trend.machine),
            Cell::Count(point.number.into()),
            Cell::Text(&point.name()),
            Cell::Text(quiet),
            Cell::Count(point.runs as u64),
            Cell::Count(point.checks_failed as u64),
            Cell::Digits(Some(point.seconds), 4),
            Cell::Digits(point.seconds_ratio, 4),
            Cell::Digits(point.error_ratio, 4),
            Cell::Text(&point.moved()),
        ]);
    }
    table
}
