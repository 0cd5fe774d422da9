//! The value of the nearest node.

use shape::{Point3, PointRows, Rows, Unity};

use crate::InterpError;
use crate::neighbours::{Neighbours, check_count, check_finite};

/// `u(x) = u_i`, `i` the nearest node (of two at one distance, the lower index). Exact for constants;
/// interpolates; discontinuous.
pub fn nearest(nodes: &[Point3], targets: &[Point3]) -> Result<PointRows, InterpError> {
    check_finite(nodes, targets)?;
    check_count("nearest", nodes.len(), 1)?;
    let mut search = Neighbours::new(nodes, 1)?;
    let entries: Vec<u32> = targets.iter().map(|x| search.of(x)[0].1).collect();
    let offsets = (0..=targets.len()).collect();
    let values = vec![1.0; targets.len()];
    let rows = Rows::new(nodes.len(), offsets, entries, values, Unity::Within(0.0))?;
    Ok(PointRows::new(targets.to_vec(), rows)?)
}
