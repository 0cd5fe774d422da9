//! OBJ: corners, then faces of any number of them, which are in all groups of the last `g`, or where that names none in the object of the last `o`.
//! Normals, textures and materials are read over.

use super::super::error::{Parsed, Problem};
use super::super::lines::Lines;
use crate::Point3;
use crate::surface::{Set, Soup};

/// Words that begin a line beside those of corners and faces.
const OTHERS: [&str; 12] =
    ["vt", "vn", "vp", "s", "l", "p", "usemtl", "mtllib", "usemap", "maplib", "mg", "lod"];

/// Groups of one face at most: of a small file many faces in many groups would take gigabytes.
const MOST_GROUPS: usize = 100;

/// Whether the first line that is no comment begins with a word of the format.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    if bytes.starts_with(b"# vtk") {
        return false;
    }
    let mut lines = bytes.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    let word = first.and_then(|line| line.split(u8::is_ascii_whitespace).next());
    word.is_some_and(|word| {
        [&b"v"[..], b"f", b"g", b"o"].contains(&word) || OTHERS.iter().any(|other| other.as_bytes() == word)
    })
}

pub(super) fn parse(bytes: &[u8]) -> Parsed<Soup> {
    let mut lines = Lines::new(super::super::text(bytes)?);
    let mut soup = Soup::default();
    let mut faces = 0;
    let (mut groups, mut object) = (Set::default(), Set::default());
    while let Some(line) = lines.next() {
        // A line may go on after a backslash.
        let mut whole = line.split('#').next().unwrap_or_default().to_string();
        while let Some(part) = whole.strip_suffix('\\') {
            whole = format!("{part} {}", lines.need("the rest of a line")?);
        }
        let mut words = whole.split_ascii_whitespace();
        match words.next() {
            None => {}
            Some("v") => {
                let mut at = [0.0; 3];
                for x in &mut at {
                    *x = lines.number(words.next(), "a coordinate")?;
                }
                if !at.iter().all(|x: &f64| x.is_finite()) {
                    return lines.fail(Problem::NotFinite { number: soup.points.len() as u64 + 1 });
                }
                soup.points.push(at.into());
            }
            Some("f") => {
                faces += 1;
                let corners = words
                    .map(|word| corner(&lines, word, faces, &soup.points))
                    .collect::<Parsed<Vec<u32>>>()?;
                if corners.len() < 3 {
                    return lines.fail(Problem::Expected {
                        expected: "a face of three corners or more",
                        found: whole,
                    });
                }
                soup.face(faces, &corners);
                let set = if groups == Set::default() { object } else { groups };
                soup.groups.fill(soup.triangles.len(), set);
            }
            Some("g") => {
                let names: Vec<&str> = words.collect();
                if names.len() > MOST_GROUPS {
                    return lines.fail(Problem::TooMany { what: "groups of a face", count: names.len() });
                }
                groups = soup.groups.set(names);
            }
            Some("o") => object = soup.groups.set([words.collect::<Vec<_>>().join(" ").as_str()]),
            Some(word) if OTHERS.contains(&word) => {}
            Some(_) => {
                let expected = "v, f or another word of the format";
                return lines.fail(Problem::Expected { expected, found: line.into() });
            }
        }
    }
    Ok(soup)
}

/// A corner `7`, `7/2/3` or `-1`: from 1 on, or backwards from the last.
fn corner(lines: &Lines, word: &str, face: usize, points: &[Point3]) -> Parsed<u32> {
    let number: i64 = lines.number(word.split('/').next(), "the number of a corner")?;
    let count = points.len() as i64;
    let index = if number < 0 { count.checked_add(number) } else { number.checked_sub(1) };
    match index.filter(|&at| (0..count).contains(&at)) {
        Some(at) => Ok(at as u32),
        None => lines.fail(Problem::UnknownCorner { face: face as u64, node: number }),
    }
}
