//! What every phase cost.

use super::{labelled, millimetres as milliseconds};
use crate::select::{Run, solved};
use crate::table::Column::{Number, Spread, Words};
use crate::table::{Cell, Table};
use crate::text::ratio;

const PHASES: [&str; 6] = ["prepare", "assemble", "factor", "solve", "transfer", "total"];

/// Median and spread of every phase, and peak memory.
pub(super) fn phases(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "timing",
        "Run time by phase",
        "Median ± interquartile range over repeats, no range where there was one repeat only; most memory at once beyond the input (mesh, cloud, reference). Transfer schemes have a table of their own",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("nodes", Number),
            ("points", Number),
            ("unknowns", Number),
            ("prepare [ms]", Spread),
            ("assemble [ms]", Spread),
            ("factor [ms]", Spread),
            ("solve [ms]", Spread),
            ("transfer [ms]", Spread),
            ("total [ms]", Spread),
            ("memory [MB]", Number),
        ],
    );
    let solved = solved(runs);
    for (run, label) in labelled(&solved) {
        let times: Vec<_> = PHASES.map(|p| (run.time(p, "median"), run.time(p, "spread"))).into();
        if times.iter().all(|(median, _)| median.is_none()) {
            continue;
        }
        let poisson = ratio(run.is.poisson);
        let mut cells = vec![
            Cell::Text(&run.is.case),
            Cell::Text(&poisson),
            Cell::Text(&label),
            Cell::Count(run.is.nodes),
            Cell::Count(run.is.points),
            Cell::Count(run.is.dofs),
        ];
        cells.extend(times.iter().map(|(m, s)| Cell::Spread(milliseconds(*m), milliseconds(*s))));
        cells.push(Cell::Digits(run.memory().map(|b| b / 1e6), 3));
        table.row(&cells);
    }
    table
}
