//! Restores the order of mid-edge nodes that a file lists in another order than its format.
//!
//! Programs differ: Gmsh swaps the last two mid-edge nodes of a tet10 compared with VTK and Abaqus. A node
//! belongs to the edge whose midpoint is nearest. If all cells of a kind have the same order, and this is not
//! the order of the format, the nodes are reordered.

use geometry::{CellKind, Point3, element};

/// Largest distance of a mid-edge node from the midpoint of its edge, as a fraction of the edge's length.
const NEAR: f64 = 0.25;

/// Reorders the mid-edge nodes of every cell kind whose cells all share an order other than the format's.
/// Returns the kinds that were reordered, with their numbers of cells.
pub(super) fn put_in_order(
    kinds: &[CellKind],
    nodes: &mut [u32],
    points: &[Point3],
) -> Vec<(CellKind, usize)> {
    let quadratic = CellKind::ALL.into_iter().filter(|kind| kind.order() == 2);
    quadratic.filter_map(|kind| Some((kind, of_kind(kind, kinds, nodes, points)?))).collect()
}

fn of_kind(kind: CellKind, kinds: &[CellKind], nodes: &mut [u32], points: &[Point3]) -> Option<usize> {
    let mut starts = Vec::new();
    let mut start = 0;
    for &own in kinds {
        if own == kind {
            starts.push(start);
        }
        start += own.node_count();
    }
    let order = order(kind, &nodes[*starts.first()?..], points)?;
    let all = |&start: &usize| self::order(kind, &nodes[start..], points).as_ref() == Some(&order);
    if order.iter().enumerate().all(|(edge, &place)| edge == place) || !starts.iter().all(all) {
        return None;
    }
    let corners = kind.corner_count();
    for &start in &starts {
        let listed: Vec<u32> = nodes[start + corners..start + kind.node_count()].to_vec();
        for (edge, &place) in order.iter().enumerate() {
            nodes[start + corners + edge] = listed[place];
        }
    }
    Some(starts.len())
}

/// Index of the mid-edge node of each edge in the list of the cell; `None` if it is ambiguous.
fn order(kind: CellKind, cell: &[u32], points: &[Point3]) -> Option<Vec<usize>> {
    let at = |local: usize| points[cell[local] as usize];
    let corners = kind.corner_count();
    let mut taken = vec![false; kind.edges().len()];
    let mut order = Vec::with_capacity(taken.len());
    for &[a, b] in kind.edges() {
        let middle = nalgebra::center(&at(a), &at(b));
        let length = nalgebra::distance(&at(a), &at(b));
        let far = |place: usize| nalgebra::distance(&at(corners + place), &middle);
        let nearest = (0..taken.len()).min_by(|&p, &q| far(p).total_cmp(&far(q)))?;
        // A distance that is not a number compares as false.
        let near = far(nearest) <= NEAR * length;
        if !near || std::mem::replace(&mut taken[nearest], true) {
            return None;
        }
        order.push(nearest);
    }
    Some(order)
}

/// Puts the nodes of a cell in mirrored order if its volume is negative.
pub(super) fn turn_if_inverted(kind: CellKind, nodes: &mut [u32], points: &[Point3]) {
    let listed = nodes.to_vec();
    let at: Vec<Point3> = listed.iter().map(|&node| points[node as usize]).collect();
    if element::map(kind, &at, kind.entry().cell.centre).1.determinant() < 0.0 {
        nodes.iter_mut().zip(kind.mirrored()).for_each(|(node, local)| *node = listed[local]);
    }
}
