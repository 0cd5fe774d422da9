//! Constants of the scene that are fitted to a measured curve.
//!
//! ```toml
//! [fit]
//! data = "curve.csv"
//! keys = ["material.young", "tool[].friction"]
//! ```

use std::collections::BTreeMap;

use catalogue::{Dimension, Problem};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Value;
use uncertainty::Constant;

use super::check::{Bound, NumberKeys};
use super::measured::{self, Measured};
use super::report::Report;
use super::vary::{number, written};
use super::words::words;

/// Most constants of a fit. A curve hardly distinguishes more than three.
const MOST_CONSTANTS: usize = 12;

/// Constants that are fitted to a measured curve, for `tissuebench fit` and studies
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FitKeys {
    /// CSV file of the curve, relative to the folder of the scene. Its header names a metric along the curve,
    /// the measured metric, and optionally "sd", its standard deviation: closure [mm],tool-force [N],sd [N]
    data: String,
    /// Keys of the scene whose values are fitted, such as "material.young", or "tool[].friction" for every
    /// tool. The fit starts at the values in the scene
    keys: ConstantsKeys,
    /// Bounds on the results of the fit
    #[serde(default)]
    check: Vec<FitCheckKeys>,
}

/// A list of keys, or a table of keys with their allowed ranges
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
enum ConstantsKeys {
    List(Vec<String>),
    Ranges(BTreeMap<String, RangeKeys>),
}

/// Allowed range of a constant
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RangeKeys {
    /// Lowest and highest value
    #[schemars(with = "Option<[serde_json::Value; 2]>")]
    within: Option<[Value; 2]>,
}

/// A bound on a result of the fit
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FitCheckKeys {
    statistic: FitStatistic,
    /// Fitted key, for value and half-width
    key: Option<String>,
    at_least: Option<NumberKeys>,
    at_most: Option<NumberKeys>,
}

words! {
    /// Results of a fit.
    pub enum FitStatistic {
        /// Fitted value of a key.
        Value = "value",
        /// Half of the width of the 95 % interval of a key.
        HalfWidth = "half-width",
        /// Coefficient of determination.
        R2 = "r2",
        /// Root mean square of the residuals.
        Rms = "rms",
        /// Number of runs of the scene.
        Runs = "runs",
    }
}

impl FitStatistic {
    fn is_of_key(self) -> bool {
        [FitStatistic::Value, FitStatistic::HalfWidth].contains(&self)
    }
}

/// Constants that are fitted to a measured curve.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Measured curve.
    pub data: Measured,
    /// Fitted constants.
    pub keys: Vec<FittedKey>,
    /// Bounds on the results.
    pub checks: Vec<FitCheck>,
}

/// A key of the scene whose value is fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedKey {
    /// Key in the form of messages, such as `material.young`; `tool[].friction` is that of every tool.
    pub key: String,
    /// Unit of the value in the scene; empty for a bare number.
    pub unit: String,
    /// Start and allowed range, in this unit.
    pub constant: Constant,
}

/// A bound on a result of the fit.
#[derive(Clone, Debug, PartialEq)]
pub struct FitCheck {
    /// Result.
    pub statistic: FitStatistic,
    /// Fitted key, for results of a key.
    pub key: Option<String>,
    /// The bound; in the unit of the key, or SI.
    pub bound: Bound,
    /// Location in the file, `file:line`.
    pub at: String,
}

impl FittedKey {
    /// A value as TOML.
    pub fn written(&self, value: f64) -> String {
        written(value, &self.unit)
    }
}

