//! Drawings by plotters as SVG, and from there by resvg as PNG and PDF.
//!
//! Lengths are in tenths of a point (1/72 inch): plotters draws in whole numbers, and tenths keep curves
//! smooth.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;
use std::sync::{Arc, OnceLock};

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use resvg::usvg;

use super::backend::{FONT_HEIGHT, Paths, escaped};
use super::pdf::pdf;
use super::pixels::png;
use crate::error::ReportError;

const REGULAR: &[u8] = include_bytes!("../../assets/fonts/DejaVuSans.ttf");
const BOLD: &[u8] = include_bytes!("../../assets/fonts/DejaVuSans-Bold.ttf");
const FONT: &str = "DejaVu Sans";
/// Lengths of a drawing per point.
pub(super) const PER_POINT: f64 = 10.0;

pub(crate) const BLACK_INK: RGBColor = RGBColor(0x20, 0x20, 0x20);
pub(crate) const GREY: RGBColor = RGBColor(0x75, 0x75, 0x75);
pub(crate) const PALE: RGBColor = RGBColor(0xe4, 0xe4, 0xe4);

/// Size of ordinary text.
pub(crate) const TEXT: f64 = 90.0;
/// Height of a line of a note.
pub(crate) const LINE: i32 = 120;

/// Part of a page.
pub(crate) type Area = DrawingArea<Paths, Shift>;

/// Result of drawing.
pub(crate) type Drawn<T = ()> = Result<T, DrawingAreaErrorKind<Infallible>>;

/// A page as SVG elements, or the reason for which it could not be drawn.
pub(crate) struct Drawing {
    size: (u32, u32),
    elements: Result<String, String>,
}

impl Drawing {
    /// Draws on a white page.
    pub(crate) fn new(width: i32, height: i32, draw: impl FnOnce(&Area) -> Drawn) -> Drawing {
        let size = (width.unsigned_abs(), height.unsigned_abs());
        let paths = Rc::new(RefCell::new(Paths::new(size)));
        let page = Area::from(&paths);
        let drawn = page.fill(&WHITE).and_then(|()| draw(&page)).map_err(|e| e.to_string());
        Drawing { size, elements: drawn.map(|()| paths.borrow_mut().take()) }
    }

    /// Returns the SVG text; `title` is its accessible name.
    pub(crate) fn svg(&self, name: &str, title: &str) -> Result<String, ReportError> {
        let wrong = |reason: &String| ReportError::Figure { name: name.into(), reason: reason.clone() };
        let elements = self.elements.as_ref().map_err(wrong)?;
        let [width, height] = [self.size.0, self.size.1].map(|length| f64::from(length) / PER_POINT);
        Ok(format!(
            "<svg width=\"{width}pt\" height=\"{height}pt\" role=\"img\" viewBox=\"0 0 {} {}\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n<title>{}</title>\n{elements}</svg>\n",
            self.size.0,
            self.size.1,
            escaped(title)
        ))
    }
}

fn font(size: f64, style: FontStyle) -> FontDesc<'static> {
    static REGISTERED: OnceLock<()> = OnceLock::new();
    REGISTERED.get_or_init(|| {
        for (style, font) in [(FontStyle::Normal, REGULAR), (FontStyle::Bold, BOLD)] {
            assert!(register_font(FONT, style, font).is_ok(), "the built-in font {FONT} can't be read");
        }
    });
    (FONT, size * FONT_HEIGHT, style).into_font()
}

/// Style of a text with the given end at its point, centred vertically.
pub(crate) fn text(size: f64, at: HPos) -> TextStyle<'static> {
    font(size, FontStyle::Normal).color(&BLACK_INK).pos(Pos::new(at, VPos::Center))
}

/// Style of a bold text, as [`text`].
pub(crate) fn bold(size: f64, at: HPos) -> TextStyle<'static> {
    font(size, FontStyle::Bold).color(&BLACK_INK).pos(Pos::new(at, VPos::Center))
}

/// Width of a text.
pub(crate) fn text_width(text: &str, size: f64) -> i32 {
    let size = font(size, FontStyle::Normal).box_size(text);
    size.expect("the built-in font is registered").0 as i32
}

/// Largest width of some texts of ordinary size.
pub(crate) fn widest(texts: impl Iterator<Item = impl AsRef<str>>) -> i32 {
    texts.map(|text| text_width(text.as_ref(), TEXT)).max().unwrap_or(0)
}

/// Wraps a note into lines of a given width.
pub(crate) fn wrapped(note: &str, width: i32) -> Vec<String> {
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

/// Writes the lines of a note, the first one at the top of the area.
pub(crate) fn noted(area: &Area, lines: &[String]) -> Drawn {
    for (line, top) in lines.iter().zip((0..).step_by(LINE as usize)) {
        area.draw_text(line, &text(TEXT, HPos::Left).color(&GREY), (0, top + LINE / 2))?;
    }
    Ok(())
}

/// Renders the picture as PNG and as PDF.
pub(crate) fn png_and_pdf(name: &str, title: &str, svg: &str) -> Result<(Vec<u8>, Vec<u8>), ReportError> {
    static FONTS: OnceLock<Arc<usvg::fontdb::Database>> = OnceLock::new();
    let wrong = |reason: String| ReportError::Figure { name: name.into(), reason };
    let fontdb = FONTS.get_or_init(|| {
        let mut fonts = usvg::fontdb::Database::new();
        [REGULAR, BOLD].into_iter().for_each(|font| fonts.load_font_data(font.to_vec()));
        Arc::new(fonts)
    });
    let options = usvg::Options { fontdb: fontdb.clone(), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| wrong(e.to_string()))?;
    Ok((png(&tree).map_err(wrong)?, pdf(&tree, title).map_err(wrong)?))
}
