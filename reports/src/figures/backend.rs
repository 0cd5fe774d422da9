//! Compact SVG backend for plotters. Consecutive shapes of equal appearance become one path in relative
//! coordinates. The drawing order is preserved, and with it the overlaps.
//!
//! A surface consists of thousands of triangles. The output is five times smaller than one element for each,
//! as the SVG backend of plotters writes them.

use std::convert::Infallible;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use plotters::element::{Drawable, PointCollection};
use plotters::style::{Color, RGBColor, ShapeStyle};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};

/// Font families. Verdana has the same widths if DejaVu Sans is not installed.
const FAMILIES: &str = "'DejaVu Sans', Verdana, sans-serif";
/// Ratio of the height of DejaVu Sans, by which plotters measures a font, to the em size of SVG text.
pub(super) const FONT_HEIGHT: f64 = 1.164;

/// Width of the line around a facet and of a line that closes a seam: half a point.
const SEAM: u32 = 5;

/// A shape with SVG attributes that the styles of plotters lack: a pattern of dashes, or an outline of a
/// filled shape.
pub(super) struct Attributed<C> {
    points: Vec<C>,
    attributes: String,
    filled: bool,
}

impl<C> Attributed<C> {
    /// A line. The pattern alternates drawn and omitted lengths; an empty pattern gives a solid line.
    pub(super) fn line(points: Vec<C>, style: ShapeStyle, pattern: &[f64]) -> Attributed<C> {
        let mut attributes = stroke(&style);
        if !pattern.is_empty() {
            let lengths: Vec<String> = pattern.iter().map(f64::to_string).collect();
            write!(attributes, " stroke-dasharray=\"{}\"", lengths.join(" ")).expect("a string");
        }
        Attributed { points, attributes, filled: false }
    }

    /// A facet of a surface with an outline of its own colour. This closes gaps between neighbours and
    /// smooths the silhouette of the surface.
    pub(super) fn facet(points: Vec<C>, colour: RGBColor) -> Attributed<C> {
        let colour = hexadecimal(colour.to_backend_color());
        // The joins are round, because a mitre at a sharp corner would stand out.
        let attributes = format!(
            "fill=\"{colour}\" stroke=\"{colour}\" stroke-width=\"{SEAM}\" stroke-linejoin=\"round\""
        );
        Attributed { points, attributes, filled: true }
    }
}

impl<'a, C> PointCollection<'a, C> for &'a Attributed<C> {
    type Point = &'a C;
    type IntoIter = &'a [C];

    fn point_iter(self) -> &'a [C] {
        &self.points
    }
}

impl<C> Drawable<Paths> for Attributed<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(&self, points: I, paths: &mut Paths, _: (u32, u32)) -> Drawn {
        paths.shape(self.attributes.clone(), &points.collect::<Vec<_>>(), self.filled);
        Ok(())
    }
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// SVG elements in drawing order.
pub(crate) struct Paths {
    elements: String,
    size: (u32, u32),
    /// Appearance of the path being written, and its steps so far.
    open: Option<(String, String)>,
}

impl Paths {
    pub(super) fn new(size: (u32, u32)) -> Paths {
        Paths { elements: String::new(), size, open: None }
    }

    /// Takes the elements out.
    pub(super) fn take(&mut self) -> String {
        self.close();
        std::mem::take(&mut self.elements)
    }

    fn shape(&mut self, look: String, points: &[BackendCoord], filled: bool) {
        if points.len() < 2 {
            return;
        }
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
            self.elements.push_str(&format!("<path {look}{seam} d=\"{path}\"/>\n"));
        }
    }
}

