//! Compact SVG backend for plotters. Consecutive shapes of equal appearance become one path in relative
//! coordinates. The drawing order is preserved, and with it the overlaps.
//!
//! A dashed curve consists of dozens of short lines and a surface of thousands of triangles. The output is
//! five times smaller than one element for each.

use std::convert::Infallible;
use std::fmt::Write as _;

use plotters::element::{Drawable, PointCollection};
use plotters::style::{Color, RGBColor};
use plotters_backend::text_anchor::HPos;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};

/// Font families. Verdana has the same widths if DejaVu Sans is not installed.
const FAMILIES: &str = "'DejaVu Sans', Verdana, sans-serif";
/// Ratio of the line height, which plotters uses, to the em size, which SVG text uses.
pub(super) const LINE_HEIGHT: f64 = 1.24;

/// Width of the line around a facet and of a line that closes a seam, in tenths of a point: half a point.
const SEAM: u32 = 5;

/// A filled facet of a surface with an outline of the same colour. (A polygon of plotters has no outline.)
pub(super) struct Facet {
    pub(super) points: Vec<BackendCoord>,
    pub(super) colour: RGBColor,
}

impl<'a> PointCollection<'a, BackendCoord> for &'a Facet {
    type Point = &'a BackendCoord;
    type IntoIter = std::slice::Iter<'a, BackendCoord>;

    fn point_iter(self) -> Self::IntoIter {
        self.points.iter()
    }
}

impl Drawable<Paths<'_>> for Facet {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        points: I,
        backend: &mut Paths<'_>,
        _: (u32, u32),
    ) -> Drawn {
        backend.fill_polygon(points, &self.colour.filled().stroke_width(SEAM))
    }
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// SVG elements in drawing order.
pub(super) struct Paths<'a> {
    out: &'a mut String,
    size: (u32, u32),
    /// Appearance of the path being written, and its steps so far.
    open: Option<(String, String)>,
}

impl<'a> Paths<'a> {
    pub(super) fn new(out: &'a mut String, size: (u32, u32)) -> Paths<'a> {
        Paths { out, size, open: None }
    }

    fn shape(&mut self, look: String, points: &[BackendCoord], filled: bool) {
        if self.open.as_ref().is_none_or(|open| open.0 != look) {
            self.close();
            self.open = Some((look, String::new()));
        }
        if let Some((_, path)) = &mut self.open {
            steps(path, points, filled);
        }
    }

    fn close(&mut self) {
        if let Some((look, path)) = self.open.take() {
            // Chromium leaves hairlines between the parts of one path; a line of half a point closes them.
            let seam = match look.strip_prefix("fill=\"#") {
                Some(colour) if !colour.contains(' ') && path.matches('z').count() > 1 => {
                    format!(" stroke=\"#{colour} stroke-width=\"{SEAM}\"")
                }
                _ => String::new(),
            };
            self.out.push_str(&format!("<path {look}{seam} d=\"{path}\"/>\n"));
        }
    }
}

impl DrawingBackend for Paths<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        self.close();
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.shape(
            format!("fill=\"{}\"", hexadecimal(color)),
            &[(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)],
            true,
        );
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<BackendCoord> = path.into_iter().collect();
        if points.len() > 1 {
            let (colour, width) = (hexadecimal(style.color()), style.stroke_width());
            self.shape(format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\""), &points, false);
        }
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let points: Vec<BackendCoord> = path.into_iter().collect();
        if points.len() > 1 {
            let colour = hexadecimal(style.color());
            // The joins are round, because a mitre at a sharp corner would stand out.
            let line = match style.stroke_width() {
                SEAM => format!(" stroke=\"{colour}\" stroke-width=\"{SEAM}\" stroke-linejoin=\"round\""),
                _ => String::new(),
            };
            self.shape(format!("fill=\"{colour}\"{line}"), &points, true);
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Drawn {
        self.close();
        let anchor = match style.anchor().h_pos {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let weight = if matches!(style.style(), FontStyle::Bold) { " font-weight=\"bold\"" } else { "" };
        let turned = match style.transform() {
            FontTransform::Rotate270 => format!(" transform=\"rotate(270, {x}, {y})\""),
            _ => String::new(),
        };
        let (size, colour) = (style.size() / LINE_HEIGHT, hexadecimal(style.color()));
        let place = format!("x=\"{x}\" y=\"{y}\" dy=\"0.5ex\" text-anchor=\"{anchor}\"");
        let look = format!("font-family=\"{FAMILIES}\" font-size=\"{size}\" opacity=\"1\" fill=\"{colour}\"");
        self.out.push_str(&format!("<text {place} {look}{weight}{turned}>\n{}\n</text>\n", escaped(text)));
        Ok(())
    }
}

fn hexadecimal(color: BackendColor) -> String {
    let (r, g, b) = color.rgb;
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Text escaped for use between tags and quotes.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&apos;"),
            other => out.push(other),
        }
    }
    out
}

