//! Inverse-distance weighting, the transfer of the paper on which this project is based.

use catalogue::{Build, Dimension, Entry, Kind, Parameter, Range};
use shape::{Point3, PointRows, Unity};

use crate::error::InterpError;
use crate::neighbours::{Found, Neighbours, check_count, check_finite};
use crate::table::{Batch, in_chunks};
use crate::transfer::{Source, Transfer, TransferInfo};

/// The scheme of [`inverse_distance`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseDistance {
    /// Number of nearest nodes.
    pub neighbours: usize,
    /// Power `p` of the distance, dimensionless.
    pub power: f64,
}

pub(crate) const ENTRY: Entry<Build<InverseDistance>> = Entry {
    name: "inverse-distance",
    meaning: "mean of the nearest nodes, weighted by a power of the inverse distance",
    source: "Shepard (1968), over the nearest nodes",
    parameters: &[NEIGHBOURS, POWER],
    build: |values| {
        let neighbours = values.number("neighbours")? as usize;
        let power = values.number("power")?;
        Ok(InverseDistance { neighbours, power })
    },
};

const NEIGHBOURS: Parameter =
    Parameter::default("neighbours", Dimension::None, 4.0, "number of nearest nodes")
        .of(Kind::Count)
        .within(Range::AtLeast(1.0));
const POWER: Parameter =
    Parameter::default("power", Dimension::None, 2.0, "power of the distance").within(Range::Positive);

impl Transfer for InverseDistance {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn exact_degree(&self) -> Option<usize> {
        Some(0)
    }

    fn interpolates(&self) -> bool {
        true
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        let InverseDistance { neighbours, power } = *self;
        Ok((inverse_distance(source.nodes, neighbours, power, targets)?, TransferInfo::default()))
    }
}

/// Builds the table of inverse-distance weighting, `u(x) = sum_i u_i / d_i^p / sum_i 1 / d_i^p` over the
/// `neighbours` nearest nodes, with `d_i = |x - x_i|` and the `power` `p` (Eq. 5 of the paper on which this
/// project is based; Shepard 1968 sums over all nodes).
///
/// Weights are relative to the weight of the nearest node, `(d_min / d_i)^p`, so nothing overflows near a
/// node. At a node the value is that of the node (or the mean of coincident nodes). The scheme is exact for
/// constants only and interpolates, with zero slope at every node for `p > 1`.
///
/// # Errors
/// Invalid parameters, coordinates that are not finite, and fewer nodes than neighbours.
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
    let search = Neighbours::new(nodes, neighbours)?;
    let (rows, _) = in_chunks(nodes.len(), targets, Unity::Within(1e-12), |targets| {
        let mut batch = Batch::with_capacity(targets.len(), targets.len() * neighbours);
        let mut found = Found::default();
        for x in targets {
            let found = search.of(x, &mut found);
            let nearest = found[0].0;
            for &(distance, node) in found {
                batch.nodes.push(node);
                batch.values.push(relative_weight(nearest, distance, power));
            }
            batch.close_over_sum();
        }
        batch
    })?;
    Ok(rows)
}

/// Returns `(d_min / d)^p`; for a `d_min` of zero, one at the node and zero elsewhere.
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
