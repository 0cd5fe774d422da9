//! Errors of surfaces that are not closed, with their positions.

use std::fmt;

use super::digits::point;
use super::wrap::WrapProblem;
use crate::Point3;

/// Problem of triangles that do not form a closed surface. Triangles have the numbers of their faces in the
/// file, from 1; positions are in the unit of the file.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceProblem {
    /// Fewer triangles than a tetrahedron has.
    TooFew {
        /// Number of triangles with an area.
        triangles: usize,
    },
    /// An edge that belongs to only one triangle.
    Open {
        /// Number of the triangle.
        triangle: u32,
        /// Ends of the edge.
        ends: [Point3; 2],
        /// Corner of another triangle on the edge, between its ends.
        corner: Option<Box<Point3>>,
        /// Number of such edges.
        edges: usize,
        /// Number of holes that these edges enclose.
        holes: usize,
        /// Number of edges of the hole that this edge belongs to.
        hole: usize,
        /// Centre of this hole.
        at: Point3,
        /// Whether all holes are small enough for a repair.
        small: bool,
    },
    /// An edge of more than two triangles.
    Branched {
        /// Numbers of the triangles.
        triangles: Vec<u32>,
        /// Ends of the edge.
        ends: [Point3; 2],
        /// Numbers of two of these triangles with the same corners in the same orientation, if there are any.
        twice: Option<[u32; 2]>,
    },
    /// Neighbours with opposite orientations.
    Turned {
        /// Numbers of the two triangles.
        triangles: [u32; 2],
        /// Ends of the common edge.
        ends: [Point3; 2],
        /// Numbers of the triangles to be reversed, so that all are counter-clockwise as seen from outside.
        turned: Vec<u32>,
        /// Number of all triangles.
        all: usize,
        /// Whether reversal suffices; a twisted band has no outside.
        orientable: bool,
    },
    /// Triangles that cross or touch away from common corners.
    Crossing {
        /// Numbers of the first two triangles.
        triangles: [u32; 2],
        /// Centre of the first triangle.
        at: Point3,
        /// Number of triangles that cross a later triangle.
        places: usize,
        /// Whether the two triangles belong to different closed parts.
        bodies: bool,
    },
    /// A part with the wrong orientation: clockwise as seen from outside, or counter-clockwise for a cavity.
    InsideOut {
        /// Number of a triangle of the part.
        triangle: u32,
        /// Centre of this triangle.
        at: Point3,
        /// Enclosed volume with the wrong sign, in the unit of the file cubed.
        volume: f64,
        /// Number of other parts that enclose the part.
        within: usize,
        /// Number of triangles of the part, and of the whole surface.
        part: [usize; 2],
    },
    /// Too many triangles close to each other for a surface.
    Tangled {
        /// Number of triangles.
        triangles: usize,
        /// Number of pairs that may touch.
        pairs: u64,
    },
    /// Too many parts.
    Parts {
        /// Number of parts.
        parts: usize,
        /// Largest number of parts.
        most: usize,
    },
    /// A surface that encloses no volume.
    Flat,
    /// A size of a wrap that does not fit the triangles.
    Wrap(WrapProblem),
}

/// Advice for surfaces that a repair mends, and for all others with an inside.
const REPAIR: &str = "tissuebench mesh make --repair mends this (repair = true in a scene's body)";
const WRAP: &str = "tissuebench mesh make --wrap SIZE makes a closed surface of the file (wrap = \"SIZE\" in a \
                    scene's body)";
const LARGE: &str = "a repair closes holes of up to a tenth of the surface's diagonal and 500 edges";

/// Advice for regions without their own surfaces.
const REGIONS: &str = "give each body its own closed surface, with the same triangles at the wall, a volume \
                       mesh with a region for each (.msh, .inp, .vtu), or the outer surface only, with a \
                       [[region]] of the scene (where = ...)";

