//! Names of recorded quantities on axes and in tables: the label and the display unit of the catalogue entry.

use catalogue::Dimension;
use catalogue::metric::{self, Metric};

/// Factor from metres to millimetres, in which lengths are shown.
const MILLIMETRES: f64 = 1e3;

/// Display form of a metric.
#[derive(Clone, Copy)]
pub(crate) struct Shown {
    entry: &'static Metric,
}

impl Shown {
    /// Looks up a recorded quantity; `None` if the catalogue does not have it.
    pub(crate) fn of(quantity: &str) -> Option<Shown> {
        metric::find(quantity).map(|entry| Shown { entry })
    }

    /// Label, such as `relative L2 error`.
    pub(crate) fn label(self) -> &'static str {
        self.entry.label
    }

    /// Whether the values are lengths.
    pub(crate) fn is_length(self) -> bool {
        self.entry.dimension == Dimension::Length
    }

    /// Display unit: `mm` for lengths, otherwise the SI unit.
    pub(crate) fn unit(self) -> &'static str {
        if self.is_length() { "mm" } else { self.entry.unit() }
    }

    /// Label with its unit, such as `relative L2 error [1]`.
    pub(crate) fn with_unit(self) -> String {
        format!("{} [{}]", self.label(), self.unit())
    }

    /// Factor from the SI value to the value shown.
    pub(crate) fn scale(self) -> f64 {
        if self.is_length() { MILLIMETRES } else { 1.0 }
    }
}

/// Label of a quantity with its unit, or only the name of a quantity that is not in the catalogue.
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
