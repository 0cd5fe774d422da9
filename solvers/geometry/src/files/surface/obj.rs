//! OBJ: corners and faces of any number of them, in any order. Faces are in all groups of the last `g`, or where that names none in the
//! object of the last `o`. Normals, textures and materials are read over.

use super::super::error::{Parsed, Place, Problem};
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

/// Faces, whose corners may come later in the file.
#[derive(Default)]
struct Faces {
    /// Place, end of its corners in the list, and groups of each.
    rows: Vec<(Place, usize, Set)>,
    /// Corners from 0 on, of all faces one after another.
    corners: Vec<i64>,
}

pub(super) fn parse(bytes: &[u8]) -> Parsed<Soup> {
    let text = super::super::text(bytes)?;
    let mut lines = Lines::new(&text);
    let (mut soup, mut faces) = (Soup::default(), Faces::default());
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

/// A corner's coordinates; what comes behind, a weight or a colour, is read over.
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
    /// Notes the face of a line, before which the file has `points` corners.
    fn add(&mut self, lines: &Lines, line: &str, points: usize, set: Set) -> Parsed<()> {
        let (start, face) = (self.corners.len(), self.rows.len() + 1);
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

    /// Adds all faces, when all corners are known.
    fn add_to(&self, soup: &mut Soup) -> Parsed<()> {
        let mut start = 0;
        for (row, &(place, end, set)) in self.rows.iter().enumerate() {
            let known = |&at: &i64| {
                let index = u32::try_from(at).ok().filter(|&at| (at as usize) < soup.points.len());
                index.ok_or((place, Problem::UnknownCorner { face: row as u64 + 1, node: at + 1 }))
            };
            let corners = self.corners[start..end].iter().map(known).collect::<Parsed<Vec<u32>>>()?;
            start = end;
            super::face(soup, place, row + 1, &corners)?;
            soup.groups.fill(soup.triangles.len(), set);
        }
        Ok(())
    }
}

/// A corner `7`, `7/2/3` or `-1`: from 1 on, which may come later, or backwards from the last so far.
fn corner(lines: &Lines, word: &str, face: usize, points: usize) -> Parsed<i64> {
    let number: i64 = lines.number(word.split('/').next(), "the number of a corner")?;
    let index = if number < 0 { number.checked_add(points as i64) } else { number.checked_sub(1) };
    match index.filter(|&at| at >= 0) {
        Some(at) => Ok(at),
        None => lines.fail(Problem::UnknownCorner { face: face as u64, node: number }),
    }
}
