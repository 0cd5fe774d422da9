//! OFF: the numbers of corners and faces, the corners, and faces with any number of corners. Colours and
//! normals are skipped.

use geometry::Point3;
use geometry::surface::Soup;

use crate::error::{Parsed, Problem};
use crate::lines::Lines;
use crate::text::text;

/// First words of files: with colours, normals or texture coordinates after each corner's position.
const HEADS: [&str; 4] = ["OFF", "COFF", "NOFF", "STOFF"];

/// Whether a file begins with a first word of the format.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    let word = bytes.split(u8::is_ascii_whitespace).next().unwrap_or_default();
    HEADS.iter().any(|head| head.as_bytes() == word)
}

pub(super) fn parse(bytes: &[u8]) -> Parsed<Soup> {
    let text = text(bytes)?;
    let mut lines = Lines::new(&text);
    let mut words = need(&mut lines, "the numbers of corners and faces")?.split_ascii_whitespace();
    if words.clone().nth(1).is_none() {
        words = need(&mut lines, "the numbers of corners and faces")?.split_ascii_whitespace();
    } else {
        words.next();
    }
    let corners: usize = lines.number(words.next(), "the number of corners")?;
    let faces: usize = lines.number(words.next(), "the number of faces")?;
    let mut soup = Soup::default();
    for corner in 0..corners {
        let mut words = need(&mut lines, "all corners")?.split_ascii_whitespace();
        let mut at = [0.0; 3];
        for x in &mut at {
            *x = lines.number(words.next(), "a coordinate")?;
        }
        if !at.iter().all(|x: &f64| x.is_finite()) {
            return lines.fail(Problem::NotFinite { number: corner as u64 });
        }
        soup.points.push(Point3::from(at));
    }
    for face in 1..=faces {
        let line = need(&mut lines, "all faces")?;
        let mut words = line.split_ascii_whitespace();
        let count: usize = lines.number(words.next(), "the number of a face's corners")?;
        if count < 3 {
            let expected = "a face of three corners or more";
            return lines.fail(Problem::Expected { expected, found: line.into() });
        }
        let mut ring = Vec::new();
        for _ in 0..count {
            let corner: i64 = lines.number(words.next(), "the number of a corner")?;
            match u32::try_from(corner).ok().filter(|&corner| (corner as usize) < corners) {
                Some(corner) => ring.push(corner),
                None => return lines.fail(Problem::UnknownCorner { face: face as u64, node: corner }),
            }
        }
        soup.face(face, &ring).map_err(|fault| (lines.place(), Problem::of_face(face, fault)))?;
    }
    Ok(soup)
}

/// The next line with content, without its comment.
fn need<'a>(lines: &mut Lines<'a>, expected: &'static str) -> Parsed<&'a str> {
    loop {
        let line = lines.need(expected)?.split('#').next().unwrap_or_default().trim();
        if !line.is_empty() {
            return Ok(line);
        }
    }
}
