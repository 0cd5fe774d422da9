//! Colour scales and their colour bar.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use records::text::tick;

use super::drawing::{Area, BLACK_INK, Drawn, TEXT, text};

/// Viridis at eleven even steps (van der Walt and Smith, 2015).
const VIRIDIS: [[u8; 3]; 11] = [
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
const BLUE_RED: [[u8; 3]; 11] = [
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
    pub(super) fn colour(self, value: f64) -> RGBColor {
        let (low, high) = self.ends();
        self.shade((((value - low) / (high - low)).clamp(0.0, 1.0) * SHADES).round() / SHADES)
    }

    fn shade(self, fraction: f64) -> RGBColor {
        let colours = match self {
            Scale::Rising(_) => VIRIDIS,
            Scale::Signed(_) => BLUE_RED,
        };
        let at = fraction * (colours.len() - 1) as f64;
        let (low, rest) = (at.floor() as usize, at.fract());
        let high = (low + 1).min(colours.len() - 1);
        let mix = |i: usize| {
            (f64::from(colours[low][i]) * (1.0 - rest) + f64::from(colours[high][i]) * rest).round() as u8
        };
        RGBColor(mix(0), mix(1), mix(2))
    }

    /// Draws a colour bar at the left of an area, with its label above.
    pub(super) fn bar(self, area: &Area, label: &str) -> Drawn {
        area.draw_text(label, &text(TEXT, HPos::Left), (0, 40))?;
        let (low, high) = self.ends();
        let mut chart = ChartBuilder::on(area)
            .margin_top(200)
            .margin_bottom(TIP)
            .right_y_label_area_size(area.dim_in_pixel().0 as i32 - THICK)
            .build_cartesian_2d(0.0..1.0, low..high)?;
        // Each shade covers the rest of the bar, so that no hairline appears between neighbours.
        chart.draw_series((0..64).map(|i| {
            let from = low + (high - low) * f64::from(i) / 64.0;
            let shade = self.shade((f64::from(i) + 0.5) / 64.0);
            Rectangle::new([(0.0, from), (1.0, high)], shade.filled())
        }))?;
        if let Scale::Signed(_) = self {
            // The points at both ends indicate values beyond them.
            for (end, fraction, tip) in [(low, 0.0, TIP), (high, 1.0, -TIP)] {
                let point = Polygon::new([(0, 0), (THICK / 2, tip), (THICK, 0)], self.shade(fraction));
                chart.draw_series([EmptyElement::at((0.0, end)) + point])?;
            }
        }
        let mut mesh = chart.configure_mesh();
        mesh.disable_mesh().axis_style(BLACK_INK.stroke_width(6)).label_style(text(TEXT, HPos::Left));
        mesh.y_labels(5).y_label_formatter(&|value| tick(*value)).set_all_tick_mark_size(30).draw()
    }
}

/// Thickness of a colour bar, and length of the points at its ends.
const THICK: i32 = 120;
const TIP: i32 = 70;

#[cfg(test)]
mod tests {
    use super::*;

    fn ink([red, green, blue]: [u8; 3]) -> RGBColor {
        RGBColor(red, green, blue)
    }

    #[test]
    fn zero_is_white_on_a_signed_scale_and_what_lies_beyond_has_the_colour_of_the_end() {
        let scale = Scale::Signed(2.0);
        assert_eq!(scale.colour(0.0), ink(BLUE_RED[5]));
        assert_eq!((scale.colour(-2.0), scale.colour(2.0)), (ink(BLUE_RED[0]), ink(BLUE_RED[10])));
        assert_eq!((scale.colour(-9.0), scale.colour(9.0)), (ink(BLUE_RED[0]), ink(BLUE_RED[10])));
        assert_eq!(
            (Scale::Rising(2.0).colour(0.0), Scale::Rising(2.0).colour(2.0)),
            (ink(VIRIDIS[0]), ink(VIRIDIS[10]))
        );
    }
}
