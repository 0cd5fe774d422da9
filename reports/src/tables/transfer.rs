//! Comparison of transfer schemes.

use catalogue::metric;
use records::Family;

use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths};

/// Table of error and cost of every scheme, by transferred field.
pub(super) fn schemes(runs: &[Run]) -> Table {
    let caption = "Two numbers at the target points, and the cost. The error (rms in the records) is the distance of \
                   the transferred displacement from the reference. For a prescribed field, this is the error of the \
                   transfer alone; for a method's result, the method's own error is included, which own-rows (the \
                   method's own shape functions) shows alone. The change (transfer-rms in the records) is the \
                   distance from the method's own displacement at these points, and is independent of the reference. \
                   Cost: building the weights (prepare) and applying the weights (transfer)";
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
            ("L2 error [1]", Number),
            ("RMS error x [mm]", Number),
            ("RMS error y [mm]", Number),
            ("RMS error z [mm]", Number),
            ("RMS error |u| [mm]", Number),
            ("RMS change |u| [mm]", Number),
            ("build [ms]", Number),
            ("apply [ms]", Number),
        ],
    );
    for run in runs.iter().filter(|r| r.is.family == Family::Interp) {
        let (from, settings) = carried(run);
        let [x, y, z, all] = metric::RMS.parts().map(|part| Cell::Digits(thousandths(run.value(part)), 3));
        table.row(&[
            Cell::Text(&run.is.case),
            Cell::Text(&from),
            Cell::Text(&run.is.variant),
            Cell::Text(&settings),
            Cell::Count(run.is.nodes),
            Cell::Count(run.is.points),
            Cell::Scientific(run.value(&metric::L2)),
            x,
            y,
            z,
            all,
            Cell::Digits(thousandths(run.value(&metric::TRANSFER_RMS)), 3),
            Cell::Digits(thousandths(run.time("prepare", "median")), 3),
            Cell::Digits(thousandths(run.time("transfer", "median")), 3),
        ]);
    }
    table
}

/// The method whose field a scheme transfers, and the other settings of the scheme in words.
fn carried(run: &Run) -> (String, String) {
    let own = run.is.settings().into_iter().filter(|(name, _)| *name != "from");
    let settings: Vec<String> = own.map(|(name, value)| format!("{name} {value}")).collect();
    (run.is.from.clone().unwrap_or_default(), settings.join(", "))
}
