//! Cost of every phase.

use records::Machine;
use records::text::ratio;

use crate::select::{Run, labelled, solved};
use crate::table::Column::{Number, Spread, Words};
use crate::table::{Cell, Table, thousandths};

const PHASES: [&str; 6] = ["prepare", "assemble", "factor", "solve", "transfer", "total"];

/// Table of the median and spread of every phase, and of peak memory.
pub(super) fn phases(runs: &[Run], machine: &Machine) -> Table {
    let mut table = Table::new(
        "timing",
        "Run time by phase",
        &format!(
            "On {}, {} threads. Times are wall-clock times (median ± interquartile range over repeats; no range for a \
             single repeat). If the machine was not quiet, or a run of the case had a wall-clock time of more than \
             1.2 times its CPU time, times are CPU times (median). If runs were concurrent, times are the shortest \
             wall-clock time of the repeats. The first use is the wall-clock time of a first pass that was left out of the \
             times because it used its memory for the first time: a single run takes this time. Memory is the peak of the method beyond the input (mesh, cloud, \
             reference), and the peak of the whole process. Transfer schemes have a separate table",
            machine.processor(),
            machine.threads
        ),
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("method", Words),
            ("nodes", Number),
            ("points", Number),
            ("unknowns", Number),
            ("seconds", Words),
            ("prepare [ms]", Spread),
            ("assemble [ms]", Spread),
            ("factor [ms]", Spread),
            ("solve [ms]", Spread),
            ("transfer [ms]", Spread),
            ("total [ms]", Spread),
            ("first use [ms]", Number),
            ("memory [MB]", Number),
            ("process [MB]", Number),
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
            Cell::Text(run.by.word()),
        ];
        cells.extend(times.iter().map(|(m, s)| Cell::Spread(thousandths(*m), thousandths(*s))));
        cells.push(Cell::Digits(thousandths(run.first_use()), 3));
        cells.extend(
            [run.memory(), run.memory_of_process()].map(|bytes| Cell::Digits(bytes.map(|b| b / 1e6), 3)),
        );
        table.row(&cells);
    }
    table
}
