//! PDF output: one page with letters as outlines, which needs no font, installed or embedded.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::{Content, Filter, Finish, Pdf, Rect, Ref, TextStr};
use resvg::tiny_skia::{Point, Transform};
use resvg::{tiny_skia, usvg};

/// Points per pixel of a tree, which has 96 pixels per inch.
const PAPER: f32 = 0.75;

/// Renders the lines and plain colours of a drawing as a page.
///
/// # Errors
/// An element of any other kind, by name.
pub(super) fn pdf(tree: &usvg::Tree, title: &str) -> Result<Vec<u8>, String> {
    let (width, height) = (PAPER * tree.size().width(), PAPER * tree.size().height());
    let mut content = Content::new();
    // The joins are round, because a mitre at a sharp corner would stand out.
    content.set_line_join(pdf_writer::types::LineJoinStyle::RoundJoin);
    // The second coordinate of PDF points upwards.
    group(&mut content, tree.root(), Transform::from_row(PAPER, 0.0, 0.0, -PAPER, 0.0, height))?;
    // The default level takes a quarter of a report's time and makes its pages only a quarter smaller.
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(&content.finish()).expect("memory takes all");
    let packed = packed.finish().expect("memory takes all");

    let [catalog, pages, page, drawing, info] = [1, 2, 3, 4, 5].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([page]).count(1);
    let mut sheet = pdf.page(page);
    sheet.media_box(Rect::new(0.0, 0.0, width, height)).parent(pages).contents(drawing);
    sheet.resources();
    sheet.finish();
    pdf.stream(drawing, &packed).filter(Filter::FlateDecode);
    pdf.document_info(info).title(TextStr(title));
    Ok(pdf.finish())
}

fn group(content: &mut Content, of: &usvg::Group, paper: Transform) -> Result<(), String> {
    if of.opacity().get() < 1.0 || of.clip_path().is_some() || of.mask().is_some() || !of.filters().is_empty()
    {
        return Err("a transparent, clipped or filtered group, which is not supported in PDF".into());
    }
    for node in of.children() {
        match node {
            usvg::Node::Group(inner) => group(content, inner, paper)?,
            usvg::Node::Path(shape) => path(content, shape, paper)?,
            usvg::Node::Text(text) => group(content, text.flattened(), paper)?,
            usvg::Node::Image(_) => return Err("a picture, which is not supported in PDF".into()),
        }
    }
    Ok(())
}

fn path(content: &mut Content, shape: &usvg::Path, paper: Transform) -> Result<(), String> {
    let to_paper = shape.abs_transform().post_concat(paper);
    let fill = shape.fill().map(|fill| rgb(fill.paint(), fill.opacity())).transpose()?;
    let stroke = shape
        .stroke()
        .map(|stroke| Ok::<_, String>((rgb(stroke.paint(), stroke.opacity())?, stroke.width().get())));
    let stroke = stroke.transpose()?;
    let scaled = |length: f32| rounded(length * to_paper.get_scale().0);
    let dashes = shape.stroke().and_then(usvg::Stroke::dasharray);
    if let Some([red, green, blue]) = fill {
        content.set_fill_rgb(red, green, blue);
    }
    if let Some(([red, green, blue], width)) = stroke {
        content.set_stroke_rgb(red, green, blue).set_line_width(scaled(width));
    }
    if let Some(dashes) = dashes {
        content.set_dash_pattern(dashes.iter().map(|length| scaled(*length)), 0.0);
    }
    let at = |mut point: Point| {
        to_paper.map_point(&mut point);
        (rounded(point.x), rounded(point.y))
    };
    let mut last = Point::zero();
    for segment in shape.data().segments() {
        use tiny_skia::PathSegment::{Close, CubicTo, LineTo, MoveTo, QuadTo};
        match segment {
            MoveTo(to) => {
                let (x, y) = at(to);
                content.move_to(x, y);
                last = to;
            }
            LineTo(to) => {
                let (x, y) = at(to);
                content.line_to(x, y);
                last = to;
            }
            // PDF supports only cubic curves.
            QuadTo(control, to) => {
                let part = |end: f32, control: f32| end + (control - end) * 2.0 / 3.0;
                let towards = |end: Point| Point::from_xy(part(end.x, control.x), part(end.y, control.y));
                cubic(content, [towards(last), towards(to), to].map(at));
                last = to;
            }
            CubicTo(one, two, to) => {
                cubic(content, [one, two, to].map(at));
                last = to;
            }
            Close => {
                content.close_path();
            }
        }
    }
    match (fill, stroke) {
        (Some(_), Some(_)) => content.fill_nonzero_and_stroke(),
        (Some(_), None) => content.fill_nonzero(),
        (None, Some(_)) => content.stroke(),
        (None, None) => content.end_path(),
    };
    if dashes.is_some() {
        content.set_dash_pattern([], 0.0);
    }
    Ok(())
}

