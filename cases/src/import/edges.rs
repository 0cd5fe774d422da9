//! Node sets of quadratic elements.

use geometry::CellKind;

/// Whether both corners of an edge are in a set of nodes and its middle is not: the faces with these corners
/// then have nodes that the set lacks. `list` has the nodes in the order of Abaqus, which FEBio shares.
pub(super) fn lacks_a_middle(kind: CellKind, list: &[u64], has: impl Fn(u64) -> bool) -> bool {
    let entry = kind.entry();
    if kind.node_count() == entry.cell.corners || list.len() != kind.node_count() {
        return false;
    }
    let mut nodes = vec![0; list.len()];
    for (number, &place) in list.iter().zip(entry.files.abaqus_order) {
        nodes[place] = *number;
    }
    let middles = &nodes[entry.cell.corners..];
    let mut edges = entry.cell.edges.iter().zip(middles);
    edges.any(|(&[a, b], &middle)| has(nodes[a]) && has(nodes[b]) && !has(middle))
}
