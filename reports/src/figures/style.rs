//! How a method looks: a colour everyone can tell apart, a marker and a dash of its own.

use super::axes::TEXT;
use super::canvas::{Anchor, BLACK_INK, Canvas, Colour, text_width};

/// Okabe and Ito (2008) without yellow, which vanishes on white, then darker ones of Tol (2021).
const COLOURS: [Colour; 12] = [
    [0xd5, 0x5e, 0x00],
    [0x00, 0x72, 0xb2],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x00, 0x00, 0x00],
    [0x88, 0x22, 0x55],
    [0x99, 0x99, 0x33],
    [0x33, 0x22, 0x88],
    [0x8c, 0x51, 0x0a],
    [0x7f, 0x7f, 0x7f],
];

/// Markers told apart by their shape.
const MARKERS: usize = 7;

const DASHES: [&[f64]; 4] = [&[], &[5.0, 2.0], &[1.5, 1.8], &[6.0, 1.8, 1.5, 1.8]];

/// Colour, marker and dash of one label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Style {
    pub(crate) label: String,
    pub(crate) colour: Colour,
    pub(crate) dash: &'static [f64],
    marker: usize,
    open: bool,
}

/// Styles for labels in the order given; the plain elements keep theirs in every figure. `meshfree` draws a dashed line and open
/// markers, so that no element and no cloud look alike, in grey either.
pub(crate) fn styles(labels: &[(String, bool)]) -> Vec<Style> {
    let mut next = 4;
    let mut out: Vec<Style> = Vec::new();
    for (label, meshfree) in labels {
        if out.iter().any(|s| &s.label == label) {
            continue;
        }
        let index = match ["tet4", "tet10", "hex8", "hex20"].iter().position(|e| e == label) {
            Some(known) => known,
            None => {
                next += 1;
                next - 1
            }
        };
        let round = index / COLOURS.len();
        let dash = DASHES[(usize::from(*meshfree) + round) % DASHES.len()];
        out.push(Style {
            label: label.clone(),
            colour: COLOURS[index % COLOURS.len()],
            dash,
            // Seven and twelve have no common divisor: where colours repeat, shapes don't.
            marker: index % MARKERS,
            open: *meshfree,
        });
    }
    out
}

/// The style of a label.
pub(crate) fn find<'a>(styles: &'a [Style], label: &str) -> Option<&'a Style> {
    styles.iter().find(|s| s.label == label)
}

impl Style {
    /// The marker, 2.7 points in radius: filled for elements, open for clouds.
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
        let outline = match self.marker {
            0 => ring(20, 0.0, r),
            1 => ring(4, 0.125, r * 1.25),
            2 => ring(3, 0.0, r * 1.35),
            3 => ring(4, 0.0, r * 1.3),
            4 => ring(3, 0.5, r * 1.35),
            5 => ring(5, 0.0, r * 1.15),
            _ => ring(6, 0.0, r * 1.1),
        };
        let open = self.open;
        canvas.fill(&outline, if open { [255, 255, 255] } else { self.colour });
        canvas.line(&outline, if open { self.colour } else { [255, 255, 255] }, if open { 1.2 } else { 0.4 });
    }

    /// The line through its points, and the points.
    pub(crate) fn curve(&self, canvas: &mut Canvas, points: &[(f64, f64)]) {
        if points.len() > 1 {
            canvas.dashed(points, self.colour, 1.3, self.dash);
        }
        for at in points {
            self.mark(canvas, *at);
        }
    }
}

/// Where each legend entry goes: `(column, row)` counts that fit a width.
fn layout(styles: &[Style], width: f64) -> (usize, f64) {
    let widest = styles.iter().map(|s| text_width(&s.label, TEXT)).fold(0.0, f64::max) + 44.0;
    let columns = ((width / widest).floor() as usize).clamp(1, styles.len().max(1));
    (columns, widest)
}

/// What filled and open markers mean, where a legend has both.
pub(crate) fn fillings(styles: &[Style]) -> &'static str {
    let both = styles.iter().any(|s| s.open) && styles.iter().any(|s| !s.open);
    if both { "Filled: elements, open: clouds. " } else { "" }
}

/// Height a legend needs, points.
pub(crate) fn legend_height(styles: &[Style], width: f64) -> f64 {
    let (columns, _) = layout(styles, width);
    styles.len().div_ceil(columns) as f64 * 14.0
}

/// Draws a legend with its top left corner at a point; `lines` where the figure joins its markers.
pub(crate) fn legend(canvas: &mut Canvas, styles: &[Style], at: (f64, f64), width: f64, lines: bool) {
    let (columns, step) = layout(styles, width);
    let rows = styles.len().div_ceil(columns);
    for (i, style) in styles.iter().enumerate() {
        let (x, y) = (at.0 + (i / rows) as f64 * step, at.1 + (i % rows) as f64 * 14.0 + 7.0);
        if lines {
            canvas.dashed(&[(x, y), (x + 24.0, y)], style.colour, 1.3, style.dash);
        }
        style.mark(canvas, (x + 12.0, y));
        canvas.text((x + 29.0, y), &style.label, TEXT, BLACK_INK, Anchor::Start);
    }
}
