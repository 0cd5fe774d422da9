//! OBJ: corners, and faces with any number of corners, in any order. A face belongs to all groups of the last
//! `g`, or, if this lists none, to the object of the last `o`. Normals, textures and materials are skipped.

use geometry::Point3;
use geometry::surface::{Set, Soup};

use crate::error::{Parsed, Place, Problem};
use crate::lines::Lines;
use crate::text::text;

/// Words that may begin a line, besides those of corners, faces and groups.
const OTHERS: [&str; 12] =
    ["vt", "vn", "vp", "s", "l", "p", "usemtl", "mtllib", "usemap", "maplib", "mg", "lod"];

/// Largest number of groups of a face. A small file with many faces in many groups could take gigabytes.
const MOST_GROUPS: usize = 100;

/// Whether the first line that is not a comment begins with a word of the format.
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

/// Faces, whose corners may follow later in the file.
#[derive(Default)]
struct Faces {
    /// Place, end of the corners in `corners`, and groups of each face.
    rows: Vec<(Place, usize, Set)>,
    /// Indices of the corners of all faces, from 0.
    corners: Vec<i64>,
}

pub(super) fn parse(bytes: &[u8]) -> Parsed<Soup> {
    let text = text(bytes)?;
    let mut lines = Lines::new(&text);
    let (mut soup, mut faces) = (Soup::default(), Faces::default());
    let (mut groups, mut object) = (Set::default(), Set::default());
    while let Some(line) = lines.next() {
        // A backslash continues a line.
        let mut whole = line.split('#').next().unwrap_or_default().to_string();
        while let Some(part) = whole.strip_suffix('\\') {
            whole = format!("{part} {}", lines.need("the rest of a line")?);
        }
        let mut words = whole.split_ascii_whitespace();
        match words.next() {
            None => {}
            Some("v") => vertex(&lines, words, &mut soup.points)?,
            Some("f") => {
                let set = if groups == Set::default() { object } else { groups };
                faces.add(&lines, &whole, soup.points.len(), set)?;
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
    faces.add_to(&mut soup)?;
    Ok(soup)
}

/// Reads the coordinates of a corner; a weight or colour after them is ignored.
fn vertex<'a>(
    lines: &Lines,
    mut words: impl Iterator<Item = &'a str>,
    points: &mut Vec<Point3>,
) -> Parsed<()> {
    let mut at = [0.0; 3];
    for x in &mut at {
        *x = lines.number(words.next(), "a coordinate")?;
    }
    if !at.iter().all(|x: &f64| x.is_finite()) {
        return lines.fail(Problem::NotFinite { number: points.len() as u64 + 1 });
    }
    points.push(at.into());
    Ok(())
}

impl Faces {
    /// Adds the face of a line; `points` is the number of corners read so far.
    fn add(&mut self, lines: &Lines, line: &str, points: usize, set: Set) -> Parsed<()> {
        let start = self.corners.len();
        let face = self.rows.len() + 1;
        for word in line.split_ascii_whitespace().skip(1) {
            self.corners.push(corner(lines, word, face, points)?);
        }
        if self.corners.len() - start < 3 {
            let expected = "a face of three corners or more";
            return lines.fail(Problem::Expected { expected, found: line.into() });
        }
        self.rows.push((lines.place(), self.corners.len(), set));
        Ok(())
    }

    /// Adds all faces to the surface, once all corners are known.
    fn add_to(&self, soup: &mut Soup) -> Parsed<()> {
        let mut start = 0;
        for (row, &(place, end, set)) in self.rows.iter().enumerate() {
            let known = |&at: &i64| {
                let index = u32::try_from(at).ok().filter(|&at| (at as usize) < soup.points.len());
                index.ok_or((place, Problem::UnknownCorner { face: row as u64 + 1, node: at + 1 }))
            };
            let corners = self.corners[start..end].iter().map(known).collect::<Parsed<Vec<u32>>>()?;
            start = end;
            soup.face(row + 1, &corners).map_err(|fault| (place, Problem::of_face(row + 1, fault)))?;
            soup.groups.fill(soup.triangles.len(), set);
        }
        Ok(())
    }
}

/// Parses a corner `7`, `7/2/3` or `-1`. Positive numbers count from 1 and may refer to later corners;
/// negative numbers count backwards from the last corner so far.
fn corner(lines: &Lines, word: &str, face: usize, points: usize) -> Parsed<i64> {
    let number: i64 = lines.number(word.split('/').next(), "the number of a corner")?;
    let index = if number < 0 { number.checked_add(points as i64) } else { number.checked_sub(1) };
    match index.filter(|&at| at >= 0) {
        Some(at) => Ok(at),
        None => lines.fail(Problem::UnknownCorner { face: face as u64, node: number }),
    }
}
