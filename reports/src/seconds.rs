//! The seconds by which runs are compared.
//!
//! The clock on the wall says what a user waits for, as long as no other program has the processors.
//! Otherwise it says how busy the machine was: the seconds of the processors are then nearer to what the
//! method takes. This is decided here, for all runs of a case alike.

use serde::{Deserialize, Serialize};

use crate::provenance::Machine;
use crate::record::{Family, Record};
use crate::select::{Run, runs};

/// Seconds on the wall over seconds of the processors above which other programs had the processors.
const DISTURBED: f64 = 1.2;
/// Shorter runs are not judged, s: to wake a thread takes a part of them.
const SHORTEST: f64 = 5e-3;

/// Seconds of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Seconds {
    /// On the wall, the median of the repeats.
    #[default]
    Wall,
    /// Of all processors together, the median of the repeats; on the wall where they are not known.
    Cpu,
    /// On the wall, the least of the repeats.
    Least,
}

/// Times of one run, medians of its repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Took {
    /// On the wall, s.
    pub wall: f64,
    /// Of all processors together, s; `None` where it is not known.
    pub cpu: Option<f64>,
}

impl Took {
    /// Seconds on the wall over those of the processors, where they show that other programs had the
    /// processors.
    pub fn disturbed(&self) -> Option<f64> {
        let ratio = self.wall / self.cpu.filter(|cpu| *cpu > 0.0)?;
        (self.wall >= SHORTEST && ratio > DISTURBED).then_some(ratio)
    }
}

impl Seconds {
    /// By which seconds runs are compared that were made on a machine: the clock on the wall where that was
    /// quiet and no run was disturbed, otherwise the processors. Of runs that were made at once the
    /// processors' seconds are not told apart, and the least repeat counts.
    pub fn of(machine: &Machine, took: impl IntoIterator<Item = Took>) -> Seconds {
        let mut took = took.into_iter();
        match machine {
            _ if machine.at_once > 1 => Seconds::Least,
            _ if machine.quiet == Some(false) || took.any(|run| run.disturbed().is_some()) => Seconds::Cpu,
            _ => Seconds::Wall,
        }
    }

    /// Label on an axis and in a table, without the unit.
    pub fn name(self) -> &'static str {
        match self {
            Seconds::Wall => "run time, median",
            Seconds::Cpu => "CPU time, median",
            Seconds::Least => "run time, least repeat",
        }
    }

    /// One word.
    pub fn word(self) -> &'static str {
        match self {
            Seconds::Wall => "wall",
            Seconds::Cpu => "CPU",
            Seconds::Least => "least",
        }
    }
}

/// Times of a run; `None` for a solver outside this program, whose start-up is part of its wall time, and for
/// runs that were not timed.
fn took(run: &Run) -> Option<Took> {
    if run.is.family == Family::External {
        return None;
    }
    let of = |quantity: &str| {
        let fits = |r: &&&Record| r.quantity == quantity && r.phase == "total" && r.statistic == "median";
        run.records().iter().find(fits).map(|r| r.value)
    };
    Some(Took { wall: of("time")?, cpu: of("cpu-time") })
}

/// Decides for neighbouring runs of each case by which seconds they are compared.
pub(crate) fn decide(runs: &mut [Run], machine: &Machine) {
    for case in runs.chunk_by_mut(|a, b| a.is.case == b.is.case) {
        let by = Seconds::of(machine, case.iter().filter_map(took));
        case.iter_mut().for_each(|run| run.by = by);
    }
}

/// How busy a machine was while runs were timed.
#[derive(Clone, Debug, PartialEq)]
pub struct Busy {
    /// Runs that were disturbed.
    pub disturbed: usize,
    /// Runs that were timed.
    pub timed: usize,
    /// Case, method and id of the run that was disturbed the most, and what it took.
    pub worst: Option<(Record, Took)>,
}

impl Busy {
    /// Of runs by their records; `None` where the machine was quiet and none was disturbed.
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

    /// A run of so many nodes with its seconds on the wall, of the processors and of the least repeat.
    fn run(case: &str, nodes: u64, [wall, cpu, least]: [f64; 3]) -> Vec<Record> {
        let is = (case, RUN.1, RUN.2);
        let cpu = Record { quantity: "cpu-time".into(), ..record(is, nodes, ("time", "total:median"), cpu) };
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
        // 18.8 ms for 2.86 ms of the processors.
        let busy =
            [calm.clone(), run("jaws", 300, [0.0188, 0.00286, 0.003]), run("other", 100, [0.3, 0.3, 0.3])]
                .concat();
        assert_eq!(totals(&busy, &quiet), [0.021, 0.039, 0.00286, 0.3]);
        let found = Busy::of(&busy, &quiet).unwrap();
        let (worst, took) = found.worst.unwrap();
        assert_eq!((found.disturbed, found.timed, worst.nodes, took.wall), (1, 4, 300, 0.0188));
        // More threads than one take more seconds of the processors than on the wall.
        assert_eq!(totals(&run("jaws", 100, [1.0, 3.9, 1.0]), &quiet), [1.0]);
        // Of a short run the threads are woken for as long.
        assert_eq!(totals(&run("jaws", 100, [0.0004, 0.0002, 0.0004]), &quiet), [0.0004]);
    }

    #[test]
    fn a_machine_that_was_not_quiet_is_compared_by_the_processors_and_runs_at_once_by_the_least() {
        let calm = run("jaws", 100, [0.02, 0.021, 0.019]);
        let loaded = Machine { quiet: Some(false), ..Machine::default() };
        assert_eq!(totals(&calm, &loaded), [0.021]);
        assert_eq!(Busy::of(&calm, &loaded).unwrap().disturbed, 0);
        assert_eq!(totals(&calm, &Machine { at_once: 4, ..loaded.clone() }), [0.019]);
        // Runs without processor seconds keep their wall time.
        assert_eq!(totals(&calm[..3], &loaded), [0.02]);
        let mut all = runs(&calm);
        decide(&mut all, &loaded);
        assert_eq!(all[0].time("total", "spread"), None);
    }
}
