//! One tidy long table: one number a row, with everything that is needed to find it again.
//!
//! All values are SI (lengths in metres, times in seconds); millimetres appear only when a table or a figure is drawn.
//!
//! - A row is found by `run`, `quantity`, `phase`, `step`, `mode`, `statistic` and `repeat`: no two rows agree in all of them.
//! - Errors (`rms-*`, `relative-rms`, `l2`, `energy`, `pressure`, `max-error*`, `peak-error`, `tool-force-error`) and plain outcomes
//!   (`max-*`, `tip`, `strain-energy`) have `statistic = "value"` and no phase, step or mode.
//! - Relative errors against a method or a stored record have beside them `statistic = "band"`, the reference's own error, where it is known:
//!   what is below it says nothing.
//! - Times (`time`: by the clock on the wall; `cpu-time`: of all threads of the process, of other runs too where several go on at
//!   once) have a `phase` (`prepare`, `assemble`, `factor`, `solve`, `transfer`, `total`; within `solve` a static path's
//!   `solve-to-limit`). Each repeat has a row (`statistic = "repeat"`, `repeat` counts from 1), and so have their `median`, and of
//!   `time` also `spread` (interquartile range) and `min`.
//! - `memory` is of the method, beyond its input; with `phase = "process"` of the whole process during the run.
//! - A loop of frames has the phases `repeated` and `repeated-field` with `median`, `p99` and `p99.9` or, of too few frames, `max` (s), and `frames`,
//!   `iterations` (per frame), `deviation` or, where it broke off, `broke-off` (pure numbers); `condense` is made once for it.
//! - A transfer scheme is a run of its own, whose `rms` is the error of the displacement after the transfer (the method's error and the
//!   transfer's together) and whose `transfer-rms` is what the transfer changes of the method's own displacement: `family = "interp"`, `variant` its name, `method` the scheme's id, `nodes` the number of
//!   source nodes, `from` the method whose field it carries and `kernel` that method's kernel.
//! - What is recorded step by step has one row per `step` (from 0, the start) and quantity: `closure` (m) or `time` (s, the
//!   model's own) says where the step is, `tool-force` (N), `external-work`, `strain-energy`, `kinetic-energy`, `contact-energy`,
//!   `friction-dissipation` and `damping-dissipation` (J) what was found there; a reference (`family = "reference"`) adds `low` and
//!   `high` rows for its uncertainty. Modes of vibration have their number in `mode` (from 1).
//! - The same approach at several sizes is one series: it differs in `level`, `nodes` and `spacing` only.
//!
//! Nothing is read out of a name: what a case is for is its `purpose`, what a method is its `family` and settings.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use crate::error::ReportError;

/// What made a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Finite elements.
    #[default]
    Fem,
    /// Element-free Galerkin.
    Efg,
    /// Another family of methods over a mesh.
    OverMesh,
    /// A solver outside this program.
    External,
    /// A transfer scheme.
    Interp,
    /// A stored or published reference.
    Reference,
}

/// What a case is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Purpose {
    /// A test of exactness: run times, locking and orders mean nothing.
    Patch,
    /// A smooth solution, whose errors fall with the order that theory promises.
    #[default]
    Smooth,
    /// A solution that is not smooth: no order is promised.
    Rough,
    /// A reading of a published case, compared with its numbers; no order is promised.
    Published,
}

