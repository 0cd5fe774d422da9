//! Replaces needles, triangles without area that close a T-junction, together with their neighbours.
//!
//! Such a needle lies on the long edge of a neighbour, which ends at the needle's ends and passes through its
//! third corner. The two triangles form a quadrilateral. Divided along its other diagonal, it is the same
//! surface, and the third corner is a corner of both parts.

use super::closed;
use super::error::SurfaceProblem;
use super::soup::{Soup, WELD};

/// Neighbours of each triangle across its edges.
pub(super) type Across = Vec<[u32; 3]>;

/// Replaces all needles and their neighbours; `None` without needles.
pub(super) fn cut(soup: &Soup, across: &Across) -> Option<Result<(Soup, Across), SurfaceProblem>> {
    let tolerance = WELD * soup.diagonal();
    let (mut soup, mut across) = (soup.clone(), across.clone());
    let mut open: Vec<usize> = (0..soup.triangles.len()).rev().collect();
    let mut cut = 0;
    let most = 2 * open.len();
    while let Some(needle) = open.pop().filter(|_| cut < most) {
        let Some(edge) = long_edge(&soup, needle, tolerance) else { continue };
        let other = exchange(&mut soup, &mut across, needle, edge);
        // If the neighbour is also a needle, the exchange leaves a needle.
        open.extend([other, needle]);
        cut += 1;
    }
    if cut == 0 {
        return None;
    }
    Some(closed::neighbours(&soup).map(|across| (soup, across)))
}

/// Divides a needle and the neighbour across its long edge along the other diagonal; returns the neighbour.
fn exchange(soup: &mut Soup, across: &mut Across, needle: usize, edge: usize) -> usize {
    let corner = |t: [u32; 3], first: usize| [0, 1, 2].map(|i| t[(first + i) % 3]);
    let [a, b, m] = corner(soup.triangles[needle], edge);
    let [other, beyond_b, beyond_a] = corner(across[needle], edge);
    let other = other as usize;
    // The neighbour's edge goes from b to a.
    let start = soup.triangles[other].iter().position(|&p| p == b).unwrap_or(0);
    let [_, _, c] = corner(soup.triangles[other], start);
    let [_, along_a, along_b] = corner(across[other], start);
    (soup.triangles[needle], soup.triangles[other]) = ([a, c, m], [c, b, m]);
    across[needle] = [along_a, other as u32, beyond_a];
    across[other] = [along_b, beyond_b, needle as u32];
    let mut replace = |of: u32, old: usize, new: usize| {
        let slots = across[of as usize].iter_mut().filter(|slot| **slot == old as u32);
        slots.for_each(|slot| *slot = new as u32);
    };
    replace(along_a, other, needle);
    replace(beyond_b, needle, other);
    soup.faces[needle] = soup.faces[other];
    soup.groups.copy(other, needle);
    other
}

/// The edge of a triangle that contains the third corner between its ends.
fn long_edge(soup: &Soup, triangle: usize, tolerance: f64) -> Option<usize> {
    let corners = soup.corners(triangle);
    (0..3).find(|&edge| {
        let [a, b, m] = [0, 1, 2].map(|i| corners[(edge + i) % 3]);
        let (along, to) = (b - a, m - a);
        let part = to.dot(&along) / along.norm_squared();
        (0.0..=1.0).contains(&part) && (to - along * part).norm() <= tolerance
    })
}
