//! Supports by exact elimination: a nodal parameter that *is* a displacement (a Kronecker basis) is set and
//! removed from the system. Other bases need constraint rows or weak supports.

use shape::FixedDof;

use crate::error::SolveError;

/// Returns the prescribed value of every degree of freedom `3 node + axis`, `None` if it is free.
pub(crate) fn prescribed(node_count: usize, fixed: &[FixedDof]) -> Result<Vec<Option<f64>>, SolveError> {
    let mut values: Vec<Option<f64>> = vec![None; 3 * node_count];
    for (index, f) in fixed.iter().enumerate() {
        if f.node as usize >= node_count {
            return Err(SolveError::NodeOutOfRange {
                what: "a support",
                node: f.node as usize,
                nodes: node_count,
            });
        }
        if f.axis > 2 {
            return Err(SolveError::BadAxis { what: "a support", axis: f.axis });
        }
        if !f.value.is_finite() {
            return Err(SolveError::NotFinite { what: "value of support", index });
        }
        let slot = &mut values[3 * f.node as usize + f.axis as usize];
        match *slot {
            // Two groups with a common edge may both constrain it, to the same value.
            Some(first) if first != f.value => {
                return Err(SolveError::Conflict {
                    node: f.node as usize,
                    axis: f.axis,
                    first,
                    second: f.value,
                });
            }
            _ => *slot = Some(f.value),
        }
    }
    Ok(values)
}
