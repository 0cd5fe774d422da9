//! References of runs, with their own errors.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::text::{list, percent};

/// Reference of the runs of a case, with its own error.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reference {
    /// Case name.
    pub case: String,
    /// Poisson's ratio of the (first) material.
    pub poisson: f64,
    /// Id of the reference method, or name of an exact solution.
    pub method: String,
    /// Number of nodes; 0 for an exact solution.
    pub nodes: u64,
    /// Relative error of the reference by metric; empty for an exact solution, or if it is unknown.
    pub band: BTreeMap<String, f64>,
    /// Solutions whose distance estimates this error.
    pub by: Vec<String>,
    /// Reason for which the error is unknown; empty if it is known.
    pub unknown: String,
    /// Warnings about the numbers of the reference.
    pub warnings: Vec<String>,
}

impl Reference {
    /// Name of the reference with its size.
    pub fn name(&self) -> String {
        match self.nodes {
            0 => format!("the exact solution {}", self.method),
            nodes => format!("{} with {nodes} nodes", self.method),
        }
    }

    /// Name of the reference and its error, as a sentence without the full stop.
    pub fn sentence(&self) -> String {
        let name = self.name();
        if !self.unknown.is_empty() {
            return format!("{name}, whose own error is unknown: {}", self.unknown);
        }
        let known = WORDS.iter().filter_map(|(metric, word)| {
            Some(format!(
                "{} of {word}",
                percent(*self.band.get(*metric).filter(|error| **error > ROUNDING)?)
            ))
        });
        let known: Vec<String> = known.collect();
        if known.is_empty() {
            return name;
        }
        format!(
            "{name}, whose own error is about {} (by {}): smaller errors are not significant",
            list(&known),
            list(&self.by)
        )
    }
}

/// Errors below this are due to rounding, or belong to a prescribed quantity.
const ROUNDING: f64 = 1e-6;

/// Metrics of the reference error that a sentence mentions, with their words.
const WORDS: [(&str, &str); 4] = [
    ("relative-rms", "displacement"),
    ("tool-force-error", "force"),
    ("strain-energy-error", "energy"),
    ("peak-error", "the peak"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_says_how_far_it_is_off_or_why_that_is_unknown() {
        let known = Reference {
            method: "tet4".into(),
            nodes: 75,
            band: BTreeMap::from([("relative-rms".into(), 0.9), ("peak-error".into(), 0.2)]),
            by: vec!["tet4 with 18 nodes".into(), "tet10 with 75 nodes".into()],
            ..Reference::default()
        };
        assert_eq!(
            known.sentence(),
            "tet4 with 75 nodes, whose own error is about 90.0 % of displacement and 20.0 % of the peak (by tet4 with 18 nodes and tet10 \
             with 75 nodes): smaller errors are not significant"
        );
        let unknown = Reference { band: BTreeMap::new(), unknown: "its mesh is a file".into(), ..known };
        assert_eq!(unknown.sentence(), "tet4 with 75 nodes, whose own error is unknown: its mesh is a file");
        let exact = Reference { method: "affine".into(), ..Reference::default() };
        assert_eq!(exact.sentence(), "the exact solution affine");
    }
}
