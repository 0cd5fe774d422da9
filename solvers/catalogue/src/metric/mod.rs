//! Metrics: every number that is recorded, checked or drawn, with an explanation.

mod entries;

pub use entries::*;

use crate::Dimension;
use crate::names::nearest;
use crate::problem::Problem;

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
    /// Meaning, in one phrase.
    pub meaning: &'static str,
}

/// Kind of a metric: error, order of convergence, cost, result, count, or value per tool or support.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A distance from the right value: lower is better.
    Error,
    /// An observed order of convergence: higher is better.
    Order,
    /// Time or memory of the machine: lower is better, and two runs differ.
    Cost,
    /// A result, neither good nor bad by itself.
    Value,
    /// A number of events or objects.
    Count,
    /// One value per tool: the first tool has the bare name, the others have `-2`, `-3` and so on appended.
    Tool,
    /// One value per support, or per face with a requested mean, numbered like the tools.
    Place,
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
    /// A face with a requested mean.
    Mean,
    /// Dynamics with probes.
    Motion,
    /// Dynamics with probes, and an exact solution that depends on time.
    Exact,
}

impl Metric {
    /// Returns the SI unit of the recorded value; `1` for a bare number.
    pub const fn unit(&self) -> &'static str {
        self.dimension.si_unit()
    }

    /// Whether a lower value is better. A result or a count is neither better nor worse.
    pub const fn lower_is_better(&self) -> bool {
        matches!(self.kind, Kind::Error | Kind::Cost)
    }

    /// Returns the name of the metric for one tool, support or face. `index` counts from 0: 0 gives the bare
    /// name, 1 appends `-2`, 2 appends `-3`.
    pub fn numbered(&self, index: usize) -> String {
        if index == 0 { self.name.into() } else { format!("{}-{}", self.name, index + 1) }
    }
}

/// Returns the metric with that name. A name may end in the number of a tool, a support or a face, from 2:
/// `tool-force-2` returns the metric `tool-force`.
pub fn find(name: &str) -> Option<&'static Metric> {
    let named = |name: &str| METRICS.iter().copied().find(|metric| metric.name == name);
    named(name).or_else(|| {
        let (bare, number) = name.rsplit_once('-')?;
        let numbered = number.parse::<usize>().is_ok_and(|n| n >= 2) && !number.starts_with(['0', '+']);
        named(bare).filter(|metric| numbered && matches!(metric.kind, Kind::Tool | Kind::Place))
    })
}

/// Renamed metrics: old and new name.
const RENAMED: [(&str, &str); 1] = [("estimated-error", "stress-jump")];

/// Returns the metric with exactly that name.
///
/// # Errors
///
/// The name is unknown or was renamed; the help gives the nearest or the new name.
pub fn named(name: &str) -> Result<&'static Metric, Problem> {
    METRICS.iter().copied().find(|metric| metric.name == name).ok_or_else(|| {
        if let Some((_, new)) = RENAMED.iter().find(|(old, _)| *old == name) {
            return Problem::new(format!("is called '{new}' now")).found(name);
        }
        let near = nearest(name, METRICS.iter().map(|metric| metric.name));
        let near = near.map_or(String::new(), |near| format!("did you mean '{near}'? "));
        let help = format!("{near}`tissuebench list metrics` explains all of them");
        Problem::new("is not a known metric").found(name).help(help)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metric_under_its_old_name_is_refused_with_the_new_one() {
        assert!(RENAMED.iter().all(|(old, new)| find(old).is_none() && find(new).is_some()));
        assert!(named("estimated-error").unwrap_err().to_string().contains("'stress-jump'"));
    }

    #[test]
    fn every_metric_has_one_name_a_label_and_a_meaning() {
        for (i, metric) in METRICS.iter().enumerate() {
            assert!(!metric.label.is_empty() && !metric.meaning.is_empty(), "{}", metric.name);
            assert!(METRICS[..i].iter().all(|other| other.name != metric.name), "{} twice", metric.name);
            assert_eq!(find(metric.name), Some(*metric));
        }
    }

    #[test]
    fn tools_are_numbered_from_two() {
        assert_eq!(TOOL_FORCE.numbered(0), "tool-force");
        assert_eq!(find(&TOOL_FORCE.numbered(1)), Some(&TOOL_FORCE));
        for none in ["tool-force-1", "tool-force-02", "rms-2", "force"] {
            assert_eq!(find(none), None, "{none}");
        }
        assert_eq!(named("tool-farce").unwrap_err().help.unwrap().split(' ').nth(3), Some("'tool-force'?"));
    }
}
