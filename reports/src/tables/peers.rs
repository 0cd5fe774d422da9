//! Times and errors of external solvers relative to this program's elements on the same mesh.

use catalogue::metric;
use records::Family;
use records::text::ratio;

use crate::fronts::QUESTIONS;
use crate::select::{Run, by_material};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table, thousandths};

/// Prefix of the phases that a solver reports itself.
const OWN: &str = "own-";

/// Smallest CPU time that is compared, s. CPU times of processes are measured in hundredths of a second.
const SHORTEST: f64 = 0.1;

/// Table with a row for each run of an external solver that has a counterpart of this program.
pub(super) fn peers(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "solver-times",
        "Other solvers on the same mesh",
        "Median time of all phases of this program, and of the whole process of the other solver, with its start, \
         reading and writing. Own phases: times reported by the solver itself. With a ratio above 1, this program is \
         faster. CPU times have a resolution of 0.01 s, so their ratio is left out below 0.1 s. All errors are \
         measured here: with the same elements and integration, the errors are the same",
        &[
            ("case", Words),
            ("ν [1]", Number),
            ("element", Words),
            ("nodes", Number),
            ("solver", Words),
            ("ours [ms]", Number),
            ("theirs [ms]", Number),
            ("theirs / ours", Number),
            ("CPU time / ours", Number),
            ("own phases [ms]", Number),
            ("own phases / ours", Number),
            ("error / ours", Number),
        ],
    );
    for group in by_material(runs) {
        let error = QUESTIONS[0].error(group);
        for theirs in group.iter().filter(|run| run.is.family == Family::External) {
            let Some(ours) = group.iter().find(|ours| is_same_problem(ours, theirs)) else { continue };
            let over_ours = |theirs: Option<f64>, ours: Option<f64>| Some(theirs? / ours?);
            let own = own_phases(theirs);
            let long = cpu(theirs).filter(|seconds| *seconds >= SHORTEST);
            let errors = error.map(|error| (theirs.value(error), ours.value(error)));
            let errors = errors.and_then(|(theirs, ours)| over_ours(theirs, ours));
            table.row(&[
                Cell::Text(&theirs.is.case),
                Cell::Text(&ratio(theirs.is.poisson)),
                Cell::Text(&theirs.is.variant),
                Cell::Count(theirs.is.nodes),
                Cell::Text(theirs.is.adapter.as_deref().unwrap_or_default()),
                Cell::Digits(thousandths(ours.total()), 3),
                Cell::Digits(thousandths(theirs.total()), 3),
                Cell::Digits(over_ours(theirs.total(), ours.total()), 3),
                Cell::Digits(over_ours(long, cpu(ours)), 3),
                Cell::Digits(thousandths(own), 3),
                Cell::Digits(over_ours(own, ours.total()), 3),
                Cell::Digits(errors, 4),
            ]);
        }
    }
    table
}

/// Whether a run of this program has the same mesh and elements, without measures against locking.
fn is_same_problem(ours: &Run, theirs: &Run) -> bool {
    let what = |run: &Run| {
        let is = run.is;
        (is.variant.clone(), is.nodes, is.elements, is.level, is.seed, is.at.map(f64::to_bits))
    };
    let plain = ours.is.dilation.as_deref().is_none_or(|dilation| dilation == "standard");
    ours.is.family == Family::Fem && plain && what(ours) == what(theirs)
}

/// Median CPU time of the whole run, s.
fn cpu(run: &Run) -> Option<f64> {
    run.timed(&metric::CPU_TIME, "total", "median")
}

/// Total time of the phases that a solver reports itself, s.
fn own_phases(run: &Run) -> Option<f64> {
    let own = run
        .records()
        .iter()
        .filter(|r| r.is(&metric::TIME) && r.statistic == "median" && r.phase.starts_with(OWN));
    own.map(|r| r.value).reduce(|a, b| a + b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::run;
    use crate::select::runs;
    use records::Record;

    fn with_cpu(mut records: Vec<Record>, seconds: f64) -> Vec<Record> {
        let cpu = Record { value: seconds, ..records[0].clone() }.with(&metric::CPU_TIME);
        records.push(cpu);
        records
    }

    #[test]
    fn a_solver_stands_beside_the_same_elements_of_ours() {
        let ours = with_cpu(run(("tet4", Family::Fem), 10, 0.1, &[("l2", 0.1)]), 0.2);
        let mut locked = run(("tet4-nodal", Family::Fem), 10, 0.1, &[("l2", 0.05)]);
        locked.iter_mut().for_each(|record| record.dilation = Some("nodal-mean".into()));
        let mut theirs = with_cpu(run(("tet4-ccx", Family::External), 10, 0.3, &[("l2", 0.11)]), 0.5);
        let mut own = theirs[0].clone();
        (own.phase, own.value) = ("own-solve".into(), 0.15);
        theirs.push(own);
        // A size without a run of this program.
        let alone = with_cpu(run(("tet4-ccx", Family::External), 20, 0.3, &[("l2", 0.11)]), 0.5);
        let mut records = [locked, ours, theirs, alone].concat();
        records.iter_mut().for_each(|record| record.variant = "tet4".into());
        let found = records.iter_mut().filter(|record| record.family == Family::External);
        found.for_each(|record| record.adapter = Some("calculix".into()));
        let table = peers(&runs(&records));
        let [row] = &table.shown()[..] else { panic!("{:?}", table.shown()) };
        assert_eq!(
            row[2..],
            ["tet4", "10", "calculix", "100", "300", "3.00", "2.50", "150", "1.50", "1.100"]
        );
        assert!(peers(&runs(&records[..3])).is_empty());
    }
}
