//! Uncertain inputs: keys of the scene with the distributions of their values.
//!
//! ```toml
//! [vary]
//! samples = 60
//! of = ["tool-force"]
//!
//! [vary.keys]
//! "material.young" = { lognormal = { mean = "20 kPa", sd = "2 kPa" } }
//! "tool[].friction" = { uniform = [0.1, 0.2] }
//! ```

use std::collections::{BTreeMap, BTreeSet};

use catalogue::metric::{self, Address, Needs};
use catalogue::{Dimension, Problem, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Value;
use uncertainty::{Distribution, MOST_INPUTS, MOST_SAMPLES, point};

use super::check::{Bound, NumberKeys};
use super::report::Report;
use super::words::words;

/// Fewest samples from which statistics are made.
const LEAST_SAMPLES: u32 = 20;

/// Least probability that a truncation keeps. A distribution that is almost never inside is a slip.
const LEAST_KEPT: f64 = 1e-6;

/// Uncertain inputs of a scene, for `tissuebench vary` and studies
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct VaryKeys {
    /// Number of samples, 20 to 100,000
    samples: u32,
    /// Metrics whose statistics are made, such as "tool-force"
    of: Vec<String>,
    /// Keys of the scene, such as "material.young" or "tool[].friction" for every tool, with the
    /// distributions of their values, which are independent of each other
    keys: BTreeMap<String, DistributionKeys>,
    /// Bounds on the statistics
    #[serde(default)]
    check: Vec<StatisticKeys>,
}

/// Distribution of a value: one of uniform, normal, lognormal and list
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-one-of" = ["uniform", "normal", "lognormal", "list"]))]
struct DistributionKeys {
    /// Lower and upper end of a range in which every value is equally likely
    #[schemars(with = "Option<[serde_json::Value; 2]>")]
    uniform: Option<[Value; 2]>,
    normal: Option<NormalKeys>,
    /// The logarithm of the value is normally distributed; mean and sd are those of the value itself
    lognormal: Option<NormalKeys>,
    /// Values that are equally likely
    #[schemars(with = "Option<Vec<serde_json::Value>>")]
    list: Option<Vec<Value>>,
    /// Ends at which a normal or lognormal distribution is cut off
    #[schemars(with = "Option<[serde_json::Value; 2]>")]
    within: Option<[Value; 2]>,
}

/// Mean and standard deviation
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct NormalKeys {
    /// Mean
    #[schemars(with = "serde_json::Value")]
    mean: Value,
    /// Standard deviation, above zero
    #[schemars(with = "serde_json::Value")]
    sd: Value,
}

/// A bound on a statistic of a varied scene
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StatisticKeys {
    /// Metric, one of `of`
    metric: String,
    statistic: Statistic,
    /// Key whose share of the variance is bounded, for first and total
    key: Option<String>,
    at_least: Option<NumberKeys>,
    at_most: Option<NumberKeys>,
}

words! {
    /// Statistics of a varied scene.
    pub enum Statistic {
        /// Mean.
        Mean = "mean",
        /// Standard deviation.
        Sd = "sd",
        /// Value with 5 % of the results below it.
        P5 = "p5",
        /// Median.
        P50 = "p50",
        /// Value with 95 % of the results below it.
        P95 = "p95",
        /// Q2: 1 minus the square error of the polynomial at samples left out of its fit, over the variance.
        Q2 = "q2",
        /// Share of a key in the variance, alone (first-order Sobol index).
        First = "first",
        /// Share of a key in the variance, with its interactions (total Sobol index).
        Total = "total",
        /// Number of samples without a result.
        Missing = "missing",
    }
}

impl Statistic {
    /// Whether the statistic has the unit of its metric.
    fn is_of_metric(self) -> bool {
        use Statistic::{Mean, P5, P50, P95, Sd};
        [Mean, Sd, P5, P50, P95].contains(&self)
    }

    /// Whether the statistic is that of a key.
    pub fn is_of_key(self) -> bool {
        [Statistic::First, Statistic::Total].contains(&self)
    }
}

/// Uncertain inputs.
#[derive(Clone, Debug)]
pub struct Vary {
    /// Number of samples.
    pub samples: u32,
    /// Metrics whose statistics are made.
    pub of: Vec<Address>,
    /// Uncertain keys.
    pub keys: Vec<VariedKey>,
    /// Bounds on the statistics.
    pub checks: Vec<StatisticCheck>,
}

/// A key of the scene with the distribution of its value.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedKey {
    /// Key in the form of messages, such as `material.young`; `tool[].friction` is that of every tool.
    pub key: String,
    /// Unit of the values as written; empty for bare numbers.
    pub unit: String,
    /// Distribution, in this unit.
    pub distribution: Distribution,
}

