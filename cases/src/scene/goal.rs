//! A number of a solution whose error is traced to parts of the body, by the name of its metric.

use std::fmt;

use catalogue::Problem;
use catalogue::metric::{self, Address};

use super::condition::Support;
use super::drive::Drive;
use super::report::Report;
use super::tool::Tool;

/// A number of a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Force of a tool along its direction.
    ToolForce(usize),
    /// Force of a support along an axis.
    Reaction(usize, usize),
    /// Mean displacement of a face of output.means along an axis.
    Mean(usize, usize),
    /// Displacement of a probe along an axis; `None` for its size.
    Probe(usize, Option<usize>),
}

/// Names of the numbers, for messages.
const KNOWN: &str = "tool-force, reaction-x, mean-x or probe";

impl Goal {
    /// Reads the name of a metric at a key of the report.
    pub(crate) fn read(name: &str, key: &str, report: &Report) -> Option<Goal> {
        let address = metric::named(name).map_err(|bad| report.add(key, bad)).ok()?;
        let index = address.index.unwrap_or(1) as usize - 1;
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == address.component);
        let goal = match (address.metric, axis) {
            (of, _) if *of == metric::TOOL_FORCE => Goal::ToolForce(index),
            (of, Some(axis)) if *of == metric::REACTION => Goal::Reaction(index, axis),
            (of, Some(axis)) if *of == metric::MEAN => Goal::Mean(index, axis),
            (of, axis) if *of == metric::PROBE => Goal::Probe(index, axis),
            _ => {
                let problem = Problem::new("is not a number whose error can be traced").found(name);
                report.add(
                    key,
                    problem.help(format!("take {KNOWN}, of another place with its number: probe-2")),
                );
                return None;
            }
        };
        Some(goal)
    }

    /// The metric of the number.
    pub fn address(&self) -> Address {
        match *self {
            Goal::ToolForce(tool) => metric::TOOL_FORCE.at(tool),
            Goal::Reaction(support, axis) => metric::REACTION.components()[axis].at(support),
            Goal::Mean(face, axis) => metric::MEAN.components()[axis].at(face),
            Goal::Probe(probe, Some(axis)) => metric::PROBE.components()[axis].at(probe),
            Goal::Probe(probe, None) => metric::PROBE.at(probe),
        }
    }

    /// Reports a number that the scene does not have, with its number of faces and probes.
    pub(crate) fn demands(
        &self,
        (supports, tools): (&[Support], &[Tool]),
        [faces, probes]: [usize; 2],
        key: &str,
        report: &Report,
    ) {
        let (index, count, what) = match *self {
            Goal::ToolForce(tool) => (tool, tools.len(), "[[tool]]"),
            Goal::Reaction(support, _) => (support, supports.len(), "[[support]]"),
            Goal::Mean(face, _) => (face, faces, "output.means"),
            Goal::Probe(probe, _) => (probe, probes, "output.probes"),
        };
        let add = |problem: String, help: &str| {
            report.add(key, Problem::new(problem).found(self.to_string()).help(help));
        };
        if index >= count {
            add(format!("needs number {} of {what}, but the scene has {count}", index + 1), "add it");
        }
        if let Goal::Reaction(support, axis) = *self
            && supports.get(support).is_some_and(|support| support.motion[axis].is_none())
        {
            add("is a force along an axis that the support leaves free".into(), "take another axis");
        }
        if let Some(forced) = tools.iter().find(|tool| !matches!(tool.drive, Drive::Closure(_))) {
            let problem =
                format!("needs tools that are driven by displacement, but '{}' is not", forced.name);
            add(problem, "take drive = { closure = ... }");
        }
    }
}

impl fmt::Display for Goal {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        self.address().fmt(out)
    }
}
