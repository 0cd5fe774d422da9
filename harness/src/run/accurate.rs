//! A reference of a requested accuracy: its spacing is halved until its own error is small enough.

use cases::scene::{Method, Size};
use catalogue::{metric, warning};

use super::group::Group;
use super::witness::fineness;
use crate::error::Failure;
use crate::measure::Reference;
use crate::outcome::Warning;
use crate::scenario::estimate;

/// Longest estimated time of a reference that is tried, s.
const LONGEST: f64 = 3600.0;
/// Number of nodes of a mesh by that of a mesh of twice the spacing.
const FINER: usize = 8;

impl Group<'_> {
    /// Halves the spacing of the reference, which `method` has solved, until its own errors of displacement
    /// and tool forces are at most `accuracy`. If they can't be, the finest reference stays, with a warning.
    ///
    /// # Errors
    /// Errors of a finer reference.
    pub(super) fn refine_reference(&mut self, mut method: Method, accuracy: f64) -> Result<(), Failure> {
        let why = loop {
            let Some(reference) = self.own_reference() else { return Ok(()) };
            let own = match worst(reference) {
                Ok(own) if own <= accuracy => return Ok(()),
                Ok(own) => own,
                Err(unknown) => break (0.0, format!("its own error is unknown: {unknown}")),
            };
            let reached = format!("its own error is {:.2} % with {} nodes", 100.0 * own, reference.nodes);
            let Some(size) = finer(fineness(&method), reference.nodes) else {
                break (own, format!("{reached}, and no finer mesh than that of a file is known"));
            };
            method.resize(&size);
            let seconds = estimate(self.scene(), &method.family).seconds;
            if seconds > LONGEST {
                break (
                    own,
                    format!("{reached}, and half the spacing would take about {:.1} h", seconds / 3600.0),
                );
            }
            if !self.solve_reference(&method, true)? {
                return Ok(());
            }
        };
        let message = format!("the reference is not accurate to {} %: {}", 100.0 * accuracy, why.1);
        self.warn_of_reference(Warning::new(&warning::REFERENCE_ROUGH, why.0, "reference.accuracy", message));
        Ok(())
    }
}

/// Largest own error of displacement and tool forces, or why it is unknown.
fn worst(reference: &Reference) -> Result<f64, String> {
    let judged = |of: &&metric::Metric| [&metric::RELATIVE_RMS, &metric::TOOL_FORCE_ERROR].contains(of);
    let each = reference.own.band.iter().filter(|own| judged(&own.of.metric)).map(|own| own.value);
    each.reduce(f64::max).ok_or_else(|| reference.own.unknown.clone())
}

/// Size of half the spacing for a size that gave this number of nodes; `None` for a file.
fn finer(size: Size, nodes: usize) -> Option<Size> {
    Some(match size {
        Size::Nodes(_) => Size::Nodes(FINER * nodes),
        Size::Level(level) => Size::Level(level + 1),
        Size::Spacing(spacing) => Size::Spacing(0.5 * spacing),
        Size::Cells { cells, grading } => Size::Cells { cells: cells.map(|n| 2 * n), grading },
        Size::File(_) => return None,
    })
}
