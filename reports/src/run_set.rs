//! Everything that one study leaves behind.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::body::Body;
use crate::error::ReportError;
use crate::provenance::Provenance;
use crate::record::{Family, Record};
use crate::reference::Reference;

/// How a check came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The bound held.
    Pass,
    /// The bound didn't hold.
    Fail,
    /// The bound didn't hold and wasn't expected to; the reason says why.
    KnownFailure,
    /// The check couldn't be evaluated.
    NotRun,
}

impl Status {
    /// The word used in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Status::Pass => "pass",
            Status::Fail => "fail",
            Status::KnownFailure => "known-failure",
            Status::NotRun => "not-run",
        }
    }

    /// Reads the word back.
    pub fn from_name(name: &str) -> Option<Status> {
        [Status::Pass, Status::Fail, Status::KnownFailure, Status::NotRun]
            .into_iter()
            .find(|s| s.name() == name)
    }
}

/// One bound on one number, and whether it held.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Check {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// The number that is bounded, such as `rms-x` or `order-l2`.
    pub metric: String,
    /// Its value in SI; `None` where it couldn't be computed.
    pub value: Option<f64>,
    /// The bound in words, such as `at most 1e-12`.
    pub bound: String,
    /// How it came out.
    pub status: Status,
    /// Why it failed, is known to fail, or wasn't run; empty for a pass.
    pub reason: String,
    /// Place of the check, `file:line` with the file as it was named; not stored, as results are the same
    /// wherever a study is.
    #[serde(skip)]
    pub at: String,
}

/// Displacement on a body's surface, for the pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceField {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Finite elements or a cloud.
    pub family: Family,
    /// Title above the picture.
    pub title: String,
    /// Surface points in the reference configuration, metres.
    pub points: Vec<[f64; 3]>,
    /// Corner indices into `points`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Displacement at each point, metres.
    pub displacement: Vec<[f64; 3]>,
    /// The tools of a scene where they stand in this state.
    #[serde(default)]
    pub tools: Vec<ToolHull>,
    /// A section between the tools.
    #[serde(default)]
    pub section: Option<Section>,
    /// What a view in three dimensions shows.
    #[serde(default)]
    pub body: Option<Body>,
}

/// A tool as points whose convex hull it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ToolHull {
    /// Name in the scene.
    pub name: String,
    /// The points, metres.
    pub points: Vec<[f64; 3]>,
}

/// A plane cut through the undeformed body, shown deformed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Unit vector in the plane that is to the right on paper: the way of the first tool.
    pub right: [f64; 3],
    /// Unit vector in the plane that is upwards on paper.
    pub up: [f64; 3],
    /// The cells it cuts.
    pub cells: Vec<SectionCell>,
}

/// A plane's cut through one cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SectionCell {
    /// Deformed corners in the order around the cut, metres.
    pub corners: Vec<[f64; 3]>,
    /// Mean pressure over the whole cell, Pa, positive in compression.
    pub pressure: f64,
}

impl SurfaceField {
    /// Refuses a field whose arrays don't fit together or hold a number that isn't finite.
    pub fn check(&self) -> Result<(), ReportError> {
        let wrong = |reason: String| ReportError::Field {
            case: self.case.clone(),
            method: self.method.clone(),
            reason,
        };
        let n = self.points.len();
        if self.displacement.len() != n {
            return Err(wrong(format!("{n} points but {} displacements", self.displacement.len())));
        }
        if let Some(t) = self.triangles.iter().flatten().find(|&&t| t as usize >= n) {
            return Err(wrong(format!("a triangle names point {t} of {n}")));
        }
        if self.points.iter().chain(&self.displacement).flatten().any(|v| !v.is_finite()) {
            return Err(wrong("a coordinate or a displacement isn't finite".into()));
        }
        let cells = || self.section.iter().flat_map(|s| &s.cells);
        let more = self.tools.iter().flat_map(|t| &t.points).chain(cells().flat_map(|c| &c.corners));
        if more.flatten().any(|v| !v.is_finite()) || cells().any(|c| !c.pressure.is_finite()) {
            return Err(wrong("a tool or a section holds a number that isn't finite".into()));
        }
        Ok(())
    }
}

/// One stage of one plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlanEntry {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Stage, such as `contact search`.
    pub stage: String,
    /// Whether it ran.
    pub ran: bool,
    /// Why it ran or was skipped.
    pub why: String,
}

/// A run that ended early: it gave no numbers, or those of a part of its load.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// What went wrong.
    pub reason: String,
    /// The part of the load, 0 to 1, that its numbers are of; `None` where it gave none.
    #[serde(default)]
    pub carried: Option<f64>,
    /// The word for how it ended, such as `stalled`.
    #[serde(default)]
    pub status: String,
    /// The adapter of a solver outside this program, with its settings; empty for a run of this program.
    #[serde(default)]
    pub adapter: String,
    /// Place of the key that it is about, `file:line`; empty where none is known.
    #[serde(default)]
    pub at: String,
}

/// What is to be said against the numbers of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Id of the run, as in the records.
    pub run: String,
    /// Which warning, such as `probe-outside`.
    pub code: String,
    /// What it means here, with its numbers.
    pub message: String,
    /// The number it goes by, SI.
    pub value: f64,
    /// Unit of the value; `1` for a bare number.
    pub unit: String,
    /// The key of the scene that it is about, or empty.
    #[serde(rename = "where")]
    pub place: String,
}

/// Everything one study leaves behind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunSet {
    /// Where the numbers come from.
    pub provenance: Provenance,
    /// The numbers.
    pub records: Vec<Record>,
    /// The bounds.
    pub checks: Vec<Check>,
    /// Surface displacements for the pictures.
    pub fields: Vec<SurfaceField>,
    /// Stages run and skipped.
    pub plans: Vec<PlanEntry>,
    /// Runs that failed or ended early.
    pub failures: Vec<Failure>,
    /// What is to be said against the numbers.
    pub warnings: Vec<Warning>,
    /// References of the numbers.
    pub references: Vec<Reference>,
    /// How methods fare along axes.
    pub axes: Vec<Axis>,
}
