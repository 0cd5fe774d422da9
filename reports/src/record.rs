//! The one tidy long table every run is told in: one number per row, with everything needed to find it again.
//!
//! All values are SI (lengths in metres, times in seconds); millimetres appear only when a table or a figure is drawn.
//!
//! Conventions the tables and figures rely on:
//! - errors (`rms-*`, `relative-rms`, `l2`, `energy`, `pressure`, `max-error*`, `peak-error`, `tool-force-error`) and plain
//!   outcomes (`max-*`, `tip`, `strain-energy`) have `statistic = "value"` and `phase = ""`;
//! - times are `quantity = "time"`, `unit = "s"`, one row per `phase` (`prepare`, `assemble`, `factor`, `solve`, `transfer`,
//!   `total`; within `solve` a static path's `solve-to-limit`) and per `statistic` (`median`, `spread`, `min`);
//! - a loop of frames has the phases `repeated` and `repeated-field` with `median`, `p99` and `p99.9` (s), and `frames`,
//!   `iterations` (per frame), `deviation` or, where it broke off, `broke-off` (pure numbers); `condense` is made once for it;
//! - a transfer scheme is `family = "interp"`, `variant` its name, `method` the scheme's id and `nodes` the number of source
//!   nodes; `parameters` names the source with `from=METHOD` or the field with `field=linear`;
//! - what is told step by step has one row per step and quantity, with `phase = "step-N"` (N counts from 0): `closure` (m) or
//!   `time` (s) says where the step is, `tool-force` (N), `external-work`, `strain-energy`, `kinetic-energy`,
//!   `contact-energy`, `friction-dissipation` and `damping-dissipation` (J) what was found there, `statistic = "value"`; a
//!   reference (`family = "reference"`, `method` its source) adds `low` and `high` rows for its uncertainty;
//! - the same approach at several sizes is one series: it differs in `level`, `nodes` and `spacing` only (a method id that
//!   ends in its node count, as in `efg-83`, is read without that ending).

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use crate::error::ReportError;
use crate::history::step;

/// One number of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Case (scene) name, such as `pure-bending`.
    pub case: String,
    /// Method id as the scene gives it, such as `tet4` or `efg-83`.
    pub method: String,
    /// `fem`, `efg`, `interp` or `reference`.
    pub family: String,
    /// Element (`tet10`), kernel (`cubic-spline`) or transfer scheme (`inverse-distance`).
    pub variant: String,
    /// Further settings as `key=value` pairs joined by `;` and sorted by key, such as `basis=linear;dilatation=1.6`.
    pub parameters: String,
    /// Poisson's ratio of the (first) material, dimensionless.
    pub poisson: f64,
    /// Refinement level, 1 the coarsest; 0 where the run belongs to no family of levels.
    pub level: u32,
    /// Nodes of the discretisation.
    pub nodes: u64,
    /// Elements (finite elements or background cells).
    pub elements: u64,
    /// Integration points.
    pub points: u64,
    /// Unknowns solved for: supports eliminated, multipliers included.
    pub dofs: u64,
    /// Mean node spacing h, in metres.
    pub spacing: f64,
    /// Seed of jitter and clouds; 0 where there is no randomness.
    pub seed: u64,
    /// What was measured: `rms-x`, `rms-y`, `rms-z`, `rms`, `l2`, `energy`, `pressure`, `max-x`, `time`, `memory`,
    /// `condition-median`, `condition-max`, `neighbours-mean`, `fallbacks`, `tip`, ...
    pub quantity: String,
    /// SI unit as text: `m`, `s`, `Pa`, `B`, or `1` for a pure number.
    pub unit: String,
    /// `prepare`, `assemble`, `factor`, `solve`, `transfer`, `total`, `repeated`, `step-N`, or empty where no phase applies.
    pub phase: String,
    /// `value`, `median`, `spread` (interquartile range), `min`, `p99` and `p99.9` (quantiles), or the ends `low` and `high` of an uncertainty.
    pub statistic: String,
    /// The number, in `unit`; always finite.
    pub value: f64,
}

impl Record {
    /// Refuses a record whose value, Poisson's ratio or spacing isn't finite.
    pub fn check(&self) -> Result<(), ReportError> {
        for (field, value) in [("value", self.value), ("poisson", self.poisson), ("spacing", self.spacing)] {
            if !value.is_finite() {
                return Err(ReportError::NotFinite {
                    case: self.case.clone(),
                    method: self.method.clone(),
                    quantity: self.quantity.clone(),
                    field,
                    value,
                });
            }
        }
        Ok(())
    }

    /// Whether the value depends on the machine and the moment (times and memory): such rows are left out when two runs
    /// are compared bit by bit.
    pub fn is_measured(&self) -> bool {
        // Of a step, time is the model's own.
        self.quantity == "time" && step(self).is_none() || self.quantity == "memory"
    }

    /// The value of one key in `parameters`.
    pub fn parameter(&self, key: &str) -> Option<&str> {
        self.parameters
            .split(';')
            .find_map(|pair| pair.split_once('=').filter(|(k, _)| *k == key).map(|(_, v)| v))
    }

    /// Total order by every identifying field, then by value: the order of the stored table.
    pub fn order(&self, other: &Record) -> Ordering {
        let key = |r: &Record| {
            (
                r.case.clone(),
                r.family.clone(),
                r.method.clone(),
                r.variant.clone(),
                r.parameters.clone(),
                r.level,
                r.nodes,
            )
        };
        let detail = |r: &Record| (r.seed, r.quantity.clone(), r.phase.clone(), r.statistic.clone());
        key(self)
            .cmp(&key(other))
            .then(self.poisson.total_cmp(&other.poisson))
            .then_with(|| detail(self).cmp(&detail(other)))
            .then(self.spacing.total_cmp(&other.spacing))
            .then(self.value.total_cmp(&other.value))
    }
}

/// Where, by what and from what a run's numbers came. Carries no date: two runs of one state are the same bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of the program.
    pub version: String,
    /// Commit of the source, with `+` appended when the tree had changes.
    pub commit: String,
    /// Compiler version.
    pub rustc: String,
    /// Processor model.
    pub cpu: String,
    /// Threads the solvers used.
    pub threads: u32,
    /// Seed of the study.
    pub seed: u64,
    /// CPU and build features in use, such as `avx2,fma`.
    pub features: String,
    /// Build profile: `release` or `dev`.
    pub profile: String,
    /// Content hash (BLAKE3, hexadecimal) of each scene file, by scene name, sorted.
    pub scenes: Vec<SceneHash>,
}

/// The content hash of one scene file.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SceneHash {
    /// Scene (case) name.
    pub case: String,
    /// BLAKE3 hash of the file, hexadecimal.
    pub blake3: String,
}

/// How a check came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
}

/// Displacement on a body's surface, for the pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceField {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
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

/// A run that gave no numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Case name.
    pub case: String,
    /// Method id.
    pub method: String,
    /// What went wrong.
    pub reason: String,
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
    /// Runs that failed.
    pub failures: Vec<Failure>,
}

#[cfg(test)]
impl Record {
    /// What tests fill in: a value of a run of no size.
    pub(crate) fn blank() -> Record {
        Record {
            case: String::new(),
            method: String::new(),
            family: String::new(),
            variant: String::new(),
            parameters: String::new(),
            poisson: 0.495,
            level: 0,
            nodes: 0,
            elements: 0,
            points: 0,
            dofs: 0,
            spacing: 0.0,
            seed: 0,
            quantity: String::new(),
            unit: "m".into(),
            phase: String::new(),
            statistic: "value".into(),
            value: 0.0,
        }
    }
}