/// Writes `M` to the first point, followed by steps. A filled shape is closed, without a last point that
/// repeats the first.
fn steps(path: &mut String, points: &[BackendCoord], filled: bool) {
    let ends = points.len() - usize::from(filled && points.len() > 2 && points.first() == points.last());
    let mut points = points[..ends].to_vec();
    // In one path, two overlapping shapes of opposite orientation would cut a hole.
    if filled && area(&points) < 0 {
        points.reverse();
    }
    write!(path, "M{} {}", points[0].0, points[0].1).expect("a string");
    for (i, ends) in points.windows(2).enumerate() {
        let (dx, dy) = (ends[1].0 - ends[0].0, ends[1].1 - ends[0].1);
        let before = match i {
            0 => "l",
            _ if dx < 0 => "",
            _ => " ",
        };
        let between = if dy < 0 { "" } else { " " };
        write!(path, "{before}{dx}{between}{dy}").expect("a string");
    }
    if filled {
        path.push('z');
    }
}

/// Twice the signed area of a polygon.
fn area(points: &[BackendCoord]) -> i64 {
    let next = points.iter().cycle().skip(1);
    let wide = |v: i32| i64::from(v);
    points.iter().zip(next).map(|(a, b)| wide(a.0) * wide(b.1) - wide(a.1) * wide(b.0)).sum()
}

#[cfg(test)]
mod tests {
    use plotters::prelude::*;

    use super::{Facet, Paths};

    #[test]
    fn a_facet_has_a_line_of_its_own_colour() {
        let mut out = String::new();
        {
            let area = Paths::new(&mut out, (100, 100)).into_drawing_area();
            let colour = RGBColor(0x44, 0x01, 0x54);
            area.draw(&Facet { points: vec![(1, 2), (3, 4), (5, 0)], colour }).unwrap();
            area.draw(&Facet { points: vec![(9, 9), (8, 9), (8, 11)], colour }).unwrap();
            area.present().unwrap();
        }
        assert_eq!(
            out,
            "<path fill=\"#440154\" stroke=\"#440154\" stroke-width=\"5\" stroke-linejoin=\"round\" \
             d=\"M5 0l-2 4-2-2zM8 11l0-2 1 0z\"/>\n"
        );
    }

    #[test]
    fn neighbours_alike_become_one_path_and_texts_stay_between() {
        let mut out = String::new();
        {
            let area = Paths::new(&mut out, (100, 100)).into_drawing_area();
            let violet = RGBColor(0x44, 0x01, 0x54);
            let fill = |points: Vec<(i32, i32)>| area.draw(&Polygon::new(points, violet.filled())).unwrap();
            fill(vec![(1, 2), (3, 4), (5, 0), (1, 2)]);
            fill(vec![(9, 9), (8, 9), (8, 11)]);
            area.draw(&PathElement::new(vec![(0, 5), (10, 0)], BLACK.stroke_width(13))).unwrap();
            area.draw(&PathElement::new(vec![(0, 0)], BLACK.stroke_width(13))).unwrap();
            fill(vec![(1, 2), (3, 4), (5, 0)]);
            area.present().unwrap();
        }
        assert_eq!(
            out,
            "<path fill=\"#440154\" stroke=\"#440154\" stroke-width=\"5\" d=\"M5 0l-2 4-2-2zM8 11l0-2 1 0z\"/>\n\
             <path fill=\"none\" stroke=\"#000000\" stroke-width=\"13\" d=\"M0 5l10-5\"/>\n\
             <path fill=\"#440154\" d=\"M5 0l-2 4-2-2z\"/>\n"
        );
    }
}
