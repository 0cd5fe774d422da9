//! Reduced models: displacements restricted to a few deformations that training runs of the scene pass
//! through.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::common::Dilation;
use crate::scene::procedure::ProcedureKind;
use crate::scene::report::Report;
use crate::scene::units::{Part, Q};

/// Largest number of modes: their tangent is dense.
const MOST_MODES: u32 = 500;

/// Displacements restricted to a few deformations (proper orthogonal decomposition), which are learnt from the
/// scene's [[training]]
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PodKeys {
    /// Number of deformations, 1 to 500
    modes: u32,
    /// Largest part of the cells in which forces are evaluated, such as "20 %", with weights that give the forces
    /// of all cells in the training states; all cells with weight 1 unless given
    cells: Option<Q<Part>>,
}

/// Reduced model of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pod {
    /// Number of modes.
    pub modes: usize,
    /// Largest part of the cells in which forces are evaluated; `None` for all cells.
    pub cells: Option<f64>,
}

impl PodKeys {
    pub(super) fn read(self, report: &Report) -> Pod {
        let sound = (1..=MOST_MODES).contains(&self.modes);
        report.require(sound, "modes", "is not a valid number of modes", "give 1 to 500; 20 is usual");
        let cells = self.cells.map(|part| part.0);
        let sound = cells.is_none_or(|part| part > 0.0 && part <= 1.0);
        report.require(sound, "cells", "is no part of the cells", "give more than 0 and at most \"100 %\"");
        Pod { modes: self.modes as usize, cells }
    }
}

/// Properties of a method that a reduced model may not go with.
pub(super) struct Reduces {
    pub dilation: Dilation,
    /// Whether the mesh or the cloud is refined.
    pub refined: bool,
    pub hourglass: bool,
}

impl Pod {
    /// Reports contradictions with the method and the procedure.
    pub(super) fn demands(&self, method: &Reduces, kind: ProcedureKind, report: &Report) {
        let Reduces { dilation, refined, hourglass } = *method;
        let at_rest = kind == ProcedureKind::Static;
        report.require(at_rest, "", "needs static load steps", "take [procedure] kind = \"static\"");
        report.require(!refined, "", "does not go with a refined method", "leave pod or refine out");
        if dilation == Dilation::Mixed {
            let problem = "has no modes of a pressure field, which dilation = \"mixed\" has";
            let help = "take \"element-mean\", \"nodal-mean\" or \"standard\"";
            report.add("", Problem::new(problem).help(help));
        }
        if self.cells.is_none() {
            return;
        }
        if !matches!(dilation, Dilation::Standard | Dilation::ElementMean) {
            let name = dilation.name();
            let problem = format!("can't be chosen with dilation = \"{name}\", whose cells share dilations");
            let help = "leave it out, or take \"element-mean\" or \"standard\"";
            report.add("cells", Problem::new(problem).help(help));
        }
        let problem = "can't be chosen with hourglass control, which acts in every cell";
        report.require(!hourglass, "cells", problem, "leave it out, or take reduced = false");
    }
}
