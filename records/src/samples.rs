//! A scene with uncertain inputs: the samples of its inputs with the results of one method.

use serde::{Deserialize, Serialize};
use uncertainty::Distribution;

use crate::record::Family;

/// Samples of one scene with one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// Case name.
    pub case: String,
    /// Method id, with its size if a study varies it.
    pub method: String,
    /// Id of the run of the scene as written; empty if it has no numbers.
    #[serde(default)]
    pub run: String,
    /// Family of the method.
    pub family: Family,
    /// Uncertain inputs.
    pub inputs: Vec<Input>,
    /// Seed of the sequence of samples.
    pub seed: u32,
    /// Metrics of the results.
    pub outputs: Vec<Output>,
    /// Metric along which histories run: `closure` (m) or `time` (s).
    pub along: String,
    /// Samples, in their order. Those that a part of a study leaves out are missing.
    pub samples: Vec<Sample>,
}

/// An uncertain input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// Key of the scene.
    pub key: String,
    /// Unit of the values as written in the scene; empty for bare numbers.
    pub unit: String,
    /// Distribution of the values, in this unit.
    pub distribution: Distribution,
}

/// A metric of the results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Output {
    /// Name of the metric.
    pub name: String,
    /// Value in the scene as written, SI; `None` if that run gave none.
    pub nominal: Option<f64>,
    /// Estimated numerical error of this value, SI; `None` without an estimate.
    pub numerical: Option<f64>,
}

/// One sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    /// Number of the sample, from 1.
    pub sample: u32,
    /// Values of the inputs, in their units.
    pub values: Vec<f64>,
    /// Results.
    #[serde(flatten)]
    pub results: SampleResults,
    /// Codes of the warnings.
    pub warnings: Vec<String>,
    /// Reason for missing results; empty if the run reached the whole load.
    pub failure: String,
}

/// Results of one sample.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SampleResults {
    /// Values of the metrics, SI; `None` for missing ones.
    pub results: Vec<Option<f64>>,
    /// For each metric with a history, its values at the recorded steps: `(closure in m or time in s,
    /// value)`.
    pub curves: Vec<Vec<(f64, f64)>>,
}
