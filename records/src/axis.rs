//! A scene varied along an axis: the outcome of each method at each value.

use serde::{Deserialize, Serialize};

use crate::text::significant;

/// Errors below this are dominated by rounding, so a doubling is not reported.
const ROUNDING: f64 = 1e-6;

/// One axis of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Case name.
    pub case: String,
    /// Name of the varied quantity.
    pub name: String,
    /// Unit of the values; empty for a dimensionless number.
    pub unit: String,
    /// Values, in order.
    pub values: Vec<f64>,
    /// Value whose errors the others are compared with.
    pub base: f64,
    /// Quantity of the error that decides.
    pub judge: String,
    /// Error from which a result is wrong.
    pub wrong: f64,
    /// Outcome of each method at each value.
    pub trials: Vec<Trial>,
}

/// Outcome of one method at one value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Method id.
    pub method: String,
    /// Value of the axis.
    pub value: f64,
    /// End of the run.
    pub ended: Ended,
    /// The deciding error, if the run has one.
    pub error: Option<f64>,
    /// Codes of the warnings.
    pub warnings: Vec<String>,
    /// Reason for missing numbers, or for those of a partial load; empty otherwise.
    pub reason: String,
}

/// End of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ended {
    /// The whole load was reached.
    Whole,
    /// A part of the load was reached, and this was reported.
    Early,
    /// There are no numbers, and the reason was reported.
    Refused,
}

/// Verdict on a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Not much worse than at the base value.
    Holds,
    /// At least twice the error at the base value.
    Bends,
    /// Wrong, with a warning.
    Warned,
    /// Ended early or refused, and reported as such.
    Refused,
    /// Wrong without a warning.
    Silent,
}

impl Verdict {
    /// Name in tables.
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

/// Boundaries of the error classes of a map, below the error from which a result is wrong.
const CLASSES: [f64; 2] = [0.01, 0.05];

impl Axis {
    /// Names of the classes of a map: the classes of errors that are not wrong, the best first, followed by
    /// the kinds of wrong results.
    pub fn classes(&self) -> Vec<String> {
        let ends = self.ends();
        let per_cent = |e: f64| significant(100.0 * e, 1 + usize::from(e >= 0.1));
        let mut out = vec![format!("below {} %", per_cent(ends[0]))];
        out.extend(ends.windows(2).map(|w| format!("{} to {} %", per_cent(w[0]), per_cent(w[1]))));
        out.extend([Verdict::Warned, Verdict::Refused, Verdict::Silent].map(|v| v.name().into()));
        out
    }

    /// Class of a trial, as an index into [`classes`](Self::classes).
    pub fn class(&self, trial: &Trial) -> usize {
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

    /// Upper bound of each class of errors that are not wrong.
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

    /// Trial of a method at a value.
    pub fn trial(&self, method: &str, value: f64) -> Option<&Trial> {
        self.trials.iter().find(|t| t.method == method && t.value == value)
    }

    /// Verdict on a trial.
    pub fn verdict(&self, trial: &Trial) -> Verdict {
        // A complete run without the deciding error is not a result either.
        let Some(error) = trial.error.filter(|_| trial.ended == Ended::Whole) else {
            return if trial.ended == Ended::Whole { Verdict::Silent } else { Verdict::Refused };
        };
        // The comparison is written so that NaN counts as wrong.
        if !(error < self.wrong) {
            return if trial.warnings.is_empty() { Verdict::Silent } else { Verdict::Warned };
        }
        let base = self.trial(&trial.method, self.base).and_then(|t| t.error);
        let bends = base.is_some_and(|base| error >= 2.0 * base.max(ROUNDING));
        if bends { Verdict::Bends } else { Verdict::Holds }
    }

    /// Number of a method's trials that are wrong without a warning.
    pub fn silent(&self, method: &str) -> usize {
        let own = self.trials.iter().filter(|t| t.method == method);
        own.filter(|t| self.verdict(t) == Verdict::Silent).count()
    }

    /// The first value at which a method's verdict is `verdict` or worse. The search starts at the base and
    /// goes to the end of the list if `up`, otherwise to its beginning.
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
