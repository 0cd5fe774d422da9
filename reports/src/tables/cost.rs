//! Growth of times and memory with the number of nodes.

use records::text::ratio;

use super::orders::labelled;
use crate::order::{Order, observed};
use crate::select::{Run, Series};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Phases with their own columns.
const PHASES: [&str; 4] = ["prepare", "assemble", "factor", "solve"];

/// Smallest ratio of the largest to the smallest size for a meaningful exponent.
const SPAN: f64 = 4.0;

/// Exponent `p` of `time ~ nodes^p` by least squares, from at least three sizes.
pub(crate) fn growth(series: &Series, phase: &str) -> Option<Order> {
    let points: Vec<(f64, f64)> = (series.runs.iter())
        .filter_map(|run| Some((1.0 / run.is.nodes as f64, run.time(phase, "median")?)))
        .collect();
    let [first, .., last] = points.as_slice() else { return None };
    // Below a microsecond, the clock's own time dominates.
    let usable = points.len() > 2 && first.0 >= SPAN * last.0 && points.iter().all(|p| p.1 > 1e-6);
    if !usable {
        return None;
    }
    observed(&points).map(|order| Order { fit: -order.fit, ..order })
}

/// Table of the growth of every phase, and of preparation time and memory per integration point at the
/// largest size.
pub(super) fn cost(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "cost",
        "Growth of cost",
        "Exponent p of time ~ nodes^p by least squares over all sizes of a method (three or more sizes that span a \
         factor of four), with its standard error; preparation time and memory beyond the input, both per integration \
         point at the largest size",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("sizes", Number),
            ("fewest nodes", Number),
            ("most nodes", Number),
            ("prepare", Number),
            ("standard error", Number),
            ("assemble", Number),
            ("factor", Number),
            ("solve", Number),
            ("prepare per point [µs]", Number),
            ("memory per point [KB]", Number),
        ],
    );
    for (label, series) in labelled(runs) {
        let orders = PHASES.map(|phase| growth(&series, phase));
        let Some(prepare) = &orders[0] else { continue };
        let least = series.runs[0].is.nodes;
        let most = series.finest().is.nodes;
        let points = Some(series.finest().is.points as f64).filter(|&points| points > 0.0);
        let per_point = |value: Option<f64>, scale: f64| points.zip(value).map(|(n, v)| scale * v / n);
        let poisson = ratio(series.is().poisson);
        let exponent = |order: &Option<Order>| Cell::Digits(order.as_ref().map(|o| o.fit), 3);
        table.row(&[
            Cell::Text(&series.is().case),
            Cell::Text(&poisson),
            Cell::Text(&label),
            Cell::Count(prepare.pairs.len() as u64 + 1),
            Cell::Count(least),
            Cell::Count(most),
            exponent(&orders[0]),
            Cell::Digits(prepare.error, 2),
            exponent(&orders[1]),
            exponent(&orders[2]),
            exponent(&orders[3]),
            Cell::Digits(per_point(series.finest().time("prepare", "median"), 1e6), 3),
            Cell::Digits(per_point(series.finest().memory(), 1e-3), 3),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::{runs, series};
    use catalogue::metric;
    use records::{Family, Record};

    fn exponent(times: &[(u64, f64)]) -> Option<f64> {
        let record = |&(nodes, value): &(u64, f64)| {
            Record {
                case: "cube".into(),
                family: Family::Efg,
                nodes,
                spacing: (nodes as f64).powf(-1.0 / 3.0),
                phase: "prepare".into(),
                statistic: "median".into(),
                value,
                ..Record::default()
            }
            .with(&metric::TIME)
            .of_its_run()
        };
        let records: Vec<Record> = times.iter().map(record).collect();
        growth(&series(&runs(&records))[0], "prepare").map(|order| order.fit)
    }

    #[test]
    fn exponents_are_those_of_the_times() {
        let quadratic = [(100, 1e-4), (300, 9e-4), (1000, 1e-2)];
        assert!((exponent(&quadratic).unwrap() - 2.0).abs() < 1e-9);
        let linear = [(1000, 2e-3), (10_000, 2e-2), (100_000, 0.2)];
        assert!((exponent(&linear).unwrap() - 1.0).abs() < 1e-9);
        // Two sizes, a narrow span, and times below the resolution of a clock.
        assert_eq!(exponent(&linear[..2]), None);
        assert_eq!(exponent(&[(100, 1e-4), (200, 2e-4), (300, 3e-4)]), None);
        assert_eq!(exponent(&[(100, 1e-7), (300, 9e-4), (1000, 1e-2)]), None);
    }
}
