//! Relations of a claim, and the sides that they compare.

use records::text::list;
use records::{Family, Record};
use serde::Deserialize;

use super::named::Named;

/// Methods on one side of a claim, selected by family, by id, or by both.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Side {
    family: Option<Family>,
    #[serde(default)]
    methods: Vec<String>,
}

impl Side {
    pub(super) fn takes(&self, record: &Record) -> bool {
        self.family.is_none_or(|family| family == record.family)
            && (self.methods.is_empty() || self.methods.contains(&record.method))
    }

    /// Methods of the side in words.
    pub(super) fn name(&self) -> String {
        match self.family {
            _ if !self.methods.is_empty() => list(&self.methods),
            Some(Family::Fem) => "FEM".into(),
            Some(Family::Efg) => "EFG".into(),
            Some(Family::External) => "external".into(),
            _ => "other".into(),
        }
    }
}

/// Kind of comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Kind {
    /// Smallest error of the left side over that of the right side.
    ErrorRatio,
    /// Smallest time of the left side over that of the right side at equal errors, for every error that both
    /// reach.
    TimeRatio,
}

/// A comparison between the two sides of a claim.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Relation {
    pub(super) kind: Kind,
    /// Relative error in records.
    pub(super) error: Named,
    pub(super) at_most: f64,
    /// Relative tolerance of the bound.
    #[serde(default)]
    pub(super) tolerance: f64,
}

impl Relation {
    /// Whether the error has no component, and the bound and its tolerance are in range.
    pub(super) fn sound(&self) -> bool {
        self.error.0 == self.error.0.metric.whole()
            && self.at_most > 0.0
            && self.at_most.is_finite()
            && self.tolerance >= 0.0
    }
}
