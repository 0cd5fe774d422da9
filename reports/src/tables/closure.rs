//! Tool force against travel, step by step, compared with the reference and its uncertainty.

use catalogue::metric;
use records::Family;

use crate::history::{band, between, curve, reference};
use crate::select::{Run, by_material, labels, series};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Table of the finest run of every method at every step, in the order of the steps.
pub(super) fn force_closure(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "force-closure",
        "Tool force against closure",
        "Force on the first tool at every step, for the finest run of each method, with the reference force at the \
         same closure (interpolated linearly between steps), the bounds of the reference's uncertainty if known, and \
         the deviation from the reference. If no reference is recorded, the method without a deviation takes its place",
        &[
            ("case", Words),
            ("step", Number),
            ("method", Words),
            ("nodes", Number),
            ("closure [mm]", Number),
            ("force [N]", Number),
            ("reference [N]", Number),
            ("low [N]", Number),
            ("high [N]", Number),
            ("deviation [%]", Number),
            ("in the band", Words),
        ],
    );
    for case in by_material(runs) {
        let all: Vec<_> = series(case).into_iter().filter(|s| s.is().family != Family::Reference).collect();
        let names = labels(all.iter().map(|s| s.is()));
        let known = reference(case);
        let force = known.map(|r| curve(r, &metric::CLOSURE, &metric::TOOL_FORCE)).unwrap_or_default();
        let around = known.map(|r| band(r, &metric::CLOSURE, &metric::TOOL_FORCE)).unwrap_or_default();
        let low: Vec<(f64, f64)> = around.iter().map(|b| (b.0, b.1)).collect();
        let high: Vec<(f64, f64)> = around.iter().map(|b| (b.0, b.2)).collect();
        let curves: Vec<_> =
            all.iter().map(|s| curve(s.finest(), &metric::CLOSURE, &metric::TOOL_FORCE)).collect();
        // Step 0 is the start of every tool, without a force.
        for step in 1..curves.iter().map(Vec::len).max().unwrap_or(0) {
            for ((s, name), points) in all.iter().zip(&names).zip(&curves) {
                let Some(&(closure, found)) = points.get(step) else { continue };
                let [expected, low, high] = [&force, &low, &high].map(|line| between(line, closure));
                let deviation = expected.filter(|e| *e != 0.0).map(|e| 100.0 * (found / e - 1.0));
                let inside = low.zip(high).map(|(low, high)| (low..=high).contains(&found));
                table.row(&[
                    Cell::Text(&s.is().case),
                    Cell::Count(step as u64),
                    Cell::Text(name),
                    Cell::Count(s.finest().is.nodes),
                    Cell::Digits(Some(closure * 1e3), 3),
                    Cell::Digits(Some(found), 4),
                    Cell::Digits(expected, 4),
                    Cell::Digits(low, 4),
                    Cell::Digits(high, 4),
                    Cell::Digits(deviation, 3),
                    Cell::Text(inside.map_or("—", |inside| if inside { "yes" } else { "no" })),
                ]);
            }
        }
    }
    table
}
