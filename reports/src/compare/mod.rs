//! Two results against each other: numbers by a tolerance, times as paired ratios with their confidence.
//!
//! Runs are paired by their ids, or by all but a stated setting. A time is called only outside noise, which
//! is what the pairs themselves scatter by.

mod across;
mod numbers;
mod statistics;
mod times;

pub use across::across;
pub use numbers::{NumberChange, Numbers};
pub use times::{Ratio, Scope, Times};

use records::{RecordError, RunSet};
use serde::Serialize;

/// What is different between results before and after.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Numbers that do not depend on the moment.
    pub numbers: Numbers,
    /// Times; absent where they were not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub times: Option<Times>,
}

impl Comparison {
    /// Of pairs of results, before and after; the first pair's numbers are compared, the times of all. A number has changed from the
    /// relative difference `tolerance` on.
    ///
    /// # Errors
    /// Numbers that can't be paired.
    pub fn of(
        pairs: &[(RunSet, RunSet)],
        tolerance: f64,
        with_times: bool,
    ) -> Result<Comparison, RecordError> {
        let numbers = pairs.first().map(|(a, b)| Numbers::of(a, b, tolerance)).transpose()?;
        let times = with_times.then(|| Times::of(pairs));
        Ok(Comparison { numbers: numbers.unwrap_or_default(), times })
    }

    /// Whether no number has changed, no run is missing, and no time is called.
    pub fn is_same(&self) -> bool {
        self.numbers.is_same() && self.times.as_ref().is_none_or(|times| times.called.is_empty())
    }
}
