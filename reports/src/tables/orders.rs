//! Observed orders of convergence and grid convergence indices.

use catalogue::metric::{self, Metric};
use records::text::ratio;

use crate::order;
use crate::quantity::{scale, unit};
use crate::select::{Run, Series, by_material, labels, series, solved};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Outcomes with a grid convergence index.
const OUTCOMES: [&Metric; 3] = [&metric::TIP, &metric::STRAIN_ENERGY, &metric::MAX];
/// Errors with an observed order.
const ERRORS: [&Metric; 5] =
    [&metric::L2, &metric::ENERGY, &metric::PRESSURE, &metric::RMS, &metric::MAX_ERROR];

/// Table of observed orders, by least squares and between the finest levels.
pub(super) fn observed(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "orders",
        "Observed order of convergence",
        "Slope of log error against log h by least squares with its standard error and 95 % band (Student's t), and \
         the order between the two finest levels. Asymptotic: the last two pairs agree within 0.15. Oscillatory: \
         errors grow and shrink. Divergent: errors grow at the finest levels",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("error", Words),
            ("levels", Number),
            ("theory", Number),
            ("least squares", Number),
            ("standard error", Number),
            ("95 % ±", Number),
            ("finest pair", Number),
            ("verdict", Words),
        ],
    );
    for (label, series) in labelled(runs) {
        for error in ERRORS {
            let Some(order) = order::observed(&series.points(error)) else { continue };
            let poisson = ratio(series.is().poisson);
            table.row(&[
                Cell::Text(&series.is().case),
                Cell::Text(&poisson),
                Cell::Text(&label),
                Cell::Text(error.name),
                Cell::Count(order.pairs.len() as u64 + 1),
                Cell::Digits(series.theory(error), 1),
                Cell::Digits(Some(order.fit), 3),
                Cell::Digits(order.error, 2),
                Cell::Digits(order.band, 2),
                Cell::Digits(order.pairs.last().copied(), 3),
                Cell::Text(order.verdict.map_or("two levels only", |verdict| verdict.name())),
            ]);
        }
    }
    table
}

/// Table of grid convergence indices of plain outcomes.
pub(super) fn convergence_index(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "grid-convergence",
        "Grid convergence index",
        "Results on the three finest levels: apparent order, Richardson's extrapolation and the grid convergence \
         index of the finest and the next level (safety factor 1.25); r^p GCI21 / GCI32 is 1 within 0.05 in the \
         asymptotic range. No order is defined if the changes alternate or grow. Directions with less than a \
         thousandth of the largest displacement are left out",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("outcome", Words),
            ("unit", Words),
            ("finest value", Number),
            ("order", Number),
            ("extrapolated", Number),
            ("GCI [%]", Number),
            ("next GCI [%]", Number),
            ("range ratio", Number),
            ("verdict", Words),
        ],
    );
    for (label, series) in labelled(runs) {
        for outcome in OUTCOMES.into_iter().flat_map(Metric::addresses) {
            let points: Vec<(f64, f64)> = series
                .runs
                .iter()
                .filter_map(|r| r.value(outcome).map(|v| (r.is.spacing, v)))
                .filter(|(h, _)| *h > 0.0)
                .collect();
            // In a direction that hardly moves, rounding or the asymmetry of the mesh dominates, not a
            // converging outcome.
            let still = |v: f64| v < 1e-3 * series.finest().value(&metric::MAX).unwrap_or(0.0);
            if !outcome.component.is_empty() && points.last().is_some_and(|p| still(p.1)) {
                continue;
            }
            let Some(found) = order::grid_convergence(&points) else { continue };
            let of = |value: fn(&order::Gci) -> f64| found.index.as_ref().map(value);
            let poisson = ratio(series.is().poisson);
            let (name, scale) = (outcome.to_string(), scale(outcome));
            table.row(&[
                Cell::Text(&series.is().case),
                Cell::Text(&poisson),
                Cell::Text(&label),
                Cell::Text(&name),
                Cell::Text(unit(outcome)),
                Cell::Digits(points.last().map(|p| p.1 * scale), 5),
                Cell::Digits(of(|gci| gci.order), 3),
                Cell::Digits(of(|gci| gci.extrapolated).map(|value| value * scale), 5),
                Cell::Digits(of(|gci| 100.0 * gci.fine), 3),
                Cell::Digits(of(|gci| 100.0 * gci.coarse), 3),
                Cell::Digits(of(|gci| gci.range), 3),
                Cell::Text(found.verdict.name()),
            ]);
        }
    }
    table
}

/// Solver series, each with a label that is unique within its case and Poisson's ratio.
pub(super) fn labelled<'r>(runs: &[Run<'r>]) -> Vec<(String, Series<'r>)> {
    let solved = solved(runs);
    let mut out = Vec::new();
    for group in by_material(&solved) {
        let series = series(group);
        out.extend(labels(series.iter().map(|s| s.is())).into_iter().zip(series));
    }
    out
}
