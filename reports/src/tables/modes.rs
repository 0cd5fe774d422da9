//! Free vibrations: the first frequency, and spurious modes.

use catalogue::metric::{self, Metric};

use crate::select::{Run, labelled};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths, whole};

/// Table of every run with modes.
pub(super) fn modes(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "modes",
        "Vibrations",
        "Frequency error of the mode nearest to the exact mode, with the share of its displacement that is exact; \
         largest error of the lowest frequencies in order; number of modes slower than 0.9 of the slowest exact mode; \
         rigid motions; motions without mass; critical time step of central differences",
        &[
            ("case", Words),
            ("method", Words),
            ("mass", Words),
            ("nodes", Number),
            ("unknowns", Number),
            ("frequency [%]", Number),
            ("share [%]", Number),
            ("spectrum [%]", Number),
            ("slow", Number),
            ("rigid", Number),
            ("massless", Number),
            ("critical step [ms]", Number),
        ],
    );
    for (run, label) in labelled(runs) {
        let Some(mass) = &run.is.mass else { continue };
        let percent = |of: &'static Metric| run.value(of).map(|v| v * 1e2);
        table.row(&[
            Cell::Text(&run.is.case),
            Cell::Text(&label),
            Cell::Text(mass),
            Cell::Count(run.is.nodes),
            Cell::Count(run.is.dofs),
            Cell::Digits(percent(&metric::FREQUENCY_RATIO).map(|v| v - 1e2), 3),
            Cell::Digits(percent(&metric::MODE_OVERLAP), 4),
            Cell::Digits(percent(&metric::SPECTRUM_ERROR), 3),
            whole(run.value(&metric::SLOW_MODES)),
            whole(run.value(&metric::RIGID_MODES)),
            whole(run.value(&metric::MASSLESS)),
            Cell::Digits(thousandths(run.value(&metric::CRITICAL_STEP)), 3),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::modes;
    use crate::blank::Blank as _;
    use crate::fronts::tests::record;
    use crate::select::runs;
    use records::Family;

    #[test]
    fn a_row_for_each_mass() {
        let mut records = Vec::new();
        for (mass, ratio) in [("consistent", 1.01), ("lumped", 0.5)] {
            for (quantity, value) in [("frequency-ratio", ratio), ("slow-modes", 3.0), ("rigid-modes", 6.0)] {
                let mut record = record(("cube", "tet4", Family::Fem), 100, (quantity, ":value"), value);
                record.mass = Some(mass.into());
                records.push(record.of_its_run());
            }
        }
        records.push(record(("cube", "still", Family::Fem), 100, ("l2", ":value"), 1.0));
        let table = modes(&runs(&records));
        let rows: Vec<String> = table.shown().iter().map(|row| row[2..].join(" ")).collect();
        assert_eq!(rows, ["consistent 100 300 1.00 — — 3 6 — —", "lumped 100 300 -50.0 — — 3 6 — —"]);
    }
}
