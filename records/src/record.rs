//! Tidy long table of results: one number per row, with all that identifies it.
//!
//! All values are SI (lengths in metres, times in seconds). Millimetres appear only in drawn tables and
//! figures.
//!
//! - A row is identified by `run`, `quantity`, `component`, `index`, `phase`, `step`, `mode`, `statistic` and
//!   `repeat`: no two rows agree in all of them.
//! - The displacement error `rms` has the components `x`, `y` and `z`, and without a component its magnitude.
//!   `index` is the number of a tool, support or face. Checks, baselines and messages use the name that
//!   combines the three columns: `rms-x`, `tool-force-2` ([`Record::name`]).
//! - Errors (`rms`, `relative-rms`, `l2`, `energy`, `pressure`, `max-error`, `peak-error`,
//!   `tool-force-error`) and plain outcomes (`max`, `tip`, `strain-energy`) have `statistic = "value"` and no
//!   phase, step or mode.
//! - Relative errors against a method or a stored record also have a row with `statistic = "band"`, if the
//!   error of the reference itself is known. Differences below this value are not significant.
//! - Times are `time` (wall time) or `cpu-time` (of all threads of the process, including concurrent runs).
//!   They have a `phase` (`prepare`, `assemble`, `factor`, `solve`, `transfer`, `total`; within `solve` also
//!   `solve-to-limit` of a static path). Each repeat has a row (`statistic = "repeat"`, `repeat` counts from
//!   1). Further rows have the `median`, and for `time` the `spread` (interquartile range) and `min`.
//! - `memory` is that of the method in excess of its input; with `phase = "process"`, that of the whole
//!   process during the run.
//! - A loop of frames has the phases `repeated` and `repeated-field`. Their rows are `median`, `p99` and
//!   `p99.9` or, for too few frames, `max` (s), and the pure numbers `frames`, `iterations` (per frame),
//!   `deviation` and, for a loop that ended early, `broke-off`. The phase `condense` is computed once for the
//!   loop.
//! - A transfer scheme is a separate run with `family = "interp"`. Its `rms` is the error of the displacement
//!   after the transfer, which combines the errors of the method and the transfer. Its `transfer-rms` is the
//!   change by the transfer of the method's own displacement. `variant` is the name of the scheme, `method`
//!   its id, `nodes` the number of source nodes, `from` the method whose field is transferred, and `kernel`
//!   the kernel of this method.
//! - Histories have one row per `step` (from 0, the start) and quantity. The step is located by `closure` (m)
//!   or `time` (s, of the model). Results are `tool-force` (N), and `external-work`, `strain-energy`,
//!   `kinetic-energy`, `contact-energy`, `friction-dissipation` and `damping-dissipation` (J). A reference
//!   (`family = "reference"`) adds rows `low` and `high` for its uncertainty. Modes of vibration have their
//!   number in `mode` (from 1).
//! - An approach at several sizes forms one series, which varies only in `level`, `nodes` and `spacing`.
//!
//! No information is derived from names: the role of a case is its `purpose`, and a method is described by
//! its `family` and settings.

use std::cmp::Ordering;

use catalogue::metric::{self, Address};
use serde::{Deserialize, Serialize};

use crate::error::RecordError;

/// Kind of method that produced a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Finite elements.
    #[default]
    Fem,
    /// Element-free Galerkin.
    Efg,
    /// A solver outside of this program.
    External,
    /// A transfer scheme.
    Interp,
    /// A stored or published reference.
    Reference,
}

/// Purpose of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Purpose {
    /// A test of exactness, without meaning for run times, locking and orders.
    Patch,
    /// A smooth solution, whose errors decrease with the theoretical order.
    #[default]
    Smooth,
    /// A non-smooth solution, without a theoretical order.
    Rough,
    /// A reproduction of a published case, compared with its numbers, without a theoretical order.
    Published,
}

