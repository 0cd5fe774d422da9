//! Natural neighbour interpolation.

use catalogue::{Build, Entry};
use lanes::{LanePath, on_path};
use shape::{Point3, PointRows, Unity};

use crate::delaunay::{Degenerate, Delaunay};
use crate::error::InterpError;
use crate::frame::{FLAT, centre_and_half_extent, thickness};
use crate::hull::{Hull, Place};
use crate::neighbours::{check_count, check_finite};
use crate::sibson::{Voronoi, Workspace};
use crate::table::{Batch, in_chunks};
use crate::transfer::{Source, Transfer, TransferInfo};

/// The scheme of [`natural_neighbour`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NaturalNeighbour;

pub(crate) const ENTRY: Entry<Build<NaturalNeighbour>> = Entry {
    name: SCHEME,
    meaning: "mean weighted by the volumes that the target's Voronoi cell takes from the cells of the nodes; \
              C1 except at the nodes",
    source: "Sibson (1980, 1981)",
    parameters: &[],
    build: |_| Ok(NaturalNeighbour),
};

impl Transfer for NaturalNeighbour {
    fn name(&self) -> &'static str {
        SCHEME
    }

    fn exact_degree(&self) -> Option<usize> {
        Some(1)
    }

    fn interpolates(&self) -> bool {
        true
    }

    fn rows(&self, source: Source, targets: &[Point3]) -> Result<(PointRows, TransferInfo), InterpError> {
        natural_neighbour(source.nodes, targets)
    }
}

const SCHEME: &str = "natural-neighbour";

/// Builds the table of natural neighbour interpolation, `u(x) = sum_i V_i u_i / sum_i V_i`, where `V_i` is
/// the volume that the Voronoi cell of the target takes from the cell of node `i` (Sibson 1980, 1981).
///
/// The scheme is exact for linear fields and interpolates. Within the convex hull of the nodes it is smooth
/// (C1) except at the nodes. It has no parameter: the neighbours of a target are the nodes whose cells its
/// cell touches.
///
/// Beyond the hull no cell is bounded. A target there (counted in [`TransferInfo::outside`]) takes the linear
/// field that best fits the natural neighbours of the closest point of the hull. Each neighbour is weighted
/// by its coordinate `V_i / sum_j V_j` at that point. This is still exact for linear fields, and continuous.
/// The coordinates are computed just inside the hull, at a depth of a millionth of the distance to the
/// cloud's middle. If rounding spoils the volumes, the target takes the linear field that best fits its
/// natural neighbours with equal weights, and is counted in [`TransferInfo::fallbacks`].
pub fn natural_neighbour(
    nodes: &[Point3],
    targets: &[Point3],
) -> Result<(PointRows, TransferInfo), InterpError> {
    check_finite(nodes, targets)?;
    check_count(SCHEME, nodes.len(), 4)?;
    let (centre, extent) = centre_and_half_extent(nodes);
    let coincident = |first: u32, second: u32| InterpError::CoincidentNodes {
        scheme: SCHEME,
        first: first as usize,
        second: second as usize,
        distance: (nodes[first as usize] - nodes[second as usize]).norm(),
        extent,
        pivot_ratio: 0.0,
    };
    if extent == 0.0 {
        return Err(coincident(0, 1));
    }
    let scaled = |x: &Point3| Point3::from((x - centre) / extent);
    let cloud: Vec<Point3> = nodes.iter().map(scaled).collect();
    let thickness = thickness(&cloud);
    let flat = || InterpError::FlatCloud { scheme: SCHEME, thickness: thickness * extent, extent };
    if !(thickness > FLAT) {
        return Err(flat());
    }
    let mesh = Delaunay::new(&cloud).map_err(|degenerate| match degenerate {
        Degenerate::Flat => flat(),
        Degenerate::Coincident(first, second) => coincident(first, second),
    })?;
    let hull = Hull::new(&cloud, &mesh);
    let voronoi = Voronoi::new(cloud, &mesh);

    in_chunks(nodes.len(), targets, Unity::Within(1e-9), |chunk| {
        batch(LanePath::best(), &chunk.iter().map(scaled).collect::<Vec<_>>(), &hull, &voronoi)
    })
}

on_path! {
    /// Processes targets with the same arithmetic in the same order on every path, hence with the same bits.
    /// Fused multiply-add is not used because it would change them.
    fn batch(targets: &[Point3], hull: &Hull, voronoi: &Voronoi) -> Batch = batch_in
}

#[inline(always)]
fn batch_in<const FMA: bool>(targets: &[Point3], hull: &Hull, voronoi: &Voronoi) -> Batch {
    let mut at = Workspace::new(voronoi);
    let mut info = TransferInfo::default();
    let (mut rows, mut nodes, mut values) = (vec![0..0; targets.len()], Vec::new(), Vec::new());
    for target in along_a_curve(targets) {
        let x = &targets[target];
        let inner = match hull.place(x) {
            Place::Inside => None,
            Place::Near { inner, outside } => {
                info.outside += usize::from(outside);
                Some(inner)
            }
        };
        voronoi.coordinates(x, inner.as_ref(), &mut at);
        info.fallbacks += usize::from(at.fallback);
        rows[target] = nodes.len()..nodes.len() + at.nodes.len();
        nodes.extend_from_slice(&at.nodes);
        values.extend_from_slice(&at.values);
    }
    let mut batch = Batch::with_capacity(targets.len(), nodes.len());
    batch.info = info;
    for row in rows {
        batch.nodes.extend_from_slice(&nodes[row.clone()]);
        batch.values.extend_from_slice(&values[row]);
        batch.close();
    }
    batch
}

/// Returns the targets in Z-order (Morton 1966) on a grid of 16 cells along each axis of the cloud, whose
/// half-extent is 1. The walk to a target starts at the cell of the previous target, which is close.
fn along_a_curve(targets: &[Point3]) -> Vec<usize> {
    let key = |&target: &usize| {
        // The cast saturates: targets beyond the cloud are assigned to the cells at its border.
        let cells = targets[target].coords.map(|c| (((c + 1.0) * 8.0) as u32).min(15));
        (0..4).fold(0, |key, bit| {
            key | (cells.x >> bit & 1 | (cells.y >> bit & 1) << 1 | (cells.z >> bit & 1) << 2) << (3 * bit)
        })
    };
    let mut order: Vec<usize> = (0..targets.len()).collect();
    order.sort_by_cached_key(key);
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_registers_give_the_same_bits() {
        let at = |i: usize, c: f64| (i as f64 * c).fract() * 2.0 - 1.0;
        let points = |n: usize, scale: f64| -> Vec<Point3> {
            (0..n).map(|i| Point3::new(at(i, 0.754_877), at(i, 0.569_84), at(i, 0.317_8)) * scale).collect()
        };
        let nodes = points(150, 1.0);
        let mesh = Delaunay::new(&nodes).unwrap();
        let hull = Hull::new(&nodes, &mesh);
        let voronoi = Voronoi::new(nodes, &mesh);
        let targets = points(601, 1.1);
        let on = |path| batch(path, &targets, &hull, &voronoi);
        let plain = on(LanePath::PORTABLE);
        assert!((100..500).contains(&plain.info.outside), "{:?}", plain.info);
        for path in LanePath::available() {
            assert!(on(path) == plain, "{}", path.name());
        }
    }
}
