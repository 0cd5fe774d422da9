//! Checks of results: the bound of a metric, for some methods.

use catalogue::metric::{self, Address};
use catalogue::{Dimension, Problem};
use schemars::JsonSchema;
use serde::Deserialize;

use super::report::Report;
use super::selection::Names;

/// A bare number, or a quantity in quotes
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum NumberKeys {
    Number(f64),
    Quantity(String),
}

/// A bound on a result
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckKeys {
    metric: String,
    /// Methods that the check applies to; all unless given
    method: Option<Names>,
    at_most: Option<NumberKeys>,
    at_least: Option<NumberKeys>,
    /// Low and high end of a known defect, reported as not passing
    known_band: Option<[NumberKeys; 2]>,
    reason: Option<String>,
}

/// A bound on the results.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Metric, component, and number of the tool, support or face.
    pub address: Address,
    /// Ids of the methods that the check applies to; empty for all.
    pub methods: Vec<String>,
    /// The bound, in the SI unit of the metric.
    pub bound: Bound,
    /// Location in the file, `file:line`.
    pub at: String,
}

/// Bound of a metric.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound {
    /// A range: passes if no value is outside.
    Within {
        /// Smallest allowed value.
        at_least: Option<f64>,
        /// Largest allowed value.
        at_most: Option<f64>,
    },
    /// A known defect: the value is reported as not passing, and the check holds only while the value is in
    /// the band.
    KnownBand {
        /// Low end.
        low: f64,
        /// High end.
        high: f64,
        /// Reason why the method can't do better.
        reason: String,
    },
}

impl Check {
    /// Whether the bound holds only if a run ends before the whole load. Such an end is a result, not a
    /// failure.
    pub fn foresees_early_end(&self) -> bool {
        let most = match self.bound {
            Bound::Within { at_most, .. } => at_most,
            Bound::KnownBand { high, .. } => Some(high),
        };
        let of_load = [&metric::LOAD_CARRIED, &metric::LIMIT_LOAD].map(|metric| metric.whole());
        of_load.contains(&self.address) && most.is_some_and(|most| most < 1.0)
    }
}

impl Bound {
    /// Reads a range whose ends `read` converts to SI units. A bound that could not be read is reported.
    pub(super) fn read(
        at_least: Option<NumberKeys>,
        at_most: Option<NumberKeys>,
        read: impl Fn(NumberKeys) -> Result<f64, Problem>,
        report: &Report,
    ) -> Option<Bound> {
        if at_least.is_none() && at_most.is_none() {
            report.missing("", "give at_least or at_most");
            return None;
        }
        let number = |keys: Option<NumberKeys>, key| {
            let read = keys.map(|keys| read(keys).map_err(|bad| report.add(key, bad)).ok());
            read.map_or(Some(None), |number| number.map(Some))
        };
        let ends = (number(at_least, "at_least"), number(at_most, "at_most"));
        let (at_least, at_most) = (ends.0?, ends.1?);
        if let (Some(low), Some(high)) = (at_least, at_most) {
            let help = "at_least must not be above at_most";
            report.require(low <= high, "at_most", "leaves no value to pass", help);
        }
        Some(Bound::Within { at_least, at_most })
    }
}

impl CheckKeys {
    pub fn read(self, report: &Report) -> Option<Check> {
        let address = metric::named(&self.metric).map_err(|bad| report.add("metric", bad)).ok()?;
        let number = |keys: NumberKeys, key: &str| {
            keys.read(address.metric.dimension).map_err(|bad| report.add(key, bad)).ok()
        };
        let bound = match (self.at_least, self.at_most, self.known_band) {
            (None, None, None) => {
                report.missing("", "give at_most, at_least or known_band");
                return None;
            }
            (None, None, Some([low, high])) => {
                let (low, high) = (number(low, "known_band")?, number(high, "known_band")?);
                report.require(low < high, "known_band", "is not a valid band", "give the low end first");
                let Some(reason) = self.reason else {
                    report.missing("reason", "say why the method can't do better");
                    return None;
                };
                Bound::KnownBand { low, high, reason }
            }
            (_, _, Some(_)) => {
                let help = "give a band or bounds, not both";
                report.add("known_band", Problem::new("can't be combined with a bound").help(help));
                return None;
            }
            (low, high, None) => {
                let stray = self.reason.is_some();
                report.require(!stray, "reason", "applies to known_band only", "leave it out");
                Bound::read(low, high, |keys| keys.read(address.metric.dimension), report)?
            }
        };
        let methods = self.method.map(Vec::from).unwrap_or_default();
        Some(Check { address, methods, bound, at: report.location() })
    }
}

impl NumberKeys {
    /// The number in the SI unit of a dimension.
    pub fn read(self, dimension: Dimension) -> Result<f64, Problem> {
        match self {
            NumberKeys::Number(value) if dimension.is_plain() => Ok(value),
            NumberKeys::Number(value) => {
                Err(Problem::new("has no unit").help(dimension.fix(&value.to_string())))
            }
            NumberKeys::Quantity(text) => dimension.read(&text),
        }
    }
}