impl DrawingBackend for Paths {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.fill_polygon([(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)], &color)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        match fill {
            true => self.fill_polygon(corners, style),
            false => self.draw_path(corners.into_iter().chain([corners[0]]), style),
        }
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let ring =
            ring(CIRCLE, 0.0, f64::from(radius)).into_iter().map(|corner| (x + corner.0, y + corner.1));
        if fill { self.fill_polygon(ring, style) } else { self.draw_path(ring, style) }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        if style.color().alpha > 0.0 {
            self.shape(stroke(style), &path.into_iter().collect::<Vec<_>>(), false);
        }
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        if style.color().alpha > 0.0 {
            let look = format!("fill=\"{}\"", hexadecimal(style.color()));
            self.shape(look, &path.into_iter().collect::<Vec<_>>(), true);
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Drawn {
        if text.is_empty() {
            return Ok(());
        }
        self.close();
        let anchor = match style.anchor().h_pos {
            HPos::Left => "start",
            HPos::Center => "middle",
            HPos::Right => "end",
        };
        let below = match style.anchor().v_pos {
            VPos::Top => "0.76em",
            VPos::Center => "0.5ex",
            VPos::Bottom => "-0.24em",
        };
        let weight = if matches!(style.style(), FontStyle::Bold) { " font-weight=\"bold\"" } else { "" };
        let turned = match style.transform() {
            FontTransform::Rotate270 => format!(" transform=\"rotate(270, {x}, {y})\""),
            _ => String::new(),
        };
        let (size, colour) = ((style.size() / FONT_HEIGHT).round(), hexadecimal(style.color()));
        let place = format!("x=\"{x}\" y=\"{y}\" dy=\"{below}\" text-anchor=\"{anchor}\"");
        let look = format!("font-family=\"{FAMILIES}\" font-size=\"{size}\" opacity=\"1\" fill=\"{colour}\"");
        self.elements
            .push_str(&format!("<text {place} {look}{weight}{turned}>\n{}\n</text>\n", escaped(text)));
        Ok(())
    }
}

/// Number of corners of a circle.
pub(super) const CIRCLE: i32 = 20;

/// Corners of a regular polygon around the origin, clockwise from a part of a turn after the top, with the
/// first one repeated at the end.
pub(super) fn ring(corners: i32, turn: f64, radius: f64) -> Vec<BackendCoord> {
    let corner = |k: i32| {
        let (sin, cos) = (TAU * (f64::from(k) / f64::from(corners) + turn)).sin_cos();
        ((radius * sin).round() as i32, (-radius * cos).round() as i32)
    };
    (0..=corners).map(corner).collect()
}

/// Attributes of a line.
fn stroke(style: &impl BackendStyle) -> String {
    let (colour, width) = (hexadecimal(style.color()), style.stroke_width());
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"")
}

fn hexadecimal(color: BackendColor) -> String {
    let (r, g, b) = color.rgb;
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Text escaped for use between tags and quotes.
pub(crate) fn escaped(text: &str) -> String {
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

    use super::{Attributed, Paths};

    /// Elements of a drawing.
    fn elements(draw: impl Fn(&DrawingArea<Paths, plotters::coord::Shift>)) -> String {
        let paths = std::rc::Rc::new(std::cell::RefCell::new(Paths::new((100, 100))));
        draw(&DrawingArea::from(&paths));
        paths.borrow_mut().take()
    }

    #[test]
    fn facets_have_outlines_and_dashed_lines_are_one_path() {
        let drawn = elements(|area| {
            for points in [vec![(1, 2), (3, 4), (5, 0)], vec![(9, 9), (8, 9), (8, 11)]] {
                area.draw(&Attributed::facet(points, RGBColor(0x44, 0x01, 0x54))).unwrap();
            }
            let line = Attributed::line(vec![(0, 5), (90, 5)], BLACK.stroke_width(13), &[50.0, 18.0]);
            area.draw(&line).unwrap();
        });
        assert_eq!(
            drawn,
            "<path fill=\"#440154\" stroke=\"#440154\" stroke-width=\"5\" stroke-linejoin=\"round\" \
             d=\"M5 0l-2 4-2-2zM8 11l0-2 1 0z\"/>\n\
             <path fill=\"none\" stroke=\"#000000\" stroke-width=\"13\" stroke-dasharray=\"50 18\" \
             d=\"M0 5l90 0\"/>\n"
        );
    }

    #[test]
    fn neighbours_alike_become_one_path_and_order_is_kept() {
        let violet = RGBColor(0x44, 0x01, 0x54);
        let drawn = elements(|area| {
            let fill = |points: Vec<(i32, i32)>| area.draw(&Polygon::new(points, violet.filled())).unwrap();
            fill(vec![(1, 2), (3, 4), (5, 0), (1, 2)]);
            fill(vec![(9, 9), (8, 9), (8, 11)]);
            area.draw(&PathElement::new(vec![(0, 5), (10, 0)], BLACK.stroke_width(13))).unwrap();
            area.draw(&PathElement::new(vec![(0, 0)], BLACK.stroke_width(13))).unwrap();
            area.draw(&Rectangle::new([(0, 0), (9, 9)], TRANSPARENT)).unwrap();
            area.draw_text("", &("sans-serif", 9).into_text_style(area), (0, 0)).unwrap();
            fill(vec![(1, 2), (3, 4), (5, 0)]);
        });
        assert_eq!(
            drawn,
            "<path fill=\"#440154\" stroke=\"#440154\" stroke-width=\"5\" d=\"M5 0l-2 4-2-2zM8 11l0-2 1 0z\"/>\n\
             <path fill=\"none\" stroke=\"#000000\" stroke-width=\"13\" d=\"M0 5l10-5\"/>\n\
             <path fill=\"#440154\" d=\"M5 0l-2 4-2-2z\"/>\n"
        );
    }
}
