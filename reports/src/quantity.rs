//! What a recorded quantity is called on axes and in tables: the label of its catalogue entry and the unit it is shown in.

use catalogue::Dimension;
use catalogue::metric::{self, Metric};

/// Millimetres to a metre: lengths are shown in mm.
const MILLIMETRES: f64 = 1e3;

/// A metric as reports show it.
#[derive(Clone, Copy)]
pub(crate) struct Shown {
    entry: &'static Metric,
}

impl Shown {
    /// A recorded quantity; `None` for one that the catalogue does not have.
    pub(crate) fn of(quantity: &str) -> Option<Shown> {
        metric::find(quantity).map(|entry| Shown { entry })
    }

    /// `relative L2 error`.
    pub(crate) fn label(self) -> &'static str {
        self.entry.label
    }

    /// `mm` for lengths, else the SI unit.
    pub(crate) fn unit(self) -> &'static str {
        if self.entry.dimension == Dimension::Length { "mm" } else { self.entry.unit() }
    }

    /// `relative L2 error [1]`.
    pub(crate) fn with_unit(self) -> String {
        format!("{} [{}]", self.label(), self.unit())
    }

    /// What an SI value is multiplied by to be shown.
    pub(crate) fn scale(self) -> f64 {
        if self.entry.dimension == Dimension::Length { MILLIMETRES } else { 1.0 }
    }
}

/// The label of a quantity with its unit; the bare name of one that the catalogue does not have.
pub(crate) fn label(quantity: &str) -> String {
    Shown::of(quantity).map_or_else(|| quantity.into(), Shown::with_unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_the_unit_that_values_are_shown_in() {
        assert_eq!(label("l2"), "relative L2 error [1]");
        assert_eq!(label("rms-x"), "RMS error along x [mm]");
        assert_eq!(label("tool-force-2"), "tool force [N]");
        assert_eq!(label("unheard-of"), "unheard-of");
        assert_eq!(Shown::of("rms").map(Shown::scale), Some(1e3));
    }
}
