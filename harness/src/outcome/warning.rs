//! Warnings about the results of a run.

use catalogue::warning;
use schemars::JsonSchema;
use serde::Serialize;

/// Warning of a run. Only warnings of the catalogue can be given.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Warning {
    /// Entry of the catalogue.
    #[serde(rename = "code", serialize_with = "code")]
    #[schemars(with = "String")]
    pub kind: &'static warning::Warning,
    /// Meaning for this run, with numbers and a remedy.
    pub message: String,
    /// Value that triggered the warning, in SI units.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// Key of the scene that the warning concerns; may be empty.
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

    /// Formats the warning as one line.
    pub fn text(&self) -> String {
        let place = if self.place.is_empty() { String::new() } else { format!("key '{}': ", self.place) };
        format!("{place}{} ({})", self.message, self.kind.code)
    }
}

fn code<S: serde::Serializer>(kind: &&'static warning::Warning, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(kind.code)
}
