//! Limits of methods along the axes of a study.

use records::text::short;
use records::{Axis, AxisVerdict as Verdict, RunSet};

use crate::quantity::label_of_name;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Table with a row for each method of each axis.
pub(super) fn stability(set: &RunSet) -> Table {
    let mut table = Table::new(
        "stability",
        "Where methods bend and break",
        "Along each axis: the first values below and above the base at which the error is twice the error at the base \
         (bends), and at which the result is wrong, refused or unfinished (breaks); silent: the number of results \
         that are wrong without a warning",
        &[
            ("case", Words),
            ("axis", Words),
            ("method", Words),
            ("base", Number),
            ("error at base", Number),
            ("of", Words),
            ("bends below", Words),
            ("bends above", Words),
            ("breaks below", Words),
            ("breaks above", Words),
            ("silent", Number),
        ],
    );
    for axis in &set.axes {
        for method in axis.methods() {
            let first = |verdict, up| first(axis, method, verdict, up);
            table.row(&[
                Cell::Text(&axis.case),
                Cell::Text(&axis.name),
                Cell::Text(method),
                Cell::Digits(Some(axis.base), 4),
                Cell::Digits(axis.trial(method, axis.base).and_then(|t| t.error), 3),
                Cell::Text(&label_of_name(&axis.judge)),
                Cell::Text(&first(Verdict::Bends, false)),
                Cell::Text(&first(Verdict::Bends, true)),
                Cell::Text(&first(Verdict::Warned, false)),
                Cell::Text(&first(Verdict::Warned, true)),
                Cell::Count(axis.silent(method) as u64),
            ]);
        }
    }
    table
}

fn first(axis: &Axis, method: &str, verdict: Verdict, up: bool) -> String {
    axis.first(method, verdict, up).map_or_else(|| "—".into(), short)
}
