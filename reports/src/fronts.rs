//! Run time against error: the questions put to runs, the kinds of time, and the Pareto front.

use catalogue::metric::{self, Address, Metric};
use records::text::significant;

use crate::order::ROUNDING;
use crate::select::Run;

/// Smallest relative error drawn; smaller errors are drawn at this value. Errors of rounding size would
/// squeeze all others into a corner.
pub(crate) const FLOOR: f64 = 1e-6;

/// A result that a user needs to be accurate.
pub(crate) struct Question {
    /// Suffix of the names of its figures; empty for the first question.
    pub(crate) ending: &'static str,
    /// Name in a sentence.
    pub(crate) name: &'static str,
    /// Relative errors that measure the result, in order of preference. A case uses one of them.
    errors: &'static [&'static Metric],
    /// Estimate of the error, which measures the result in a case without a reference.
    pub(crate) estimate: Option<&'static Metric>,
    /// Whether the result is a single number, which may be right by chance, rather than a field.
    pub(crate) scalar: bool,
}

/// Questions on the displacement field, the pressure, the tool force and the largest displacement.
pub(crate) const QUESTIONS: [Question; 4] = [
    Question {
        ending: "",
        name: "displacement",
        errors: &[&metric::L2, &metric::RELATIVE_RMS],
        estimate: Some(&metric::DISPLACEMENT_ESTIMATE),
        scalar: false,
    },
    Question {
        ending: "-pressure",
        name: "pressure",
        errors: &[&metric::PRESSURE],
        estimate: None,
        scalar: false,
    },
    Question {
        ending: "-force",
        name: "tool force",
        errors: &[&metric::TOOL_FORCE_ERROR],
        estimate: Some(&metric::TOOL_FORCE_ESTIMATE),
        scalar: true,
    },
    Question {
        ending: "-peak",
        name: "peak displacement",
        errors: &[&metric::PEAK_ERROR],
        estimate: None,
        scalar: true,
    },
];

impl Question {
    /// Whether the question is measured only by this error.
    pub(crate) fn errors_are(&self, error: &Metric) -> bool {
        self.errors == [error]
    }

    /// The error of a case, `None` if no run has one.
    ///
    /// A quantity that the scene prescribes is right with every method and answers nothing. Examples are the
    /// force of a force-driven tool (up to the tolerance of Newton's method) and a largest displacement at a
    /// support.
    pub(crate) fn error(&self, runs: &[Run]) -> Option<&'static Metric> {
        if self.errors_are(&metric::PEAK_ERROR) && is_peak_prescribed(runs) {
            return None;
        }
        let found = |error: &'static Metric| {
            let least = if error.kind == metric::Kind::Tool { FLOOR } else { 0.0 };
            runs.iter().filter_map(|run| worst(run, error)).any(|e| e > least)
        };
        let measured = |error: &'static Metric| runs.iter().any(|run| worst(run, error).is_some());
        match self.estimate {
            Some(estimate) if !self.errors.iter().copied().any(measured) => {
                Some(estimate).filter(|e| found(e))
            }
            _ => self.errors.iter().copied().find(|error| found(error)),
        }
    }

    /// The estimated error of a run beside its measured error `error`.
    pub(crate) fn estimated(&self, run: &Run, error: &'static Metric) -> Option<f64> {
        self.estimate.filter(|estimate| *estimate != error).and_then(|estimate| worst(run, estimate))
    }
}

/// Whether an error belongs to a question that the runs of a case cannot answer.
pub(crate) fn is_unanswerable(error: &Metric, runs: &[Run]) -> bool {
    QUESTIONS.iter().any(|question| question.errors.contains(&error) && question.error(runs).is_none())
}

/// Whether the largest displacement is prescribed by a support: exact to rounding although the field is not.
fn is_peak_prescribed(runs: &[Run]) -> bool {
    let Some(displacement) = QUESTIONS[0].error(runs) else { return false };
    runs.iter().any(|run| {
        run.value(&metric::PEAK_ERROR).is_some_and(|e| e < ROUNDING)
            && run.value(displacement).is_some_and(|e| e > FLOOR)
    })
}

/// A plain value, the largest for several tools.
fn worst(run: &Run, error: &'static Metric) -> Option<f64> {
    largest(error, |of| run.value(of))
}

/// Error of the reference itself in a quantity, the largest for several tools.
pub(crate) fn band(run: &Run, error: &'static Metric) -> Option<f64> {
    largest(error, |of| run.band(of))
}

fn largest(error: &'static Metric, of: impl Fn(Address) -> Option<f64>) -> Option<f64> {
    let first = of(error.whole())?;
    let others = (1..).map_while(|tool| of(error.at(tool)));
    Some(others.fold(first, f64::max))
}

