//! Names of recorded quantities on axes and in tables: the label and the display unit of the catalogue entry.

use catalogue::Dimension;
use catalogue::metric::{self, Address};

/// Factor from metres to millimetres, in which lengths are shown.
const MILLIMETRES: f64 = 1e3;

/// Whether the values are lengths.
fn is_length(of: Address) -> bool {
    of.metric.dimension == Dimension::Length
}

/// Display unit: `mm` for lengths, otherwise the SI unit.
pub(crate) fn unit(of: Address) -> &'static str {
    if is_length(of) { "mm" } else { of.metric.unit() }
}

/// Factor from the SI value to the value shown.
pub(crate) fn scale(of: Address) -> f64 {
    if is_length(of) { MILLIMETRES } else { 1.0 }
}

/// Label of a quantity with its unit.
pub(crate) fn label(of: impl Into<Address>) -> String {
    let of = of.into();
    format!("{} [{}]", of.label(), unit(of))
}

/// Label of a stored name with its unit, or only the name of a quantity that is not in the catalogue.
pub(crate) fn label_of_name(name: &str) -> String {
    metric::find(name).map_or_else(|| name.into(), label)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_the_unit_that_values_are_shown_in() {
        assert_eq!(label_of_name("l2"), "relative L2 error [1]");
        assert_eq!(label_of_name("rms-x"), "RMS error along x [mm]");
        assert_eq!(label_of_name("tool-force-2"), "tool force [N]");
        assert_eq!(label_of_name("unheard-of"), "unheard-of");
        assert_eq!(scale(metric::RMS.whole()), 1e3);
    }
}
