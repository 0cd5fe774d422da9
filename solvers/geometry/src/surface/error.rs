//! Why triangles are no closed surface, and where.

use std::fmt;
use std::path::PathBuf;

use crate::Point3;
use crate::files::FileError;

/// A surface file that can't be used.
#[derive(Debug, thiserror::Error)]
pub enum SurfaceError {
    /// It can't be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is read, but is no closed surface.
    #[error("{file}: {problem}", file = file.display())]
    Surface {
        /// The file.
        file: PathBuf,
        /// Why not.
        problem: SurfaceProblem,
    },
}

/// Why triangles are no closed surface. Triangles are numbered from 1 as the faces in the file; positions are in its unit.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceProblem {
    /// Fewer triangles than a tetrahedron has.
    TooFew {
        /// Triangles with an area.
        triangles: usize,
    },
    /// An edge of one triangle alone.
    Open {
        /// Its triangle.
        triangle: u32,
        /// Its ends.
        ends: [Point3; 2],
        /// Number of such edges.
        edges: usize,
    },
    /// An edge of more than two triangles.
    Branched {
        /// Its triangles.
        triangles: Vec<u32>,
        /// Its ends.
        ends: [Point3; 2],
    },
    /// Neighbours that turn opposite ways.
    Turned {
        /// The two.
        triangles: [u32; 2],
        /// Ends of their edge.
        ends: [Point3; 2],
    },
    /// Triangles that cross or touch away from common corners.
    Crossing {
        /// The first two.
        triangles: [u32; 2],
        /// The middle of the first.
        at: Point3,
        /// Number of triangles that cross a later one.
        places: usize,
    },
    /// A part whose triangles turn the wrong way: clockwise seen from outside, or of a cavity counter-clockwise.
    InsideOut {
        /// A triangle of it.
        triangle: u32,
        /// The middle of that.
        at: Point3,
        /// Volume enclosed, of wrong sign, in the unit of the file.
        volume: f64,
        /// How many other parts enclose it.
        within: usize,
    },
    /// More triangles close to each other than a surface has.
    Tangled {
        /// Number of triangles.
        triangles: usize,
        /// Pairs that may touch.
        pairs: u64,
    },
    /// More parts than bodies have.
    Parts {
        /// How many.
        parts: usize,
        /// At most.
        most: usize,
    },
    /// Nothing enclosed.
    Flat,
}

impl fmt::Display for SurfaceProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SurfaceProblem::TooFew { triangles } => {
                write!(f, "{triangles} triangles enclose nothing; a closed surface has 4 or more")
            }
            SurfaceProblem::Open { triangle, ends, edges } => {
                let more = if *edges > 1 { format!(" ({edges} such edges)") } else { String::new() };
                write!(
                    f,
                    "the surface is open: the edge {} of triangle {triangle} has no other triangle{more}",
                    line(ends)
                )
            }
            SurfaceProblem::Branched { triangles, ends } => {
                write!(
                    f,
                    "triangles {} meet at one edge, {}; two do in a closed surface",
                    list(triangles),
                    line(ends)
                )
            }
            SurfaceProblem::Turned { triangles, ends } => write!(
                f,
                "triangles {} turn opposite ways along their edge {}; all have to be counter-clockwise seen from outside",
                list(triangles),
                line(ends)
            ),
            SurfaceProblem::Crossing { triangles, at, places } => {
                let more = if *places > 1 { format!(" ({places} such places)") } else { String::new() };
                let triangles = list(triangles);
                write!(f, "the surface crosses itself: triangles {triangles} do, near {}{more}", point(at))
            }
            SurfaceProblem::InsideOut { triangle, at, volume, within: 0 } => write!(
                f,
                "the surface is inside out at triangle {triangle}, {}: its triangles turn clockwise seen from outside, the volume is {volume:.6e}",
                point(at)
            ),
            SurfaceProblem::InsideOut { triangle, at, within, .. } => write!(
                f,
                "the part with triangle {triangle}, {}, lies within {within} others and turns the wrong way: a cavity is clockwise seen from outside of it, what is outside or within a cavity counter-clockwise",
                point(at)
            ),
            SurfaceProblem::Tangled { triangles, pairs } => {
                write!(
                    f,
                    "{triangles} triangles lie so close that {pairs} pairs may cross: it is no surface of a body"
                )
            }
            SurfaceProblem::Parts { parts, most } => {
                write!(f, "the surface has {parts} parts that nothing connects; at most {most} are taken")
            }
            SurfaceProblem::Flat => write!(f, "the surface encloses no volume"),
        }
    }
}

impl std::error::Error for SurfaceProblem {}

fn point(p: &Point3) -> String {
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}

/// Seven digits, as many as single precision has, without zeros at the end.
fn short(x: f64) -> f64 {
    format!("{x:.6e}").parse().unwrap_or(x)
}

fn line(ends: &[Point3; 2]) -> String {
    format!("{} to {}", point(&ends[0]), point(&ends[1]))
}

/// The first numbers of a list in words.
fn list(numbers: &[u32]) -> String {
    let some: Vec<String> = numbers.iter().take(4).map(u32::to_string).collect();
    let more = if numbers.len() > 4 { ", ..." } else { "" };
    match &some[..] {
        [a, b] => format!("{a} and {b}"),
        _ => format!("{}{more}", some.join(", ")),
    }
}
