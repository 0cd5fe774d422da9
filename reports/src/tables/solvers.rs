//! External solvers: the outcome of each on each case.

use std::collections::{BTreeMap, BTreeSet};

use records::{Family, Record, RunSet};

use crate::table::Column::Words;
use crate::table::{Cell, Table};

/// This program among the solvers; its column comes first.
const OURS: &str = "tissuebench (own)";
/// Status of a run with all its numbers.
const OK: &str = "ok";

/// Number of occurrences of each status, by case and solver.
type Ends<'a> = BTreeMap<(&'a str, &'a str), BTreeMap<&'a str, usize>>;

/// Table with a row for each case that was given to an external solver, and a column for each solver.
pub(super) fn solvers(set: &RunSet) -> Table {
    let ends = ends(set);
    let foreign: BTreeSet<&str> = ends.keys().filter(|key| key.1 != OURS).map(|key| key.1).collect();
    let cases: BTreeSet<&str> = ends.keys().filter(|key| key.1 != OURS).map(|key| key.0).collect();
    let ours = ends.keys().any(|key| key.1 == OURS && cases.contains(key.0));
    let names: Vec<&str> = ours.then_some(OURS).into_iter().chain(foreign).collect();
    let header: Vec<_> =
        std::iter::once(("case", Words)).chain(names.iter().map(|&name| (name, Words))).collect();
    let mut table = Table::new(
        "solvers",
        "Solvers and cases",
        "Status of the runs of each solver: ok; stalled before the full load; refused by the solver itself; failed or \
         timed-out; not-offered if the adapter lacks a feature of the case or the solver is not installed; stale if \
         the answer belongs to another problem. All errors are measured here; times are those of the solver's processes",
        &header,
    );
    for case in cases {
        let texts: Vec<String> = names.iter().map(|&name| text(ends.get(&(case, name)))).collect();
        let cells: Vec<Cell> =
            std::iter::once(Cell::Text(case)).chain(texts.iter().map(|text| Cell::Text(text))).collect();
        table.row(&cells);
    }
    table
}

/// Statuses with their counts, as `ok` or `ok 3, stalled 1`.
fn text(ends: Option<&BTreeMap<&str, usize>>) -> String {
    let Some(ends) = ends else { return "not run".into() };
    match ends.iter().collect::<Vec<_>>()[..] {
        [(status, 1)] => status.to_string(),
        ref several => {
            several.iter().map(|(status, n)| format!("{status} {n}")).collect::<Vec<_>>().join(", ")
        }
    }
}

fn ends(set: &RunSet) -> Ends<'_> {
    let mut ends: Ends = BTreeMap::new();
    let mut runs = BTreeSet::new();
    for record in &set.records {
        let solved = !matches!(record.family, Family::Interp | Family::Reference) && record.at.is_none();
        if solved && runs.insert(record.run.as_str()) {
            *ends.entry((&record.case, name(record))).or_default().entry(OK).or_default() += 1;
        }
    }
    for failure in &set.failures {
        let name = if failure.adapter.is_empty() { OURS } else { &failure.adapter };
        let status = if failure.status.is_empty() { "failed" } else { &failure.status };
        let of = ends.entry((&failure.case, name)).or_default();
        *of.entry(status).or_default() += 1;
        // The numbers of this run belong to a partial load.
        if let Some(ok) = of.get_mut(OK).filter(|_| failure.carried.is_some()) {
            *ok = ok.saturating_sub(1);
        }
        of.retain(|_, count| *count > 0);
    }
    ends
}

fn name(record: &Record) -> &str {
    record.adapter.as_deref().unwrap_or(OURS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::run;
    use records::Failure;

    #[test]
    fn every_end_is_counted_once_and_cases_of_our_own_are_left_out() {
        let ours = run(("tet4", Family::Fem), 10, 1.0, &[("l2", 0.1)]);
        let mut theirs = run(("ccx", Family::External), 10, 1.0, &[("l2", 0.1)]);
        theirs.extend(run(("ccx", Family::External), 20, 1.0, &[("l2", 0.1)]));
        theirs.iter_mut().for_each(|record| record.adapter = Some("calculix".into()));
        let mut alone = run(("tet4", Family::Fem), 30, 1.0, &[("l2", 0.1)]);
        alone.iter_mut().for_each(|record| record.case = "alone".into());
        let failure = |status: &str, adapter: &str, carried| Failure {
            case: "jaws".into(),
            status: status.into(),
            adapter: adapter.into(),
            carried,
            ..Failure::default()
        };
        let failures = vec![
            failure("stalled", "calculix", Some(0.5)),
            failure("not-offered", "felupe", None),
            failure("timed-out", "felupe", None),
        ];
        let records = [ours, theirs, alone].concat();
        let set = RunSet { records, failures, ..RunSet::default() };
        let table = solvers(&set);
        let header: Vec<&str> = table.header().iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(header, ["case", OURS, "calculix", "felupe"]);
        assert_eq!(table.shown(), [["jaws", "ok", "ok 1, stalled 1", "not-offered 1, timed-out 1"]]);
        assert!(solvers(&RunSet::default()).is_empty());
    }
}
