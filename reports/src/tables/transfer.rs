//! Transfer schemes compared.

use super::millimetres;
use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Error and cost of every scheme, by what it carried over.
pub(super) fn schemes(runs: &[Run]) -> Table {
    let all = || runs.iter().filter(|r| r.is.family == "interp");
    let mut caption = String::from(
        "Error at the target points after the transfer, and its cost: building the weights (prepare) and applying them (transfer). Of a prescribed field \
         the error is the transfer's own; of a method's result it holds the method's error too, which own-rows (the method's own shape functions) shows alone",
    );
    let lost = all().filter(|r| r.contradicts("rms")).count();
    if lost > 0 {
        caption += &format!(
            ". Left out: {lost} rows whose records contradict each other, as they don't name the kernel of the method carried over"
        );
    }
    let mut table = Table::new(
        "transfer",
        "Transfer schemes",
        &caption,
        &[
            ("case", Words),
            ("of", Words),
            ("scheme", Words),
            ("settings", Words),
            ("from nodes", Number),
            ("to points", Number),
            ("L2 [1]", Number),
            ("RMS x [mm]", Number),
            ("RMS y [mm]", Number),
            ("RMS z [mm]", Number),
            ("RMS |u| [mm]", Number),
            ("build [ms]", Number),
            ("apply [ms]", Number),
        ],
    );
    for run in all().filter(|r| !r.contradicts("rms")) {
        let (from, settings) = carried(run);
        table.row(&[
            Cell::Text(&run.is.case),
            Cell::Text(&from),
            Cell::Text(&run.is.variant),
            Cell::Text(&settings),
            Cell::Count(run.is.nodes),
            Cell::Count(run.is.points),
            Cell::Scientific(run.value("l2")),
            Cell::Digits(millimetres(run.value("rms-x")), 3),
            Cell::Digits(millimetres(run.value("rms-y")), 3),
            Cell::Digits(millimetres(run.value("rms-z")), 3),
            Cell::Digits(millimetres(run.value("rms")), 3),
            Cell::Digits(millimetres(run.time("prepare", "median")), 3),
            Cell::Digits(millimetres(run.time("transfer", "median")), 3),
        ]);
    }
    table
}

/// What a scheme carried over (a field or a method's result), and its remaining settings in words.
fn carried(run: &Run) -> (String, String) {
    let from = run.is.parameter("field").map(|f| format!("{f} field"));
    let from = from.or(run.is.parameter("from").map(str::to_string)).unwrap_or_default();
    let own = |pair: &&str| !pair.is_empty() && !pair.starts_with("from=") && !pair.starts_with("field=");
    let settings: Vec<String> =
        run.is.parameters.split(';').filter(own).map(|p| p.replace('=', " ")).collect();
    (from, settings.join(", "))
}