impl FitKeys {
    pub fn read(self, report: &Report) -> Option<Fit> {
        let path = report.path(&self.data, "data");
        let data = measured::read(&path).map_err(|errors| report.add_of_file("data", errors)).ok();
        let keys: Vec<(String, String, Option<[Value; 2]>)> = match self.keys {
            ConstantsKeys::List(keys) => {
                keys.into_iter().enumerate().map(|(i, key)| (key, format!("keys[{i}]"), None)).collect()
            }
            ConstantsKeys::Ranges(keys) => keys
                .into_iter()
                .map(|(key, range)| (key.clone(), format!("keys.{key}"), range.within))
                .collect(),
        };
        let help = format!("name 1 to {MOST_CONSTANTS} keys of the scene");
        report.require((1..=MOST_CONSTANTS).contains(&keys.len()), "keys", "is out of range", &help);
        for (i, (key, at, _)) in keys.iter().enumerate() {
            let known = keys[..i].iter().any(|(other, ..)| other == key);
            report.require(!known, at, "is given already", "name each key once");
        }
        if let Some(data) = data.as_ref().filter(|data| data.y.len() <= keys.len()) {
            let problem = format!("has {} rows for {} constants", data.y.len(), keys.len());
            report.add("data", Problem::new(problem).help("give more rows than constants"));
        }
        let count = keys.len();
        let keys: Vec<FittedKey> =
            keys.into_iter().filter_map(|(key, at, within)| fitted(key, within, &report.at(&at))).collect();
        let data = data?;
        let dimension = data.of.metric.dimension;
        let check = |check: FitCheckKeys, report: &Report| check.read(&keys, dimension, report);
        let checks = report.each("check", self.check, check);
        (keys.len() == count).then_some(Fit { data, keys, checks })
    }
}

/// A fitted key with its start, which is the value in the scene.
fn fitted(key: String, within: Option<[Value; 2]>, report: &Report) -> Option<FittedKey> {
    let Some(text) = report.origin().scalar(&key) else {
        let help =
            "name a key with a number, and write it in the scene with the value at which the fit starts";
        report.add("", Problem::new("is no number of this scene").found(key).help(help));
        return None;
    };
    let value = text.parse().map_or_else(|_| Value::String(text.into()), Value::Float);
    let mut unit = None;
    let mut read =
        |value: &Value, key: &str| number(value, &mut unit).map_err(|bad| report.add(key, bad)).ok();
    let start = read(&value, "")?;
    let within = match within {
        None => None,
        Some([low, high]) => Some([read(&low, "within[0]")?, read(&high, "within[1]")?]),
    };
    if let Some([low, high]) = within {
        let holds = low < high && (low..=high).contains(&start);
        let problem = format!("doesn't hold the start, {start}");
        report.require(
            holds,
            "within",
            &problem,
            "give the lower end first, and a range that holds the value in the scene",
        );
        if !holds {
            return None;
        }
    }
    if start == 0.0 && within.is_none() {
        let help = "start at another value, or give within = [low, high], by which its steps are measured";
        report.add("", Problem::new("starts at zero, which has no scale").help(help));
        return None;
    }
    Some(FittedKey { key, unit: unit.unwrap_or_default(), constant: Constant { start, within } })
}

impl FitCheckKeys {
    fn read(self, keys: &[FittedKey], dimension: Dimension, report: &Report) -> Option<FitCheck> {
        let of_key = self.statistic.is_of_key();
        let key = keys.iter().find(|key| Some(&key.key) == self.key.as_ref());
        let help =
            if of_key { "name a key of fit.keys" } else { "it goes with value and half-width: leave it out" };
        let fits = key.is_some() == of_key && self.key.is_some() == of_key;
        report.require(fits, "key", "does not fit", help);
        if !fits {
            return None;
        }
        let read = |keys: NumberKeys| match (key, keys) {
            (Some(key), NumberKeys::Number(value)) => {
                number(&Value::Float(value), &mut Some(key.unit.clone()))
            }
            (Some(key), NumberKeys::Quantity(text)) => {
                number(&Value::String(text), &mut Some(key.unit.clone()))
            }
            (None, keys) if self.statistic == FitStatistic::Rms => keys.read(dimension),
            (None, keys) => keys.read(Dimension::None),
        };
        let bound = Bound::read(self.at_least, self.at_most, read, report)?;
        Some(FitCheck { statistic: self.statistic, key: self.key, bound, at: report.location() })
    }
}
