//! Small multiples: rows and columns of panels with one legend.

use super::axes::{Axis, Panel, TEXT};
use super::canvas::{Anchor, Canvas, GREY, text_width};
use super::style::{Style, fillings, legend, legend_height};

/// Page width of a journal, 178 mm, in points.
pub(crate) const WIDTH: f64 = 504.0;
/// Column width of a journal, 85 mm, in points. Figures with one panel have this width, so that their text is
/// printed at its nominal size.
pub(crate) const COLUMN: f64 = 241.0;
const LEFT: f64 = 60.0;
/// Room for a short label beyond the frame.
const RIGHT: f64 = 24.0;
const GAP: f64 = 66.0;
const HEIGHT: f64 = 150.0;
const STEP: f64 = 206.0;

/// A closure that draws into a frame.
pub(crate) type Plot<'a> = Box<dyn Fn(&mut Canvas, &Panel) + 'a>;

/// Content of one panel.
pub(crate) struct Content<'a> {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// Draws the data into the frame.
    pub(crate) plot: Plot<'a>,
}

/// Draws panels of lines, two to a row, with a legend and a note below.
pub(crate) fn multiples(panels: Vec<Content>, styles: &[Style], note: &str) -> Canvas {
    let columns = panels.len().clamp(1, 2);
    let rows = panels.len().div_ceil(columns);
    let whole = if columns == 1 { COLUMN } else { WIDTH };
    let width = (whole - LEFT - RIGHT - GAP * (columns as f64 - 1.0)) / columns as f64;
    let notes = wrapped(&format!("{}{note}", fillings(styles)), whole - 20.0);
    let below = legend_height(styles, whole - 20.0) + 12.0 * notes.len() as f64 + 6.0;
    let mut canvas = Canvas::new(whole, 20.0 + STEP * rows as f64 + below);
    for (i, content) in panels.into_iter().enumerate() {
        let left = LEFT + (i % columns) as f64 * (width + GAP);
        let top = 24.0 + (i / columns) as f64 * STEP;
        let panel = Panel { frame: (left, top, left + width, top + HEIGHT), x: content.x, y: content.y };
        panel.draw(&mut canvas, &content.title);
        (content.plot)(&mut canvas, &panel);
    }
    let bottom = 12.0 + STEP * rows as f64;
    legend(&mut canvas, styles, (12.0, bottom), whole - 20.0, true);
    let foot = bottom + legend_height(styles, whole - 20.0) + 10.0;
    for (i, line) in notes.iter().enumerate() {
        canvas.text((12.0, foot + 12.0 * i as f64), line, TEXT, GREY, Anchor::Start);
    }
    canvas
}

/// Wraps a note into lines of a given width.
pub(crate) fn wrapped(note: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in note.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), TEXT) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}
