//! SVG shapes written shortly: neighbours that look the same become one path, in relative coordinates.

/// A shape as `(what it looks like, its points, whether it is filled)`.
type Shape = (String, Vec<(i64, i64)>, bool);

/// Joins polygons, and lines, that follow each other and look the same. Order, and so what covers what, stays.
///
/// A dashed curve is dozens of short lines and a surface thousands of triangles: this is five times less text.
pub(super) fn compact(body: &str) -> String {
    let mut out = String::with_capacity(body.len() / 3);
    let mut open: Option<(String, String)> = None;
    for line in body.split_inclusive('\n') {
        match shape(line) {
            Some((look, points, filled)) => {
                if open.as_ref().is_none_or(|o| o.0 != look) {
                    close(&mut out, &mut open);
                    open = Some((look, String::new()));
                }
                if let Some((_, path)) = &mut open {
                    draw(path, &points, filled);
                }
            }
            None => {
                close(&mut out, &mut open);
                out.push_str(line);
            }
        }
    }
    close(&mut out, &mut open);
    out
}

fn close(out: &mut String, open: &mut Option<(String, String)>) {
    if let Some((look, path)) = open.take() {
        // Chromium leaves hairlines between the parts of one path; a line of half a point closes them.
        let seam = match look.strip_prefix("fill=\"#") {
            Some(colour) if path.matches('z').count() > 1 => {
                format!(" stroke=\"#{colour} stroke-width=\"5\"")
            }
            _ => String::new(),
        };
        out.push_str(&format!("<path {look}{seam} d=\"{path}\"/>\n"));
    }
}

/// `M` to the first point, then steps; a filled shape is closed, and its last point dropped where it repeats the first.
fn draw(path: &mut String, points: &[(i64, i64)], filled: bool) {
    let ends = points.len() - usize::from(filled && points.len() > 2 && points.first() == points.last());
    let mut points = points[..ends].to_vec();
    // Inside one path two overlapping shapes of opposite turn would cut a hole.
    if filled && area(&points) < 0 {
        points.reverse();
    }
    path.push_str(&format!("M{} {}", points[0].0, points[0].1));
    for (i, ends) in points.windows(2).enumerate() {
        let (dx, dy) = (ends[1].0 - ends[0].0, ends[1].1 - ends[0].1);
        let before = match i {
            0 => "l",
            _ if dx < 0 => "",
            _ => " ",
        };
        let between = if dy < 0 { "" } else { " " };
        path.push_str(&format!("{before}{dx}{between}{dy}"));
    }
    if filled {
        path.push('z');
    }
}

/// Twice the signed area.
fn area(points: &[(i64, i64)]) -> i64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum()
}

/// Reads a polygon or polyline as plotters writes it, one to a line; anything else is left alone.
fn shape(line: &str) -> Option<Shape> {
    let filled = line.starts_with("<polygon ");
    if !filled && !line.starts_with("<polyline ") || line.trim_end().lines().count() != 1 {
        return None;
    }
    let value = |key: &str| {
        line.split_once(&format!(" {key}=\"")).and_then(|(_, rest)| rest.split_once('"')).map(|v| v.0)
    };
    if value("opacity")? != "1" {
        return None;
    }
    let look = match filled {
        true => format!("fill=\"{}\"", value("fill")?),
        false => format!(
            "fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"",
            value("stroke")?,
            value("stroke-width")?
        ),
    };
    let points: Option<Vec<(i64, i64)>> = value("points")?
        .split_whitespace()
        .map(|p| p.split_once(',').and_then(|(x, y)| Some((x.parse().ok()?, y.parse().ok()?))))
        .collect();
    points.filter(|p| p.len() > 1).map(|points| (look, points, filled))
}

#[cfg(test)]
mod tests {
    use super::compact;

    #[test]
    fn neighbours_alike_become_one_path_and_others_stay() {
        let body = "<polygon opacity=\"1\" fill=\"#440154\" points=\"1,2 3,4 5,0 1,2 \"/>\n\
                    <polygon opacity=\"1\" fill=\"#440154\" points=\"9,9 8,9 8,11 \"/>\n\
                    <text x=\"1\">\nl2\n</text>\n\
                    <polyline fill=\"none\" opacity=\"1\" stroke=\"#000000\" stroke-width=\"13\" points=\"0,0 10,-5 \"/>\n\
                    <polygon opacity=\"0.5\" fill=\"#440154\" points=\"1,2 3,4 5,0\"/>\n";
        assert_eq!(
            compact(body),
            "<path fill=\"#440154\" stroke=\"#440154\" stroke-width=\"5\" d=\"M5 0l-2 4-2-2zM8 11l0-2 1 0z\"/>\n\
             <text x=\"1\">\nl2\n</text>\n\
             <path fill=\"none\" stroke=\"#000000\" stroke-width=\"13\" d=\"M0 0l10-5\"/>\n\
             <polygon opacity=\"0.5\" fill=\"#440154\" points=\"1,2 3,4 5,0\"/>\n"
        );
    }
}
