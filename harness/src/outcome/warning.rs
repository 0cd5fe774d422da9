//! What is to be said against the numbers of a run.

use catalogue::warning;
use schemars::JsonSchema;
use serde::Serialize;

/// A warning of one run. What is no entry of the catalogue cannot be told.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Warning {
    /// Which.
    #[serde(rename = "code", serialize_with = "code")]
    #[schemars(with = "String")]
    pub kind: &'static warning::Warning,
    /// What it means here, with its numbers and what would help.
    pub message: String,
    /// The number it goes by, SI.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// The key of the scene that it is about, or empty.
    #[serde(rename = "where")]
    pub place: String,
}

impl Warning {
    pub(crate) fn new(
        kind: &'static warning::Warning,
        value: f64,
        place: impl Into<String>,
        message: String,
    ) -> Warning {
        Warning { kind, message, value, unit: kind.unit(), place: place.into() }
    }

    /// One line for people.
    pub fn text(&self) -> String {
        let place = if self.place.is_empty() { String::new() } else { format!("key '{}': ", self.place) };
        format!("{place}{} ({})", self.message, self.kind.code)
    }
}

fn code<S: serde::Serializer>(kind: &&'static warning::Warning, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(kind.code)
}
