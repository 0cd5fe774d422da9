//! A drawing in points (1/72 inch), rendered by plotters as SVG and by resvg as PNG.

use std::sync::{Arc, OnceLock};

use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use resvg::usvg;

use super::backend::{Facet, LINE_HEIGHT, Paths, escaped};
use super::pdf::pdf;
use super::pixels::png;
use crate::error::ReportError;

const REGULAR: &[u8] = include_bytes!("../../assets/fonts/DejaVuSans.ttf");
const BOLD: &[u8] = include_bytes!("../../assets/fonts/DejaVuSans-Bold.ttf");
const FONT: &str = "DejaVu Sans";
/// Units per point. plotters draws in whole numbers; ten per point keep curves smooth.
const UNITS: f64 = 10.0;
/// Ascent plus descent of DejaVu Sans over its em size. plotters measures a font whose total height is the
/// given size.
const FONT_HEIGHT: f64 = 1.164;

/// A colour: red, green and blue.
pub(crate) type Colour = [u8; 3];

pub(crate) const BLACK_INK: Colour = [0x20, 0x20, 0x20];
pub(crate) const GREY: Colour = [0x75, 0x75, 0x75];
pub(crate) const PALE: Colour = [0xe4, 0xe4, 0xe4];

/// End of a text that is placed at its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Clone, Debug)]
enum Shape {
    Line {
        points: Vec<(f64, f64)>,
        colour: Colour,
        width: f64,
    },
    Fill {
        points: Vec<(f64, f64)>,
        colour: Colour,
        /// Whether the shape is a facet of a surface, without hairlines between neighbours.
        facet: bool,
    },
    Text {
        at: (f64, f64),
        text: String,
        size: f64,
        colour: Colour,
        anchor: Anchor,
        bold: bool,
        vertical: bool,
    },
}

/// Shapes in drawing order.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    width: f64,
    height: f64,
    shapes: Vec<Shape>,
}

impl Canvas {
    pub(crate) fn new(width: f64, height: f64) -> Canvas {
        let mut canvas = Canvas { width, height, shapes: Vec::new() };
        canvas.fill(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)], [255, 255, 255]);
        canvas
    }

    pub(crate) fn line(&mut self, points: &[(f64, f64)], colour: Colour, width: f64) {
        self.shapes.push(Shape::Line { points: points.to_vec(), colour, width });
    }

    /// Draws a dashed line. The pattern alternates drawn and omitted lengths in points; an empty pattern
    /// gives a solid line.
    pub(crate) fn dashed(&mut self, points: &[(f64, f64)], colour: Colour, width: f64, pattern: &[f64]) {
        if pattern.is_empty() {
            return self.line(points, colour, width);
        }
        let (mut index, mut left) = (0, pattern[0]);
        let mut piece: Vec<(f64, f64)> = points.first().copied().into_iter().collect();
        for ends in points.windows(2) {
            let (mut from, to) = (ends[0], ends[1]);
            loop {
                let length = (to.0 - from.0).hypot(to.1 - from.1);
                if length < left {
                    left -= length;
                    piece.push(to);
                    break;
                }
                let at = (from.0 + (to.0 - from.0) * left / length, from.1 + (to.1 - from.1) * left / length);
                piece.push(at);
                if index % 2 == 0 {
                    self.line(&piece, colour, width);
                }
                (piece, from) = (vec![at], at);
                index = (index + 1) % pattern.len();
                left = pattern[index];
            }
        }
        if index % 2 == 0 && piece.len() > 1 {
            self.line(&piece, colour, width);
        }
    }

    pub(crate) fn fill(&mut self, points: &[(f64, f64)], colour: Colour) {
        self.shapes.push(Shape::Fill { points: points.to_vec(), colour, facet: false });
    }

    /// Draws a facet of a surface with an outline of its own colour. This closes gaps between neighbours and
    /// smooths the silhouette of the surface.
    pub(crate) fn facet(&mut self, points: &[(f64, f64)], colour: Colour) {
        self.shapes.push(Shape::Fill { points: points.to_vec(), colour, facet: true });
    }

    pub(crate) fn text(&mut self, at: (f64, f64), text: &str, size: f64, colour: Colour, anchor: Anchor) {
        self.push_text(at, text, size, colour, anchor, false, false);
    }

    pub(crate) fn bold(&mut self, at: (f64, f64), text: &str, size: f64, anchor: Anchor) {
        self.push_text(at, text, size, BLACK_INK, anchor, true, false);
    }

    /// Draws a centred text that reads upwards.
    pub(crate) fn vertical(&mut self, at: (f64, f64), text: &str, size: f64) {
        self.push_text(at, text, size, BLACK_INK, Anchor::Middle, false, true);
    }

    fn push_text(
        &mut self,
        at: (f64, f64),
        text: &str,
        size: f64,
        colour: Colour,
        anchor: Anchor,
        bold: bool,
        vertical: bool,
    ) {
        let text = text.to_string();
        self.shapes.push(Shape::Text { at, text, size, colour, anchor, bold, vertical });
    }

    /// Returns the SVG text; `title` is its accessible name.
    pub(crate) fn svg(&self, name: &str, title: &str) -> Result<String, ReportError> {
        let wrong = |reason: String| ReportError::Figure { name: name.into(), reason };
        fonts().map_err(|e| wrong(e.into()))?;
        let size = ((self.width * UNITS).round() as u32, (self.height * UNITS).round() as u32);
        let (width, height) = (self.width, self.height);
        // The accessible name.
        let title = escaped(title);
        let mut svg = format!(
            "<svg width=\"{width}pt\" height=\"{height}pt\" role=\"img\" viewBox=\"0 0 {} {}\" \
             xmlns=\"http://www.w3.org/2000/svg\">\n<title>{title}</title>\n",
            size.0, size.1
        );
        {
            let area = Paths::new(&mut svg, size).into_drawing_area();
            for shape in &self.shapes {
                draw(&area, shape).map_err(&wrong)?;
            }
            area.present().map_err(|e| wrong(e.to_string()))?;
        }
        svg.push_str("</svg>\n");
        Ok(svg)
    }
}

