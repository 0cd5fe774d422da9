//! Loops in real time: frames that miss their deadline, and how far off they are.

use catalogue::metric;
use records::text::ratio;

use crate::select::{Run, labelled, solved};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths};

/// Table of every run with a loop in real time, with a row for each rate.
pub(super) fn real_time(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "real-time",
        "Loops in real time",
        "Frames at a fixed rate while the loading passes: those that take longer than the time between two frames, of \
         1000; the longest run of them; times of a frame; the longest time of a frame in which a tool begins to touch; and \
         the errors of force and displacement that 99 % of the frames keep, relative to the largest of the converged path",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("nodes", Number),
            ("frames per second", Number),
            ("misses of 1000", Number),
            ("longest run", Number),
            ("median [ms]", Number),
            ("p99 [ms]", Number),
            ("p99.9 [ms]", Number),
            ("max [ms]", Number),
            ("touch [ms]", Number),
            ("force error [%]", Number),
            ("displacement error [%]", Number),
        ],
    );
    let solved = solved(runs);
    for (run, label) in labelled(&solved) {
        for (index, rate) in run.rates().into_iter().enumerate() {
            let phase = format!("loop-{rate}");
            let of = |statistic: &str| run.time(&phase, statistic);
            let milliseconds = |statistic: &str| Cell::Digits(thousandths(of(statistic)), 3);
            let percent = |of| Cell::Digits(run.value(of).map(|error: f64| 100.0 * error), 3);
            let poisson = ratio(run.is.poisson);
            table.row(&[
                Cell::Text(&run.is.case),
                Cell::Text(&poisson),
                Cell::Text(&label),
                Cell::Count(run.is.nodes),
                Cell::Count(rate),
                Cell::Digits(of("misses"), 3),
                Cell::Digits(of("longest-run"), 3),
                milliseconds("median"),
                milliseconds("p99"),
                milliseconds("p99.9"),
                milliseconds("max"),
                milliseconds("touch"),
                percent(metric::LOOP_FORCE_ERROR.at(index)),
                percent(metric::LOOP_PROBE_ERROR.at(index)),
            ]);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::real_time;
    use crate::fronts::tests::record;
    use crate::select::runs;
    use records::Family;

    #[test]
    fn each_rate_has_a_row_with_its_own_errors() {
        let is = ("pressed", "tet4", Family::Fem);
        let mut records = Vec::new();
        for (of, value) in [
            ("loop-30:misses", 0.0),
            ("loop-30:median", 0.002),
            ("loop-30:max", 0.02),
            ("loop-1000:misses", 985.0),
            ("loop-1000:median", 0.0015),
            ("loop-1000:touch", 0.004),
        ] {
            records.push(record(is, 100, ("time", of), value));
        }
        records.push(record(is, 100, ("loop-force-error", "value"), 0.02));
        records.push(record(is, 100, ("loop-force-error-2", "value"), 0.01));
        // A run without a loop has no row.
        records.push(record(("pressed", "hex8", Family::Fem), 100, ("time", "total:median"), 1.0));
        let table = real_time(&runs(&records));
        let rows: Vec<String> = table.shown().iter().map(|row| row[2..].join(" ")).collect();
        assert_eq!(
            rows,
            ["tet4 100 30 0 — 2.00 — — 20.0 — 2.00 —", "tet4 100 1000 985 — 1.50 — — — 4.00 1.00 —"]
        );
    }
}
