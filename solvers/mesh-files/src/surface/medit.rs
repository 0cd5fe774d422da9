//! Medit's `.mesh` files in text: keywords, each with a number of items and their values. Triangles and
//! quadrilaterals with a reference other than 0 belong to the group "surface-REFERENCE".

use std::str::FromStr;

use geometry::Point3;
use geometry::surface::Soup;

use crate::error::{Parsed, Place, Problem};
use crate::text::text;

/// Keywords whose items are skipped, with the number of values of each item.
const SKIPPED: [(&str, usize); 14] = [
    ("Edges", 3),
    ("Corners", 1),
    ("Ridges", 1),
    ("RequiredVertices", 1),
    ("RequiredEdges", 1),
    ("RequiredTriangles", 1),
    ("RequiredQuadrilaterals", 1),
    ("Normals", 3),
    ("NormalAtVertices", 2),
    ("NormalAtTriangleVertices", 3),
    ("NormalAtQuadrilateralVertices", 3),
    ("Tangents", 3),
    ("TangentAtVertices", 2),
    ("TangentAtEdges", 3),
];

/// Whether a file begins with the first keyword of the format.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    bytes.starts_with(b"MeshVersionFormatted")
}

/// Words with the numbers of their lines.
struct Words<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    line: usize,
}

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<&'a str> {
        let (line, word) = self.words.next()?;
        self.line = line + 1;
        Some(word)
    }

    fn fail<T>(&self, problem: Problem) -> Parsed<T> {
        Err((Place::Line(self.line), problem))
    }

    fn number<T: FromStr>(&mut self, expected: &'static str) -> Parsed<T> {
        let Some(word) = self.next() else { return self.fail(Problem::End { expected }) };
        word.parse().or_else(|_| self.fail(Problem::Expected { expected, found: word.into() }))
    }
}

pub(super) fn parse(bytes: &[u8]) -> Parsed<Soup> {
    let text = text(bytes)?;
    let words = text.lines().enumerate().flat_map(|(line, content)| {
        let content = content.split('#').next().unwrap_or_default();
        content.split_ascii_whitespace().map(move |word| (line, word))
    });
    let mut words = Words { words: Box::new(words), line: 1 };
    let mut soup = Soup::default();
    let mut faces = 0;
    while let Some(word) = words.next() {
        match word {
            "MeshVersionFormatted" => _ = words.number::<u32>("the version of the format")?,
            "Dimension" => match words.number("a dimension")? {
                3u32 => {}
                found => {
                    let expected = "dimension 3";
                    return words.fail(Problem::Expected { expected, found: found.to_string() });
                }
            },
            "Vertices" => vertices(&mut words, &mut soup)?,
            "Triangles" => polygons::<3>(&mut words, &mut soup, &mut faces)?,
            "Quadrilaterals" => polygons::<4>(&mut words, &mut soup, &mut faces)?,
            "Tetrahedra" | "Hexahedra" | "Prisms" | "Pyramids" => {
                if words.number::<usize>("a number of solids")? > 0 {
                    let help = "write the volume mesh as Gmsh .msh or VTK .vtu, or the surface alone";
                    return words.fail(Problem::Unread { what: format!("{word} of a .mesh file"), help });
                }
            }
            "End" => break,
            _ => match SKIPPED.iter().find(|(known, _)| *known == word) {
                Some((_, values)) => {
                    for _ in 0..words.number::<usize>("a number of items")?.saturating_mul(*values) {
                        words.number::<f64>("a value")?;
                    }
                }
                None => {
                    let expected = "Vertices, Triangles or another keyword of the format";
                    return words.fail(Problem::Expected { expected, found: word.into() });
                }
            },
        }
    }
    Ok(soup)
}

fn vertices(words: &mut Words, soup: &mut Soup) -> Parsed<()> {
    for vertex in 1..=words.number("a number of vertices")? {
        let mut at = [0.0; 3];
        for x in &mut at {
            *x = words.number("a coordinate")?;
        }
        words.number::<f64>("a reference")?;
        if !at.iter().all(|x: &f64| x.is_finite()) {
            return words.fail(Problem::NotFinite { number: vertex });
        }
        soup.points.push(Point3::from(at));
    }
    Ok(())
}

/// Reads faces of `N` corners, which count from 1.
fn polygons<const N: usize>(words: &mut Words, soup: &mut Soup, faces: &mut usize) -> Parsed<()> {
    for _ in 0..words.number::<usize>("a number of faces")? {
        *faces += 1;
        let mut corners = [0; N];
        for corner in &mut corners {
            let number: i64 = words.number("the number of a corner")?;
            let index = number.checked_sub(1).and_then(|at| u32::try_from(at).ok());
            let index = index.filter(|&at| (at as usize) < soup.points.len());
            let Some(index) = index else {
                return words.fail(Problem::UnknownCorner { face: *faces as u64, node: number });
            };
            *corner = index;
        }
        let reference: i64 = words.number("a reference")?;
        let fault = |fault| (Place::Line(words.line), Problem::of_face(*faces, fault));
        soup.face(*faces, &corners).map_err(fault)?;
        let name = if reference == 0 { String::new() } else { format!("surface-{reference}") };
        let set = soup.groups.set([name.as_str()]);
        soup.groups.fill(soup.triangles.len(), set);
    }
    Ok(())
}
