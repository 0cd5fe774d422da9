//! Neighbours, conditioning and fallbacks of the meshfree methods.

use super::labelled;
use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// What the moment matrices went through.
pub(super) fn conditioning(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "conditioning",
        "Neighbours and conditioning",
        "Neighbours per integration point, condition number of the moment matrix (shifted and scaled basis), and points that needed a fallback: \
         a larger support, a regularised moment matrix, a lower order",
        &[
            ("case", Words),
            ("method", Words),
            ("kernel", Words),
            ("settings", Words),
            ("nodes", Number),
            ("neighbours min", Number),
            ("mean", Number),
            ("max", Number),
            ("condition median [1]", Number),
            ("condition max [1]", Number),
            ("enlarged", Number),
            ("regularised", Number),
            ("reduced", Number),
        ],
    );
    for (run, _) in labelled(runs) {
        if run
            .value("neighbours-mean")
            .or(run.value("condition-max"))
            .or(run.value("condition-median"))
            .is_none()
        {
            continue;
        }
        let settings = run.is.parameters.replace(';', ", ").replace('=', " ");
        let count = |quantity| Cell::Digits(run.value(quantity), 4);
        table.row(&[
            Cell::Text(&run.is.case),
            Cell::Text(&run.is.method),
            Cell::Text(&run.is.variant),
            Cell::Text(&settings),
            Cell::Count(run.is.nodes),
            whole(run.value("neighbours-min")),
            count("neighbours-mean"),
            whole(run.value("neighbours-max")),
            Cell::Scientific(run.value("condition-median")),
            Cell::Scientific(run.value("condition-max")),
            whole(run.value("fallbacks-enlarged")),
            whole(run.value("fallbacks-regularised")),
            whole(run.value("fallbacks-reduced")),
        ]);
    }
    table
}

/// A count that may be absent.
fn whole<'a>(value: Option<f64>) -> Cell<'a> {
    match value {
        Some(v) if v >= 0.0 && v.fract() == 0.0 => Cell::Count(v as u64),
        other => Cell::Digits(other, 3),
    }
}
