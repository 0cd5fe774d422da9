//! Metric: a kind of number with its unit, label and meaning.

use crate::dimension::Dimension;

/// Name, label, dimension and meaning of a number that is computed from one run, or from a family of runs at
/// several levels.
#[derive(Debug, PartialEq, Eq)]
pub struct Metric {
    /// Name in files, records and tables.
    pub name: &'static str,
    /// Label of a column or an axis, without the unit.
    pub label: &'static str,
    /// Dimension of the value.
    pub dimension: Dimension,
    /// Kind of number, such as an error, a cost or a count.
    pub kind: Kind,
    /// Requirement that a scene must meet for this metric.
    pub needs: Needs,
    /// Components of the value.
    pub shape: Shape,
    /// Meaning, in one phrase.
    pub meaning: &'static str,
}

/// Kind of a metric: error, order of convergence, cost, result, count, or value per tool or support.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A distance from the right value: lower is better.
    Error,
    /// The observed order of convergence of an error: higher is better.
    Order(&'static Metric),
    /// Time or memory of the machine: lower is better, and two runs differ.
    Cost,
    /// The time of a phase, which is recorded as `time` with the phase: lower is better, and two runs differ.
    Phase(&'static str),
    /// A result, neither good nor bad by itself.
    Value,
    /// A number of events or objects.
    Count,
    /// One value per tool, numbered from 1.
    Tool,
    /// One value per support, face, point or volume of a list in the scene, or per mode, numbered like the
    /// tools.
    Place,
}

/// Components of a metric, each of which is a number of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A single number.
    Scalar,
    /// Components along x, y and z, and the magnitude.
    Vector,
    /// Components along x, y and z.
    Components,
    /// Components xx, yy, zz, xy, yz and zx of a symmetric tensor.
    Tensor,
}

/// Requirement for computing a metric.
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
    /// A study with many clouds of one method: `seeds`.
    Seeds,
    /// A transfer.
    Transfer,
    /// A static procedure or dynamics.
    Steps,
    /// A procedure by Newton's method.
    Newton,
    /// Vibrations.
    Modes,
    /// Vibrations, and an exact solution for them.
    ModesReference,
    /// Dynamics.
    Dynamics,
    /// Explicit dynamics.
    Explicit,
    /// Frames with a fixed budget of work.
    Frames,
    /// A reduced model.
    Reduced,
    /// A loop in real time, and a tool.
    ToolLoop,
    /// A loop in real time, and probes.
    PointLoop,
    /// An axis of a study.
    Axis,
    /// A tool.
    Tool,
    /// A tool, and a method as `[reference]`.
    ToolReference,
    /// A tool, and an exact solution of its contact.
    ExactContact,
    /// Probes, and a method as `[reference]`.
    ProbesReference,
    /// A static procedure or dynamics, and a method as `[reference]`.
    StepsReference,
    /// A support.
    Support,
    /// Springs or dampers on a surface.
    Foundation,
    /// A support, and a point for moments.
    SupportMoment,
    /// A tool, and a point for moments.
    ToolMoment,
    /// A face with a requested mean.
    Mean,
    /// Probes.
    Point,
    /// A point with a requested stretch.
    Stretch,
    /// A surface with a requested volume.
    Enclosed,
    /// A region with a requested strain energy.
    RegionEnergy,
    /// Dynamics with probes.
    Motion,
    /// Dynamics with probes, and an exact solution that depends on time.
    Exact,
    /// A requested estimate of errors.
    Estimate,
    /// A number whose error is traced.
    Trace,
    /// Requested strict bounds.
    Bounds,
    /// Requested strict bounds, and a face with a requested mean.
    MeanBounds,
    /// A requested estimate of errors, and a tool.
    ToolEstimate,
    /// A requested estimate of errors, and probes.
    PointEstimate,
    /// A requested estimate of errors, and a support.
    SupportEstimate,
    /// A requested estimate of errors, and vibrations.
    ModeEstimate,
}

impl Metric {
    /// Returns the SI unit of the recorded value; `1` for a bare number.
    pub const fn unit(&self) -> &'static str {
        self.dimension.si_unit()
    }

    /// Whether a lower value is better. A result or a count is neither better nor worse.
    pub const fn lower_is_better(&self) -> bool {
        matches!(self.kind, Kind::Error | Kind::Cost | Kind::Phase(_))
    }

    /// Whether a run has a number for each of its tools, supports, faces, points or rates.
    pub const fn is_numbered(&self) -> bool {
        matches!(self.kind, Kind::Tool | Kind::Place)
    }
}
