//! Checks that every edge has a triangle on either side, with consistent orientation.

use super::{Soup, SurfaceProblem, faults};

/// Fraction of the surface's diagonal below which corners of a file coincide, from the rounding of single
/// precision.
pub(super) const WELD: f64 = 1e-6;
/// Smallest number of triangles that enclose a volume.
const FEWEST: usize = 4;

/// Returns the triangles with coinciding corners merged, and the neighbours of each triangle across its
/// edges.
pub(super) fn closed(soup: Soup) -> Result<(Soup, Vec<[u32; 3]>), SurfaceProblem> {
    let same = soup.welded(0.0);
    if let Ok(neighbours) = neighbours(&same) {
        return Ok((same, neighbours));
    }
    let near = same.welded(WELD * same.diagonal());
    let neighbours = neighbours(&near)?;
    Ok((near, neighbours))
}

/// An edge of one triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    /// Lower and higher corner.
    pub(super) edge: [u32; 2],
    pub(super) triangle: u32,
    /// Corner of the triangle at which the edge begins.
    corner: u8,
    /// Whether the edge goes from the lower corner to the higher.
    pub(super) upwards: bool,
}

/// Finds the neighbours of each triangle across its edges.
pub(super) fn neighbours(soup: &Soup) -> Result<Vec<[u32; 3]>, SurfaceProblem> {
    let count = soup.triangles.len();
    if count < FEWEST {
        return Err(SurfaceProblem::TooFew { triangles: count });
    }
    let mut sides: Vec<Side> = Vec::with_capacity(3 * count);
    for (triangle, t) in soup.triangles.iter().enumerate() {
        for corner in 0..3 {
            let (a, b) = (t[corner], t[(corner + 1) % 3]);
            let edge = [a.min(b), a.max(b)];
            sides.push(Side { edge, triangle: triangle as u32, corner: corner as u8, upwards: a < b });
        }
    }
    sides.sort_unstable();
    let mut across = vec![[0; 3]; count];
    let mut open = None;
    for around in sides.chunk_by(|a, b| a.edge == b.edge) {
        match around {
            [a, b] if a.upwards != b.upwards => {
                across[a.triangle as usize][a.corner as usize] = b.triangle;
                across[b.triangle as usize][b.corner as usize] = a.triangle;
            }
            // An edge of more triangles is the more informative error.
            [_] => open = open.or(Some(around)),
            _ => return Err(faults::of_edge(soup, &sides, around)),
        }
    }
    open.map_or(Ok(across), |around| Err(faults::of_edge(soup, &sides, around)))
}