/// A bound on a statistic.
#[derive(Clone, Debug, PartialEq)]
pub struct StatisticCheck {
    /// Metric.
    pub address: Address,
    /// Statistic.
    pub statistic: Statistic,
    /// Varied key, for statistics of a key.
    pub key: Option<String>,
    /// The bound; SI.
    pub bound: Bound,
    /// Location in the file, `file:line`.
    pub at: String,
}

impl Vary {
    /// Values of the keys in the sample `index`, which counts from 0, in their units.
    pub fn values(&self, index: u32) -> Vec<f64> {
        let inputs: Vec<Distribution> = self.keys.iter().map(|key| key.distribution.clone()).collect();
        point(&inputs, index)
    }

    /// Whether a metric of the samples is compared with the scene's reference.
    pub(crate) fn needs_reference(&self) -> bool {
        use Needs::{
            Enclosed, Estimate, Foundation, Mean, Modes, Newton, Point, PointEstimate, RegionEnergy, Run,
            Steps, Stretch, Support, SupportEstimate, SupportMoment, Tool, ToolEstimate, ToolMoment,
        };
        let own = [
            Enclosed,
            Estimate,
            Foundation,
            Mean,
            Modes,
            Newton,
            Point,
            PointEstimate,
            RegionEnergy,
            Run,
            Steps,
            Stretch,
            Support,
            SupportEstimate,
            SupportMoment,
            Tool,
            ToolEstimate,
            ToolMoment,
        ];
        !self.of.iter().all(|address| own.contains(&address.metric.needs))
    }

    /// Whether a metric of the samples has one of these needs.
    pub(crate) fn needs_any(&self, needs: &[Needs]) -> bool {
        self.of.iter().any(|address| needs.contains(&address.metric.needs))
    }
}

impl VariedKey {
    /// A value as TOML.
    pub(crate) fn written(&self, value: f64) -> String {
        written(value, &self.unit)
    }

    /// A value with its unit.
    pub fn shown(&self, value: f64) -> String {
        format!("{value} {}", self.unit).trim_end().to_string()
    }
}

/// A value with its unit as TOML.
pub(super) fn written(value: f64, unit: &str) -> String {
    if unit.is_empty() { value.to_string() } else { format!("\"{value} {unit}\"") }
}

impl VaryKeys {
    pub fn read(self, report: &Report) -> Vary {
        let fits = (LEAST_SAMPLES..=MOST_SAMPLES).contains(&self.samples);
        let help =
            format!("give {LEAST_SAMPLES} to {MOST_SAMPLES}; 60 suffice for a smooth result of five keys");
        report.require(fits, "samples", "is out of range", &help);
        report.require(!self.of.is_empty(), "of", "names no metric", "name one, such as \"tool-force\"");
        let help = format!("name 1 to {MOST_INPUTS} keys of the scene");
        report.require((1..=MOST_INPUTS).contains(&self.keys.len()), "keys", "is out of range", &help);
        let mut seen = BTreeSet::new();
        let of = |(i, name): (usize, &String)| {
            let key = format!("of[{i}]");
            report.require(seen.insert(name.clone()), &key, "is given already", "name each metric once");
            metric::named(name).map_err(|bad| report.add(&key, bad)).ok()
        };
        let of: Vec<Address> = self.of.iter().enumerate().filter_map(of).collect();
        let varied = |(key, keys): (String, DistributionKeys)| {
            let (distribution, unit) = keys.read(&report.at(&format!("keys.{key}")))?;
            Some(VariedKey { key, unit, distribution })
        };
        let keys: Vec<VariedKey> = self.keys.into_iter().filter_map(varied).collect();
        let check = |check: StatisticKeys, report: &Report| check.read(&of, &keys, report);
        let checks = report.each("check", self.check, check);
        Vary { samples: self.samples, of, keys, checks }
    }
}

impl DistributionKeys {
    /// The distribution with the unit of its values.
    fn read(self, report: &Report) -> Option<(Distribution, String)> {
        let mut unit = None;
        let mut number =
            |value: &Value, key: &str| number(value, &mut unit).map_err(|bad| report.add(key, bad)).ok();
        let distribution = match (self.uniform, self.normal, self.lognormal, self.list) {
            (Some([low, high]), None, None, None) => {
                let (low, high) = (number(&low, "uniform[0]")?, number(&high, "uniform[1]")?);
                report.require(
                    low < high,
                    "uniform",
                    "is not a range",
                    "give the lower end first, below the upper end",
                );
                (low < high).then_some(Distribution::Uniform { low, high })?
            }
            (None, Some(NormalKeys { mean, sd }), None, None) => {
                let (mean, sd) = (number(&mean, "normal.mean")?, number(&sd, "normal.sd")?);
                report.positive("normal.sd", sd);
                (sd > 0.0).then_some(Distribution::Normal { mean, sd, within: None })?
            }
            (None, None, Some(NormalKeys { mean, sd }), None) => {
                let (mean, sd) = (number(&mean, "lognormal.mean")?, number(&sd, "lognormal.sd")?);
                report.positive("lognormal.mean", mean);
                report.positive("lognormal.sd", sd);
                (mean > 0.0 && sd > 0.0).then_some(Distribution::Lognormal { mean, sd, within: None })?
            }
            (None, None, None, Some(list)) => {
                report.require(!list.is_empty(), "list", "is empty", "give the values of the key");
                let read = |(i, value): (usize, &Value)| number(value, &format!("list[{i}]"));
                let values: Vec<f64> = list.iter().enumerate().filter_map(read).collect();
                (!values.is_empty() && values.len() == list.len()).then_some(Distribution::List { values })?
            }
            _ => {
                let help = "give one of uniform = [low, high], normal = { mean, sd }, lognormal = { mean, sd } and list";
                report.add("", Problem::new("is not one distribution").help(help));
                return None;
            }
        };
        let distribution = match self.within {
            None => distribution,
            Some([low, high]) => {
                let (low, high) = (number(&low, "within[0]")?, number(&high, "within[1]")?);
                cut(distribution, [low, high], report)?
            }
        };
        Some((distribution, unit.unwrap_or_default()))
    }
}