fn draw(area: &DrawingArea<Paths, plotters::coord::Shift>, shape: &Shape) -> Result<(), String> {
    let unit = |v: f64| (v * UNITS).round() as i32;
    let scaled = |points: &[(f64, f64)]| points.iter().map(|p| (unit(p.0), unit(p.1))).collect::<Vec<_>>();
    let ink = |c: Colour| RGBColor(c[0], c[1], c[2]);
    match shape {
        Shape::Line { points, colour, width } => {
            let style = ink(*colour).stroke_width(unit(*width).max(1) as u32);
            area.draw(&PathElement::new(scaled(points), style)).map_err(|e| e.to_string())
        }
        Shape::Fill { points, colour, facet: false } => {
            area.draw(&Polygon::new(scaled(points), ink(*colour).filled())).map_err(|e| e.to_string())
        }
        Shape::Fill { points, colour, facet: true } => {
            area.draw(&Facet { points: scaled(points), colour: ink(*colour) }).map_err(|e| e.to_string())
        }
        Shape::Text { at, text, size, colour, anchor, bold, vertical } => {
            let weight = if *bold { FontStyle::Bold } else { FontStyle::Normal };
            let side = match anchor {
                Anchor::Start => HPos::Left,
                Anchor::Middle => HPos::Center,
                Anchor::End => HPos::Right,
            };
            let colour = ink(*colour);
            let mut style = (FONT, size * UNITS * LINE_HEIGHT, weight)
                .into_text_style(area)
                .color(&colour)
                .pos(Pos::new(side, VPos::Center));
            if *vertical {
                style = style.transform(FontTransform::Rotate270);
            }
            area.draw_text(text, &style, (unit(at.0), unit(at.1))).map_err(|e| e.to_string())
        }
    }
}

/// Width of a text, points.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    if fonts().is_err() {
        return 0.6 * size * text.chars().count() as f64;
    }
    let font: FontDesc = (FONT, size * UNITS * FONT_HEIGHT).into_font();
    font.box_size(text).map_or(0.6 * size * text.chars().count() as f64, |(w, _)| f64::from(w) / UNITS)
}

fn fonts() -> Result<(), &'static str> {
    static DONE: OnceLock<bool> = OnceLock::new();
    let done = DONE.get_or_init(|| {
        register_font(FONT, FontStyle::Normal, REGULAR).is_ok()
            && register_font(FONT, FontStyle::Bold, BOLD).is_ok()
    });
    if *done { Ok(()) } else { Err("the built-in fonts can't be read") }
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
