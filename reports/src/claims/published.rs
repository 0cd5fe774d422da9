//! Published runs and their numbers.

use catalogue::Quantity;
use records::Family;
use serde::Deserialize;

use super::named::Named;

/// A published run with its numbers.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Published {
    pub(super) family: Family,
    /// Element or kernel.
    pub(super) variant: String,
    pub(super) nodes: u64,
    /// Scheme that transfers the displacement to the nodes of the secondary reference.
    pub(super) transfer: Option<String>,
    pub(super) number: Vec<Number>,
}

/// A published number.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Number {
    /// Description of the number.
    pub(crate) what: String,
    pub(crate) published: Printed,
    /// Place in the publication.
    pub(crate) place: String,
    pub(super) ours: Ours,
    /// Quantities that a comparable run has recorded.
    #[serde(default)]
    pub(super) needs: Vec<Named>,
}

/// A number as it is printed, such as `0.40 mm`.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct Printed {
    pub(crate) text: String,
    /// Number of digits before the unit.
    digits: usize,
    /// SI value.
    pub(crate) value: f64,
    /// SI value of the unit.
    pub(crate) unit: f64,
}

impl Printed {
    /// Number without its unit.
    pub(crate) fn digits(&self) -> &str {
        &self.text[..self.digits]
    }

    /// Unit, `1` for a pure number.
    pub(crate) fn unit(&self) -> &str {
        self.text.get(self.digits + 1..).unwrap_or("1")
    }
}

impl TryFrom<String> for Printed {
    type Error = String;

    fn try_from(text: String) -> Result<Printed, String> {
        let read = |text: &str| Quantity::read(text).map(|read| read.value).map_err(|bad| bad.to_string());
        let (digits, unit) = text.split_once(' ').unwrap_or((&text, "1"));
        Ok(Printed { digits: digits.len(), value: read(&text)?, unit: read(&format!("1 {unit}"))?, text })
    }
}

/// Part of the records that corresponds to a published number.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Ours {
    Elements,
    /// Sum of the times of phases, or the `total`.
    Time(Vec<String>),
    /// Quantity of the run.
    Value(Named),
    /// Quantity of the run's displacement after the transfer.
    Transferred(Named),
    LeastTransferred(Vec<Named>),
    LargestTransferred(Vec<Named>),
}
