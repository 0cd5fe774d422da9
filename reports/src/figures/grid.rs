//! Small multiples: rows and columns of panels with one legend.

use super::axes::{ABOVE, Axis, BELOW, Chart, LEFT, framed};
use super::drawing::{Area, Drawing, Drawn, LINE, noted, wrapped};
use super::style::{Key, Style, fillings, find, keys, legend, legend_height};
use crate::plot::{Curve, Plot};

/// Page width of a journal, 178 mm.
pub(crate) const WIDTH: i32 = 5040;
/// Column width of a journal, 85 mm. Figures with one panel have this width, so that their text is printed at
/// its nominal size.
pub(crate) const COLUMN: i32 = 2410;
/// Room left and right of the text below a figure.
const MARGIN: i32 = 120;
const HEIGHT: i32 = 1500;
/// Room between panels and a legend.
const GAP: i32 = 120;
const STEP: i32 = ABOVE + HEIGHT + BELOW;

/// Largest number of markers on a line; more would hide it.
const MARKS: usize = 12;

/// A closure that draws into a chart.
pub(crate) type Series<'a> = Box<dyn Fn(&mut Chart<'_>) -> Drawn + 'a>;

/// Content of one panel.
pub(crate) struct Content<'a> {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// Draws the data.
    pub(crate) series: Series<'a>,
}

impl<'a> Content<'a> {
    /// The curves of a plot.
    pub(crate) fn of(plot: &'a Plot, styles: &'a [Style]) -> Content<'a> {
        let points = || plot.curves.iter().flat_map(|curve| &curve.points);
        let bands = plot.curves.iter().flat_map(|curve| curve.band.iter().flat_map(|b| [b.1, b.2]));
        Content {
            title: plot.title.clone(),
            x: Axis::of(&plot.x, points().map(|p| p.0)),
            y: Axis::of(&plot.y, points().map(|p| p.1).chain(bands)),
            series: Box::new(move |chart| {
                for Curve { label, points, .. } in &plot.curves {
                    if let Some(style) = find(styles, label) {
                        style.curve(chart, points, points.len().div_ceil(MARKS))?;
                    }
                }
                Ok(())
            }),
        }
    }

    /// Draws something below the curves.
    pub(crate) fn over(self, below: impl Fn(&mut Chart<'_>) -> Drawn + 'a) -> Content<'a> {
        let series = self.series;
        let both = move |chart: &mut Chart<'_>| below(chart).and_then(|()| series(chart));
        Content { series: Box::new(both), ..self }
    }
}

/// Draws panels of lines, two to a row, with a legend and a note below.
pub(crate) fn multiples(panels: Vec<Content>, styles: &[Style], note: &str) -> Drawing {
    let columns = panels.len().clamp(1, 2);
    let rows = panels.len().div_ceil(columns);
    let width = if columns == 1 { COLUMN } else { WIDTH };
    let note = format!("{}{note}", fillings(styles));
    with_foot(width, STEP * rows as i32, keys(styles, true), &note, |area| {
        for (area, content) in area.split_evenly((rows, columns)).iter().zip(panels) {
            (content.series)(&mut framed(area, LEFT, &content.title, content.x, content.y)?)?;
        }
        Ok(())
    })
}

/// Draws a page with a legend and a note below an area of the given height.
pub(crate) fn with_foot(
    width: i32,
    above: i32,
    keys: Vec<Key>,
    note: &str,
    draw: impl FnOnce(&Area) -> Drawn,
) -> Drawing {
    let notes = wrapped(note, width - 2 * MARGIN);
    let between = legend_height(&keys, width - 2 * MARGIN) + LINE / 4;
    let below = GAP + between + LINE * notes.len() as i32 + LINE / 2;
    Drawing::new(width, above + below, |page| {
        let (upper, lower) = page.split_vertically(above);
        draw(&upper)?;
        let (upper, lower) = lower.margin(GAP, 0, MARGIN, MARGIN).split_vertically(between);
        legend(&upper, &keys)?;
        noted(&lower, &notes)
    })
}
