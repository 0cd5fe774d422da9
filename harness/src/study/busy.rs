//! The warning that other programs used the processors while runs were timed.

use catalogue::warning;
use records::{Machine, Record, RunSet, Warning};
use reports::{Busy, Seconds, Took};

/// Adds a warning to results from a busy machine. It names the clock by which runs are compared instead, and
/// the deviation of the wall-clock times.
pub fn warn_if_busy(set: &mut RunSet) {
    let machine = &set.provenance.machine;
    set.warnings.extend(Busy::of(&set.records, machine).map(|busy| row(&busy, machine)));
}

fn row(busy: &Busy, machine: &Machine) -> Warning {
    let load = machine.load.filter(|_| machine.quiet == Some(false));
    let load = load.map(|load| format!("the load was {load:.1} when the runs began"));
    let (run, ratio, took) = match &busy.worst {
        Some((run, took)) => (run.clone(), took.disturbed().unwrap_or(1.0), Some(disturbed(busy, run, took))),
        None => (Record::default(), 1.0, None),
    };
    let what = load.into_iter().chain(took).collect::<Vec<_>>().join("; ");
    let compared = match Seconds::of(machine, busy.worst.iter().map(|(_, took)| *took)) {
        Seconds::Least => "for concurrent runs, the shortest repeat is compared",
        _ if machine.quiet == Some(false) => "runs are compared by CPU time",
        _ => "runs of a case with such a run are compared by CPU time",
    };
    Warning {
        case: run.case,
        method: run.method,
        run: run.run,
        code: warning::MACHINE_BUSY.code.into(),
        message: format!("other programs used the processors: {what}; {compared}"),
        value: ratio,
        unit: warning::MACHINE_BUSY.unit().into(),
        place: String::new(),
    }
}

fn disturbed(busy: &Busy, run: &Record, took: &Took) -> String {
    let [wall, cpu] = [took.wall, took.cpu.unwrap_or(took.wall)].map(|seconds| 1e3 * seconds);
    format!(
        "the wall-clock time of {} of {} timed runs was more than 1.2 times the CPU time, with the largest ratio for \
         {} with {} nodes of {}: {wall:.3} ms of wall-clock time for {cpu:.3} ms of CPU time",
        busy.disturbed, busy.timed, run.method, run.nodes, run.case
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Results of one run with its wall-clock and CPU times (s) on a machine.
    fn results(wall: f64, cpu: f64, machine: Machine) -> RunSet {
        let record = |quantity: &str, value: f64| Record {
            run: "r".into(),
            case: "block".into(),
            method: "tet4".into(),
            nodes: 75,
            quantity: quantity.into(),
            unit: "s".into(),
            phase: "total".into(),
            statistic: "median".into(),
            value,
            ..Record::default()
        };
        let mut set =
            RunSet { records: vec![record("time", wall), record("cpu-time", cpu)], ..RunSet::default() };
        set.provenance.machine = machine;
        warn_if_busy(&mut set);
        set
    }

    #[test]
    fn a_busy_machine_is_warned_of_with_its_numbers_and_a_quiet_one_is_not() {
        let quiet = Machine { load: Some(0.1), quiet: Some(true), ..Machine::default() };
        assert_eq!(results(0.0188, 0.0187, quiet.clone()).warnings, []);
        let found = results(0.0188, 0.00286, quiet.clone()).warnings.remove(0);
        assert_eq!(
            (found.code.as_str(), found.method.as_str(), found.run.as_str()),
            ("machine-busy", "tet4", "r")
        );
        assert!((found.value - 0.0188 / 0.00286).abs() < 1e-12);
        assert_eq!(
            found.message,
            "other programs used the processors: the wall-clock time of 1 of 1 timed runs was more than 1.2 times the CPU time, with the largest ratio \
             for tet4 with 75 nodes of block: 18.800 ms of wall-clock time for 2.860 ms of CPU time; runs of a case with such a run are compared by CPU time"
        );
        let loaded = Machine { load: Some(5.2), quiet: Some(false), ..quiet };
        let found = results(0.0188, 0.0187, loaded.clone()).warnings.remove(0);
        assert_eq!(
            found.message,
            "other programs used the processors: the load was 5.2 when the runs began; runs are compared by CPU time"
        );
        let found = results(0.0188, 0.0187, Machine { at_once: 2, ..loaded }).warnings.remove(0);
        assert!(
            found.message.ends_with("for concurrent runs, the shortest repeat is compared"),
            "{}",
            found.message
        );
    }
}
