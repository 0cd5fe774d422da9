//! The metrics that checks may name.

use crate::names::suggest;

use super::error::Problem;
use super::units::Dimension;

/// A number computed from one run, or from a family of runs at several levels.
#[derive(Debug, PartialEq, Eq)]
pub struct Metric {
    /// Name in files and tables.
    pub name: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    /// What it needs.
    pub needs: Needs,
    /// What it is.
    pub meaning: &'static str,
}

/// What a metric needs to be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// A run alone.
    Run,
    /// A `[reference]`.
    Reference,
    /// A `[reference]` and probes.
    Probes,
    /// A `[reference]` and a study with several levels.
    Levels,
    /// A transfer.
    Transfer,
    /// A static procedure or dynamics.
    Steps,
    /// A procedure by Newton's method.
    Newton,
    /// Vibrations.
    Modes,
    /// Vibrations, and an exact solution of them.
    ModesReference,
    /// Dynamics.
    Dynamics,
    /// Explicit dynamics.
    Explicit,
    /// A tool.
    Tool,
    /// A tool, and a method as `[reference]`.
    ToolReference,
    /// Probes, and a method as `[reference]`.
    ProbesReference,
    /// A static procedure or dynamics, and a method as `[reference]`.
    StepsReference,
    /// Dynamics with probes.
    Motion,
    /// Dynamics with probes, and an exact solution that moves.
    Exact,
}

const fn metric(name: &'static str, dimension: Dimension, needs: Needs, meaning: &'static str) -> Metric {
    Metric { name, dimension, needs, meaning }
}

