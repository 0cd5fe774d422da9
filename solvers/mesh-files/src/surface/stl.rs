//! STL: triangles with their own corners, in text or in 50 bytes each. The name of a solid becomes a group of
//! its triangles.

use geometry::surface::{Set, Soup, triangles_of};
use geometry::{Mesh, Point3};

use crate::error::{Parsed, Place, Problem};
use crate::lines::Lines;
use crate::text::text;

/// Size of the header in bytes: a comment of 80, and the number of triangles.
const HEAD: usize = 84;
/// Size of a triangle in bytes: a normal and three corners in single precision, and two more bytes.
const EACH: usize = 50;

/// Number of triangles stated in a binary file.
fn claimed(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    Some(u32::from_le_bytes(count.try_into().ok()?) as usize)
}

/// Whether the size of a file matches its stated number of triangles. Some binary files begin with the
/// keyword of text files.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    claimed(bytes).is_some_and(|count| {
        count.checked_mul(EACH).and_then(|all| all.checked_add(HEAD)) == Some(bytes.len())
    })
}

pub(super) fn parse(bytes: &[u8]) -> Parsed<Soup> {
    if is_binary(bytes) {
        return binary(bytes);
    }
    let word = bytes.trim_ascii_start();
    let is_text = word.len() >= 5 && word[..5].eq_ignore_ascii_case(b"solid") && !bytes.contains(&0);
    if is_text {
        return lines(&text(bytes)?);
    }
    let problem = match claimed(bytes) {
        Some(count) => {
            Problem::Size { what: "triangles", count, expected: HEAD + EACH * count, found: bytes.len() }
        }
        None => Problem::End { expected: "a comment of 80 bytes and the number of triangles" },
    };
    Err((Place::Byte(bytes.len().min(HEAD - 4)), problem))
}

fn binary(bytes: &[u8]) -> Parsed<Soup> {
    let mut soup = Soup::default();
    for (at, triangle) in bytes[HEAD..].chunks_exact(EACH).enumerate() {
        let number = |n: usize| {
            let bytes = [0, 1, 2, 3].map(|byte| triangle[12 + 4 * n + byte]);
            f64::from(f32::from_le_bytes(bytes))
        };
        let corners = [0, 3, 6].map(|n| Point3::new(number(n), number(n + 1), number(n + 2)));
        add(&mut soup, Place::Byte(HEAD + EACH * at), corners)?;
    }
    Ok(soup)
}

/// Adds a triangle with its own corners.
fn add(soup: &mut Soup, place: Place, corners: [Point3; 3]) -> Parsed<()> {
    let number = soup.triangles.len() + 1;
    if !corners.iter().all(|p| p.coords.iter().all(|x| x.is_finite())) {
        return Err((place, Problem::NotFiniteFace { number: number as u64 }));
    }
    let first = u32::try_from(soup.points.len()).ok().filter(|first| *first < u32::MAX - 3);
    let first = first.ok_or((place, Problem::TooMany { what: "triangles", count: number }))?;
    soup.points.extend(corners);
    soup.triangle(number, [first, first + 1, first + 2]);
    Ok(())
}

fn lines(text: &str) -> Parsed<Soup> {
    let mut lines = Lines::new(text);
    let mut soup = Soup::default();
    let (mut open, mut set) = (false, Set::default());
    while let Some(line) = lines.next() {
        match (keyword(line).as_str(), open) {
            ("solid", false) => {
                open = true;
                set = soup.groups.set([&line["solid".len()..]]);
            }
            ("endsolid", true) => open = false,
            ("facet", true) => {
                let place = lines.place();
                word(&mut lines, &["outer", "loop"], "outer loop")?;
                let mut corners = [Point3::origin(); 3];
                for corner in &mut corners {
                    *corner = vertex(&mut lines)?;
                }
                word(&mut lines, &["endloop"], "endloop (a facet has three corners)")?;
                word(&mut lines, &["endfacet"], "endfacet")?;
                add(&mut soup, place, corners)?;
                soup.groups.fill(soup.triangles.len(), set);
            }
            (_, true) => {
                return lines.fail(Problem::Expected { expected: "facet or endsolid", found: line.into() });
            }
            (_, false) => return lines.fail(Problem::Expected { expected: "solid", found: line.into() }),
        }
    }
    if open { lines.fail(Problem::End { expected: "endsolid" }) } else { Ok(soup) }
}

/// First word of a line in lower case; some programs write `end solid` for `endsolid`.
fn keyword(line: &str) -> String {
    let mut words = line.split_ascii_whitespace().map(str::to_ascii_lowercase);
    let first = words.next().unwrap_or_default();
    if first == "end" { first + &words.next().unwrap_or_default() } else { first }
}

fn word(lines: &mut Lines, words: &[&str], expected: &'static str) -> Parsed<()> {
    let line = lines.need(expected)?;
    let mut found = line.split_ascii_whitespace();
    let same = words.iter().all(|word| found.next().is_some_and(|found| found.eq_ignore_ascii_case(word)))
        || words == [keyword(line)];
    if same { Ok(()) } else { lines.fail(Problem::Expected { expected, found: line.into() }) }
}

fn vertex(lines: &mut Lines) -> Parsed<Point3> {
    let expected = "vertex and three coordinates";
    let line = lines.need(expected)?;
    let mut words = line.split_ascii_whitespace();
    if !words.next().is_some_and(|word| word.eq_ignore_ascii_case("vertex")) {
        return lines.fail(Problem::Expected { expected, found: line.into() });
    }
    let mut at = [0.0; 3];
    for x in &mut at {
        *x = lines.number(words.next(), "a coordinate")?;
    }
    match words.next() {
        None => Ok(at.into()),
        Some(_) => lines.fail(Problem::Expected { expected, found: line.into() }),
    }
}

/// Writes the boundary of a mesh in binary. Quadrilaterals are split into two triangles, and faces of
/// quadratic cells into triangles through all their nodes. `unit` is the length of the file's unit in metres.
pub(crate) fn write(mesh: &Mesh, unit: f64) -> Vec<u8> {
    let mut triangles = Vec::new();
    for facet in mesh.boundary() {
        let nodes: Vec<u32> = mesh.facet_nodes(facet).collect();
        triangles.extend(triangles_of(mesh.facet_kind(facet), &nodes));
    }
    let mut bytes = vec![b' '; HEAD - 4];
    let comment = b"boundary of a mesh, written by tissuebench";
    bytes[..comment.len()].copy_from_slice(comment);
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        let [a, b, c] = triangle.map(|node| Point3::from(mesh.points()[node as usize].coords / unit));
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        for vector in [normal, a.coords, b.coords, c.coords] {
            bytes.extend(vector.iter().flat_map(|&x| (x as f32).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}
