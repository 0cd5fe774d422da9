//! Finds overlapping cells: cells with the same corners, or on the same side of a shared face.
//!
//! Most meshes have none, so the first pass compares short hashes in buckets. It takes 12 to 15 % of the time
//! to read a million tetrahedra (41 ms of 280 to 340), including the search for twins; sorting for twins
//! alone took as long. Repeated hashes are compared in full.

use std::collections::{HashMap, HashSet};

use geometry::{CellKind, Point3, Vector3};

/// Largest bucket in which all pairs are compared; larger buckets are sorted.
const FEW: usize = 64;
/// Relative height below which a cell counts as flat, as a fraction of a length cubed. Flat cells are
/// rejected elsewhere.
const FLAT: f64 = 1e-12;

/// Cells of a mesh as a file lists them.
pub(super) struct Cells<'a> {
    pub kinds: &'a [CellKind],
    pub nodes: &'a [u32],
    pub points: &'a [Point3],
}

/// Key for the first comparison: the lowest corner, and a hash of the others.
type Key = (u32, u32);

impl Cells<'_> {
    /// First cell with the same corners as an earlier cell, as `[earlier, later]`.
    pub(super) fn twins(&self) -> Option<[usize; 2]> {
        let mut keys: Vec<Key> = Vec::with_capacity(self.kinds.len());
        self.each(|_, kind, nodes| keys.push(set_key(&nodes[..kind.corner_count()])));
        let repeated = repeated(&keys, self.points.len());
        let mut groups: HashMap<Vec<u32>, Vec<usize>> = HashMap::new();
        self.each_of(&repeated, |cell, kind, nodes| {
            if repeated.contains(&keys[cell]) {
                let mut corners = nodes[..kind.corner_count()].to_vec();
                corners.sort_unstable();
                groups.entry(corners).or_default().push(cell);
            }
        });
        first(groups)
    }

    /// First cell on the same side of a face as an earlier cell, as `[earlier, later]`.
    pub(super) fn same_side(&self) -> Option<[usize; 2]> {
        let mut keys: Vec<Key> = Vec::with_capacity(4 * self.kinds.len());
        self.each(|_, kind, nodes| faces(kind, nodes, |_, face| keys.push(face.key())));
        let repeated = repeated(&keys, self.points.len());
        // Cells whose faces have the same orientation are on the same side, unless one is inverted, which is
        // reported elsewhere.
        let mut groups: HashMap<(Face, bool), Vec<usize>> = HashMap::new();
        self.each_of(&repeated, |cell, kind, nodes| {
            faces(kind, nodes, |at, face| {
                if repeated.contains(&face.key())
                    && let Some(side) = self.side(kind, nodes, at)
                {
                    groups.entry((face, side)).or_default().push(cell);
                }
            });
        });
        first(groups)
    }

    /// Whether a cell is on the side that the normal of its face points to; `None` if the cell is flat.
    fn side(&self, kind: CellKind, nodes: &[u32], face: usize) -> Option<bool> {
        let point = |local: usize| self.points[nodes[local] as usize].coords;
        let mean = |list: &mut dyn ExactSizeIterator<Item = usize>| {
            let count = list.len() as f64;
            list.map(point).sum::<Vector3>() / count
        };
        let corners = kind.face_corners(face);
        let middle = mean(&mut corners.iter().copied());
        // The normal of a quadrilateral is the cross product of its diagonals.
        let [a, b, c] = [corners[0], corners[1], corners[2]].map(point);
        let normal = match corners.get(3) {
            None => (b - a).cross(&(c - a)),
            Some(&d) => (c - a).cross(&(point(d) - b)),
        };
        let away = mean(&mut (0..kind.corner_count())) - middle;
        let height = away.dot(&normal);
        let size = away.norm() + normal.norm().sqrt();
        (height.abs() > FLAT * size.powi(3)).then_some(height > 0.0)
    }

    /// Calls `call` with each cell, its kind and its nodes.
    fn each(&self, mut call: impl FnMut(usize, CellKind, &[u32])) {
        let mut start = 0;
        for (cell, &kind) in self.kinds.iter().enumerate() {
            let end = start + kind.node_count();
            call(cell, kind, &self.nodes[start..end]);
            start = end;
        }
    }

    /// Calls [`Cells::each`] unless `looked_for` is empty.
    fn each_of(&self, looked_for: &HashSet<Key>, call: impl FnMut(usize, CellKind, &[u32])) {
        if !looked_for.is_empty() {
            self.each(call);
        }
    }
}