/// One number of one run. Settings that a method does not have are `None`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Id of the run: the same for all of its rows, and in every study that runs the same case with the same settings and size.
    pub run: String,
    /// Case (scene) name, such as `pure-bending`.
    pub case: String,
    /// What the case is for.
    pub purpose: Purpose,
    /// The published comparison that the case belongs to, such as `saghaei-2016`; empty where there is none.
    pub published: String,
    /// Method id as the scene gives it, such as `tet4` or `efg-83`.
    pub method: String,
    /// The name that the sizes of one approach share, such as `efg`.
    pub series: String,
    /// Finite elements, clouds, a transfer scheme or a reference.
    pub family: Family,
    /// Element (`tet10`), kernel (`cubic-spline`), transfer scheme (`inverse-distance`) or, of a reference, its method.
    pub variant: String,
    /// Polynomial basis of a cloud: `linear`, `quadratic` or `maximum-entropy`.
    pub basis: Option<String>,
    /// Support radius over the local node spacing.
    pub support_scale: Option<f64>,
    /// Neighbours that a support reaches to, or that a transfer scheme takes.
    pub neighbours: Option<u64>,
    /// Support radius over the distance to the last of these neighbours.
    pub neighbour_factor: Option<f64>,
    /// Shape of supports other than balls.
    pub neighbourhood: Option<String>,
    /// Locality of maximum-entropy functions.
    pub gamma: Option<f64>,
    /// Kernel of a cloud; of a transfer scheme that of the method whose field it carries.
    pub kernel: Option<String>,
    /// Volumetric projection, such as `standard` or `nodal-mean`.
    pub dilation: Option<String>,
    /// Rule of integration where a family has several, such as `gauss-4` or `cell-smoothed-1`.
    pub integration: Option<String>,
    /// How prescribed displacements are imposed on a cloud, such as `nitsche`.
    pub essential: Option<String>,
    /// Error indicator and steps by which a cloud was refined.
    pub refine: Option<String>,
    /// Rule of the second integration by which errors of integration and of discretisation are told apart.
    pub split: Option<String>,
    /// Material law at large strain.
    pub law: Option<String>,
    /// Mass of vibrations: `consistent`, `lumped` or `transformed`.
    pub mass: Option<String>,
    /// The method whose field a transfer scheme carries.
    pub from: Option<String>,
    /// Power of the distance in a transfer scheme.
    pub power: Option<f64>,
    /// Width of a scheme's radial functions over the mean node spacing.
    pub shape: Option<f64>,
    /// Whether a scheme's radial functions have a linear polynomial with them.
    pub polynomial: Option<bool>,
    /// Kernel that evaluated the internal forces of explicit dynamics.
    pub force_kernel: Option<String>,
    /// The adapter of a solver outside this program, with its settings.
    #[serde(default)]
    pub adapter: Option<String>,
    /// Lanes that it ran in, such as `avx2`, or `plain` for one element at a time.
    pub lane_path: Option<String>,
    /// Linear solver that ran, such as `sparse-llt`.
    pub linear_solver: Option<String>,
    /// What a study drives the scene along; empty for the scene as it is.
    #[serde(default)]
    pub axis: String,
    /// Where on that axis it is.
    #[serde(default)]
    pub at: Option<f64>,
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
    /// What was measured: `rms-x`, `rms`, `l2`, `energy`, `pressure`, `max-x`, `time`, `memory`, `condition-max`, `tip`, ...
    pub quantity: String,
    /// SI unit as text: `m`, `s`, `Pa`, `B`, or `1` for a pure number.
    pub unit: String,
    /// Phase of a time: `prepare`, `assemble`, `factor`, `solve`, `transfer`, `total`, `repeated`; empty where none applies.
    pub phase: String,
    /// Load step or recorded state, 0 the start.
    pub step: Option<u64>,
    /// Mode of vibration, 1 the lowest.
    pub mode: Option<u64>,
    /// `value`, `repeat`, `median`, `spread` (interquartile range), `min`, `max`, `p99` and `p99.9`
    /// (quantiles), the ends `low` and `high` of an uncertainty, or `band`: the reference's own error in that
    /// quantity.
    pub statistic: String,
    /// Which repeat of a timing, from 1.
    pub repeat: Option<u64>,
    /// The number, in `unit`; always finite.
    pub value: f64,
}