/// One number of one run. Settings that a method does not have are `None`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Id of the run, the same for all its rows and in every study that runs the same case with the same
    /// settings and size.
    pub run: String,
    /// Case (scene) name, such as `pure-bending`.
    pub case: String,
    /// Purpose of the case.
    pub purpose: Purpose,
    /// Published comparison that the case belongs to, such as `saghaei-2016`; empty without one.
    pub published: String,
    /// Method id in the scene, such as `tet4` or `efg-83`.
    pub method: String,
    /// Common name of the sizes of an approach, such as `efg`.
    pub series: String,
    /// Finite elements, clouds, a transfer scheme or a reference.
    pub family: Family,
    /// Element (`tet10`), kernel (`cubic-spline`), transfer scheme (`inverse-distance`) or method of a
    /// reference.
    pub variant: String,
    /// Polynomial basis of a cloud: `linear`, `quadratic` or `maximum-entropy`.
    pub basis: Option<String>,
    /// Support radius over the local node spacing.
    pub support_scale: Option<f64>,
    /// Number of neighbours that a support reaches, or that a transfer scheme uses.
    pub neighbours: Option<u64>,
    /// Support radius over the distance to the last of these neighbours.
    pub neighbour_factor: Option<f64>,
    /// Shape of supports that are not balls.
    pub neighbourhood: Option<String>,
    /// Locality of maximum-entropy functions.
    pub gamma: Option<f64>,
    /// Kernel of a cloud; for a transfer scheme, that of the method whose field is transferred.
    pub kernel: Option<String>,
    /// Volumetric projection, such as `standard` or `nodal-mean`.
    pub dilation: Option<String>,
    /// Integration rule, for a family with several, such as `gauss-4` or `cell-smoothed-1`.
    pub integration: Option<String>,
    /// Enforcement of prescribed displacements on a cloud, such as `nitsche`.
    pub essential: Option<String>,
    /// Error indicator and number of steps of the refinement of a cloud.
    pub refine: Option<String>,
    /// Rule of the second integration that separates integration errors from discretisation errors.
    pub split: Option<String>,
    /// Material law at large strain.
    pub law: Option<String>,
    /// Mass matrix of vibrations: `consistent`, `lumped` or `transformed`.
    pub mass: Option<String>,
    /// Method whose field a transfer scheme transfers.
    pub from: Option<String>,
    /// Power of the distance in a transfer scheme.
    pub power: Option<f64>,
    /// Width of a scheme's radial functions over the mean node spacing.
    pub shape: Option<f64>,
    /// Whether the radial functions of a scheme are augmented by a linear polynomial.
    pub polynomial: Option<bool>,
    /// Kernel for the internal forces of explicit dynamics.
    pub force_kernel: Option<String>,
    /// Adapter of a solver outside of this program, with its settings.
    #[serde(default)]
    pub adapter: Option<String>,
    /// SIMD lanes of the run, such as `avx2`, or `plain` for one element at a time.
    pub lane_path: Option<String>,
    /// Linear solver of the run, such as `sparse-llt`.
    pub linear_solver: Option<String>,
    /// Axis along which a study varies the scene; empty for the unchanged scene.
    #[serde(default)]
    pub axis: String,
    /// Value on this axis.
    #[serde(default)]
    pub at: Option<f64>,
    /// Poisson's ratio of the (first) material, dimensionless.
    pub poisson: f64,
    /// Refinement level, 1 the coarsest; 0 for a run without levels.
    pub level: u32,
    /// Nodes of the discretisation.
    pub nodes: u64,
    /// Elements (finite elements or background cells).
    pub elements: u64,
    /// Integration points.
    pub points: u64,
    /// Unknowns of the system, without prescribed displacements and with multipliers.
    pub dofs: u64,
    /// Mean node spacing h, in metres.
    pub spacing: f64,
    /// Seed of jitter and clouds; 0 without randomness.
    pub seed: u64,
    /// Measured quantity, a metric of the catalogue: `rms`, `l2`, `energy`, `pressure`, `max`, `time`,
    /// `memory`, `condition-max`, `tip`, ...
    pub quantity: String,
    /// Component of a vector: `x`, `y` or `z`; empty for its magnitude and for a scalar.
    #[serde(default)]
    pub component: String,
    /// Number of the tool, support or face, from 1; `None` if the quantity is that of the whole run.
    #[serde(default)]
    pub index: Option<u64>,
    /// SI unit: `m`, `s`, `Pa`, `B`, or `1` for a pure number.
    pub unit: String,
    /// Phase of a time: `prepare`, `assemble`, `factor`, `solve`, `transfer`, `total`, `repeated`; empty
    /// without a phase.
    pub phase: String,
    /// Load step or recorded state; 0 is the start.
    pub step: Option<u64>,
    /// Mode of vibration; 1 is the lowest.
    pub mode: Option<u64>,
    /// Statistic: `value`, `repeat`, `median`, `spread` (interquartile range), `min`, `max`, the quantiles
    /// `p99` and `p99.9`, the ends `low` and `high` of an uncertainty, or `band`, the error of the reference
    /// itself in this quantity.
    pub statistic: String,
    /// Number of the timing repeat, from 1.
    pub repeat: Option<u64>,
    /// The number, in `unit`; always finite.
    pub value: f64,
}

