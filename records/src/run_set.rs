//! Results of one study.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::body::RecordedBody;
use crate::error::RecordError;
use crate::fit::Fit;
use crate::provenance::Provenance;
use crate::record::{Family, Record};
use crate::reference::Reference;
use crate::samples::Samples;

/// Outcome of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// The bound held.
    Pass,
    /// The bound did not hold.
    Fail,
    /// The bound did not hold, as expected for the stated reason.
    KnownFailure,
    /// The check could not be evaluated.
    NotRun,
}

impl Status {
    /// Name in files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Status::Pass => "pass",
            Status::Fail => "fail",
            Status::KnownFailure => "known-failure",
            Status::NotRun => "not-run",
        }
    }

    /// Parses a name.
    pub fn from_name(name: &str) -> Option<Status> {
        [Status::Pass, Status::Fail, Status::KnownFailure, Status::NotRun]
            .into_iter()
            .find(|s| s.name() == name)
    }
}

/// Bound on a number, and its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Check {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Name of the bounded number, such as `rms-x` or `order-l2`.
    pub metric: String,
    /// Value in SI units; `None` if it could not be computed.
    pub value: Option<f64>,
    /// The bound in words, such as `at most 1e-12`.
    pub bound: String,
    /// Whether the bound has an upper end: an error that only has a least value proves nothing right.
    #[serde(default)]
    pub capped: bool,
    /// Outcome of the check.
    pub status: Status,
    /// Reason for a failure, a known failure or a check that did not run, or why the bound of a passed check
    /// proves nothing; else empty.
    pub reason: String,
    /// Ids of the runs that gave the value: one, or those of all levels or clouds of a method; empty for a
    /// run without numbers.
    #[serde(default)]
    pub runs: Vec<String>,
    /// Place of the check, as `file:line` with the file name as given. It is not stored, so that results do
    /// not depend on the location of a study.
    #[serde(skip)]
    pub at: String,
}

/// Displacement on a body's surface, for pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceField {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Family of the method.
    pub family: Family,
    /// Title above the picture.
    pub title: String,
    /// Surface points in the reference configuration, metres.
    pub points: Vec<[f64; 3]>,
    /// Corner indices into `points`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Displacement at each point, metres.
    pub displacement: Vec<[f64; 3]>,
    /// Tools of the scene at their positions in this state.
    #[serde(default)]
    pub tools: Vec<ToolHull>,
    /// Section between the tools.
    #[serde(default)]
    pub section: Option<Section>,
    /// Data of the three-dimensional view.
    #[serde(default)]
    pub body: Option<RecordedBody>,
}

/// A tool as the convex hull of points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ToolHull {
    /// Name in the scene.
    pub name: String,
    /// Positions of the points, m.
    pub points: Vec<[f64; 3]>,
}

/// A plane cut through the undeformed body, shown deformed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Unit vector in the plane that points right on paper: the travel of the first tool.
    pub right: [f64; 3],
    /// Unit vector in the plane that points up on paper.
    pub up: [f64; 3],
    /// Cells cut by the plane.
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
    /// Checks the arrays of the field.
    ///
    /// # Errors
    /// Arrays that are inconsistent or contain a number that is not finite.
    pub fn check(&self) -> Result<(), RecordError> {
        let wrong = |reason: String| RecordError::Field {
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
            return Err(wrong("a coordinate or a displacement is not finite".into()));
        }
        let cells = || self.section.iter().flat_map(|s| &s.cells);
        let more = self.tools.iter().flat_map(|t| &t.points).chain(cells().flat_map(|c| &c.corners));
        if more.flatten().any(|v| !v.is_finite()) || cells().any(|c| !c.pressure.is_finite()) {
            return Err(wrong("a tool or a section holds a number that is not finite".into()));
        }
        Ok(())
    }
}

/// Decision on one stage of a run's plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlanEntry {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Stage, such as `contact search`.
    pub stage: String,
    /// Whether the stage ran.
    pub ran: bool,
    /// Reason for which the stage ran or was skipped.
    pub why: String,
}

/// A run that ended early, without numbers or with those of a partial load.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Reason for the early end.
    pub reason: String,
    /// Load fraction, 0 to 1, that the numbers belong to; `None` without numbers.
    #[serde(default)]
    pub carried: Option<f64>,
    /// Status word, such as `stalled`.
    #[serde(default)]
    pub status: String,
    /// Adapter of a solver outside of this program, with its settings; empty for a run of this program.
    #[serde(default)]
    pub adapter: String,
    /// Place of the key concerned, `file:line`; empty if unknown.
    #[serde(default)]
    pub at: String,
}

/// Warning about the numbers of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// Id of the run, as in the records.
    pub run: String,
    /// Code of the warning, such as `probe-outside`.
    pub code: String,
    /// Message with its numbers.
    pub message: String,
    /// Decisive number, SI.
    pub value: f64,
    /// Unit of the value; `1` for a pure number.
    pub unit: String,
    /// Scene key concerned, or empty.
    #[serde(rename = "where")]
    pub place: String,
}

/// Results of one study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunSet {
    /// Provenance of the numbers.
    pub provenance: Provenance,
    /// Numbers of all runs.
    pub records: Vec<Record>,
    /// Checks with their outcomes.
    pub checks: Vec<Check>,
    /// Surface displacements for pictures.
    pub fields: Vec<SurfaceField>,
    /// Stages run and skipped.
    pub plans: Vec<PlanEntry>,
    /// Runs that failed or ended early.
    pub failures: Vec<Failure>,
    /// Warnings about the numbers.
    pub warnings: Vec<Warning>,
    /// References of the numbers.
    pub references: Vec<Reference>,
    /// Outcomes of methods along axes.
    pub axes: Vec<Axis>,
    /// Samples of scenes with uncertain inputs.
    pub samples: Vec<Samples>,
    /// Fits of constants to measured curves.
    pub fits: Vec<Fit>,
}
