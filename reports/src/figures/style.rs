//! Appearance of a method in figures: marker, line and legend.

use records::Family;

use super::axes::TEXT;
use super::canvas::{Anchor, BLACK_INK, Canvas, text_width};
use crate::appearance::{Look, distinct};

/// Style of a label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Style {
    pub(crate) label: String,
    pub(crate) look: Look,
}

/// Distinct styles of the labels, without duplicates, in the given order.
pub(crate) fn styles(labels: &[(String, Family)]) -> Vec<Style> {
    let mut once: Vec<(String, Family)> = Vec::new();
    for (label, family) in labels {
        if once.iter().all(|known| &known.0 != label) {
            once.push((label.clone(), *family));
        }
    }
    let looks = distinct(&once, |_, _| true);
    once.into_iter().zip(looks).map(|((label, _), look)| Style { label, look }).collect()
}

/// Style of a label.
pub(crate) fn find<'a>(styles: &'a [Style], label: &str) -> Option<&'a Style> {
    styles.iter().find(|s| s.label == label)
}

impl Style {
    /// Draws the marker with a radius of 2.7 points: filled for elements, open for clouds.
    pub(crate) fn mark(&self, canvas: &mut Canvas, at: (f64, f64)) {
        let r = 2.7;
        let ring = |n: usize, turn: f64, r: f64| -> Vec<(f64, f64)> {
            (0..=n)
                .map(|i| {
                    let angle = std::f64::consts::TAU * (i as f64 / n as f64 + turn);
                    (at.0 + r * angle.sin(), at.1 - r * angle.cos())
                })
                .collect()
        };
        let outline = match self.look.marker {
            0 => ring(20, 0.0, r),
            1 => ring(4, 0.125, r * 1.25),
            2 => ring(3, 0.0, r * 1.35),
            3 => ring(4, 0.0, r * 1.3),
            4 => ring(3, 0.5, r * 1.35),
            5 => ring(5, 0.0, r * 1.15),
            _ => ring(6, 0.0, r * 1.1),
        };
        let open = self.look.open;
        canvas.fill(&outline, if open { [255, 255, 255] } else { self.look.colour });
        canvas.line(
            &outline,
            if open { self.look.colour } else { [255, 255, 255] },
            if open { 1.2 } else { 0.4 },
        );
    }

    /// Draws the line through the points, and their markers.
    pub(crate) fn curve(&self, canvas: &mut Canvas, points: &[(f64, f64)]) {
        if points.len() > 1 {
            canvas.dashed(points, self.look.colour, 1.3, self.look.dash);
        }
        for at in points {
            self.mark(canvas, *at);
        }
    }
}

/// Number of columns of a legend that fit a width, and the width of a column.
fn layout(styles: &[Style], width: f64) -> (usize, f64) {
    let widest = styles.iter().map(|s| text_width(&s.label, TEXT)).fold(0.0, f64::max) + 44.0;
    let columns = ((width / widest).floor() as usize).clamp(1, styles.len().max(1));
    (columns, widest)
}

/// Note on filled and open markers, for a legend that has both.
pub(crate) fn fillings(styles: &[Style]) -> &'static str {
    let both = styles.iter().any(|s| s.look.open) && styles.iter().any(|s| !s.look.open);
    if both { "Filled: elements, open: clouds. " } else { "" }
}

/// Height of a legend, points.
pub(crate) fn legend_height(styles: &[Style], width: f64) -> f64 {
    let (columns, _) = layout(styles, width);
    styles.len().div_ceil(columns) as f64 * 14.0
}

/// Draws a legend with its top left corner at a point, with lines if the figure connects its markers.
pub(crate) fn legend(canvas: &mut Canvas, styles: &[Style], at: (f64, f64), width: f64, lines: bool) {
    let (columns, step) = layout(styles, width);
    let rows = styles.len().div_ceil(columns);
    for (i, style) in styles.iter().enumerate() {
        let (x, y) = (at.0 + (i / rows) as f64 * step, at.1 + (i % rows) as f64 * 14.0 + 7.0);
        if lines {
            canvas.dashed(&[(x, y), (x + 24.0, y)], style.look.colour, 1.3, style.look.dash);
        }
        style.mark(canvas, (x + 12.0, y));
        canvas.text((x + 29.0, y), &style.label, TEXT, BLACK_INK, Anchor::Start);
    }
}
