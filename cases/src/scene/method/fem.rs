//! Finite elements.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::common::{Dilation, Jitter, JitterKeys, Mass, Size, SizeKeys};
use super::element::Element;
use crate::scene::report::Report;

#[derive(Deserialize, JsonSchema)]
pub(crate) struct FemKeys {
    element: Element,
    dilation: Option<Dilation>,
    /// Reduced integration: 2 x 2 x 2 points in hex20, 3 x 3 in wedge15
    #[serde(default)]
    reduced: bool,
    size: SizeKeys,
    jitter: Option<JitterKeys>,
    /// Mass matrix for vibrations; kind = "modes" only
    pub mass: Option<Mass>,
}

/// Settings of a finite element method.
#[derive(Clone, Debug, PartialEq)]
pub struct Fem {
    /// Element type.
    pub element: Element,
    /// Treatment of the volume change.
    pub dilation: Dilation,
    /// Whether the element's reduced integration is used: avoids locking in combined bending and
    /// compression.
    pub reduced: bool,
    /// Size of the mesh.
    pub size: Size,
    /// Random displacement of inner nodes.
    pub jitter: Option<Jitter>,
}

impl FemKeys {
    pub fn read(self, report: &Report) -> Option<Fem> {
        let (element, reduced) = (self.element, self.reduced);
        let size = self.size.read(&report.at("size"));
        let has = |element: Element| element.reduced().is_some();
        let problem = format!("applies to {} only", Element::named(has));
        report.require(
            !reduced || has(element),
            "reduced",
            &problem,
            "leave it out, or take another element",
        );
        let jitter = self.jitter.map(|jitter| jitter.read(report));
        let dilation = self.dilation.unwrap_or(Dilation::Standard);
        Some(Fem { element, dilation, reduced, size: size?, jitter })
    }
}

impl Fem {
    /// Reports dilations that do not suit the element. A mixed pressure field, linear between the corners, is
    /// stable with second-order elements only. In second-order elements the functions of the corners are
    /// negative in most of a cell, so nodal means would average over negative volumes.
    pub(super) fn demands(&self, report: &Report) {
        let name = self.element.name();
        let linear = self.element.order() == 1;
        let (found, problem, help) = match self.dilation {
            Dilation::Mixed if linear => (
                "mixed",
                format!("has no stable pressure field with {name}"),
                format!(
                    "take {}, or \"nodal-mean\" (tet4) or \"element-mean\" (hex8)",
                    Element::named(|element| element.order() == 2)
                ),
            ),
            Dilation::NodalMean if !linear => (
                "nodal-mean",
                format!(
                    "averages over a negative volume at the corners of {name}, where its functions are negative"
                ),
                format!(
                    "take \"element-mean\" or \"nodal-near\" with {name}, or \"nodal-mean\" with tet4 or hex8"
                ),
            ),
            _ => return,
        };
        report.add("dilation", Problem::new(problem).found(found).help(help));
    }
}
