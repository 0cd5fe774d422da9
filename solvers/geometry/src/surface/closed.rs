//! Checks that every edge has a triangle on either side, with consistent orientation.

use super::error::SurfaceProblem;
use super::faults;
use super::sides::sides;
use super::soup::{Soup, WELD};

/// Smallest number of triangles that enclose a volume.
const FEWEST: usize = 4;

/// Returns the triangles with coinciding corners merged, and the neighbours of each triangle across its
/// edges, which `neighbours` finds.
pub(super) fn closed(
    soup: Soup,
    neighbours: impl Fn(&Soup) -> Result<Vec<[u32; 3]>, SurfaceProblem>,
) -> Result<(Soup, Vec<[u32; 3]>), SurfaceProblem> {
    let same = soup.welded(0.0);
    if let Ok(neighbours) = neighbours(&same) {
        return Ok((same, neighbours));
    }
    let near = same.welded(WELD * same.diagonal());
    let neighbours = neighbours(&near)?;
    Ok((near, neighbours))
}

/// Finds the neighbours of each triangle across its edges.
pub(super) fn neighbours(soup: &Soup) -> Result<Vec<[u32; 3]>, SurfaceProblem> {
    let count = soup.triangles.len();
    if count < FEWEST {
        return Err(SurfaceProblem::TooFew { triangles: count });
    }
    let sides = sides(soup);
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
