//! Solves in the loop of a simulator after one preparation, and whether they meet visual and haptic rates.

use records::text::ratio;

use crate::fronts::{DEADLINES, Frame, RESOLUTION};
use crate::select::{Run, labelled, solved};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths};

/// Table of every run with repeated solves, with a row for each kind of result of its frames.
pub(super) fn repeated(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "repeated",
        "Repeated solves",
        "Time of one solve in a loop that is prepared once: the median and the percentiles p99 and p99.9; frames per \
         second at p99, and whether this rate suffices for haptics and for pictures. With fewer than 100 frames, p99 \
         is the slowest frame. A frame gives the displacement of all nodes, or only of the probes and loaded faces. \
         Times below 0.001 ms are not resolved: a frame is timed by two readings of the clock, which take about 50 ns",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("nodes", Number),
            ("unknowns", Number),
            ("a frame gives", Words),
            ("median [ms]", Number),
            ("p99 [ms]", Number),
            ("p99.9 [ms]", Number),
            ("frames per second", Number),
            (DEADLINES[0].name, Words),
            (DEADLINES[1].name, Words),
        ],
    );
    let solved = solved(runs);
    for (run, label) in labelled(&solved) {
        for frame in Frame::ALL {
            let median = frame.time(run, "median");
            let p99 = frame.p99(run);
            let p999 = frame.time(run, "p99.9");
            if [median, p99, p999].iter().all(Option::is_none) {
                continue;
            }
            let holds = DEADLINES.map(|d| p99.map_or("—", |t| if t <= d.seconds { "yes" } else { "no" }));
            let rate = p99.filter(|t| *t > 0.0).map(|t| 1.0 / t);
            let poisson = ratio(run.is.poisson);
            table.row(&[
                Cell::Text(&run.is.case),
                Cell::Text(&poisson),
                Cell::Text(&label),
                Cell::Count(run.is.nodes),
                Cell::Count(run.is.dofs),
                Cell::Text(match frame {
                    Frame::Field => "all nodes",
                    Frame::Probes => "probes",
                }),
                resolved(median),
                resolved(p99),
                resolved(p999),
                match rate {
                    Some(rate) if rate > 1.0 / RESOLUTION => Cell::Named("> 10⁶", rate),
                    rate => Cell::Digits(rate, 3),
                },
                Cell::Text(holds[0]),
                Cell::Text(holds[1]),
            ]);
        }
    }
    table
}

/// A time in thousandths, or a note that it is below the resolution of the clock.
fn resolved<'a>(seconds: Option<f64>) -> Cell<'a> {
    match seconds {
        Some(time) if time < RESOLUTION => Cell::Named("< 0.001", 1e3 * time),
        time => Cell::Digits(thousandths(time), 3),
    }
}

#[cfg(test)]
mod tests {
    use super::repeated;
    use crate::fronts::tests::record;
    use crate::select::runs;
    use records::Family;

    #[test]
    fn a_rate_holds_where_p99_is_within_its_period() {
        let of = ["median", "p99", "p99.9"].map(|s| format!("repeated:{s}"));
        let mut records = Vec::new();
        for (method, times) in
            [("quick", [6e-4, 1e-3, 4e-3]), ("seen", [9e-4, 0.02, 0.05]), ("slow", [0.03, 0.04, 0.04])]
        {
            let times = of.iter().zip(times);
            let is = ("loop", method, Family::Fem);
            records.extend(times.map(|(of, t)| record(is, 100, ("time", of.as_str()), t)));
        }
        // A run without a loop has no row, and missing times have no verdict.
        records.push(record(("loop", "once", Family::Fem), 100, ("time", "total:median"), 1.0));
        records.push(record(("loop", "unknown", Family::Fem), 100, ("time", "repeated:median"), 1e-4));
        // A linear problem has two rows: its probes are too fast for the clock, and it has few frames of the
        // whole field.
        for (of, t) in [
            ("condense:median", 0.01),
            ("repeated:median", 3e-7),
            ("repeated:p99", 2e-6),
            ("repeated-field:median", 0.05),
            ("repeated-field:max", 0.06),
        ] {
            records.push(record(("loop", "tiny", Family::Fem), 100, ("time", of), t));
        }
        let table = repeated(&runs(&records));
        let rows: Vec<String> = table.shown().iter().map(|row| row[2..].join(" ")).collect();
        assert_eq!(
            rows,
            [
                "quick 100 300 all nodes 0.600 1.00 4.00 1000 yes yes",
                "seen 100 300 all nodes 0.900 20.0 50.0 50.0 no yes",
                "slow 100 300 all nodes 30.0 40.0 40.0 25.0 no no",
                "tiny 100 300 probes < 0.001 0.00200 — 5.00×10⁵ yes yes",
                "tiny 100 300 all nodes 50.0 60.0 — 16.7 no no",
                "unknown 100 300 all nodes 0.100 — — — — —",
            ]
        );
    }
}