fn cubic(content: &mut Content, [one, two, to]: [(f32, f32); 3]) {
    content.cubic_to(one.0, one.1, two.0, two.1, to.0, to.1);
}

/// Returns the components of an opaque plain colour.
fn rgb(paint: &usvg::Paint, opacity: usvg::Opacity) -> Result<[f32; 3], String> {
    match paint {
        usvg::Paint::Color(c) if opacity.get() == 1.0 => {
            Ok([c.red, c.green, c.blue].map(|part| rounded(f32::from(part) / 255.0)))
        }
        _ => Err("a gradient, a pattern or a transparent colour, which is not supported in PDF".into()),
    }
}

/// Rounds to three decimals: a thousandth of a point is invisible.
fn rounded(value: f32) -> f32 {
    (value * 1e3).round() / 1e3
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;

    use super::*;

    #[test]
    fn a_page_has_the_size_the_lines_and_the_outlines_of_the_drawing() {
        let svg = "<svg width=\"72pt\" height=\"36pt\" viewBox=\"0 0 720 360\" xmlns=\"http://www.w3.org/2000/svg\">\
                   <path fill=\"none\" stroke=\"#FF0000\" stroke-width=\"20\" d=\"M0 0l360 180\"/>\
                   <path fill=\"none\" stroke=\"#FF0000\" stroke-width=\"20\" stroke-dasharray=\"50 20\" d=\"M0 0l360 180\"/>\
                   <path fill=\"#0000FF\" d=\"M100 100q100 0 100 100z\"/></svg>";
        let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap();
        let made = pdf(&tree, "a title").unwrap();
        let text = String::from_utf8_lossy(&made);
        assert!(text.starts_with("%PDF-") && text.contains("/MediaBox [0 0 72 36]"), "{text}");
        assert!(text.contains("(a title)"), "{text}");
        let begin = made.windows(7).position(|w| w == b"stream\n").unwrap() + 7;
        let mut drawn = String::new();
        flate2::read::ZlibDecoder::new(&made[begin..]).read_to_string(&mut drawn).unwrap();
        // A line from the top left corner to the middle, two points wide, and the curve in its cubic form.
        assert!(drawn.contains("1 0 0 RG\n2 w\n0 36 m\n36 18 l\nS"), "{drawn}");
        assert!(drawn.contains("2 w\n[5 2] 0 d\n0 36 m\n36 18 l\nS\n[] 0 d"), "{drawn}");
        assert!(drawn.contains("0 0 1 rg\n10 26 m\n16.667 26 20 22.667 20 16 c\nh\nf"), "{drawn}");
    }

    #[test]
    fn what_a_page_would_lack_is_refused() {
        let refused = |inside: &str| {
            let svg =
                format!("<svg width=\"9\" height=\"9\" xmlns=\"http://www.w3.org/2000/svg\">{inside}</svg>");
            let tree = usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap();
            pdf(&tree, "").err()
        };
        let square = "d=\"M1 1h5v5h-5z\"";
        assert_eq!(refused(&format!("<path {square}/>")), None);
        let gradient = format!(
            "<linearGradient id=\"g\"><stop offset=\"0\"/><stop offset=\"1\" stop-color=\"red\"/></linearGradient>\
             <path fill=\"url(#g)\" {square}/>"
        );
        for (inside, what) in [
            (gradient, "a gradient"),
            (format!("<path fill-opacity=\"0.5\" {square}/>"), "a transparent colour"),
            (format!("<g opacity=\"0.5\"><path {square}/><path {square}/></g>"), "clipped or filtered group"),
        ] {
            let found = refused(&inside);
            assert!(found.as_ref().is_some_and(|reason| reason.contains(what)), "{inside}: {found:?}");
        }
    }
}