impl fmt::Display for SurfaceProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SurfaceProblem::TooFew { triangles } => {
                write!(f, "{triangles} triangles enclose nothing; a closed surface has 4 or more")
            }
            SurfaceProblem::Open { triangle, ends, corner: Some(corner), edges, .. } => {
                let more = if *edges > 1 {
                    format!(" ({edges} edges without another triangle)")
                } else {
                    String::new()
                };
                write!(
                    f,
                    "the surface is open: the corner {} lies on the edge {} of triangle {triangle}, between its \
                     ends{more}",
                    point(corner),
                    line(ends)
                )
            }
            SurfaceProblem::Open { triangle, ends, edges, holes, hole, at, .. } => {
                let more = if *holes > 1 {
                    format!(", one of {holes} holes of {edges} edges")
                } else {
                    String::new()
                };
                write!(
                    f,
                    "the surface is open: the edge {} of triangle {triangle} has no other triangle, at a hole of {hole} \
                     edges near {}{more}",
                    line(ends),
                    point(at)
                )
            }
            SurfaceProblem::Branched { triangles, ends, twice } => {
                branched(f, triangles, ends, twice.as_ref())
            }
            SurfaceProblem::Turned { triangles, ends, turned, all, orientable } => {
                write!(
                    f,
                    "triangles {} have opposite orientations along their common edge {}; all triangles have \
                     to be counter-clockwise seen from outside: ",
                    list(triangles),
                    line(ends)
                )?;
                match orientable {
                    true => reversible(f, turned, *all),
                    false => write!(f, "no reversal achieves this, so the surface has no outside"),
                }
            }
            SurfaceProblem::Crossing { triangles, at, places, bodies } => {
                crossing(f, *triangles, at, *places, *bodies)
            }
            SurfaceProblem::InsideOut { triangle, at, volume, within: 0, part: [part, all] } => write!(
                f,
                "the surface is inside out at triangle {triangle}, {}: the triangles are clockwise seen from \
                 outside, and the volume is {volume:.6e}; {part} of {all} triangles face inwards",
                point(at)
            ),
            SurfaceProblem::InsideOut { triangle, at, within, .. } => {
                within_others(f, *triangle, at, *within)
            }
            SurfaceProblem::Tangled { triangles, pairs } => write!(
                f,
                "{triangles} triangles lie so close together that {pairs} pairs may cross: they do not form \
                 the surface of a body"
            ),
            SurfaceProblem::Parts { parts, most } => {
                write!(f, "the surface has {parts} unconnected parts; at most {most} are supported")
            }
            SurfaceProblem::Flat => write!(f, "the surface encloses no volume"),
            SurfaceProblem::Wrap(problem) => write!(f, "{problem}"),
        }
    }
}

impl From<WrapProblem> for SurfaceProblem {
    fn from(problem: WrapProblem) -> SurfaceProblem {
        SurfaceProblem::Wrap(problem)
    }
}

impl SurfaceProblem {
    /// Advice for the file of a body: the treatment that gets a closed surface from the triangles, if there
    /// is one. `repaired` are the faults that a repair has left.
    pub fn advice(&self, repaired: bool) -> Option<String> {
        let small = match self {
            SurfaceProblem::Open { small, .. } => *small,
            SurfaceProblem::Branched { twice, .. } => twice.is_some(),
            SurfaceProblem::Turned { orientable, .. } => *orientable,
            SurfaceProblem::InsideOut { within, .. } => *within == 0,
            SurfaceProblem::Crossing { .. }
            | SurfaceProblem::Tangled { .. }
            | SurfaceProblem::Parts { .. } => false,
            SurfaceProblem::TooFew { .. } | SurfaceProblem::Flat | SurfaceProblem::Wrap(_) => return None,
        };
        let is_large = matches!(self, SurfaceProblem::Open { small: false, .. });
        Some(match (small && !repaired, is_large) {
            (true, _) => REPAIR.into(),
            (false, true) => format!("{LARGE}; {WRAP}"),
            (false, false) => WRAP.into(),
        })
    }
}

impl std::error::Error for SurfaceProblem {}

/// Writes where two triangles cross.
fn crossing(
    f: &mut fmt::Formatter<'_>,
    triangles: [u32; 2],
    at: &Point3,
    places: usize,
    bodies: bool,
) -> fmt::Result {
    let more = if places > 1 { format!(" ({places} such places)") } else { String::new() };
    let triangles = list(&triangles);
    write!(f, "the surface crosses itself: triangles {triangles} intersect near {}{more}", point(at))?;
    match bodies {
        true => write!(
            f,
            "; they belong to two bodies, which may lie within each other or touch at common triangles (the same \
             corners in both), but not cross"
        ),
        false => Ok(()),
    }
}

/// Writes which triangles have to be reversed.
fn reversible(f: &mut fmt::Formatter<'_>, turned: &[u32], all: usize) -> fmt::Result {
    write!(f, "{} of {all} are clockwise ({})", turned.len(), list(turned))
}

/// Writes that a part within others has the wrong orientation.
fn within_others(f: &mut fmt::Formatter<'_>, triangle: u32, at: &Point3, within: usize) -> fmt::Result {
    let at = point(at);
    write!(
        f,
        "the part with triangle {triangle}, {at}, lies within {within} others and has the wrong orientation: \
         triangles of a cavity have to be clockwise seen from outside the cavity, all other triangles \
         counter-clockwise"
    )
}

fn branched(
    f: &mut fmt::Formatter<'_>,
    triangles: &[u32],
    ends: &[Point3; 2],
    twice: Option<&[u32; 2]>,
) -> fmt::Result {
    let all = list(triangles);
    let ends = line(ends);
    write!(
        f,
        "triangles {all} meet at one edge, {ends}; in a closed surface two triangles meet at each \
               edge: "
    )?;
    match twice {
        Some(pair) => {
            let pair = list(pair);
            write!(f, "triangles {pair} have the same corners")
        }
        None if triangles.len().is_multiple_of(2) => {
            write!(f, "closed parts touch at the edge, but have no common triangle there; {REGIONS}")
        }
        None => {
            write!(f, "a wall ends at the edge, which bounds no body by itself; {REGIONS}")
        }
    }
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
