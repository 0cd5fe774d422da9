//! Middle nodes of quadratic cells that a file lists in another order than its format has.
//!
//! Programs differ in it: Gmsh exchanges the last two of a tet10 against VTK and Abaqus. A node belongs to
//! the edge whose middle it is nearest to. Where all cells of a kind have one order, and it is not that of
//! the format, that order is meant.

use crate::{CellKind, Point3};

/// A middle node is at most this part of its edge's length from the middle of the edge.
const NEAR: f64 = 0.25;

/// Puts the middle nodes of each kind in their places where the file has all of them in one other order;
/// returns kinds and cells.
pub(super) fn put_in_order(
    kinds: &[CellKind],
    nodes: &mut [u32],
    points: &[Point3],
) -> Vec<(CellKind, usize)> {
    let quadratic = [CellKind::Tet10, CellKind::Hex20].into_iter();
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

/// For each edge of a cell the place of its middle node among those listed; `None` where that is not clear.
fn order(kind: CellKind, cell: &[u32], points: &[Point3]) -> Option<Vec<usize>> {
    let at = |local: usize| points[cell[local] as usize];
    let corners = kind.corner_count();
    let mut taken = vec![false; kind.edges().len()];
    let mut order = Vec::with_capacity(taken.len());
    for &[a, b] in kind.edges() {
        let (middle, length) = (nalgebra::center(&at(a), &at(b)), nalgebra::distance(&at(a), &at(b)));
        let far = |place: usize| nalgebra::distance(&at(corners + place), &middle);
        let nearest = (0..taken.len()).min_by(|&p, &q| far(p).total_cmp(&far(q)))?;
        // False where the distance is no number.
        let near = far(nearest) <= NEAR * length;
        if !near || std::mem::replace(&mut taken[nearest], true) {
            return None;
        }
        order.push(nearest);
    }
    Some(order)
}