/// Unique key of a row: run, address, phase, step, mode, statistic, repeat.
pub type Key<'a> =
    (&'a str, (&'a str, &'a str, Option<u64>), &'a str, Option<u64>, Option<u64>, &'a str, Option<u64>);

impl Record {
    /// Checks the numbers of the record.
    ///
    /// # Errors
    /// A value, Poisson's ratio or spacing that is not finite.
    pub fn check(&self) -> Result<(), RecordError> {
        for (field, value) in [("value", self.value), ("poisson", self.poisson), ("spacing", self.spacing)] {
            if !value.is_finite() {
                return Err(RecordError::NotFinite {
                    case: self.case.clone(),
                    method: self.method.clone(),
                    quantity: self.name(),
                    field,
                    value,
                });
            }
        }
        Ok(())
    }

    /// The record with the quantity and unit of an address.
    #[must_use]
    pub fn with(self, of: impl Into<Address>) -> Record {
        let of = of.into();
        let (quantity, component, unit) =
            (of.metric.name.into(), of.component.into(), of.metric.unit().into());
        Record { quantity, component, index: of.index, unit, ..self }
    }

    /// The record with the quantity of this name, in its own unit. A name that the catalogue does not have is
    /// taken as the quantity.
    #[must_use]
    pub fn named(self, name: &str) -> Record {
        match metric::find(name) {
            Some(of) => Record { unit: self.unit.clone(), ..self.with(of) },
            None => Record { quantity: name.into(), ..self },
        }
    }

    /// Whether the record is a number of this address.
    pub fn is(&self, of: impl Into<Address>) -> bool {
        let of = of.into();
        self.index == of.index && self.component == of.component && self.quantity == of.metric.name
    }

    /// Name of the number: quantity, component and index in one word, such as `rms-x` or `tool-force-2`.
    pub fn name(&self) -> String {
        metric::address(&self.quantity, &self.component, self.index)
    }

    /// Whether the value depends on the machine and the moment (times and memory). Such rows are excluded
    /// from bitwise comparisons of two runs.
    pub fn is_measured(&self) -> bool {
        // The time of a step is model time.
        self.is(&metric::TIME) && self.step.is_none()
            || self.is(&metric::CPU_TIME)
            || self.is(&metric::MEMORY)
    }

    /// Unique key of the row.
    pub fn key(&self) -> Key<'_> {
        let Record { run, quantity, component, index, phase, step, mode, statistic, repeat, .. } = self;
        (run, (quantity, component, *index), phase, *step, *mode, statistic, *repeat)
    }

    /// Settings of the method, with their names in words. A kernel that equals the variant is not repeated.
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

    /// Number of the step or mode of the record, if any.
    pub fn step_or_mode(&self) -> Option<u64> {
        self.step.or(self.mode)
    }

    /// Name of the run: case, method, settings and size.
    pub fn run_name(&self) -> String {
        let mut name = format!("{} {} {}", self.case, self.method, self.variant);
        let settings: Vec<String> =
            self.settings().iter().map(|(key, value)| format!("{key}={value}")).collect();
        if !settings.is_empty() {
            name += &format!(" {}", settings.join("; "));
        }
        name += &format!(" nu={} level={} nodes={}", self.poisson, self.level, self.nodes);
        if self.seed != 0 {
            name += &format!(" seed={}", self.seed);
        }
        name
    }

    /// Name of the quantity: quantity, phase and statistic, with the unit in brackets.
    pub fn quantity_name(&self) -> String {
        let phase = match (self.step_or_mode(), self.phase.as_str()) {
            (Some(_), _) => " by step".into(),
            (None, "") => String::new(),
            (None, phase) => format!(" {phase}"),
        };
        let statistic =
            if self.statistic == "value" { String::new() } else { format!(" {}", self.statistic) };
        format!("{}{phase}{statistic} [{}]", self.name(), self.unit)
    }

    /// Order of the stored table: by the properties of the run that a reader looks for, then by the key of
    /// the row.
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
                // Not by the id alone, which contains the name of the case.
                false => self.settings().cmp(&other.settings()),
            })
            .then_with(|| self.key().cmp(&other.key()))
            .then(self.value.total_cmp(&other.value))
    }
}
