//! References of runs, and their own error.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::text::{list, percent};

/// The reference of a case's runs, with its own error.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reference {
    /// Case name.
    pub case: String,
    /// Poisson's ratio of the (first) material.
    pub poisson: f64,
    /// Id of its method, or the name of an exact solution.
    pub method: String,
    /// Its nodes; 0 of an exact solution.
    pub nodes: u64,
    /// Its own error by metric, relative; empty of an exact solution, and where it is unknown.
    pub band: BTreeMap<String, f64>,
    /// The solutions by whose distance that error is estimated.
    pub by: Vec<String>,
    /// Why its error is unknown; empty where it is known.
    pub unknown: String,
    /// Warnings about its numbers.
    pub warnings: Vec<String>,
}

impl Reference {
    /// Its name with its size.
    pub fn name(&self) -> String {
        match self.nodes {
            0 => format!("the exact solution {}", self.method),
            nodes => format!("{} with {nodes} nodes", self.method),
        }
    }

    /// Its name and its own error, in a sentence without the full stop.
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
            "{name}, whose own error is about {} (by {}): a smaller one says nothing",
            list(&known),
            list(&self.by)
        )
    }
}

/// Errors below this are of rounding, or of a quantity that is prescribed.
const ROUNDING: f64 = 1e-6;

/// Metrics of a reference's own error that a sentence names, and how.
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
             with 75 nodes): a smaller one says nothing"
        );
        let unknown = Reference { band: BTreeMap::new(), unknown: "its mesh is a file".into(), ..known };
        assert_eq!(unknown.sentence(), "tet4 with 75 nodes, whose own error is unknown: its mesh is a file");
        let exact = Reference { method: "affine".into(), ..Reference::default() };
        assert_eq!(exact.sentence(), "the exact solution affine");
    }
}
