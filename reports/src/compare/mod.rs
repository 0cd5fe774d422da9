//! Comparison of two results: numbers by a tolerance, times by paired ratios with their confidence.
//!
//! Runs are paired by their ids, or by all but given settings. A change of a time is reported only if it
//! exceeds noise, which is estimated from the scatter of the pairs.

mod across;
mod numbers;
mod statistics;
mod times;

pub use across::across;
pub use numbers::{NumberChange, Numbers};
pub use times::{Ratio, Scope, Times};

use records::RunSet;
use serde::Serialize;

/// Differences between results before and after a change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Numbers that do not depend on the moment.
    pub numbers: Numbers,
    /// Times; absent if they were not requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub times: Option<Times>,
}

impl Comparison {
    /// Compares pairs of results, before and after a change. The numbers are those of the first pair, the
    /// times those of all pairs. A number has changed if its relative difference exceeds `tolerance`.
    pub fn of(pairs: &[(RunSet, RunSet)], tolerance: f64, with_times: bool) -> Comparison {
        let numbers = pairs.first().map(|(a, b)| Numbers::of(a, b, tolerance));
        let times = with_times.then(|| Times::of(pairs));
        Comparison { numbers: numbers.unwrap_or_default(), times }
    }

    /// Whether no number has changed, no run is missing, and no change of a time is reported.
    pub fn is_same(&self) -> bool {
        self.numbers.is_same() && self.times.as_ref().is_none_or(|times| times.called.is_empty())
    }
}
