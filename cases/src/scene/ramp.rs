//! The time axis of dynamics: its keys and values.

use super::report::Report;
use super::table::table;
use super::units::{Q, Rate, Time};

table! {
    /// The time axis of dynamics
    pub struct Ramp from RampKeys {
        /// End of the time axis
        duration: f64 as Q<Time>,
        /// Time over which loads and supports grow before they are constant; the duration unless given. "0 s"
        /// applies them at once
        over: Option<f64> as Option<Q<Time>>,
        /// Equal intervals of time at whose ends results are reported; 1 unless given
        steps: usize as u32 = 1,
        /// Mass-proportional damping, in explicit dynamics also of tools that have a mass; none unless given
        damping: f64 as Q<Rate> = 0.0,
        /// Stiffness-proportional damping: the factor of the current tangent of the internal forces; none
        /// unless given
        stiffness_damping: f64 as Q<Time> = 0.0,
    }
}

/// Largest number of steps. Each step is solved, reported and stored, so a larger number is taken for a
/// mistake.
const MOST_STEPS: usize = 100_000;

impl Ramp {
    /// Whether the motion is damped.
    pub fn damps(&self) -> bool {
        self.damping > 0.0 || self.stiffness_damping > 0.0
    }

    /// Time in seconds over which loads and supports grow.
    pub fn growth(&self) -> f64 {
        self.over.unwrap_or(self.duration)
    }

    pub(super) fn check(&self, report: &Report) {
        sound_steps(self.steps, report);
        report.positive("duration", self.duration);
        let help = "give \"0 s\" for at once, or leave it out";
        report.require(self.over.is_none_or(|t| t >= 0.0), "over", "is negative", help);
        let help = "give 0 /s or more, or leave it out";
        report.require(self.damping >= 0.0, "damping", "is negative", help);
        let help = "give \"0 s\" or more, or leave it out";
        report.require(self.stiffness_damping >= 0.0, "stiffness_damping", "is negative", help);
    }
}

/// Checks a number of steps.
pub(super) fn sound_steps(steps: usize, report: &Report) {
    report.require(steps > 0, "steps", "is zero", "give 1 or more");
    let help = format!("give {MOST_STEPS} or less");
    report.require(steps <= MOST_STEPS, "steps", "are too many", &help);
}
