//! Procedures of simulators, which give each frame a fixed budget of work: their keys and values.

use super::ramp::{Ramp, RampKeys};
use super::report::Report;
use super::table::{Key, table};
use super::units::{Q, Time};

table! {
    /// Sweeps over the body in each frame
    pub struct Swept from SweptKeys {
        /// Time axis and growth of the loads
        #[serde(flatten)]
        ramp: Ramp as RampKeys,
        /// Longest time between two frames; results are reported at the ends of frames
        frame: f64 as Q<Time>,
        /// Equal time steps in a frame; 1 unless given
        substeps: usize as u32 = 1,
        /// Sweeps over the body in each time step, converged or not
        sweeps: usize as u32,
        /// Whether mass acts; true unless given. false is for "vbd" only: each frame then starts from the
        /// last
        inertia: bool = true,
    }
}

table! {
    /// Implicit Euler with a limited number of iterations in each frame
    pub struct ImplicitCg from ImplicitCgKeys {
        /// Time axis and growth of the loads
        #[serde(flatten)]
        ramp: Ramp as RampKeys,
        /// Longest time between two frames; results are reported at the ends of frames
        frame: f64 as Q<Time>,
        /// Most iterations of conjugate gradients in a frame; 25 unless given, as in the scenes of SOFA
        iterations: usize as u32 = 25,
        /// Relative residual at which the iterations of a frame end; 1e-9 unless given
        tolerance: f64 = 1e-9,
    }
}

/// Largest number of sweeps of a time step, and of time steps of a frame: larger numbers are taken for
/// mistakes.
const MOST: usize = 1_000_000;

/// Checks the time axis and the numbers of a procedure of frames.
fn check(ramp: &Ramp, frame: f64, counts: &[(&str, usize)], report: &Report) {
    ramp.check(report);
    report.positive("frame", frame);
    let sound = frame <= ramp.duration / ramp.steps as f64 * (1.0 + 1e-9);
    let help = "give the duration over the steps or less: results are reported at the ends of frames";
    report.require(sound, "frame", "is longer than the time between two results", help);
    for &(key, count) in counts {
        report.require(count > 0, key, "is zero", "give 1 or more");
        report.require(count <= MOST, key, "are too many", &format!("give {MOST} or less"));
    }
}

impl ImplicitCg {
    /// The frames, with iterations in place of sweeps.
    pub fn frames(&self) -> Swept {
        let ImplicitCg { ramp, frame, iterations, .. } = *self;
        Swept { ramp, frame, substeps: 1, sweeps: iterations, inertia: true }
    }
}

impl Swept {
    /// Checks the values; `moves` says whether the solver needs a mass that moves.
    pub(super) fn check(&self, moves: bool, report: &Report) {
        let counts = [("substeps", self.substeps), ("sweeps", self.sweeps)];
        check(&self.ramp, self.frame, &counts, report);
        let help = "leave it out, or take damping, kind = \"implicit-dynamic\" or kind = \"explicit\"";
        let sound = self.ramp.stiffness_damping == 0.0;
        report.require(sound, "stiffness_damping", "is not available in sweeps over the body", help);
        let help = "leave it out, or take kind = \"vbd\": constraints divide by a mass over the time step";
        report.require(self.inertia || !moves, "inertia", "is not available without mass", help);
        let sound = self.inertia || !report.is_given("damping");
        report.require(sound, "damping", "is of a motion, and inertia = false has none", "leave it out");
    }

    /// The same budget in each of `count` frames of equal length, with a result after each.
    pub fn in_frames(&self, count: usize) -> Swept {
        let frame = self.ramp.duration / count as f64;
        Swept { ramp: Ramp { steps: count, ..self.ramp }, frame, ..*self }
    }

    /// Length of a time step up to the next result (s), and the number of time steps up to it.
    pub fn time_steps(&self) -> (f64, usize) {
        let interval = self.ramp.duration / self.ramp.steps as f64;
        // Rounding must not add a frame.
        let frames = (interval / self.frame * (1.0 - 1e-9)).ceil().max(1.0);
        let count = frames * self.substeps as f64;
        (interval / count, count as usize)
    }
}

/// Reads a procedure of conjugate gradients.
pub(super) fn implicit_cg(keys: ImplicitCgKeys, report: &Report) -> ImplicitCg {
    let asked = keys.value();
    check(&asked.ramp, asked.frame, &[("iterations", asked.iterations)], report);
    let sound = (0.0..1.0).contains(&asked.tolerance);
    report.require(sound, "tolerance", "is no tolerance", "give 0 to 1; 1e-9 is that of SOFA");
    asked
}

/// Reads a procedure of sweeps.
pub(super) fn swept(keys: SweptKeys, moves: bool, report: &Report) -> Swept {
    let swept = keys.value();
    swept.check(moves, report);
    swept
}
