//! Gmsh's .msh files.
//!
//! The physical group of a solid element becomes its region, and further groups become groups of cells. The
//! groups of a surface element become facet groups. Version 2 lists an element once for each of its groups.
//! Groups without a name are called "region-TAG" and "surface-TAG", solids without a group "body". (Gmsh
//! reference manual, "MSH file format".)

mod data;
mod groups;
mod order;
mod scanner;
mod sections;
mod text1;
mod text2;
pub(super) mod write;

pub use write::GmshVersion;

use crate::content::Content;
use crate::error::{Parsed, Place, Problem};
use crate::text::text;

/// Parses a file of any version, and the values of the array `wanted`.
pub(super) fn parse(bytes: &[u8], wanted: Option<&str>) -> Parsed<Content> {
    let mut content = mesh(bytes)?;
    wanted.map_or(Ok(()), |name| data::read(bytes, name, &mut content))?;
    Ok(content)
}

/// Parses the mesh of a file of any version. Version 2 in text is read line by line, so that hand-edited files keep line
/// numbers in errors; all other versions are read number by number.
fn mesh(bytes: &[u8]) -> Parsed<Content> {
    let mut lines = bytes.split(|&b| b == b'\n').enumerate();
    let mut next = || {
        let blank = |line: &[u8]| line.iter().all(u8::is_ascii_whitespace);
        let (index, line) = lines.find(|(_, line)| !blank(line))?;
        Some((
            Place::Line(index + 1),
            String::from_utf8_lossy(&line[..line.len().min(60)]).trim().to_string(),
        ))
    };
    let (mut place, mut found) = next().unwrap_or((Place::Line(1), String::new()));
    // Other sections, such as $Comments, may come first.
    while let Some(name) = found.strip_prefix('$').filter(|_| found != "$MeshFormat" && found != "$NOD") {
        let end = format!("$End{name}");
        let Some(_) = std::iter::from_fn(&mut next).find(|(_, line)| line.eq_ignore_ascii_case(&end)) else {
            return Err((place, Problem::Expected { expected: "$MeshFormat", found }));
        };
        (place, found) = next().unwrap_or((place, String::new()));
    }
    if found == "$NOD" {
        return text1::parse(&text(bytes)?);
    }
    if found != "$MeshFormat" {
        return Err((place, Problem::Expected { expected: "$MeshFormat", found }));
    }
    let Some((place, found)) = next() else {
        return Err((place, Problem::End { expected: "the format version" }));
    };
    let mut words = found.split_whitespace();
    match (words.next(), words.next()) {
        (Some(version), Some("0")) if version.starts_with("2.") => text2::parse(&text(bytes)?),
        (Some(version), Some(kind @ ("0" | "1"))) => match version {
            "2.1" | "2.2" | "2" | "4.0" | "4" | "4.1" => sections::parse(bytes, version, kind == "1"),
            _ => Err((place, Problem::Version { found })),
        },
        _ => Err((place, Problem::Version { found })),
    }
}
