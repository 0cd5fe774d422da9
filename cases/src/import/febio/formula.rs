//! Formulas of coordinates, `type="math"`. (FEBio User Manual 4, 3.1.)

use crate::import::document::quoted;
use crate::import::units::{Units, number};

/// A formula of the undeformed coordinates `X`, `Y` and `Z`, in sums and products.
pub(super) struct Formula(String);

impl Formula {
    /// Reads a text; `None` for one with functions, powers or other variables.
    pub fn read(text: &str) -> Option<Formula> {
        // Functions and powers differ between programs; time has its load controllers.
        let known = |c: char| c.is_ascii_digit() || c.is_whitespace() || "XYZ+-*/().".contains(c);
        if text.is_empty() || !text.chars().all(known) {
            return None;
        }
        Some(Formula(text.split_whitespace().collect::<Vec<_>>().join(" ")))
    }

    /// The formula times a factor as a pressure of a scene, whose coordinates are in metres.
    pub fn pressure(&self, factor: f64, units: Units) -> String {
        let (unit, scale) = match units {
            Units::Metres => ("Pa", ""),
            Units::Millimetres => ("MPa", "1000 * "),
        };
        let place = |c: char| match c {
            'X' | 'Y' | 'Z' => format!("({scale}{})", c.to_ascii_lowercase()),
            other => other.to_string(),
        };
        let text: String = self.0.chars().map(place).collect();
        let text = if factor == 1.0 { text } else { format!("{} * ({text})", number(factor)) };
        format!("{{ of = {}, unit = {} }}", quoted(&text), quoted(unit))
    }
}
