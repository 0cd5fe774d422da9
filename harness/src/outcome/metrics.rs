//! Metrics of a run.

use catalogue::metric::Address;

/// Metric of a run. Only metrics of the catalogue can be recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metric {
    /// Entry of the catalogue, component, and number of the tool, support or face.
    pub of: Address,
    /// Value in SI units.
    pub value: f64,
}

impl Metric {
    pub(crate) fn new(of: impl Into<Address>, value: f64) -> Metric {
        Metric { of: of.into(), value }
    }

    /// Name in checks and on a terminal.
    pub fn name(&self) -> String {
        self.of.to_string()
    }

    /// SI unit; `1` for a dimensionless number.
    pub fn unit(&self) -> &'static str {
        self.of.metric.unit()
    }
}

/// Adds a metric to a list.
pub(crate) fn push(metrics: &mut Vec<Metric>, of: impl Into<Address>, value: f64) {
    metrics.push(Metric::new(of, value));
}