/// Kind of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Clock {
    /// A complete solution of a scene: the median over repeats.
    First,
    /// One solve for all displacements in the loop of a simulator, after preparation: the 99th percentile.
    Repeated,
}

/// Smallest time of a frame that is evaluated, s.
///
/// Each frame is timed separately, between two readings of the clock. Both readings take some 50 ns, a
/// twentieth of this.
pub(crate) const RESOLUTION: f64 = 1e-6;

/// Result of each frame in a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Frame {
    /// The displacement at all nodes.
    Field,
    /// The displacement at the probes and the mean over each loaded face, by an operator condensed once.
    Probes,
}

impl Frame {
    pub(crate) const ALL: [Frame; 2] = [Frame::Probes, Frame::Field];

    /// A statistic of the times of a run's frames, s.
    pub(crate) fn time(self, run: &Run, statistic: &str) -> Option<f64> {
        let has = |phase: &str| run.time(phase, "median").is_some();
        // Only a linear problem can be condensed; Newton's method always solves for all nodes.
        let phase = match self {
            Frame::Field if has("condense") || has("repeated-field") => "repeated-field",
            Frame::Probes if !has("condense") => return None,
            Frame::Field | Frame::Probes => "repeated",
        };
        run.time(phase, statistic)
    }

    /// 99th percentile of the frame times (s), or the maximum for fewer frames.
    pub(crate) fn p99(self, run: &Run) -> Option<f64> {
        self.time(run, "p99").or_else(|| self.time(run, "max"))
    }
}

impl Clock {
    pub(crate) const ALL: [Clock; 2] = [Clock::First, Clock::Repeated];

    fn seconds(self, run: &Run) -> Option<f64> {
        match self {
            Clock::First => run.total(),
            // Every error shown refers to the field: the largest displacement also requires all nodes.
            Clock::Repeated => Frame::Field.p99(run).filter(|time| *time >= RESOLUTION),
        }
    }
}

/// Time limit of a simulator's loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deadline {
    /// Rate of the loop.
    pub(crate) name: &'static str,
    /// Purpose of the rate.
    pub(crate) what: &'static str,
    /// Period of the loop, s.
    pub(crate) seconds: f64,
}

/// Frame rates of simulators: motion looks continuous from about 30 images per second, and a stiff contact
/// feels steady from about 1000 forces per second.
pub(crate) const DEADLINES: [Deadline; 2] = [
    Deadline { name: "1 kHz", what: "haptic", seconds: 1e-3 },
    Deadline { name: "30 Hz", what: "visual", seconds: 1.0 / 30.0 },
];

/// `(seconds, relative error)` of a run that reached its whole load. An error of exactly zero belongs to the
/// reference and gives `None`.
pub(crate) fn point(run: &Run, error: &'static Metric, clock: Clock) -> Option<(f64, f64)> {
    let time = clock.seconds(run)?;
    let error = worst(run, error)?;
    (run.whole() && time > 0.0 && error > 0.0).then_some((time, error))
}

/// The same as [`point`], with an error no smaller than the error of the reference.
pub(crate) fn judged(run: &Run, error: &'static Metric, clock: Clock) -> Option<(f64, f64)> {
    let own = band(run, error).unwrap_or(0.0);
    point(run, error, clock).map(|(time, error)| (time, error.max(own)))
}

/// A single number may be right by chance. It counts as within an error only if the displacement error is
/// within this multiple of the error.
const CHANCE: f64 = 3.0;

/// Error initially selected on a page, unless no run reaches it, and used in the tables of the cheapest runs.
pub(crate) const WANTED: f64 = 0.05;

/// [`WANTED`] in words.
pub(crate) fn wanted() -> String {
    format!("{} %", significant(100.0 * WANTED, 1))
}

