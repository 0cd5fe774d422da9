//! A scene driven along an axis: how each method fares, from value to value.

use serde::{Deserialize, Serialize};

use crate::text::significant;

/// Below this no error is called twice as large as another: there rounding decides.
const ROUNDING: f64 = 1e-6;

/// One axis of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Case name.
    pub case: String,
    /// What is driven.
    pub name: String,
    /// Unit of its values; empty for a bare number.
    pub unit: String,
    /// Its values, in their order.
    pub values: Vec<f64>,
    /// The value that errors are compared with.
    pub base: f64,
    /// The metric that judges.
    pub judge: String,
    /// From this error on a result is wrong.
    pub wrong: f64,
    /// What became of each method at each value.
    pub trials: Vec<Trial>,
}

/// One method at one value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Method id.
    pub method: String,
    /// Value of the axis.
    pub value: f64,
    /// How the run ended.
    pub ended: Ended,
    /// The error that judges, where it gave one.
    pub error: Option<f64>,
    /// Codes of its warnings.
    pub warnings: Vec<String>,
    /// Why it has no numbers, or those of a part of the load; empty otherwise.
    pub reason: String,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ended {
    /// With the whole load.
    Whole,
    /// With a part of it, and says so.
    Early,
    /// Without numbers, and says why.
    Refused,
}

/// What a trial comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Not much worse than at the base.
    Holds,
    /// Twice the error at the base, or more.
    Bends,
    /// Wrong, with a warning.
    Warned,
    /// It ended early or was refused, and said so.
    Refused,
    /// Wrong without a word.
    Silent,
}

impl Verdict {
    /// The word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Holds => "holds",
            Verdict::Bends => "bends",
            Verdict::Warned => "wrong, warned",
            Verdict::Refused => "refused",
            Verdict::Silent => "wrong, silent",
        }
    }
}

/// Errors that part the classes of a map, below that from which a result is wrong.
const CLASSES: [f64; 2] = [0.01, 0.05];

impl Axis {
    /// Meaning of the colours of a map: classes of error that is not wrong, the best first, then the ways of
    /// being wrong.
    pub(crate) fn classes(&self) -> Vec<String> {
        let ends = self.ends();
        let per_cent = |e: f64| significant(100.0 * e, 1 + usize::from(e >= 0.1));
        let mut out = vec![format!("below {} %", per_cent(ends[0]))];
        out.extend(ends.windows(2).map(|w| format!("{} to {} %", per_cent(w[0]), per_cent(w[1]))));
        out.extend([Verdict::Warned, Verdict::Refused, Verdict::Silent].map(|v| v.name().into()));
        out
    }

    /// The class of a trial, by its place in [`classes`](Self::classes).
    pub(crate) fn class(&self, trial: &Trial) -> usize {
        let ends = self.ends();
        match self.verdict(trial) {
            Verdict::Holds | Verdict::Bends => {
                let error = trial.error.unwrap_or(0.0);
                ends.iter().position(|end| error < *end).unwrap_or(ends.len() - 1)
            }
            Verdict::Warned => ends.len(),
            Verdict::Refused => ends.len() + 1,
            Verdict::Silent => ends.len() + 2,
        }
    }

    /// The upper end of each class of error that is not wrong.
    fn ends(&self) -> Vec<f64> {
        CLASSES.into_iter().filter(|end| *end < self.wrong).chain([self.wrong]).collect()
    }

    /// Methods, in the order of their first trial.
    pub fn methods(&self) -> Vec<&str> {
        let mut out: Vec<&str> = Vec::new();
        for trial in &self.trials {
            if !out.contains(&trial.method.as_str()) {
                out.push(&trial.method);
            }
        }
        out
    }

    /// One method's trial at one value.
    pub fn trial(&self, method: &str, value: f64) -> Option<&Trial> {
        self.trials.iter().find(|t| t.method == method && t.value == value)
    }

