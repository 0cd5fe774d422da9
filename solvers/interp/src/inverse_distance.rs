//! Inverse-distance weighting, the transfer of the paper that this project starts from.

use shape::{Point3, PointRows, Rows, Unity};

use crate::InterpError;
use crate::neighbours::{Neighbours, check_count, check_finite};

/// `u(x) = sum_i u_i / d_i^p / sum_i 1 / d_i^p` over the `neighbours` nearest nodes, `d_i = |x - x_i|`, `p`
/// the `power` (the paper's Eq. 5; Shepard 1968 over all nodes).
///
/// Weights are taken relative to the nearest node's, `(d_min / d_i)^p`, so that nothing overflows near a
/// node; at a node the value is the node's (the mean, where several nodes share the place). Exact for
/// constants only; interpolates, with zero slope at every node for `p > 1`.
pub fn inverse_distance(
    nodes: &[Point3],
    neighbours: usize,
    power: f64,
    targets: &[Point3],
) -> Result<PointRows, InterpError> {
    if neighbours == 0 {
        return Err(InterpError::BadParameter { what: "neighbours", value: 0.0, allowed: "1 or more" });
    }
    if !(power > 0.0 && power.is_finite()) {
        return Err(InterpError::BadParameter { what: "power", value: power, allowed: "a positive number" });
    }
    check_finite(nodes, targets)?;
    check_count("inverse-distance", nodes.len(), neighbours)?;
    let mut search = Neighbours::new(nodes, neighbours)?;
    let mut entries = Vec::with_capacity(targets.len() * neighbours);
    let mut values = Vec::with_capacity(targets.len() * neighbours);
    for x in targets {
        let found = search.of(x);
        let nearest = found[0].0;
        let start = values.len();
        for &(distance, node) in found {
            entries.push(node);
            values.push(relative_weight(nearest, distance, power));
        }
        let sum: f64 = values[start..].iter().sum();
        values[start..].iter_mut().for_each(|w| *w /= sum);
    }
    let offsets = (0..=targets.len()).map(|row| row * neighbours).collect();
    let rows = Rows::new(nodes.len(), offsets, entries, values, Unity::Within(1e-12))?;
    Ok(PointRows::new(targets.to_vec(), rows)?)
}

/// `(d_min / d)^p`; where `d_min` is zero, one at the node and zero elsewhere.
fn relative_weight(nearest: f64, distance: f64, power: f64) -> f64 {
    if distance == nearest {
        return 1.0;
    }
    let ratio = nearest / distance;
    if power == 1.0 {
        ratio
    } else if power == 2.0 {
        ratio * ratio
    } else {
        ratio.powf(power)
    }
}
