//! A fit of constants of a scene to a measured curve, with one method.

use serde::{Deserialize, Serialize};

use crate::record::Family;

/// Fit of one scene with one method. Curves are in SI units, constants in those of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Case name.
    pub case: String,
    /// Method id, with its size if a study varies it.
    pub method: String,
    /// Family of the method.
    pub family: Family,
    /// File of the measured curve.
    pub data: String,
    /// Metric along which the curve was measured.
    pub along: String,
    /// Measured metric.
    pub of: String,
    /// Fitted constants.
    pub constants: Vec<FitConstant>,
    /// Correlations of the constants, a row for each.
    pub correlation: Vec<Vec<f64>>,
    /// Measured points.
    pub points: Vec<FitPoint>,
    /// Curve of the scene with the fitted constants, at its load steps.
    pub curve: Vec<(f64, f64)>,
    /// Root mean square of the residuals.
    pub rms: f64,
    /// Coefficient of determination.
    pub r2: f64,
    /// Sum of the squared residuals over the stated standard deviations, over the degrees of freedom; `None`
    /// without stated standard deviations.
    pub chi2: Option<f64>,
    /// Number of points minus number of constants that are not on a bound.
    pub freedom: u64,
    /// Number of Jacobians.
    pub iterations: u64,
    /// Number of runs of the scene.
    pub runs: u64,
    /// Reasons to doubt the constants.
    pub warnings: Vec<String>,
}

/// A fitted constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitConstant {
    /// Key of the scene.
    pub key: String,
    /// Unit of the values; empty for bare numbers.
    pub unit: String,
    /// Value in the scene, at which the fit started.
    pub start: f64,
    /// Fitted value.
    pub value: f64,
    /// Ends of the 95 % interval; `None` if the data do not determine the constant, and on a bound.
    pub interval: Option<[f64; 2]>,
    /// Whether the constant is on a bound of its range.
    pub on_bound: bool,
    /// Whether its logarithm was fitted.
    pub logarithmic: bool,
}

/// A measured point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitPoint {
    /// Value along the curve.
    pub x: f64,
    /// Measured value.
    pub measured: f64,
    /// Stated standard deviation of the measured value.
    pub sd: Option<f64>,
    /// Value of the scene with the fitted constants.
    pub fitted: f64,
}

impl FitConstant {
    /// Half of the width of the 95 % interval.
    pub fn half_width(&self) -> Option<f64> {
        self.interval.map(|[low, high]| 0.5 * (high - low))
    }
}
