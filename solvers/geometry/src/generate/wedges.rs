//! Divides hexahedra into wedges, two each.
//!
//! A plane through a diagonal of one face and of the opposite face cuts a hexahedron into two wedges. These
//! two faces become triangles, the other four stay whole. Neighbours agree if all hexahedra of a row, through
//! opposite faces, are cut along the row, or none is. Every hexahedron is in three rows, and one of them is
//! cut. Rows are chosen one after the other; a hexahedron that two rows without cuts cross leaves no choice.

use std::collections::HashMap;

use super::parts::divided;
use crate::element::CellKind;
use crate::mesh::Mesh;

const HEX: CellKind = CellKind::Hex8;
const WEDGE: CellKind = CellKind::Wedge6;

/// Opposite faces of a hexahedron, in the order in which rows are chosen: along z, x and y.
const OPPOSITE: [[usize; 2]; 3] = [[0, 1], [5, 3], [2, 4]];

/// Corners of a face in ascending order.
type Key = [u32; 4];

/// Divides each hexahedron of a mesh into two wedges. Returns `None` if a cell is no hex8, or if no choice of
/// rows is found.
pub fn to_wedges(mesh: &Mesh) -> Option<Mesh> {
    if mesh.uniform_kind() != Some(HEX) {
        return None;
    }
    let rows = Rows::new(mesh);
    let along = rows.directions()?;
    let diagonals = rows.diagonals(&along)?;
    let mut nodes = Vec::with_capacity(12 * along.len());
    for (cell, &direction) in along.iter().enumerate() {
        let own = mesh.cell(cell);
        // The bottom, counter-clockwise as seen from the top.
        let mut bottom: Vec<usize> = HEX.faces()[OPPOSITE[direction][0]].to_vec();
        bottom.reverse();
        let [end, _] = diagonals[&key(mesh, cell, OPPOSITE[direction][0])];
        let start = bottom.iter().position(|&corner| own[corner] == end)?;
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let below = [a, b, c].map(|k| bottom[(start + k) % 4]);
            nodes.extend(below.map(|corner| own[corner]));
            nodes.extend(below.map(|corner| own[across(corner, direction)]));
        }
    }
    let first: Vec<usize> = (0..=along.len()).map(|cell| 2 * cell).collect();
    Some(divided(mesh, WEDGE, nodes, &first))
}

/// The corner at the other end of the edge along a direction.
fn across(corner: usize, direction: usize) -> usize {
    let top = |c: &usize| HEX.faces()[OPPOSITE[direction][1]].contains(c);
    let ends = |edge: &&[usize; 2]| edge.contains(&corner) && top(&edge[0]) != top(&edge[1]);
    let edge = HEX.edges().iter().find(ends).expect("every corner has an edge along each direction");
    edge[0] + edge[1] - corner
}

fn key(mesh: &Mesh, cell: usize, face: usize) -> Key {
    let mut key = [0, 1, 2, 3].map(|k| mesh.cell(cell)[HEX.faces()[face][k]]);
    key.sort_unstable();
    key
}

/// Rows of hexahedra through opposite faces.
struct Rows<'a> {
    mesh: &'a Mesh,
    /// Row of each cell along each direction.
    of: Vec<[usize; 3]>,
    /// Cells of each row.
    cells: Vec<Vec<usize>>,
    /// The cells at each face.
    at: HashMap<Key, Vec<usize>>,
}

