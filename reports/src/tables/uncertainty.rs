//! Uncertainty of results by numerical error and by uncertain inputs, and the shares of the inputs.

use uncertainty::Estimate;

use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};
use crate::uncertain::{Uncertain, words};

/// Table with a row for each metric.
pub(super) fn uncertainty(all: &[Uncertain]) -> Table {
    let mut table = Table::new(
        "uncertainty",
        "Uncertainty of results",
        "Statistics over the samples of the uncertain inputs, SI units: by polynomial chaos if its Q2 (1 minus the square \
         error at samples left out of the fit, over the variance) is 0.99 or more, otherwise of the samples themselves. \
         u input: standard deviation by the inputs. u num: estimated numerical error of the scene as written. \
         u val: both together, sqrt(u num^2 + u input^2) of ASME V&V 20, to which a comparison adds u D of the \
         measurement. size: whether the numerical error is at most a tenth of u input",
        &[
            ("case", Words),
            ("method", Words),
            ("metric", Words),
            ("samples", Number),
            ("missing", Number),
            ("by", Words),
            ("Q2", Number),
            ("mean", Number),
            ("5 %", Number),
            ("median", Number),
            ("95 %", Number),
            ("u input", Number),
            ("u num", Number),
            ("u val", Number),
            ("u num / u input", Number),
            ("size", Words),
        ],
    );
    for of in all {
        let number = |value: Option<f64>| Cell::Digits(value, 4);
        let found = of.statistics.as_ref();
        let quantile = |k: usize| number(found.map(|s| s.quantiles[k].value));
        table.row(&[
            Cell::Text(&of.of.case),
            Cell::Text(&of.of.method),
            Cell::Text(&of.label()),
            Cell::Count((of.results + of.missing) as u64),
            Cell::Count(of.missing as u64),
            Cell::Text(&of.source()),
            Cell::Digits(found.and_then(|s| s.q2), 5),
            number(found.map(|s| s.mean.value)),
            quantile(0),
            quantile(1),
            quantile(2),
            number(found.map(|s| s.sd.value)),
            number(of.output.numerical),
            number(of.combined()),
            Cell::Digits(of.numerical_share(), 2),
            Cell::Text(of.advice()),
        ]);
    }
    table
}

/// Table with a row for each uncertain input of each metric.
pub(super) fn shares(all: &[Uncertain]) -> Table {
    let mut table = Table::new(
        "sobol-indices",
        "Shares of the inputs",
        "Shares of the uncertain inputs in the variance of a result (Sobol indices): of an input alone, and with its \
         interactions; with intervals of 95 %. Missing if no polynomial of degree 3 fits, or if more than a twentieth of the samples have no result",
        &[
            ("case", Words),
            ("method", Words),
            ("metric", Words),
            ("input", Words),
            ("distribution", Words),
            ("alone", Number),
            ("interval", Words),
            ("with interactions", Number),
            ("its interval", Words),
        ],
    );
    let interval = |of: &Estimate| format!("{:.4} to {:.4}", of.low, of.high);
    for of in all {
        for (at, input) in of.of.inputs.iter().enumerate() {
            let index = of.statistics.as_ref().and_then(|s| s.indices.get(at));
            table.row(&[
                Cell::Text(&of.of.case),
                Cell::Text(&of.of.method),
                Cell::Text(&of.label()),
                Cell::Text(&input.key),
                Cell::Text(&words(input)),
                Cell::Digits(index.map(|index| index.first.value), 4),
                Cell::Text(&index.map_or(String::new(), |index| interval(&index.first))),
                Cell::Digits(index.map(|index| index.total.value), 4),
                Cell::Text(&index.map_or(String::new(), |index| interval(&index.total))),
            ]);
        }
    }
    table
}
