//! Walls between bodies that touch: triangles that occur twice, once in each orientation.

use super::closed;
use super::error::SurfaceProblem;
use super::sides::{Side, sides};
use super::soup::Soup;
use crate::Vector3;

/// For each triangle, the triangle with the same corners in the opposite orientation.
pub(super) fn opposite(soup: &Soup) -> Vec<Option<u32>> {
    let mut sorted: Vec<([u32; 3], u32)> = (0u32..)
        .zip(&soup.triangles)
        .map(|(t, &corners)| {
            let mut corners = corners;
            corners.sort_unstable();
            (corners, t)
        })
        .collect();
    sorted.sort_unstable();
    let mut opposite = vec![None; soup.triangles.len()];
    for same in sorted.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, a), (_, b)] = same
            && is_even(soup.triangles[*a as usize]) != is_even(soup.triangles[*b as usize])
        {
            (opposite[*a as usize], opposite[*b as usize]) = (Some(*b), Some(*a));
        }
    }
    opposite
}

/// Whether the corners ascend, counted from the lowest.
fn is_even(corners: [u32; 3]) -> bool {
    let lowest = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
    corners[(lowest + 1) % 3] < corners[(lowest + 2) % 3]
}

/// Finds the neighbours of each triangle across its edges, as [`closed::neighbours`] does. Bodies may touch
/// at walls: of the triangles at an edge of several bodies, two are neighbours if the same body lies
/// between them.
pub(super) fn neighbours(soup: &Soup) -> Result<Vec<[u32; 3]>, SurfaceProblem> {
    closed::neighbours(soup).or_else(|problem| between_bodies(soup).ok_or(problem))
}

fn between_bodies(soup: &Soup) -> Option<Vec<[u32; 3]>> {
    if opposite(soup).iter().all(Option::is_none) {
        return None;
    }
    let mut across = vec![[0; 3]; soup.triangles.len()];
    for around in sides(soup).chunk_by(|a, b| a.edge == b.edge) {
        for [a, b] in pairs(soup, around)? {
            across[a.triangle as usize][a.corner as usize] = b.triangle;
            across[b.triangle as usize][b.corner as usize] = a.triangle;
        }
    }
    Some(across)
}

/// Pairs of triangles at an edge with a body between them; `None` if a triangle remains.
fn pairs(soup: &Soup, around: &[Side]) -> Option<Vec<[Side; 2]>> {
    let [from, to] = around[0].edge.map(|p| soup.points[p as usize]);
    let along = (to - from).try_normalize(0.0)?;
    let outwards = |side: &Side| -> Vector3 {
        let corner = soup.triangles[side.triangle as usize][(side.corner as usize + 2) % 3];
        let line = soup.points[corner as usize] - from;
        line - along * line.dot(&along)
    };
    let first = outwards(&around[0]);
    let angle = |side: &Side| {
        let line = outwards(side);
        along.dot(&first.cross(&line)).atan2(first.dot(&line))
    };
    let (up, down): (Vec<Side>, Vec<Side>) = around.iter().partition(|side| side.upwards);
    if up.len() != down.len() {
        return None;
    }
    let mut taken = vec![false; up.len()];
    let pair = |from: Side| {
        // The body lies at increasing angles from an edge downwards. A wall's two triangles at one angle
        // belong to different bodies.
        let beyond = |to: &Side| match (angle(to) - angle(&from)).rem_euclid(std::f64::consts::TAU) {
            0.0 => std::f64::consts::TAU,
            angle => angle,
        };
        let next = (0..up.len()).min_by(|&a, &b| beyond(&up[a]).total_cmp(&beyond(&up[b])))?;
        (!std::mem::replace(&mut taken[next], true)).then_some([from, up[next]])
    };
    down.into_iter().map(pair).collect()
}