/// Cuts a normal or lognormal distribution off at two ends.
fn cut(of: Distribution, [low, high]: [f64; 2], report: &Report) -> Option<Distribution> {
    let order = "give the lower end first, below the upper end";
    match of {
        _ if !(low < high) => report.require(false, "within", "is not a range", order),
        Distribution::Normal { mean, sd, .. } => {
            return kept(Distribution::Normal { mean, sd, within: Some([low, high]) }, report);
        }
        Distribution::Lognormal { .. } if !(low > 0.0) => {
            report.require(false, "within", "holds values that are not positive", "begin above zero");
        }
        Distribution::Lognormal { mean, sd, .. } => {
            return kept(Distribution::Lognormal { mean, sd, within: Some([low, high]) }, report);
        }
        _ => {
            let help = "it goes with normal and lognormal; a range and a list have ends of their own";
            report.require(false, "within", "has nothing to cut off", help);
        }
    }
    None
}

/// The truncated distribution, unless the ends leave out nearly everything.
fn kept(of: Distribution, report: &Report) -> Option<Distribution> {
    let holds = of.kept() >= LEAST_KEPT;
    report.require(
        holds,
        "within",
        "keeps less than a millionth of the distribution",
        "give ends around the mean",
    );
    holds.then_some(of)
}

/// A value of a key: a number, or a quantity in the unit of the values before it.
pub(super) fn number(value: &Value, unit: &mut Option<String>) -> Result<f64, Problem> {
    let (number, own) = match value {
        Value::Integer(number) => (*number as f64, String::new()),
        Value::Float(number) if number.is_finite() => (*number, String::new()),
        Value::String(text) => {
            Quantity::read(text)?;
            let text = text.trim();
            // The unit begins at the last piece of text that leaves a number.
            let end = (1..=text.len()).rev().filter(|end| text.is_char_boundary(*end));
            let (number, end) =
                (end.filter_map(|end| Some((text[..end].trim().parse::<f64>().ok()?, end))).next())
                    .ok_or_else(|| Problem::new("doesn't begin with a finite number").found(text))?;
            (number, text[end..].trim().to_string())
        }
        other => {
            let help = "give a number, or a quantity in quotes such as \"20 kPa\"";
            return Err(Problem::new("is not a number").found(other.to_string()).help(help));
        }
    };
    let unit = unit.get_or_insert_with(|| own.clone());
    if *unit == own {
        return Ok(number);
    }
    let named = |unit: &str| if unit.is_empty() { "no unit".to_string() } else { format!("the unit {unit}") };
    let problem = Problem::new(format!("has {}, where a value before it has {}", named(&own), named(unit)));
    let found = value.as_str().map_or_else(|| value.to_string(), String::from);
    Err(problem.found(found).help("give all of them in the same unit"))
}

impl StatisticKeys {
    fn read(self, of: &[Address], keys: &[VariedKey], report: &Report) -> Option<StatisticCheck> {
        let address = metric::named(&self.metric).map_err(|bad| report.add("metric", bad)).ok()?;
        let known = of.contains(&address);
        report.require(known, "metric", "is not varied", "name a metric of vary.of");
        let with_key = self.statistic.is_of_key();
        let known = self.key.as_ref().is_some_and(|key| keys.iter().any(|varied| varied.key == *key));
        let help =
            if with_key { "name a key of vary.keys" } else { "it goes with first and total: leave it out" };
        report.require(known == with_key && self.key.is_some() == with_key, "key", "does not fit", help);
        let dimension =
            if self.statistic.is_of_metric() { address.metric.dimension } else { Dimension::None };
        let bound = Bound::read(self.at_least, self.at_most, |keys| keys.read(dimension), report)?;
        Some(StatisticCheck {
            address,
            statistic: self.statistic,
            key: self.key,
            bound,
            at: report.location(),
        })
    }
}
