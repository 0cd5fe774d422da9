//! Closing of small holes with the triangles of least area (Barequet and Sharir 1995).

use std::collections::{HashMap, HashSet};

use super::junctions::rims;
use crate::Point3;
use crate::surface::change::Change;
use crate::surface::digits::rounded;
use crate::surface::faults::is_small;
use crate::surface::sides::Side;
use crate::surface::soup::Soup;
use crate::surface::tree::bounds;

/// Closes the small holes of triangles with a consistent orientation.
pub(super) fn close(soup: &mut Soup) -> Option<Change> {
    let rims = rims(soup);
    let across = |ring: &[u32]| {
        let (low, high) = bounds(ring.iter().map(|&p| soup.points[p as usize]));
        (high - low).norm()
    };
    let diagonal = soup.diagonal();
    let sized = rings(soup, &rims).into_iter().map(|ring| (across(&ring), ring));
    let small: Vec<(f64, Vec<u32>)> =
        sized.filter(|(across, ring)| is_small(ring.len(), *across, diagonal)).collect();
    let mut edges: HashSet<[u32; 2]> = HashSet::new();
    for t in &soup.triangles {
        (0..3).for_each(|k| _ = edges.insert(ordered(t[k], t[(k + 1) % 3])));
    }
    let beside: HashMap<[u32; 2], u32> = rims.iter().map(|side| (side.edge, side.triangle)).collect();
    let (mut places, mut largest) = (Vec::new(), 0.0f64);
    for (across, ring) in small {
        let Some(cover) = least_area(soup, &ring, &edges) else { continue };
        let neighbour = beside[&ordered(ring[0], ring[1])] as usize;
        for triangle in cover {
            (0..3).for_each(|k| _ = edges.insert(ordered(triangle[k], triangle[(k + 1) % 3])));
            soup.add_beside(neighbour, triangle);
        }
        let middle = ring.iter().map(|&p| soup.points[p as usize].coords).sum::<crate::Vector3>();
        places.push(Point3::from(middle / ring.len() as f64));
        largest = largest.max(across);
    }
    Change::at(&format!("holes of up to {} across closed", rounded(largest)), places)
}

fn ordered(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Rings of corners around the holes, against the orientation of the triangles at them. Each corner occurs
/// once in a ring.
fn rings(soup: &Soup, rims: &[Side]) -> Vec<Vec<u32>> {
    let mut onwards: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut starts = Vec::new();
    for side in rims {
        let t = soup.triangles[side.triangle as usize];
        let (from, to) = (t[(side.corner as usize + 1) % 3], t[side.corner as usize]);
        onwards.entry(from).or_default().push(to);
        starts.push(from);
    }
    let mut rings = Vec::new();
    for start in starts {
        let (mut path, mut places) = (vec![start], HashMap::from([(start, 0)]));
        while let Some(next) = path.last().and_then(|last| onwards.get_mut(last)).and_then(Vec::pop) {
            if let Some(&at) = places.get(&next) {
                let ring = path.split_off(at);
                ring.iter().for_each(|corner| _ = places.remove(corner));
                rings.push(ring);
            }
            places.insert(next, path.len());
            path.push(next);
        }
    }
    rings
}

/// Triangles of least total area that cover a ring. No triangle has an edge across the ring that the surface
/// already has.
fn least_area(soup: &Soup, ring: &[u32], edges: &HashSet<[u32; 2]>) -> Option<Vec<[u32; 3]>> {
    let count = ring.len();
    if count < 3 {
        return None;
    }
    let point = |k: usize| soup.points[ring[k] as usize];
    let area = |i: usize, j: usize, k: usize| (point(j) - point(i)).cross(&(point(k) - point(i))).norm();
    let is_free = |i: usize, j: usize| {
        j == i + 1 || (i == 0 && j + 1 == count) || !edges.contains(&ordered(ring[i], ring[j]))
    };
    // Least area of the part from corner i to corner j, and the third corner of its triangle at the edge from
    // i to j.
    let mut least = vec![(0.0, 0); count * count];
    for span in 2..count {
        for i in 0..count - span {
            let j = i + span;
            let each =
                (i + 1..j).map(|k| (least[i * count + k].0 + least[k * count + j].0 + area(i, k, j), k));
            let best = each.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0));
            least[i * count + j] = if is_free(i, j) { best } else { (f64::INFINITY, 0) };
        }
    }
    let mut open = vec![(0, count - 1)];
    let mut cover = Vec::with_capacity(count - 2);
    if !least[count - 1].0.is_finite() {
        return None;
    }
    while let Some((i, j)) = open.pop().filter(|_| cover.len() < count) {
        if j > i + 1 {
            let k = least[i * count + j].1;
            cover.push([i, k, j].map(|k| ring[k]));
            open.extend([(i, k), (k, j)]);
        }
    }
    Some(cover)
}
