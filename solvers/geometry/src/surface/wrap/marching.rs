//! Marching tetrahedra: the surface between the inner and outer points of a lattice (Doi and Koide 1991).

use rayon::prelude::*;

use super::lattice::{Key, Lattice};
use crate::surface::winding::Winding;
use crate::{Point3, Vector3};

/// Smallest distance of a corner of the surface from the points of the lattice, over the length of its edge.
/// It prevents triangles without area.
const OFF: f64 = 0.02;
/// Number of halvings where the winding number passes 1/2 between the triangles.
const HALVINGS: usize = 12;
/// Smallest number of edges per parallel task.
const CHUNK: usize = 32;
/// Axes along which the tetrahedra of a cube go from its lowest to its highest corner.
const PATHS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// An edge of the lattice, from its inner to its outer point.
type Edge = [u32; 2];

/// Corners (m) and triangles of the surface, counter-clockwise as seen from outside.
pub(super) fn surface(lattice: &Lattice, winding: &Winding) -> (Vec<Point3>, Vec<[u32; 3]>) {
    let mut triangles: Vec<[Edge; 3]> = Vec::new();
    let [x, y, z] = lattice.count;
    for k in 0..z - 1 {
        for j in 0..y - 1 {
            for i in 0..x - 1 {
                of_cube(lattice, [i, j, k], &mut triangles);
            }
        }
    }
    let mut edges: Vec<Edge> = triangles.iter().flatten().copied().collect();
    edges.par_sort_unstable();
    edges.dedup();
    let point = |edge: &Edge| {
        let [from, to] = edge.map(|number| lattice.place(lattice.key(number as usize)));
        from + (to - from) * cut(winding, &from, &(to - from)).clamp(OFF, 1.0 - OFF)
    };
    let points = edges.par_iter().with_min_len(CHUNK).map(point).collect();
    let number = |edge: Edge| edges.binary_search(&edge).unwrap_or_default() as u32;
    (points, triangles.into_iter().map(|triangle| triangle.map(number)).collect())
}

/// Adds the triangles in a cube, given by its lowest corner.
fn of_cube(lattice: &Lattice, low: Key, triangles: &mut Vec<[Edge; 3]>) {
    let corner = |n: usize| [low[0] + (n & 1), low[1] + (n >> 1 & 1), low[2] + (n >> 2)];
    let inside = |n: usize| lattice.is_inside(lattice.number(corner(n)));
    let first = inside(0);
    if (1..8).all(|n| inside(n) == first) {
        return;
    }
    for path in PATHS {
        let mut tet = [low; 4];
        for (k, axis) in path.into_iter().enumerate() {
            tet[k + 1] = tet[k];
            tet[k + 1][axis] += 1;
        }
        let is_inside = |key: &Key| lattice.is_inside(lattice.number(*key));
        let (ins, outs): (Vec<Key>, Vec<Key>) = tet.into_iter().partition(is_inside);
        let ring: Vec<[Key; 2]> = match (&ins[..], &outs[..]) {
            (&[a, b], &[c, d]) => vec![[a, c], [a, d], [b, d], [b, c]],
            ([], _) | (_, []) => continue,
            _ => ins.iter().flat_map(|&a| outs.iter().map(move |&b| [a, b])).collect(),
        };
        let outwards = sum(&outs) * ins.len() as f64 - sum(&ins) * outs.len() as f64;
        for two in ring[1..].windows(2) {
            let triangle = [ring[0], two[0], two[1]];
            // Twice the middles of the edges: the orientation does not depend on the cuts.
            let [a, b, c] = triangle.map(|edge| sum(&edge));
            let turned = (b - a).cross(&(c - a)).dot(&outwards) < 0.0;
            let triangle = triangle.map(|edge| edge.map(|key| lattice.number(key) as u32));
            triangles.push(if turned { [triangle[0], triangle[2], triangle[1]] } else { triangle });
        }
    }
}

fn sum(keys: &[Key]) -> Vector3 {
    keys.iter().map(|key| Vector3::from(key.map(|x| x as f64))).sum()
}

/// Fraction of a line from an inner position at which it leaves the inside: at a triangle, or where the
/// winding number passes 1/2.
fn cut(winding: &Winding, from: &Point3, line: &Vector3) -> f64 {
    let mut stops = Vec::new();
    winding.tree().pierced(from, line, 1.0, |t| stops.push(t));
    if let [stop] = stops[..] {
        return stop;
    }
    let inside = |t: f64| winding.at(&(from + line * t)) > 0.5;
    stops.sort_unstable_by(f64::total_cmp);
    let (mut low, mut high, mut last) = (0.0, 1.0, None);
    for next in stops.into_iter().chain([1.0]) {
        let middle = 0.5 * (last.unwrap_or(0.0) + next);
        match (inside(middle), last) {
            (true, _) => (low, last) = (middle, Some(next)),
            (false, Some(stop)) => return stop,
            (false, None) => {
                high = middle;
                break;
            }
        }
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *if inside(middle) { &mut low } else { &mut high } = middle;
    }
    0.5 * (low + high)
}
