//! Whether every edge has a triangle on either side, turned the same way.

use super::{Soup, SurfaceProblem, faults};

/// Corners of a file are one where they are nearer than this part of the surface's diagonal: what single precision leaves.
pub(super) const WELD: f64 = 1e-6;
/// A surface of fewer triangles encloses nothing.
const FEWEST: usize = 4;

/// The triangles with their corners joined, and for each the triangle across its edges.
pub(super) fn closed(soup: Soup) -> Result<(Soup, Vec<[u32; 3]>), SurfaceProblem> {
    let same = soup.welded(0.0);
    if let Ok(neighbours) = neighbours(&same) {
        return Ok((same, neighbours));
    }
    let near = same.welded(WELD * same.diagonal());
    let neighbours = neighbours(&near)?;
    Ok((near, neighbours))
}

/// One side of an edge.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    /// Lower and higher corner.
    pub(super) edge: [u32; 2],
    pub(super) triangle: u32,
    /// From this corner of the triangle to the next.
    corner: u8,
    /// Whether it goes from the lower corner to the higher.
    pub(super) upwards: bool,
}

/// For each triangle the one across each of its edges.
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
            // Edges of more triangles say more.
            [_] => open = open.or(Some(around)),
            _ => return Err(faults::of_edge(soup, &sides, around)),
        }
    }
    open.map_or(Ok(across), |around| Err(faults::of_edge(soup, &sides, around)))
}
