//! A user-defined table: the rows of a transfer by the two nearest nodes, and their use.

use shape::{Point3, PointRows, Rows, ShapeError, Unity, Vector3};

// ANCHOR: table
/// The mean of the two nearest nodes: exact for constants.
fn two_nearest(nodes: &[Point3], targets: &[Point3]) -> Result<PointRows, ShapeError> {
    let (mut offsets, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
    for x in targets {
        let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
        order.sort_by(|&a, &b| (nodes[a as usize] - x).norm().total_cmp(&(nodes[b as usize] - x).norm()));
        let mut pair = [order[0], order[1]];
        pair.sort_unstable();
        indices.extend(pair);
        values.extend([0.5, 0.5]);
        offsets.push(indices.len());
    }
    PointRows::new(targets.to_vec(), Rows::new(nodes.len(), offsets, indices, values, Unity::Within(0.0))?)
}
// ANCHOR_END: table

// ANCHOR: use
fn main() -> Result<(), ShapeError> {
    let nodes: Vec<Point3> = (0..5).map(|i| Point3::new(i as f64 * 1e-3, 0.0, 0.0)).collect();
    let table = two_nearest(&nodes, &[Point3::new(1.4e-3, 0.0, 0.0), Point3::new(2.6e-3, 0.0, 0.0)])?;

    // Displacements are interpolated to the targets; forces are mapped back with the same work.
    let u: Vec<Vector3> = nodes.iter().map(|x| 0.1 * x.coords).collect();
    let f = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(-2.0, 0.0, 0.0)];
    let at_targets: f64 = table.rows().apply(&u).iter().zip(&f).map(|(u, f)| u.dot(f)).sum();
    let at_nodes: f64 = table.rows().apply_transposed(&f).iter().zip(&u).map(|(f, u)| f.dot(u)).sum();
    assert!((at_targets - at_nodes).abs() < 1e-15);
    println!("work at the targets {at_targets:.3e} J, at the nodes {at_nodes:.3e} J");
    Ok(())
}
// ANCHOR_END: use
