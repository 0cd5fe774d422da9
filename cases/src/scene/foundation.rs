//! Springs and dampers between a part of the surface and the ground.

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;

use super::body::Body;
use super::procedure::{Procedure, ProcedureKind};
use super::region::Region;
use super::report::Report;
use super::selection::{Names, Place};
use super::units::{ContactSlope, Q, SurfaceDamping};

/// Directions in which a foundation acts
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Along {
    /// In all directions alike
    All,
    /// Along the normal of the undeformed surface only
    Normal,
}

/// Springs and dampers on a part of the surface, fixed to the ground (an elastic foundation)
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FoundationKeys {
    /// Names given by the shape or the mesh file
    on: Option<Names>,
    /// Comparisons joined by 'and'
    #[serde(rename = "where")]
    place: Option<Region>,
    /// Stiffness of the springs per undeformed area
    stiffness: Option<Q<ContactSlope>>,
    /// Damping of the dampers per undeformed area, in dynamics
    damping: Option<Q<SurfaceDamping>>,
    /// Directions of the springs and dampers; "all" unless given
    along: Option<Along>,
}

/// Springs and dampers between a part of the surface and the ground. Their force per undeformed area is
/// `-k u - c v`, or that of the components of `u` and `v` along the normal of the undeformed surface.
#[derive(Clone, Debug)]
pub struct Foundation {
    /// Part of the surface.
    pub place: Place,
    /// Stiffness `k` per undeformed area, Pa/m; 0 without springs.
    pub stiffness: f64,
    /// Damping `c` per undeformed area, Pa s/m; 0 without dampers.
    pub damping: f64,
    /// Whether springs and dampers act along the normal only.
    pub along_normal: bool,
}

impl FoundationKeys {
    /// Reads a foundation; checks its names of surfaces if the body is known.
    pub fn read(self, body: Option<&Body>, report: &Report) -> Foundation {
        let place = Place::required(self.on, self.place, report);
        body.inspect(|body| body.find(&place, report));
        if self.stiffness.is_none() && self.damping.is_none() {
            report.missing("stiffness", "give stiffness = \"1 kPa/mm\", or damping, or both");
        }
        Foundation {
            place,
            stiffness: self.stiffness.map_or(0.0, |k| report.positive("stiffness", k.0)),
            damping: self.damping.map_or(0.0, |c| report.positive("damping", c.0)),
            along_normal: self.along == Some(Along::Normal),
        }
    }
}

/// Reports dampers in a procedure without velocities.
pub(crate) fn demands(foundations: &[Foundation], procedure: &Procedure, report: &Report) {
    let kind = procedure.kind();
    if matches!(kind, ProcedureKind::Explicit | ProcedureKind::ImplicitDynamic) {
        return;
    }
    for index in foundations.iter().enumerate().filter(|(_, of)| of.damping > 0.0).map(|(index, _)| index) {
        let problem = Problem::new(format!("has no effect: kind = \"{}\" has no velocities", kind.name()));
        let help = "leave it out, or take kind = \"explicit\" or \"implicit-dynamic\"";
        report.add(&format!("foundation[{index}].damping"), problem.help(help));
    }
}
