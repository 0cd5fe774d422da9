//! Surfaces as they are, repaired, or wrapped.

use super::error::SurfaceProblem;
use super::soup::Soup;
use super::treated::Treated;
use super::{Surface, repair, wrap};

/// Treatment of the triangles of a file before they have to be a closed surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Treatment {
    /// None: faults are refused.
    #[default]
    AsGiven,
    /// Small faults are mended.
    Repair,
    /// A closed surface around everything inside, of cells of one size.
    Wrap {
        /// Edge length of the cells, m.
        size: f64,
    },
}

impl Surface {
    /// Creates a surface of these triangles after a treatment, with lengths multiplied by `unit` (m).
    ///
    /// # Errors
    /// As for [`Surface::with_regions`], for the faults that the treatment leaves; a size of a wrap that
    /// does not fit the triangles.
    pub fn treated(soup: Soup, unit: f64, treatment: Treatment) -> Result<Treated, SurfaceProblem> {
        match treatment {
            Treatment::AsGiven => Surface::with_regions(soup, unit).map(|surface| Treated {
                surface,
                changes: Vec::new(),
                gaps: None,
            }),
            Treatment::Repair => repair::repaired(soup, unit),
            Treatment::Wrap { size } => wrap::wrapped(soup, unit, size),
        }
    }
}
