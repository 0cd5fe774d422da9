//! Transfer schemes compared.

use super::millimetres;
use crate::record::Family;
use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Error and cost of every scheme, by what it carried over.
pub(super) fn schemes(runs: &[Run]) -> Table {
    let caption = "Error at the target points after the transfer, and its cost: building the weights (prepare) and applying them (transfer). Of a prescribed field \
         the error is the transfer's own; of a method's result it holds the method's error too, which own-rows (the method's own shape functions) shows alone";
    let mut table = Table::new(
        "transfer",
        "Transfer schemes",
        caption,
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
    for run in runs.iter().filter(|r| r.is.family == Family::Interp) {
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

/// The method whose field a scheme carried, and its remaining settings in words.
fn carried(run: &Run) -> (String, String) {
    let own = run.is.settings().into_iter().filter(|(name, _)| *name != "from");
    let settings: Vec<String> = own.map(|(name, value)| format!("{name} {value}")).collect();
    (run.is.from.clone().unwrap_or_default(), settings.join(", "))
}
