//! Appearance of a method in figures: marker, line and legend.

use plotters::element::ComposedElement;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use plotters_backend::BackendCoord;
use records::Family;

use super::axes::Chart;
use super::backend::{Attributed, CIRCLE, Paths, ring};
use super::drawing::{Area, Drawn, PER_POINT, TEXT, text, widest};
use crate::appearance::{Look, distinct};

/// A marker and its rim.
pub(super) type Mark<C> = ComposedElement<C, Paths, Polygon<BackendCoord>, PathElement<BackendCoord>>;

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
    /// Marker at a point: filled for elements, open for clouds.
    pub(super) fn mark<C>(&self, at: C) -> Mark<C> {
        let (corners, turn, size) = match self.look.marker {
            0 => (CIRCLE, 0.0, 27.0),
            1 => (4, 0.125, 34.0),
            2 => (3, 0.0, 36.0),
            3 => (4, 0.0, 35.0),
            4 => (3, 0.5, 36.0),
            5 => (5, 0.0, 31.0),
            _ => (6, 0.0, 30.0),
        };
        let ring = ring(corners, turn, size);
        let colour = self.look.colour;
        let (fill, rim) = match self.look.open {
            true => (WHITE, colour.stroke_width(12)),
            false => (colour, WHITE.stroke_width(4)),
        };
        EmptyElement::at(at) + Polygon::new(ring.clone(), fill) + PathElement::new(ring, rim)
    }

    /// Line through points.
    pub(super) fn line<C>(&self, points: Vec<C>) -> Attributed<C> {
        let lengths: Vec<f64> = self.look.dash.iter().map(|length| length * PER_POINT).collect();
        Attributed::line(points, self.look.colour.stroke_width(13), &lengths)
    }

    /// Draws a curve with a marker at every `each`-th point.
    pub(super) fn curve(&self, chart: &mut Chart<'_>, points: &[(f64, f64)], each: usize) -> Drawn {
        chart.draw_series([self.line(points.to_vec())])?;
        self.marks(chart, points.iter().copied().step_by(each))
    }

    /// Draws markers.
    pub(super) fn marks(&self, chart: &mut Chart<'_>, points: impl Iterator<Item = (f64, f64)>) -> Drawn {
        chart.draw_series(points.map(|at| self.mark(at)))?;
        Ok(())
    }
}

/// An entry of a legend: its label, and the element before the label.
pub(super) type Key = (String, DynElement<'static, Paths, BackendCoord>);

/// Height of an entry, width of its element, and room for it and the gap to the next column.
pub(super) const ROW: i32 = 140;
const KEY: i32 = 290;
const COLUMN: i32 = 440;

/// Entries of methods, with lines if the figure connects its markers.
pub(super) fn keys(styles: &[Style], lines: bool) -> Vec<Key> {
    let ends = if lines { vec![(0, 0), (240, 0)] } else { Vec::new() };
    let key = |style: &Style| {
        let element = EmptyElement::at((0, ROW / 2)) + style.line(ends.clone()) + style.mark((120, 0));
        (style.label.clone(), element.into_dyn())
    };
    styles.iter().map(key).collect()
}

/// Number of rows of a legend in columns that fit a width, and the width of a column.
fn layout(keys: &[Key], width: i32) -> (usize, i32) {
    let column = COLUMN + widest(keys.iter().map(|key| &key.0));
    let columns = ((width / column) as usize).clamp(1, keys.len().max(1));
    (keys.len().div_ceil(columns), column)
}

/// Height of a legend.
pub(super) fn legend_height(keys: &[Key], width: i32) -> i32 {
    layout(keys, width).0 as i32 * ROW
}

/// Draws a legend in columns. (A legend of plotters has one column and stands inside a chart.)
pub(super) fn legend(area: &Area, keys: &[Key]) -> Drawn {
    let (rows, column) = layout(keys, area.dim_in_pixel().0 as i32);
    for (k, (label, element)) in keys.iter().enumerate() {
        let at = ((k / rows) as i32 * column, (k % rows) as i32 * ROW);
        let area = area.clone().shrink(at, (column, ROW));
        area.draw(element)?;
        area.draw_text(label, &text(TEXT, HPos::Left), (KEY, ROW / 2))?;
    }
    Ok(())
}

/// Note on filled and open markers, for a legend that has both.
pub(super) fn fillings(styles: &[Style]) -> &'static str {
    let both = styles.iter().any(|s| s.look.open) && styles.iter().any(|s| !s.look.open);
    if both { "Filled: elements, open: clouds. " } else { "" }
}
