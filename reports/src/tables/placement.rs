//! Results on clouds with the same number of nodes, placed by different seeds.

use catalogue::metric::{ENERGY, L2, MAX, Metric, PRESSURE, RMS, SMALLEST_J, TOOL_FORCE};
use records::Family;

use crate::clouds::{Clouds, Spread};
use crate::quantity::{label, scale};
use crate::select::groups;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Quantities reported if they are recorded.
const QUANTITIES: [&Metric; 7] = [&RMS, &L2, &ENERGY, &PRESSURE, &MAX, &TOOL_FORCE, &SMALLEST_J];

/// Table of the quartiles of every quantity over the clouds of a method.
pub(super) fn placement(clouds: &[Clouds]) -> Table {
    let mut table = Table::new(
        "placement",
        "Node placement",
        "The same method on clouds with the same number of nodes but different seeds: the number of clouds that \
         reached the full load, and the minimum, the quartiles and the maximum of each result. The other tables show \
         the first seed only",
        &[
            ("case", Words),
            ("method", Words),
            ("nodes", Number),
            ("clouds", Number),
            ("quantity", Words),
            ("full load", Number),
            ("minimum", Number),
            ("lower quartile", Number),
            ("median", Number),
            ("upper quartile", Number),
            ("maximum", Number),
        ],
    );
    for case in groups(clouds, |g| (g[0].is.case.clone(), g[0].is.poisson.to_bits())) {
        for group in case.iter().filter(|g| g[0].is.family != Family::Interp) {
            for quantity in QUANTITIES {
                let Some(Spread { count, quantiles }) = Spread::of(group, quantity) else { continue };
                let (name, scale) = (label(quantity), scale(quantity.whole()));
                let mut row = vec![
                    Cell::Text(&group[0].is.case),
                    Cell::Text(group[0].name()),
                    Cell::Count(group[0].is.nodes),
                    Cell::Count(group.len() as u64),
                    Cell::Text(&name),
                    Cell::Count(count as u64),
                ];
                row.extend(quantiles.map(|q| Cell::Digits(Some(q * scale), 3)));
                table.row(&row);
            }
        }
    }
    table
}
