//! Tables of computed numbers next to published numbers.

use catalogue::metric;

use crate::claims::{pairs, splits};
use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths};

/// Table of published numbers: value, place, computed value and the ratio of the two.
pub(super) fn beside_ours(runs: &[Run]) -> Table {
    let caption = "Published numbers with their place in the publication, and ours for the matching discretisation. \
                   The RMS compares EFG, after the published transfer scheme, with the secondary reference of the case. \
                   The case is our interpretation of the publication; load is the fraction of the published force that \
                   was reached. Published over ours is, for a time, the factor by which ours is faster. Times of contact \
                   are compared with runs with contact only, and those of explicit dynamics with explicit dynamics only";
    let mut table = Table::new(
        "published",
        "Beside the publication",
        caption,
        &[
            ("number", Words),
            ("unit", Words),
            ("published", Number),
            ("place", Words),
            ("case", Words),
            ("our method", Words),
            ("nodes", Number),
            ("load [1]", Number),
            ("ours", Number),
            ("published over ours [1]", Number),
        ],
    );
    for pair in pairs(runs) {
        let published = &pair.number.published;
        let ours = pair.ours.map(|v| v / published.unit);
        table.row(&[
            Cell::Text(&pair.number.what),
            Cell::Text(published.unit()),
            Cell::Named(published.digits(), published.value / published.unit),
            Cell::Text(&pair.number.place),
            Cell::Text(&pair.run.is.case),
            Cell::Text(&pair.run.is.method),
            Cell::Count(pair.run.is.nodes),
            Cell::Digits(Some(pair.run.value(&metric::LOAD_CARRIED).unwrap_or(1.0)), 4),
            match ours.filter(|_| published.unit() == "1") {
                Some(count) => Cell::Count(count as u64),
                None => Cell::Digits(ours, 3),
            },
            Cell::Digits(pair.ratio(), 2),
        ]);
    }
    table
}

/// Table of the published RMS difference and its components.
pub(super) fn rms_parts(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "published-rms",
        "Components of the difference between EFG and FE",
        "RMS over the nodes of the finite elements: the whole difference, the difference without the transfer, and \
         each part alone: the transfer of a known field, the discretisation of the cloud, and the error of the \
         elements. RMS values do not add up",
        &[
            ("case", Words),
            ("difference", Words),
            ("RMS x [mm]", Number),
            ("RMS y [mm]", Number),
            ("RMS z [mm]", Number),
            ("RMS |u| [mm]", Number),
        ],
    );
    for split in splits(runs) {
        for (what, [x, y, z, all]) in split.parts() {
            table.row(&[
                Cell::Text(&split.cloud.is.case),
                Cell::Text(&what),
                Cell::Digits(thousandths(x), 3),
                Cell::Digits(thousandths(y), 3),
                Cell::Digits(thousandths(z), 3),
                Cell::Digits(thousandths(all), 3),
            ]);
        }
    }
    table
}
