//! Finite elements.

use catalogue::Problem;
use geometry::CellKind;
use schemars::JsonSchema;
use serde::Deserialize;

use super::common::{Dilation, Jitter, JitterKeys, Mass, Size, SizeKeys};
use super::element::Element;
use super::pod::PodKeys;
use crate::scene::goal::Goal;
use crate::scene::report::Report;
use crate::scene::units::{Part, Q};
use crate::scene::words::words;

/// Number of meshes of a refinement unless given, and the largest.
const ROUNDS: u32 = 6;
const MOST_ROUNDS: u32 = 10;

words! {
    /// Modulus that the stiffness of hourglass control is proportional to.
    pub enum HourglassModulus {
        /// The P-wave modulus `lambda + 2 mu`.
        PWave = "p-wave",
        /// The shear modulus `mu`, which does not grow with the bulk modulus.
        Shear = "shear",
    }
}

/// Hourglass control: artificial stiffness of the motions that the single point of a cell does not see
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct HourglassKeys {
    /// Stiffness of the motions that the point does not see, divided by the largest stiffness of a cell with
    /// this modulus, from 0 to 1; unless given, 0.05 with the P-wave modulus and 0.3 with the shear modulus
    coefficient: Option<f64>,
    /// Modulus of the material that the stiffness is proportional to; p-wave unless given
    modulus: Option<HourglassModulus>,
}

/// Hourglass control of hexahedra with one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hourglass {
    /// Coefficient, from 0 to 1.
    pub coefficient: f64,
    /// Modulus of the stiffness.
    pub modulus: HourglassModulus,
}

impl HourglassKeys {
    fn read(self, report: &Report) -> Hourglass {
        let modulus = self.modulus.unwrap_or(HourglassModulus::PWave);
        let coefficient = self.coefficient.unwrap_or(modulus.usual());
        let sound = (0.0..=1.0).contains(&coefficient);
        let help = format!("{} is usual with the modulus \"{}\"", modulus.usual(), modulus.name());
        report.require(sound, "coefficient", "is not between 0 and 1", &help);
        Hourglass { coefficient, modulus }
    }
}

impl HourglassModulus {
    /// Usual coefficient. That of the P-wave modulus is in most models of NiftySim (Johnsen et al., Int. J.
    /// Comput. Assist. Radiol. Surg. 10 (2015) 1077-1095), whose hexahedron this is. That of the shear modulus
    /// gives a cube the energy of pure bending, whose coefficient is `2 (1 + nu) / 9`.
    fn usual(self) -> f64 {
        match self {
            HourglassModulus::PWave => 0.05,
            HourglassModulus::Shear => 0.3,
        }
    }
}

#[derive(Deserialize, JsonSchema)]
pub(crate) struct FemKeys {
    element: Element,
    dilation: Option<Dilation>,
    /// Reduced integration: one point in hex8, 2 x 2 x 2 in hex20, 3 x 3 in wedge15
    #[serde(default)]
    reduced: bool,
    /// Hourglass control of hex8 with reduced = true
    hourglass: Option<HourglassKeys>,
    size: SizeKeys,
    jitter: Option<JitterKeys>,
    /// Refinement until an error is reached: tet4 and tet10 in boxes and in surfaces that tetrahedra fill
    refine: Option<AdaptKeys>,
    /// Mass matrix for vibrations; kind = "modes" only
    pub mass: Option<Mass>,
    pub pod: Option<PodKeys>,
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
    /// Hourglass control; `None` for elements without it.
    pub hourglass: Option<Hourglass>,
    /// Size of the mesh.
    pub size: Size,
    /// Random displacement of inner nodes.
    pub jitter: Option<Jitter>,
    /// Refinement of the mesh until an error is reached.
    pub adapt: Option<Adapt>,
}

/// Refinement where the error of a number comes from, until the number is accurate
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct AdaptKeys {
    /// Number whose error refines the mesh, such as "tool-force", "probe-2" or "reaction-z"
    by: String,
    /// Relative error of the number at which the refinement ends, such as "1 %"
    error: Q<Part>,
    /// Largest number of meshes, 2 to 10; 6 unless given
    rounds: Option<u32>,
}

/// Refinement of a mesh until a number is accurate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adapt {
    /// The number.
    pub by: Goal,
    /// Relative error at which the refinement ends.
    pub error: f64,
    /// Largest number of meshes.
    pub rounds: usize,
}

impl AdaptKeys {
    fn read(self, report: &Report) -> Option<Adapt> {
        let rounds = self.rounds.unwrap_or(ROUNDS);
        let sound = (2..=MOST_ROUNDS).contains(&rounds);
        report.require(sound, "rounds", "is not a valid number of meshes", "give 2 to 10; 6 is usual");
        let error = self.error.0;
        let sensible = error > 0.0 && error < 1.0;
        report.require(sensible, "error", "is not between 0 and 100 %", "such as \"1 %\"");
        Some(Adapt { by: Goal::read(&self.by, "by", report)?, error, rounds: rounds as usize })
    }
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
        let controlled = reduced && element.kind() == Some(CellKind::Hex8);
        let help = "leave it out, or take element = \"hex8\" with reduced = true";
        let unused = self.hourglass.is_none() || controlled;
        report.require(unused, "hourglass", "applies to hex8 with one point only", help);
        let hourglass = self.hourglass.unwrap_or_default().read(&report.at("hourglass"));
        let hourglass = controlled.then_some(hourglass);
        let jitter = self.jitter.map(|jitter| jitter.read(report));
        let dilation = self.dilation.unwrap_or(Dilation::Standard);
        let tets = element.kind().is_some_and(|kind| kind.of_order(1) == Some(CellKind::Tet4));
        let problem = format!("applies to tet4 and tet10 only, not to {}", element.name());
        report.require(self.refine.is_none() || tets, "refine", &problem, "leave it out, or take tet10");
        let adapt = self.refine.and_then(|keys| keys.read(&report.at("refine")));
        Some(Fem { element, dilation, reduced, hourglass, size: size?, jitter, adapt })
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
            dilation if self.hourglass.is_some() && dilation != Dilation::Standard => (
                dilation.name(),
                format!("does not apply to {name} with one point, which has one dilation already"),
                "leave it out, or take reduced = false".into(),
            ),
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