/// Effective error of a run's answer. For a field it is the run's own error; for a single number it is at
/// least a third of the displacement error. Neither error counts for less than the error of the reference. A
/// run answers a question within a given error if its effective error does not exceed it.
pub(crate) fn counts(
    run: &Run,
    question: &Question,
    displacement: Option<&'static Metric>,
    (quantity, error): (&'static Metric, f64),
) -> f64 {
    let known = |quantity: &'static Metric, error: f64| error.max(band(run, quantity).unwrap_or(0.0));
    let companion = displacement
        .filter(|_| question.scalar)
        .and_then(|quantity| Some(known(quantity, worst(run, quantity)?)));
    known(quantity, error).max(companion.unwrap_or(0.0) / CHANCE)
}

/// Smallest number of runs with a front; for fewer, it adds nothing to their markers.
pub(crate) const FRONT: usize = 3;

/// Runs on the Pareto front of time and error, by ascending time.
pub(crate) fn pareto<T>(runs: impl IntoIterator<Item = T>, at: impl Fn(&T) -> (f64, f64)) -> Vec<T> {
    let mut sorted: Vec<T> = runs.into_iter().collect();
    sorted.sort_by(|a, b| {
        let (a, b) = (at(a), at(b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let mut least = f64::INFINITY;
    sorted.retain(|run| {
        let error = at(run).1;
        let better = error < least;
        least = least.min(error);
        better
    });
    sorted
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::select::runs;
    use records::{Family, Record};

    /// A record of one number. `of` is its phase and statistic, separated by a colon: `time`, `total:median`.
    pub(crate) fn record(
        (case, method, family): (&str, &str, Family),
        nodes: u64,
        (quantity, of): (&str, &str),
        value: f64,
    ) -> Record {
        let (phase, statistic) = of.split_once(':').unwrap_or(("", "value"));
        Record {
            case: case.into(),
            method: method.into(),
            published: "saghaei-2016".into(),
            series: method.into(),
            family,
            variant: method.into(),
            nodes,
            dofs: 3 * nodes,
            spacing: (nodes as f64).powf(-1.0 / 3.0),
            phase: phase.into(),
            statistic: statistic.into(),
            value,
            ..Record::blank()
        }
        .named(quantity)
        .of_its_run()
    }

    /// Records of a run of `jaws`: its nodes as its size, its time in seconds, and its errors by name.
    pub(crate) fn run(is: (&str, Family), nodes: u64, seconds: f64, errors: &[(&str, f64)]) -> Vec<Record> {
        let of = ("jaws", is.0, is.1);
        let mut records = vec![record(of, nodes, ("time", "total:median"), seconds)];
        records.push(record(of, nodes, ("tool-force", ""), 1.0));
        records.extend(errors.iter().map(|(name, value)| record(of, nodes, (name, ""), *value)));
        records
    }

    #[test]
    fn the_front_drops_what_another_run_beats() {
        let runs = [(3.0, 0.1), (1.0, 0.5), (2.0, 0.6), (2.5, 0.2), (4.0, 0.1)];
        assert_eq!(pareto(runs, |r| *r), [(1.0, 0.5), (2.5, 0.2), (3.0, 0.1)]);
    }

    #[test]
    fn a_case_answers_by_the_best_error_it_has() {
        let asked = |errors: &[(&str, f64)]| {
            let records = run(("tet4", Family::Fem), 100, 1.0, errors);
            let runs = runs(&records);
            QUESTIONS.each_ref().map(|question| question.error(&runs).map(|error| error.name))
        };
        let all = [("relative-rms", 0.1), ("l2", 0.2), ("pressure", 0.3), ("peak-error", 0.4)];
        assert_eq!(asked(&all), [Some("l2"), Some("pressure"), None, Some("peak-error")]);
        assert_eq!(asked(&all[..1])[0], Some("relative-rms"));
        // The reference alone answers nothing, and neither does a prescribed force.
        assert_eq!(asked(&[("relative-rms", 0.0), ("tool-force-error", 4e-11)]), [None; 4]);
        assert_eq!(
            asked(&[("tool-force-error", 0.0), ("tool-force-error-2", 0.02)])[2],
            Some("tool-force-error")
        );
        // Estimates answer if nothing is measured.
        let estimates = [("displacement-error-estimate", 0.1), ("tool-force-error-estimate", 0.2)];
        let estimated = [Some(estimates[0].0), None, Some(estimates[1].0), None];
        assert_eq!(asked(&estimates), estimated);
        assert_eq!(asked(&[estimates[1], ("tool-force-error", 4e-11)])[2], None);
    }

    #[test]
    fn a_peak_that_a_support_prescribes_answers_nothing() {
        let asked = |peak: f64| {
            let moved = run(("tet4", Family::Fem), 100, 1.0, &[("relative-rms", 0.05), ("peak-error", peak)]);
            let weak = run(("efg", Family::Efg), 83, 1.0, &[("relative-rms", 0.04), ("peak-error", 1e-4)]);
            QUESTIONS[3].error(&runs(&[moved, weak].concat())).map(|error| error.name)
        };
        assert_eq!((asked(5e-16), asked(0.0), asked(1e-3)), (None, None, Some("peak-error")));
    }

    #[test]
    fn the_time_of_an_error_is_that_of_the_field() {
        let seconds = |times: &[(&str, f64)]| {
            let is = ("loop", "tet4", Family::Fem);
            let records: Vec<Record> =
                times.iter().map(|(of, t)| record(is, 100, ("time", of), *t)).collect();
            Clock::Repeated.seconds(&runs(&records)[0])
        };
        let probes = [("condense:median", 0.01), ("repeated:p99", 4e-7)];
        let with = |more: &[(&'static str, f64)]| seconds(&[&probes, more].concat());
        // The probes of a linear problem are not a field, however fast they are.
        assert_eq!(with(&[]), None);
        assert_eq!(with(&[("repeated-field:median", 2e-3), ("repeated-field:p99", 3e-3)]), Some(3e-3));
        // A few frames have no 99th percentile but a maximum.
        assert_eq!(with(&[("repeated-field:median", 0.06), ("repeated-field:max", 0.07)]), Some(0.07));
        assert_eq!(with(&[("repeated-field:median", 0.06)]), None);
        // A linear problem without probes and loaded faces has only its field; Newton's method always solves
        // for the field.
        assert_eq!(seconds(&[("repeated-field:median", 1e-3), ("repeated-field:p99", 2e-3)]), Some(2e-3));
        assert_eq!(seconds(&[("repeated:p99", 0.02)]), Some(0.02));
        // A time below the resolution of the clock is not used.
        assert_eq!(seconds(&[("repeated:p99", 0.9e-6)]), None);
    }

    #[test]
    fn a_number_right_by_chance_counts_as_a_third_of_the_error_of_its_field() {
        let counted = |question: &Question, errors: &[(&str, f64)], error: f64| {
            let records = run(("efg", Family::Efg), 83, 1.0, errors);
            let error = (&metric::TOOL_FORCE_ERROR, error);
            counts(&runs(&records)[0], question, Some(&metric::RELATIVE_RMS), error)
        };
        let force = &QUESTIONS[2];
        assert_eq!(counted(force, &[("relative-rms", 0.69)], 0.001), 0.69 / 3.0);
        assert_eq!(counted(force, &[("relative-rms", 0.02)], 0.01), 0.01);
        assert_eq!(counted(force, &[], 0.01), 0.01);
        // A field is not a single number.
        assert_eq!(counted(&QUESTIONS[1], &[("relative-rms", 0.69)], 0.01), 0.01);
    }

    #[test]
    fn nothing_counts_for_less_than_the_error_of_the_reference() {
        let of = ("jaws", "tet4", Family::Fem);
        let mut records = run(("tet4", Family::Fem), 100, 1.0, &[("relative-rms", 0.127)]);
        let counted = |records: &[Record], question: &Question, error: (&'static Metric, f64)| {
            counts(&runs(records)[0], question, Some(&metric::RELATIVE_RMS), error)
        };
        let displacement = (&metric::RELATIVE_RMS, 0.127);
        assert_eq!(counted(&records, &QUESTIONS[0], displacement), 0.127);
        records.push(record(of, 100, ("relative-rms", ":band"), 0.9));
        assert_eq!(counted(&records, &QUESTIONS[0], displacement), 0.9);
        // A force whose displacement error is uncertain is not counted as right either.
        assert_eq!(counted(&records, &QUESTIONS[2], (&metric::TOOL_FORCE_ERROR, 0.01)), 0.9 / 3.0);
        records.extend([
            record(of, 100, ("tool-force-error", ":band"), 0.2),
            record(of, 100, ("tool-force-error-2", ":band"), 0.4),
        ]);
        assert_eq!(counted(&records, &QUESTIONS[2], (&metric::TOOL_FORCE_ERROR, 0.01)), 0.4);
        assert_eq!(judged(&runs(&records)[0], &metric::RELATIVE_RMS, Clock::First), Some((1.0, 0.9)));
    }

    #[test]
    fn a_run_counts_if_it_was_timed_and_carried_its_load() {
        let point = |errors: &[(&str, f64)], clock| {
            let mut records = run(("tet4", Family::Fem), 100, 2.0, errors);
            records.push(record(("jaws", "tet4", Family::Fem), 100, ("time", "repeated:p99"), 0.02));
            super::point(&runs(&records)[0], &metric::TOOL_FORCE_ERROR, clock)
        };
        let two = [("tool-force-error", 0.02), ("tool-force-error-2", 0.03)];
        assert_eq!(point(&two, Clock::First), Some((2.0, 0.03)));
        assert_eq!(point(&two, Clock::Repeated), Some((0.02, 0.03)));
        assert_eq!(point(&[two[0], ("load-carried", 0.6)], Clock::First), None);
        assert_eq!(point(&[two[0], ("load-carried", 1.0)], Clock::First), Some((2.0, 0.02)));
        assert_eq!(point(&[("tool-force-error", 0.0)], Clock::First), None);
    }
}
