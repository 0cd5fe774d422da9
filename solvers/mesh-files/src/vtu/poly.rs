//! VTK's surfaces, `.vtp`: polygons of `<VTKFile type="PolyData">`. Points, lines and their data are skipped.

use geometry::Point3;
use geometry::surface::Soup;

use super::grid::{File, open, whole};
use crate::error::{Parsed, Problem};

/// Type of the file, in its first tag.
const KIND: &str = "PolyData";
/// Length of the text in which the first tag is searched.
const HEAD: usize = 1024;

/// Whether a file holds surfaces, by its first tag.
pub(crate) fn is_surface(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]);
    let tag = head.split_once("<VTKFile").and_then(|(_, rest)| rest.split('>').next());
    tag.is_some_and(|tag| tag.contains(KIND))
}

pub(crate) fn surface(bytes: &[u8]) -> Parsed<Soup> {
    open(bytes, KIND, None, |file| {
        let mut soup = Soup::default();
        for piece in file.pieces() {
            add(&file, piece, &mut soup)?;
        }
        Ok(soup)
    })
}

/// Adds the polygons of a piece, whose points follow those of the previous pieces.
fn add(file: &File, piece: roxmltree::Node, soup: &mut Soup) -> Parsed<()> {
    let (points, polygons) = (file.count(piece, "NumberOfPoints")?, file.count(piece, "NumberOfPolys")?);
    let strips = piece.attribute("NumberOfStrips").is_some_and(|count| count.trim() != "0");
    if strips {
        let help = "write triangles: vtkTriangleFilter divides the strips";
        return Err((file.place(piece), Problem::Unread { what: "a strip of triangles".into(), help }));
    }
    let first = soup.points.len();
    let (place, at) = file.points(piece, points)?;
    for (number, x) in at.chunks_exact(3).enumerate() {
        if !x.iter().all(|x| x.is_finite()) {
            return Err((place, Problem::NotFinite { number: number as u64 }));
        }
        soup.points.push(Point3::new(x[0], x[1], x[2]));
    }
    if polygons == 0 {
        return Ok(());
    }
    let section = file.section(piece, "Polys")?;
    let (ends, place) = file.offsets(section, polygons)?;
    let list = file.named(section, "connectivity")?;
    let list = whole(file.array(list, ends.last().copied().unwrap_or(0))?, file.place(list))?;
    let mut start = 0;
    for end in ends {
        let number = soup.faces.last().map_or(1, |&last| last as usize + 1);
        let known = |&node: &i64| {
            let index = usize::try_from(node).ok().filter(|&node| node < points);
            let unknown = || (place, Problem::UnknownCorner { face: number as u64, node });
            index.map(|index| (first + index) as u32).ok_or_else(unknown)
        };
        let corners = list[start..end].iter().map(known).collect::<Parsed<Vec<u32>>>()?;
        start = end;
        if corners.len() < 3 {
            let (expected, found) = ("a polygon of three corners or more", corners.len().to_string());
            return Err((place, Problem::Expected { expected, found }));
        }
        soup.face(number, &corners).map_err(|fault| (place, Problem::of_face(number, fault)))?;
    }
    Ok(())
}
