//! Constants fitted to measured curves, and how well the curves are met.

use records::Fit;

use crate::quantity;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Table with a row for each constant.
pub(super) fn constants(fits: &[Fit]) -> Table {
    let mut table = Table::new(
        "fit",
        "Fitted constants",
        "Constants fitted to measured curves by least squares, in the units of the scene, with intervals of 95 %. An \
         interval is missing on a bound and for a constant that the curve does not determine",
        &[
            ("case", Words),
            ("method", Words),
            ("constant", Words),
            ("start", Number),
            ("fitted", Number),
            ("low", Number),
            ("high", Number),
            ("unit", Words),
            ("on a bound", Words),
        ],
    );
    for fit in fits {
        for constant in &fit.constants {
            table.row(&[
                Cell::Text(&fit.case),
                Cell::Text(&fit.method),
                Cell::Text(&constant.key),
                Cell::Digits(Some(constant.start), 5),
                Cell::Digits(Some(constant.value), 5),
                Cell::Digits(constant.interval.map(|of| of[0]), 5),
                Cell::Digits(constant.interval.map(|of| of[1]), 5),
                Cell::Text(&constant.unit),
                Cell::Text(if constant.on_bound { "yes" } else { "no" }),
            ]);
        }
    }
    table
}

/// Table with a row for each pair of constants.
pub(super) fn correlations(fits: &[Fit]) -> Table {
    let mut table = Table::new(
        "fit-correlation",
        "Correlations of fitted constants",
        "Correlations of fitted constants, by the Jacobian of the fit. Near 1 or -1 the curve does not distinguish \
         two constants",
        &[("case", Words), ("method", Words), ("constant", Words), ("other", Words), ("correlation", Number)],
    );
    for fit in fits {
        for (i, one) in fit.constants.iter().enumerate() {
            for (j, other) in fit.constants.iter().enumerate().skip(i + 1) {
                let value = fit.correlation.get(i).and_then(|row| row.get(j)).copied();
                table.row(&[
                    Cell::Text(&fit.case),
                    Cell::Text(&fit.method),
                    Cell::Text(&one.key),
                    Cell::Text(&other.key),
                    Cell::Digits(value, 4),
                ]);
            }
        }
    }
    table
}

/// Table with a row for each curve.
pub(super) fn quality(fits: &[Fit]) -> Table {
    let mut table = Table::new(
        "fit-quality",
        "Quality of fits",
        "Residuals of fits, SI units. R2: 1 minus the sum of their squares over that of the deviations from the mean. \
         chi2: their mean square over the stated standard deviations, about 1 for a right model; missing without these",
        &[
            ("case", Words),
            ("method", Words),
            ("data", Words),
            ("metric", Words),
            ("points", Number),
            ("RMS residual", Number),
            ("R2", Number),
            ("chi2", Number),
            ("runs", Number),
            ("doubts", Words),
        ],
    );
    for fit in fits {
        table.row(&[
            Cell::Text(&fit.case),
            Cell::Text(&fit.method),
            Cell::Text(&fit.data),
            Cell::Text(&quantity::label_of_name(&fit.of)),
            Cell::Count(fit.points.len() as u64),
            Cell::Digits(Some(fit.rms), 4),
            Cell::Digits(Some(fit.r2), 6),
            Cell::Digits(fit.chi2, 3),
            Cell::Count(fit.runs),
            Cell::Text(&fit.warnings.join("; ")),
        ]);
    }
    table
}
