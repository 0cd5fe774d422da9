//! Small multiples: panels in rows and columns over one legend.

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Anchor, Canvas, GREY};
use super::style::{Style, legend, legend_height};

/// Full page width of a journal, points.
pub(crate) const WIDTH: f64 = 504.0;
const LEFT: f64 = 60.0;
const GAP: f64 = 66.0;
const HEIGHT: f64 = 150.0;
const STEP: f64 = 206.0;

/// Draws into a frame.
pub(crate) type Plot<'a> = Box<dyn Fn(&mut Canvas, &Panel) + 'a>;

/// What one panel shows.
pub(crate) struct Content<'a> {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// Draws the data into the frame.
    pub(crate) plot: Plot<'a>,
}

/// Panels, two to a row, a legend and a note below.
pub(crate) fn multiples(panels: Vec<Content>, styles: &[Style], note: &str) -> Canvas {
    let columns = panels.len().clamp(1, 2);
    let rows = panels.len().div_ceil(columns);
    let width = (WIDTH - LEFT - 14.0 - GAP * (columns as f64 - 1.0)) / columns as f64;
    let below = legend_height(styles, WIDTH - 20.0) + if note.is_empty() { 0.0 } else { 18.0 };
    let mut canvas = Canvas::new(WIDTH, 26.0 + STEP * rows as f64 + below);
    for (i, content) in panels.into_iter().enumerate() {
        let left = LEFT + (i % columns) as f64 * (width + GAP);
        let top = 24.0 + (i / columns) as f64 * STEP;
        let panel = Panel { frame: (left, top, left + width, top + HEIGHT), x: content.x, y: content.y };
        panel.draw(&mut canvas, &content.title);
        (content.plot)(&mut canvas, &panel);
    }
    let bottom = 12.0 + STEP * rows as f64;
    legend(&mut canvas, styles, (12.0, bottom), WIDTH - 20.0);
    if !note.is_empty() {
        let at = (12.0, bottom + legend_height(styles, WIDTH - 20.0) + 10.0);
        canvas.text(at, note, TEXT, GREY, Anchor::Start);
    }
    canvas
}
