//! Quantities that must be accurate, and the metrics that measure their errors.

use catalogue::metric::{self, Kind, METRICS, Metric};
use catalogue::{Dimension, nearest};
use records::Reference;

use crate::outcome::Outcome;

/// Words for quantities. Each has its metrics, the preferred one first, and a flag for a single number, which
/// can be accurate by chance.
const WORDS: [(&str, &[&Metric], bool); 8] = [
    ("displacement", &[&metric::L2, &metric::RELATIVE_RMS], false),
    ("force", &[&metric::TOOL_FORCE_ERROR], true),
    ("pressure", &[&metric::PRESSURE], false),
    ("stress", &[&metric::STRESS], false),
    ("energy", &[&metric::ENERGY, &metric::STRAIN_ENERGY_ERROR], true),
    ("peak", &[&metric::PEAK_ERROR], true),
    ("probes", &[&metric::PROBE_ERROR], false),
    ("frequency", &[&metric::FREQUENCY_ERROR], true),
];

/// Words of quantities whose errors can be estimated, with the metric and the flag for a single number.
const ESTIMATED: [(&str, &Metric, bool); 4] = [
    ("displacement", &metric::DISPLACEMENT_ESTIMATE, false),
    ("force", &metric::TOOL_FORCE_ESTIMATE, true),
    ("energy", &metric::STRAIN_ENERGY_ESTIMATE, true),
    ("probes", &metric::PROBE_ESTIMATE, false),
];

/// A quantity and the metrics of its error.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Quantity {
    pub name: String,
    metrics: Vec<&'static Metric>,
    pub scalar: bool,
}

impl Quantity {
    /// Returns the quantity of a word, or of a metric that is a relative error.
    pub fn named(name: &str) -> Result<Quantity, String> {
        if let Some((word, metrics, scalar)) = WORDS.iter().find(|(word, ..)| *word == name) {
            return Ok(Quantity { name: (*word).into(), metrics: metrics.to_vec(), scalar: *scalar });
        }
        let relative = |m: &&&Metric| {
            m.dimension == Dimension::None && (m.kind == Kind::Error || ***m == metric::TOOL_FORCE_ERROR)
        };
        if let Some(found) = METRICS.iter().filter(relative).find(|m| m.name == name) {
            // Errors over a whole field are not single numbers. Other metrics count as single numbers.
            let field = [&metric::L2, &metric::RELATIVE_RMS, &metric::RELATIVE_MAX, &metric::STRESS];
            let scalar = !field.contains(found) && **found != metric::PRESSURE;
            return Ok(Quantity { name: name.into(), metrics: vec![found], scalar });
        }
        let words = WORDS.map(|(word, ..)| word);
        let near =
            nearest(name, words.iter().copied().chain(METRICS.iter().filter(relative).map(|m| m.name)));
        let near = near.map_or(String::new(), |near| format!(" did you mean '{near}'?"));
        Err(format!("'{name}' is not a quantity with a relative error:{near} give {}", words.join(", ")))
    }

    /// Returns the quantity of a word, whose errors are estimates.
    pub fn estimated(name: &str) -> Result<Quantity, String> {
        let found = ESTIMATED.iter().find(|(word, ..)| *word == name);
        let (word, metric, scalar) = found.ok_or_else(|| {
            let words = ESTIMATED.map(|(word, ..)| word).join(", ");
            format!(
                "'{name}' can't be estimated, and the scene has no reference: add [reference] method = \"...\" with a \
                 finer size, exact = \"...\" or record = \"...\", or give {words}"
            )
        })?;
        Ok(Quantity { name: (*word).into(), metrics: vec![metric], scalar: *scalar })
    }

    /// Name of the error in a sentence.
    pub fn word(&self) -> &'static str {
        let estimated = ESTIMATED.iter().any(|(_, metric, _)| self.metrics == [*metric]);
        if estimated { "estimated error" } else { "error" }
    }

    /// Returns the relative error of a run, the largest over several tools; `None` if the run has none.
    pub fn error(&self, outcome: &Outcome) -> Option<f64> {
        self.metrics.iter().find_map(|metric| {
            let each = outcome.metrics.iter().filter(|m| m.of.metric == *metric).map(|m| m.value);
            each.reduce(f64::max)
        })
    }

    /// Returns the reference's own error of this quantity, the largest over several tools; `None` if unknown.
    pub fn band(&self, reference: &Reference) -> Option<f64> {
        self.metrics.iter().find_map(|metric| {
            let of = |index: usize| reference.band.get(&metric.at(index).to_string()).copied();
            (0..).map_while(of).reduce(f64::max)
        })
    }

    /// Iterates over the quantities that are shown in addition, if runs have them.
    pub fn shown() -> impl Iterator<Item = Quantity> {
        ["displacement", "force", "pressure", "peak"].into_iter().map(|word| {
            let (_, metrics, scalar) = WORDS.iter().find(|(name, ..)| *name == word).expect("a word");
            Quantity { name: word.into(), metrics: metrics.to_vec(), scalar: *scalar }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_metrics_are_quantities_and_lengths_are_not() {
        assert!(Quantity::named("force").unwrap().scalar && !Quantity::named("l2").unwrap().scalar);
        assert!(Quantity::named("tool-force-error").unwrap().scalar);
        for bad in ["rms", "max", "tool-force", "displacment"] {
            assert!(Quantity::named(bad).is_err(), "{bad}");
        }
        assert!(Quantity::named("displacment").unwrap_err().contains("did you mean 'displacement'?"));
    }
}
