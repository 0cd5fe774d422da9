//! Colour scales and their colour bar.

use super::axes::{Axis, TEXT};
use super::canvas::{Anchor, BLACK_INK, Canvas, Colour};

/// Viridis at eleven even steps (van der Walt and Smith, 2015).
const VIRIDIS: [Colour; 11] = [
    [68, 1, 84],
    [72, 36, 117],
    [65, 68, 135],
    [53, 95, 141],
    [42, 120, 142],
    [33, 145, 140],
    [34, 168, 132],
    [68, 191, 112],
    [122, 209, 81],
    [189, 223, 38],
    [253, 231, 37],
];

/// Diverging from blue over white to red, safe for colour-blind readers (reversed ColorBrewer RdBu; Harrower
/// and Brewer, 2003).
const BLUE_RED: [Colour; 11] = [
    [5, 48, 97],
    [33, 102, 172],
    [67, 147, 195],
    [146, 197, 222],
    [209, 229, 240],
    [247, 247, 247],
    [253, 219, 199],
    [244, 165, 130],
    [214, 96, 77],
    [178, 24, 43],
    [103, 0, 31],
];

/// Number of shades on a body: more than an eye distinguishes, and few enough for neighbours to share a
/// shade.
const SHADES: f64 = 48.0;

/// Map from values to colours.
#[derive(Clone, Copy, Debug)]
pub(super) enum Scale {
    /// From zero to a maximum.
    Rising(f64),
    /// Symmetric about zero; values beyond the ends have the colours of the ends.
    Signed(f64),
}

impl Scale {
    fn ends(self) -> (f64, f64) {
        match self {
            Scale::Rising(largest) => (0.0, largest.max(1e-300)),
            Scale::Signed(largest) => (-largest.max(1e-300), largest.max(1e-300)),
        }
    }

    /// Colour of a value, quantised to the shades.
    pub(super) fn colour(self, value: f64) -> Colour {
        let (low, high) = self.ends();
        self.shade((((value - low) / (high - low)).clamp(0.0, 1.0) * SHADES).round() / SHADES)
    }

    fn shade(self, fraction: f64) -> Colour {
        let colours = match self {
            Scale::Rising(_) => VIRIDIS,
            Scale::Signed(_) => BLUE_RED,
        };
        let at = fraction * (colours.len() - 1) as f64;
        let (low, rest) = (at.floor() as usize, at.fract());
        let high = (low + 1).min(colours.len() - 1);
        std::array::from_fn(|i| {
            (f64::from(colours[low][i]) * (1.0 - rest) + f64::from(colours[high][i]) * rest).round() as u8
        })
    }

    /// Draws a colour bar with its top left corner at a point and its label above.
    pub(super) fn bar(self, canvas: &mut Canvas, at: (f64, f64), height: f64, label: &str) {
        let (low, high) = self.ends();
        let steps = 64;
        for i in 0..steps {
            let (from, to) = (i as f64 / steps as f64, (i + 1) as f64 / steps as f64);
            let (top, bottom) = (at.1 + height * (1.0 - to) - 0.2, at.1 + height * (1.0 - from));
            canvas.fill(
                &[(at.0, top), (at.0 + 12.0, top), (at.0 + 12.0, bottom), (at.0, bottom)],
                self.shade((from + to) / 2.0),
            );
        }
        if let Scale::Signed(_) = self {
            // The points at both ends indicate values beyond them.
            let (bottom, middle, end) = (at.1 + height, at.0 + 6.0, at.0 + 12.0);
            canvas.fill(&[(at.0, at.1), (middle, at.1 - 7.0), (end, at.1)], self.shade(1.0));
            canvas.fill(&[(at.0, bottom), (end, bottom), (middle, bottom + 7.0)], self.shade(0.0));
        }
        for (value, text) in Axis::linear("", [low, high].into_iter(), true).ticks() {
            let fraction = (value - low) / (high - low);
            if (-1e-9..=1.0 + 1e-9).contains(&fraction) {
                let y = at.1 + height * (1.0 - fraction);
                canvas.line(&[(at.0 + 12.0, y), (at.0 + 15.0, y)], BLACK_INK, 0.6);
                canvas.text((at.0 + 18.0, y), text, TEXT, BLACK_INK, Anchor::Start);
            }
        }
        canvas.text((at.0, at.1 - 16.0), label, TEXT, BLACK_INK, Anchor::Start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_is_white_on_a_signed_scale_and_what_lies_beyond_has_the_colour_of_the_end() {
        let scale = Scale::Signed(2.0);
        assert_eq!(scale.colour(0.0), BLUE_RED[5]);
        assert_eq!((scale.colour(-2.0), scale.colour(2.0)), (BLUE_RED[0], BLUE_RED[10]));
        assert_eq!((scale.colour(-9.0), scale.colour(9.0)), (BLUE_RED[0], BLUE_RED[10]));
        assert_eq!(
            (Scale::Rising(2.0).colour(0.0), Scale::Rising(2.0).colour(2.0)),
            (VIRIDIS[0], VIRIDIS[10])
        );
    }
}