    /// What a trial comes to.
    pub fn verdict(&self, trial: &Trial) -> Verdict {
        // A run that gave no such number is no result either.
        let Some(error) = trial.error.filter(|_| trial.ended == Ended::Whole) else {
            return if trial.ended == Ended::Whole { Verdict::Silent } else { Verdict::Refused };
        };
        // Written so that a NaN is wrong.
        if !(error < self.wrong) {
            return if trial.warnings.is_empty() { Verdict::Silent } else { Verdict::Warned };
        }
        let base = self.trial(&trial.method, self.base).and_then(|t| t.error);
        let bends = base.is_some_and(|base| error >= 2.0 * base.max(ROUNDING));
        if bends { Verdict::Bends } else { Verdict::Holds }
    }

    /// Number of a method's trials that are wrong without a word.
    pub fn silent(&self, method: &str) -> usize {
        let own = self.trials.iter().filter(|t| t.method == method);
        own.filter(|t| self.verdict(t) == Verdict::Silent).count()
    }

    /// The first value, from the base on towards `up` (to the end of the list) or back, at which a method is no better than
    /// `verdict`.
    pub fn first(&self, method: &str, verdict: Verdict, up: bool) -> Option<f64> {
        let base = self.values.iter().position(|v| *v == self.base)?;
        let way: Vec<f64> = match up {
            true => self.values[base..].to_vec(),
            false => self.values[..=base].iter().rev().copied().collect(),
        };
        way.into_iter().find(|&v| self.trial(method, v).is_some_and(|t| self.verdict(t) >= verdict))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(errors: &[(Option<f64>, &[&str])]) -> Axis {
        let trial = |(k, (error, warnings)): (usize, &(Option<f64>, &[&str]))| Trial {
            method: "a".into(),
            value: k as f64,
            ended: if error.is_some() { Ended::Whole } else { Ended::Refused },
            error: *error,
            warnings: warnings.iter().map(|w| w.to_string()).collect(),
            reason: String::new(),
        };
        Axis {
            case: "case".into(),
            name: "axis".into(),
            unit: String::new(),
            values: (0..errors.len()).map(|k| k as f64).collect(),
            base: 0.0,
            judge: "l2".into(),
            wrong: 0.25,
            trials: errors.iter().enumerate().map(trial).collect(),
        }
    }

    #[test]
    fn a_wrong_result_is_silent_unless_it_warns_or_refuses() {
        let warnings: &[&str] = &["stress-jump"];
        let axis = axis(&[
            (Some(0.01), &[]),
            (Some(0.019), &[]),
            (Some(0.021), &[]),
            (Some(0.3), warnings),
            (Some(0.3), &[]),
            (Some(f64::NAN), &[]),
            (None, &[]),
        ]);
        let verdicts: Vec<&str> = axis.trials.iter().map(|t| axis.verdict(t).name()).collect();
        let expected =
            ["holds", "holds", "bends", "wrong, warned", "wrong, silent", "wrong, silent", "refused"];
        assert_eq!(verdicts, expected);
        assert_eq!(axis.silent("a"), 2);
        assert_eq!(
            (axis.first("a", Verdict::Bends, true), axis.first("a", Verdict::Warned, true)),
            (Some(2.0), Some(3.0))
        );
        assert_eq!(axis.first("a", Verdict::Bends, false), None);
    }

    #[test]
    fn a_class_is_that_of_the_error_and_not_of_the_error_at_the_base() {
        let axis = axis(&[
            (Some(0.14), &[]),
            (Some(0.23), &[]),
            (Some(0.001), &[]),
            (Some(0.004), &[]),
            (None, &[]),
        ]);
        let named: Vec<String> = axis.trials.iter().map(|t| axis.classes()[axis.class(t)].clone()).collect();
        assert_eq!(named, ["5 to 25 %", "5 to 25 %", "below 1 %", "below 1 %", "refused"]);
        let strict = Axis { wrong: 0.05, ..axis };
        assert_eq!(strict.classes()[..3], ["below 1 %", "1 to 5 %", "wrong, warned"]);
        assert_eq!(strict.classes()[strict.class(&strict.trials[0])], "wrong, silent");
    }

    #[test]
    fn errors_of_rounding_do_not_bend() {
        let axis = axis(&[(Some(1e-15), &[]), (Some(1e-7), &[]), (Some(1e-5), &[])]);
        assert_eq!(axis.first("a", Verdict::Bends, true), Some(2.0));
    }
}
