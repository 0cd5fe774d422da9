//! Elements of a method, by their names in scenes.

use geometry::CellKind;
use serde::{Deserialize, Deserializer};

use crate::scene::words::{describe, read};

/// Elements of a finite-element method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Element(pub CellKind);

impl Element {
    /// Name in files and tables.
    pub fn name(self) -> &'static str {
        self.0.name()
    }

    /// Order of the complete polynomials: 1 or 2.
    pub fn order(self) -> usize {
        self.0.order()
    }

    /// Names of the elements with a property, in the order of lists and with "or" before the last.
    pub fn named(has: impl Fn(CellKind) -> bool) -> String {
        let mut names: Vec<&str> =
            CellKind::ALL.into_iter().filter(|kind| has(*kind)).map(CellKind::name).collect();
        let last = names.pop().unwrap_or_default();
        if names.is_empty() { last.into() } else { format!("{} or {last}", names.join(", ")) }
    }
}

impl<'de> Deserialize<'de> for Element {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Element, D::Error> {
        Ok(Element(CellKind::ALL[read(deserializer, &CellKind::ALL.map(CellKind::name))?]))
    }
}

impl schemars::JsonSchema for Element {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Element".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        describe("Element types.", &CellKind::ALL.map(|kind| (kind.name(), kind.entry().listed.meaning)))
    }
}