impl Metric {
    /// Every metric.
    pub const ALL: &'static [Metric] = &[
        metric(
            "rms-x",
            Dimension::Length,
            Needs::Reference,
            "root mean square error of the displacement along x",
        ),
        metric(
            "rms-y",
            Dimension::Length,
            Needs::Reference,
            "root mean square error of the displacement along y",
        ),
        metric(
            "rms-z",
            Dimension::Length,
            Needs::Reference,
            "root mean square error of the displacement along z",
        ),
        metric("rms", Dimension::Length, Needs::Reference, "root mean square error of the displacement"),
        metric("max-error", Dimension::Length, Needs::Reference, "largest error of the displacement"),
        metric(
            "relative-max",
            Dimension::None,
            Needs::Reference,
            "largest error over the largest exact displacement",
        ),
        metric(
            "relative-rms",
            Dimension::None,
            Needs::Reference,
            "root mean square error of the displacement over the root mean square of the reference's",
        ),
        metric(
            "peak-error",
            Dimension::None,
            Needs::Reference,
            "error of the largest displacement, wherever it is, over the reference's largest",
        ),
        metric("l2", Dimension::None, Needs::Reference, "relative L2 error of the displacement"),
        metric("energy", Dimension::None, Needs::Reference, "relative error in the energy norm"),
        metric("stress", Dimension::None, Needs::Reference, "relative L2 error of the stress"),
        metric("pressure", Dimension::None, Needs::Reference, "relative L2 error of the pressure"),
        metric("probe-error", Dimension::None, Needs::Probes, "largest relative error at the probes"),
        metric(
            "history-error",
            Dimension::None,
            Needs::Exact,
            "largest error at the probes in all recorded states, over the largest exact displacement there",
        ),
        metric(
            "period",
            Dimension::Time,
            Needs::Motion,
            "mean period of the first probe: between its passages upwards through the middle of its recorded way",
        ),
        metric("tip", Dimension::None, Needs::Probes, "computed over exact displacement at the first probe"),
        metric("order-l2", Dimension::None, Needs::Levels, "observed order of the L2 error"),
        metric("order-energy", Dimension::None, Needs::Levels, "observed order of the energy error"),
        metric("order-pressure", Dimension::None, Needs::Levels, "observed order of the pressure error"),
        metric(
            "order-frequency-error",
            Dimension::None,
            Needs::Levels,
            "observed order of the frequency's error",
        ),
        metric(
            "frequency-ratio",
            Dimension::None,
            Needs::ModesReference,
            "computed over exact frequency, the worst of the modes nearest to the exact ones of that frequency",
        ),
        metric("frequency-error", Dimension::None, Needs::ModesReference, "the same less 1, either way"),
        metric(
            "mode-overlap",
            Dimension::None,
            Needs::ModesReference,
            "least share of their displacement that lies in the exact modes",
        ),
        metric(
            "spectrum-error",
            Dimension::None,
            Needs::ModesReference,
            "largest error of the frequencies told, one by one in order, over the exact ones",
        ),
        metric(
            "slow-modes",
            Dimension::None,
            Needs::ModesReference,
            "modes slower than 0.9 of the slowest exact one",
        ),
        metric(
            "rigid-modes",
            Dimension::None,
            Needs::Modes,
            "modes slower than a thousandth of a shear wave across the body",
        ),
        metric("massless", Dimension::None, Needs::Modes, "motions that have stiffness but no mass"),
        metric("transfer-rms", Dimension::Length, Needs::Transfer, "root mean square error after transfer"),
        metric(
            "probe-difference",
            Dimension::Length,
            Needs::ProbesReference,
            "largest distance from the reference method's displacement at the probes, at the end",
        ),
        metric("closure", Dimension::Length, Needs::Tool, "way of the first tool"),
        metric("tool-force", Dimension::Force, Needs::Tool, "force of the first tool along its way"),
        metric(
            "tool-force-error",
            Dimension::None,
            Needs::ToolReference,
            "error of the first tool's force over that of the reference method, at the end",
        ),
        metric(
            "strain-energy-error",
            Dimension::None,
            Needs::StepsReference,
            "error of the strain energy over that of the reference method, at the end",
        ),
        metric("penetration", Dimension::Length, Needs::Tool, "deepest penetration of a tool"),
        metric("load-carried", Dimension::None, Needs::Steps, "part of the loading that was carried, 0 to 1"),
        metric(
            "smallest-j",
            Dimension::None,
            Needs::Steps,
            "smallest volume ratio J of all quadrature points",
        ),
        metric("newton-iterations", Dimension::None, Needs::Newton, "Newton iterations of all steps"),
        metric("cut-backs", Dimension::None, Needs::Newton, "steps that failed and were cut"),
        metric("time-steps", Dimension::None, Needs::Dynamics, "time steps made"),
        metric(
            "critical-step",
            Dimension::Time,
            Needs::Explicit,
            "smallest critical time step estimated; of vibrations 2 / omega of the fastest",
        ),
        metric(
            "energy-drift",
            Dimension::None,
            Needs::Dynamics,
            "largest error of the energy balance over its largest term; with implicit steps what the scheme dissipates",
        ),
        metric("max-x", Dimension::Length, Needs::Run, "largest displacement along x, either way"),
        metric("max-y", Dimension::Length, Needs::Run, "largest displacement along y, either way"),
        metric("max-z", Dimension::Length, Needs::Run, "largest displacement along z, either way"),
        metric("max", Dimension::Length, Needs::Run, "largest displacement"),
        metric("strain-energy", Dimension::Energy, Needs::Run, "strain energy"),
        metric(
            "residual",
            Dimension::None,
            Needs::Run,
            "relative residual of the linear solve, of the last static step, or of the worst mode told",
        ),
        metric("condition", Dimension::None, Needs::Run, "largest condition estimate of a moment matrix"),
        metric(
            "fallbacks",
            Dimension::None,
            Needs::Run,
            "points at which the approximation had to fall back",
        ),
        metric(
            "constraints-dropped",
            Dimension::None,
            Needs::Run,
            "rows of eliminated supports that follow from the others",
        ),
        metric(
            "finite-element-nodes",
            Dimension::None,
            Needs::Run,
            "nodes of finite elements that a cloud is coupled to",
        ),
        metric("time-prepare", Dimension::Time, Needs::Run, "seconds for search and shape functions"),
        metric("time-assemble", Dimension::Time, Needs::Run, "seconds to assemble"),
        metric("time-factor", Dimension::Time, Needs::Run, "seconds to factor"),
        metric("time-solve", Dimension::Time, Needs::Run, "seconds to solve"),
        metric("time-transfer", Dimension::Time, Needs::Transfer, "seconds to apply the transfer"),
        metric("time-total", Dimension::Time, Needs::Run, "seconds for all phases but reading files"),
    ];

    /// The metric of that name.
    pub fn named(name: &str) -> Option<&'static Metric> {
        Metric::ALL.iter().find(|metric| metric.name == name)
    }

    pub(crate) fn find(name: &str) -> Result<&'static Metric, Problem> {
        let names: Vec<&str> = Metric::ALL.iter().map(|metric| metric.name).collect();
        Metric::named(name)
            .ok_or_else(|| Problem::new("is not a known metric").found(name).help(suggest(name, &names)))
    }
}