/// What finds a row: run, quantity, phase, step, mode, statistic, repeat.
pub(crate) type Key<'a> = (&'a str, &'a str, &'a str, Option<u64>, Option<u64>, &'a str, Option<u64>);

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

    /// All of its texts.
    pub(crate) fn texts_mut(&mut self) -> impl Iterator<Item = &mut String> {
        let own = [
            &mut self.run,
            &mut self.case,
            &mut self.published,
            &mut self.method,
            &mut self.series,
            &mut self.variant,
            &mut self.axis,
            &mut self.quantity,
            &mut self.unit,
            &mut self.phase,
            &mut self.statistic,
        ];
        let settings = [
            &mut self.basis,
            &mut self.neighbourhood,
            &mut self.kernel,
            &mut self.dilation,
            &mut self.integration,
            &mut self.essential,
            &mut self.refine,
            &mut self.split,
            &mut self.law,
            &mut self.mass,
            &mut self.from,
            &mut self.force_kernel,
            &mut self.adapter,
            &mut self.lane_path,
            &mut self.linear_solver,
        ];
        own.into_iter().chain(settings.into_iter().flatten())
    }

    /// Whether the value depends on the machine and the moment (times and memory): such rows are left out when two runs
    /// are compared bit by bit.
    pub fn is_measured(&self) -> bool {
        match self.quantity.as_str() {
            // Of a step, time is the model's own.
            "time" => self.step.is_none(),
            "cpu-time" | "memory" => true,
            _ => false,
        }
    }

    /// What no other row has.
    pub(crate) fn key(&self) -> Key<'_> {
        let Record { run, quantity, phase, step, mode, statistic, repeat, .. } = self;
        (run, quantity, phase, *step, *mode, statistic, *repeat)
    }

    /// The settings that a method has, with their names in words. A kernel that is the variant is not repeated.
    pub fn settings(&self) -> Vec<(&'static str, String)> {
        let words = |value: &Option<String>| value.clone();
        let number = |value: &Option<f64>| value.map(|v| v.to_string());
        let all = [
            ("adapter", words(&self.adapter)),
            ("along", self.at.map(|at| format!("{} at {at}", self.axis))),
            ("basis", words(&self.basis)),
            ("support scale", number(&self.support_scale)),
            ("dilation", words(&self.dilation)),
            ("essential", words(&self.essential)),
            ("neighbour factor", number(&self.neighbour_factor)),
            ("from", words(&self.from)),
            ("gamma", number(&self.gamma)),
            ("integration", words(&self.integration)),
            ("kernel", words(&self.kernel).filter(|kernel| *kernel != self.variant)),
            ("law", words(&self.law)),
            ("mass", words(&self.mass)),
            ("neighbours", self.neighbours.map(|n| n.to_string())),
            ("polynomial", self.polynomial.map(|p| p.to_string())),
            ("power", number(&self.power)),
            ("refine", words(&self.refine)),
            ("shape", number(&self.shape)),
            ("split", words(&self.split)),
            ("neighbourhood", words(&self.neighbourhood)),
        ];
        all.into_iter().filter_map(|(name, value)| Some((name, value?))).collect()
    }

    /// The order of the stored table: by run as a reader would look for it, then by what finds a row.
    pub fn order(&self, other: &Record) -> Ordering {
        type Who<'a> = (&'a str, Family, &'a str, &'a str, u32, u64, u64);
        fn who(r: &Record) -> Who<'_> {
            (&r.case, r.family, &r.method, &r.variant, r.level, r.nodes, r.seed)
        }
        who(self)
            .cmp(&who(other))
            .then(self.poisson.total_cmp(&other.poisson))
            .then_with(|| match self.run == other.run {
                true => Ordering::Equal,
                // Not by their ids alone, which the name of a case is part of.
                false => self.settings().cmp(&other.settings()),
            })
            .then_with(|| self.key().cmp(&other.key()))
            .then(self.value.total_cmp(&other.value))
    }
}

#[cfg(test)]
impl Record {
    /// What tests fill in: a value of a run of no size.
    pub(crate) fn blank() -> Record {
        Record { poisson: 0.495, unit: "m".into(), statistic: "value".into(), ..Record::default() }
    }

    /// With an id made of what tells runs of tests apart.
    pub(crate) fn of_its_run(mut self) -> Record {
        let who = (
            &self.case,
            &self.method,
            &self.variant,
            self.settings(),
            self.poisson.to_bits(),
            self.level,
            self.nodes,
            self.seed,
        );
        self.run = format!("{who:?}");
        self
    }
}