/// Corners of a face, in the order seen from outside with the lowest first; `u32::MAX` pads triangles.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Face([u32; 4]);

impl Face {
    fn key(&self) -> Key {
        let Face([lowest, b, c, d]) = self;
        (*lowest, mixed(mixed(mixed(*b) ^ c) ^ d))
    }
}

/// Calls `call` with each face of a cell and its index.
fn faces(kind: CellKind, nodes: &[u32], mut call: impl FnMut(usize, Face)) {
    for (at, face) in kind.faces().iter().enumerate() {
        let [a, b, c] = [nodes[face[0]], nodes[face[1]], nodes[face[2]]];
        let turned = if kind.face_kind(at).is_triangle() {
            match a.min(b).min(c) {
                lowest if lowest == a => [a, b, c, u32::MAX],
                lowest if lowest == b => [b, c, a, u32::MAX],
                _ => [c, a, b, u32::MAX],
            }
        } else {
            let corners = [a, b, c, nodes[face[3]]];
            let lowest = (0..4).min_by_key(|&i| corners[i]).unwrap_or(0);
            [0, 1, 2, 3].map(|i| corners[(lowest + i) % 4])
        };
        call(at, Face(turned));
    }
}

/// Key of corners independent of their order.
fn set_key(corners: &[u32]) -> Key {
    let lowest = corners.iter().copied().min().unwrap_or(0);
    (lowest, corners.iter().fold(0, |sum: u32, &corner| sum.wrapping_add(mixed(corner))))
}

/// Mixes all bits of a number (the finaliser of MurmurHash3).
fn mixed(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
    x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
    x ^ (x >> 16)
}

/// Keys that occur more than once; their first parts are below `lowest`.
fn repeated(keys: &[Key], lowest: usize) -> HashSet<Key> {
    let mut starts = vec![0u32; lowest + 1];
    for (lowest, _) in keys {
        starts[*lowest as usize + 1] += 1;
    }
    for at in 0..lowest {
        starts[at + 1] += starts[at];
    }
    let mut next = starts.clone();
    let mut hashes = vec![0u32; keys.len()];
    for &(lowest, hash) in keys {
        let slot = &mut next[lowest as usize];
        hashes[*slot as usize] = hash;
        *slot += 1;
    }
    let mut found = HashSet::new();
    for (lowest, range) in starts.windows(2).enumerate() {
        let bucket = &mut hashes[range[0] as usize..range[1] as usize];
        if bucket.len() > FEW {
            bucket.sort_unstable();
            let twice = bucket.windows(2).filter(|two| two[0] == two[1]);
            found.extend(twice.map(|two| (lowest as u32, two[0])));
            continue;
        }
        for at in 1..bucket.len() {
            let hash = bucket[at];
            if bucket[..at].iter().fold(false, |found, &other| found | (other == hash)) {
                found.insert((lowest as u32, hash));
            }
        }
    }
    found
}

/// The pair of cells, over all groups of two or more, whose later cell comes first in the file.
fn first<K>(groups: HashMap<K, Vec<usize>>) -> Option<[usize; 2]> {
    let pairs = groups.values().filter_map(|cells| Some([*cells.first()?, *cells.get(1)?]));
    pairs.min_by_key(|&[a, b]| (b, a))
}
