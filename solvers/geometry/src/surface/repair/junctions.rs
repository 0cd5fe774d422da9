//! T-junctions: corners on the open edge of a triangle, which is divided at them.

use crate::Point3;
use crate::surface::change::Change;
use crate::surface::faults::lies_on;
use crate::surface::polygon;
use crate::surface::sides::{Side, sides};
use crate::surface::soup::Soup;
use crate::surface::tree::Tree;

/// Largest number of passes. Triangles of a pass may have corners of others on their new edges.
const PASSES: usize = 4;

/// Divides triangles at corners of the surface's rims that lie on their open edges.
pub(super) fn mend(soup: &mut Soup, tolerance: f64) -> Option<Change> {
    let mut places = Vec::new();
    for _ in 0..PASSES {
        let before = places.len();
        divide(soup, tolerance, &mut places);
        if places.len() == before {
            break;
        }
    }
    Change::at("T-junctions mended", places)
}

/// Edges of only one triangle.
pub(super) fn rims(soup: &Soup) -> Vec<Side> {
    let sides = sides(soup);
    let alone = |around: &[Side]| (around.len() == 1).then(|| around[0]);
    sides.chunk_by(|a, b| a.edge == b.edge).filter_map(alone).collect()
}

fn divide(soup: &mut Soup, tolerance: f64, places: &mut Vec<Point3>) {
    let rims = rims(soup);
    if rims.is_empty() {
        return;
    }
    let ends = |side: &Side| {
        let t = soup.triangles[side.triangle as usize];
        [0, 1].map(|k| t[(side.corner as usize + k) % 3])
    };
    let edges: Vec<[u32; 3]> = rims.iter().map(ends).map(|[from, to]| [from, to, to]).collect();
    let tree = Tree::new(&soup.points, &edges);
    let mut corners: Vec<u32> =
        edges.iter().map(|edge| edge[0]).chain(edges.iter().map(|edge| edge[1])).collect();
    corners.sort_unstable();
    corners.dedup();
    // Triangle, edge, distance from the first end of the edge, and corner on it.
    let mut found: Vec<(u32, u8, f64, u32)> = Vec::new();
    for corner in corners {
        let p = soup.points[corner as usize];
        let [low, high] = [-tolerance, tolerance].map(|by| p.map(|x| x + by));
        tree.touching(&low, &high, |edge| {
            let side = rims[edge as usize];
            let line = ends(&side).map(|end| soup.points[end as usize]);
            if !soup.triangles[side.triangle as usize].contains(&corner) && lies_on(&p, &line, tolerance) {
                found.push((side.triangle, side.corner, (p - line[0]).norm(), corner));
            }
        });
    }
    found.sort_unstable_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)).then(a.3.cmp(&b.3)));
    for edges in found.chunk_by(|a, b| a.0 == b.0) {
        let triangle = edges[0].0 as usize;
        let mut ring = Vec::new();
        for (k, corner) in soup.triangles[triangle].into_iter().enumerate() {
            ring.push(corner);
            ring.extend(edges.iter().filter(|(_, edge, ..)| *edge as usize == k).map(|(.., on)| on));
        }
        let points: Vec<Point3> = ring.iter().map(|&p| soup.points[p as usize]).collect();
        let Ok(parts) = polygon::cut(&points) else { continue };
        if parts.len() != ring.len() - 2 {
            continue;
        }
        places.extend(edges.iter().map(|(.., on)| soup.points[*on as usize]));
        for (k, part) in parts.into_iter().enumerate() {
            let part = part.map(|place| ring[place]);
            match k {
                0 => soup.triangles[triangle] = part,
                _ => soup.add_beside(triangle, part),
            }
        }
    }
}
