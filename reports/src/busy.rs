//! Disturbance of a machine during timed runs, and the time by which the runs of a case are compared.

use catalogue::metric;
use records::{Family, Machine, Record};

use crate::seconds::{Seconds, Took};
use crate::select::{Run, runs};

/// Times of a run. `None` for a run without times, and for an external solver, whose wall time includes its
/// start-up.
fn took(run: &Run) -> Option<Took> {
    if run.is.family == Family::External {
        return None;
    }
    let of = |kind| run.timed(kind, "total", "median");
    Some(Took { wall: of(&metric::TIME)?, cpu: of(&metric::CPU_TIME) })
}

/// Chooses the time for the runs of each case, which are adjacent.
pub(crate) fn decide(runs: &mut [Run], machine: &Machine) {
    for case in runs.chunk_by_mut(|a, b| a.is.case == b.is.case) {
        let by = Seconds::of(machine, case.iter().filter_map(took));
        case.iter_mut().for_each(|run| run.by = by);
    }
}

/// Disturbance of a machine during timed runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Busy {
    /// Number of disturbed runs.
    pub disturbed: usize,
    /// Number of timed runs.
    pub timed: usize,
    /// The most disturbed run, by a record with its case, method and id, and its times.
    pub worst: Option<(Record, Took)>,
}

impl Busy {
    /// Evaluates the runs of the records; `None` if the machine was quiet and no run was disturbed.
    pub fn of(records: &[Record], machine: &Machine) -> Option<Busy> {
        let all = runs(records);
        let took: Vec<(&Run, Took)> = all.iter().filter_map(|run| Some((run, took(run)?))).collect();
        let disturbed = || took.iter().filter_map(|(run, took)| Some((run, took, took.disturbed()?)));
        let worst = disturbed().max_by(|a, b| a.2.total_cmp(&b.2));
        (machine.quiet == Some(false) || worst.is_some()).then(|| Busy {
            disturbed: disturbed().count(),
            timed: took.len(),
            worst: worst.map(|(run, took, _)| (run.is.clone(), *took)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fronts::tests::record;

    const RUN: (&str, &str, Family) = ("jaws", "tet4", Family::Fem);

    /// Records of a run with its wall time, CPU time and shortest repeat.
    fn run(case: &str, nodes: u64, [wall, cpu, least]: [f64; 3]) -> Vec<Record> {
        let is = (case, RUN.1, RUN.2);
        let cpu = record(is, nodes, ("cpu-time", "total:median"), cpu);
        vec![
            record(is, nodes, ("time", "total:median"), wall),
            record(is, nodes, ("time", "total:min"), least),
            record(is, nodes, ("time", "total:spread"), 0.1 * wall),
            cpu,
        ]
    }

    fn totals(records: &[Record], machine: &Machine) -> Vec<f64> {
        let mut all = runs(records);
        decide(&mut all, machine);
        all.iter().filter_map(Run::total).collect()
    }

    #[test]
    fn a_disturbed_run_has_its_whole_case_compared_by_the_processors() {
        let quiet = Machine { quiet: Some(true), ..Machine::default() };
        let calm = [run("jaws", 100, [0.02, 0.021, 0.019]), run("jaws", 200, [0.04, 0.039, 0.038])].concat();
        assert_eq!(totals(&calm, &quiet), [0.02, 0.04]);
        assert_eq!(Busy::of(&calm, &quiet), None);
        // 18.8 ms of wall time for 2.86 ms of CPU time.
        let busy =
            [calm.clone(), run("jaws", 300, [0.0188, 0.00286, 0.003]), run("other", 100, [0.3, 0.3, 0.3])]
                .concat();
        assert_eq!(totals(&busy, &quiet), [0.021, 0.039, 0.00286, 0.3]);
        let found = Busy::of(&busy, &quiet).unwrap();
        let (worst, took) = found.worst.unwrap();
        assert_eq!((found.disturbed, found.timed, worst.nodes, took.wall), (1, 4, 300, 0.0188));
        // Several threads take more CPU time than wall time.
        assert_eq!(totals(&run("jaws", 100, [1.0, 3.9, 1.0]), &quiet), [1.0]);
        // In a short run, waking the threads takes as long.
        assert_eq!(totals(&run("jaws", 100, [0.0004, 0.0002, 0.0004]), &quiet), [0.0004]);
    }

    #[test]
    fn a_machine_that_was_not_quiet_is_compared_by_the_processors_and_runs_at_once_by_the_least() {
        let calm = run("jaws", 100, [0.02, 0.021, 0.019]);
        let loaded = Machine { quiet: Some(false), ..Machine::default() };
        assert_eq!(totals(&calm, &loaded), [0.021]);
        assert_eq!(Busy::of(&calm, &loaded).unwrap().disturbed, 0);
        assert_eq!(totals(&calm, &Machine { at_once: 4, ..loaded.clone() }), [0.019]);
        // Runs without CPU times keep their wall times.
        assert_eq!(totals(&calm[..3], &loaded), [0.02]);
        let mut all = runs(&calm);
        decide(&mut all, &loaded);
        assert_eq!(all[0].time("total", "spread"), None);
    }
}
