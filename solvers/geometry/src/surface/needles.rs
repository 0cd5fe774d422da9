//! Triangles without an area that close a T-junction, exchanged with their neighbours for triangles that have
//! one.
//!
//! Such a needle lies on the long edge of a neighbour, which ends at the needle's ends and passes its third
//! corner. The two make a quadrilateral; cut along its other diagonal it is the same surface with the corner
//! as a corner of both parts.

use super::closed::{self, WELD};
use super::{Soup, SurfaceProblem};

/// The triangle across each edge of each triangle.
type Across = Vec<[u32; 3]>;

/// Cuts all needles and their neighbours anew; `None` if there is no needle.
pub(super) fn cut(soup: &Soup, across: &Across) -> Option<Result<(Soup, Across), SurfaceProblem>> {
    let tolerance = WELD * soup.diagonal();
    let (mut soup, mut across) = (soup.clone(), across.clone());
    let mut open: Vec<usize> = (0..soup.triangles.len()).rev().collect();
    let (mut cut, most) = (0, 2 * open.len());
    while let Some(needle) = open.pop().filter(|_| cut < most) {
        let Some(edge) = long_edge(&soup, needle, tolerance) else { continue };
        let other = exchange(&mut soup, &mut across, needle, edge);
        // A neighbour that is a needle too leaves one behind.
        open.extend([other, needle]);
        cut += 1;
    }
    if cut == 0 {
        return None;
    }
    Some(closed::neighbours(&soup).map(|across| (soup, across)))
}

/// Cuts a needle and the neighbour across its long edge along their other diagonal; returns the neighbour.
fn exchange(soup: &mut Soup, across: &mut Across, needle: usize, edge: usize) -> usize {
    let corner = |t: [u32; 3], first: usize| [0, 1, 2].map(|i| t[(first + i) % 3]);
    let [a, b, m] = corner(soup.triangles[needle], edge);
    let [other, beyond_b, beyond_a] = corner(across[needle], edge);
    let other = other as usize;
    // The neighbour has the edge from b to a.
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

/// The edge of a triangle that its third corner lies on, between the ends.
fn long_edge(soup: &Soup, triangle: usize, tolerance: f64) -> Option<usize> {
    let corners = soup.corners(triangle);
    (0..3).find(|&edge| {
        let [a, b, m] = [0, 1, 2].map(|i| corners[(edge + i) % 3]);
        let (along, to) = (b - a, m - a);
        let part = to.dot(&along) / along.norm_squared();
        (0.0..=1.0).contains(&part) && (to - along * part).norm() <= tolerance
    })
}
