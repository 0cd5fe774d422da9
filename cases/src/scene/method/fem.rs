//! Finite elements.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::common::{Dilation, Jitter, JitterKeys, Mass, Size, SizeKeys};
use crate::scene::report::Report;
use crate::scene::words::words;

words! {
    /// Element types.
    pub enum Element {
        /// Linear tetrahedron.
        Tet4 = "tet4",
        /// Quadratic tetrahedron.
        Tet10 = "tet10",
        /// Trilinear hexahedron.
        Hex8 = "hex8",
        /// Quadratic serendipity hexahedron.
        Hex20 = "hex20",
    }
}

#[derive(Deserialize, JsonSchema)]
pub(crate) struct FemKeys {
    element: Element,
    dilation: Option<Dilation>,
    /// Whether hex20 has 2 x 2 x 2 integration points instead of 3 x 3 x 3
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
    /// Whether hex20 has 2 x 2 x 2 points instead of 3 x 3 x 3: avoids locking in combined bending and
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
        let sound = !reduced || element == Element::Hex20;
        let help = "leave it out, or take element = \"hex20\"";
        report.require(sound, "reduced", "applies to hex20 only", help);
        let jitter = self.jitter.map(|jitter| jitter.read(report));
        let dilation = self.dilation.unwrap_or(Dilation::Standard);
        Some(Fem { element, dilation, reduced, size: size?, jitter })
    }
}

impl Fem {
    /// Refuses dilations that do not suit the element. A mixed pressure field, linear between corners, is stable with
    /// elements of second order only. With these, the functions of the corners are negative in most of a cell, so
    /// nodal means average over negative volumes.
    pub(super) fn demands(&self, report: &Report) {
        let (name, linear) = (self.element.name(), matches!(self.element, Element::Tet4 | Element::Hex8));
        let (found, problem, help) = match self.dilation {
            Dilation::Mixed if linear => (
                "mixed",
                format!("has no stable pressure field with {name}"),
                "take tet10 or hex20, or \"nodal-mean\" (tet4) or \"element-mean\" (hex8)".to_string(),
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