impl Rows<'_> {
    fn new(mesh: &Mesh) -> Rows<'_> {
        let mut at: HashMap<Key, Vec<usize>> = HashMap::new();
        let mut sides: HashMap<Key, [usize; 2]> = HashMap::new();
        let mut parent: Vec<usize> = (0..3 * mesh.cell_count()).collect();
        fn root(parent: &mut [usize], mut k: usize) -> usize {
            while parent[k] != k {
                parent[k] = parent[parent[k]];
                k = parent[k];
            }
            k
        }
        for cell in 0..mesh.cell_count() {
            for (direction, faces) in OPPOSITE.iter().enumerate() {
                for &face in faces {
                    let key = key(mesh, cell, face);
                    at.entry(key).or_default().push(cell);
                    let [other, along] = *sides.entry(key).or_insert([cell, direction]);
                    let (a, b) =
                        (root(&mut parent, 3 * other + along), root(&mut parent, 3 * cell + direction));
                    parent[a.max(b)] = a.min(b);
                }
            }
        }
        let mut cells = vec![Vec::new(); parent.len()];
        let of = (0..mesh.cell_count())
            .map(|cell| {
                [0, 1, 2].map(|direction| {
                    let row = root(&mut parent, 3 * cell + direction);
                    cells[row].push(cell);
                    row
                })
            })
            .collect();
        Rows { mesh, of, cells, at }
    }

    /// The direction along which each cell is cut.
    fn directions(&self) -> Option<Vec<usize>> {
        let mut cut: Vec<Option<bool>> = vec![None; self.cells.len()];
        for rows in &self.of {
            if rows.iter().any(|&row| cut[row] == Some(true)) {
                continue;
            }
            let chosen = rows.iter().find(|&&row| cut[row].is_none())?;
            self.choose(*chosen, &mut cut)?;
        }
        self.of.iter().map(|rows| rows.iter().position(|&row| cut[row] == Some(true))).collect()
    }

    /// Cuts a row, and decides about all rows for which this leaves no choice.
    fn choose(&self, row: usize, cut: &mut [Option<bool>]) -> Option<()> {
        let mut next = vec![(row, true)];
        while let Some((row, is_cut)) = next.pop() {
            match cut[row] {
                Some(known) if known != is_cut => return None,
                Some(_) => continue,
                None => cut[row] = Some(is_cut),
            }
            for &cell in &self.cells[row] {
                let rows = self.of[cell];
                if is_cut {
                    // A row that crosses itself can't be cut.
                    if rows.iter().filter(|&&other| other == row).count() > 1 {
                        return None;
                    }
                    next.extend(rows.into_iter().filter(|&other| other != row).map(|other| (other, false)));
                } else {
                    let mut open = rows.into_iter().filter(|&other| cut[other] != Some(false));
                    match (open.next(), open.next()) {
                        (None, _) => return None,
                        (Some(last), None) => next.push((last, true)),
                        _ => {}
                    }
                }
            }
        }
        Some(())
    }

    /// Ends of the diagonal of every face that is cut, parallel along each row.
    fn diagonals(&self, along: &[usize]) -> Option<HashMap<Key, [u32; 2]>> {
        let mut diagonals: HashMap<Key, [u32; 2]> = HashMap::new();
        let mut seen = vec![false; along.len()];
        for start in 0..along.len() {
            let [face, _] = OPPOSITE[along[start]];
            diagonals.entry(key(self.mesh, start, face)).or_insert_with(|| {
                let own = [0, 2].map(|k| self.mesh.cell(start)[HEX.faces()[face][k]]);
                let other = [1, 3].map(|k| self.mesh.cell(start)[HEX.faces()[face][k]]);
                if own.iter().min() < other.iter().min() { own } else { other }
            });
            let mut next = vec![start];
            while let Some(cell) = next.pop() {
                if std::mem::replace(&mut seen[cell], true) {
                    continue;
                }
                let faces = OPPOSITE[along[cell]].map(|face| key(self.mesh, cell, face));
                let own = self.mesh.cell(cell);
                for (from, to) in [(0, 1), (1, 0)] {
                    let Some(&ends) = diagonals.get(&faces[from]) else { continue };
                    let mut moved = ends;
                    for end in &mut moved {
                        let corner = own.iter().position(|node| node == end)?;
                        *end = own[across(corner, along[cell])];
                    }
                    let known = *diagonals.entry(faces[to]).or_insert(moved);
                    if !moved.iter().all(|end| known.contains(end)) {
                        return None;
                    }
                }
                next.extend(faces.iter().flat_map(|face| &self.at[face]));
            }
        }
        Some(diagonals)
    }
}
