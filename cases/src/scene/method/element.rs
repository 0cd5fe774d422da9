//! Elements of a method, by their names in scenes.

use catalogue::element::{ELEMENTS, Element as Listed, MIXED_LINEAR, MIXED_QUADRATIC};
use geometry::CellKind;
use serde::{Deserialize, Deserializer};

use crate::scene::words::{describe, read};

/// Elements of a finite-element method: cells of one kind, or the cells of a mesh file as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Element(&'static Listed);

impl From<CellKind> for Element {
    fn from(kind: CellKind) -> Element {
        Element(kind.entry().listed)
    }
}

impl Element {
    /// The kind of all cells; `None` if they are of several kinds.
    pub fn kind(self) -> Option<CellKind> {
        CellKind::ALL.into_iter().find(|kind| kind.entry().listed == self.0)
    }

    /// Name in files and tables.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Order of the complete polynomials: 1 or 2.
    pub fn order(self) -> usize {
        self.0.degree
    }

    /// The elements of second order with the same cells.
    pub fn second_order(self) -> Element {
        match self.kind() {
            Some(kind) => kind.of_order(2).map_or(self, Element::from),
            None => Element(&MIXED_QUADRATIC),
        }
    }

    /// The elements that take cells of several kinds and this order as they are.
    pub fn mixed(order: usize) -> Element {
        Element(if order == 1 { &MIXED_LINEAR } else { &MIXED_QUADRATIC })
    }

    /// Name of the reduced integration in records; `None` if the element is not in use with it.
    pub fn reduced(self) -> Option<&'static str> {
        Some(self.kind()?.entry().points.reduced?.1)
    }

    /// Names of the elements with a property, in the order of lists and with "or" before the last.
    pub fn named(has: impl Fn(Element) -> bool) -> String {
        let all = ELEMENTS.into_iter().filter(|element| has(Element(element)));
        let mut names: Vec<&str> = all.map(|element| element.name).collect();
        let last = names.pop().unwrap_or_default();
        if names.is_empty() { last.into() } else { format!("{} or {last}", names.join(", ")) }
    }
}

impl<'de> Deserialize<'de> for Element {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Element, D::Error> {
        Ok(Element(ELEMENTS[read(deserializer, &ELEMENTS.map(|element| element.name))?]))
    }
}

impl schemars::JsonSchema for Element {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Element".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        describe("Element types.", &ELEMENTS.map(|element| (element.name, element.meaning)))
    }
}
