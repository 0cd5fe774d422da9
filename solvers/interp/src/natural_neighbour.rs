//! Natural neighbour interpolation.

use rayon::prelude::*;
use shape::{Point3, PointRows, Rows, Unity};

use crate::delaunay::{Degenerate, Delaunay};
use crate::frame::{FLAT, centre_and_half_extent, thickness};
use crate::hull::{Hull, Place};
use crate::neighbours::{check_count, check_finite};
use crate::sibson::{Voronoi, Workspace};
use crate::{InterpError, TransferInfo};

const SCHEME: &str = "natural-neighbour";
/// Targets per parallel task: fixed, so that the bits are the same at any thread count.
const CHUNK: usize = 128;

/// `u(x) = sum_i V_i u_i / sum_i V_i`, `V_i` the volume that the Voronoi cell of the target takes from the cell of node `i`
/// (Sibson 1980, 1981). Exact for linear fields; interpolates; smooth (C1) but at the nodes, within the convex hull of
/// the nodes. No parameter: the neighbours of a target are those that its cell touches.
///
/// Beyond the hull no cell is bounded. A target there (counted in [`TransferInfo::outside`]) takes the linear field that fits
/// the natural neighbours of the closest point of the hull best, each weighted by its coordinate: still exact for
/// linear fields, and continuous. The coordinates at the hull are those a millionth of the way to the cloud's middle
/// beneath it. Where rounding spoils the volumes, the target takes the linear field that fits its natural neighbours best,
/// all alike, and is counted in [`TransferInfo::fallbacks`].
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

    let mut batches: Vec<Batch> = Vec::new();
    targets
        .par_chunks(CHUNK)
        .map(|chunk| Batch::new(chunk.iter().map(scaled), &hull, &voronoi))
        .collect_into_vec(&mut batches);
    let (mut offsets, mut entries, mut values) = (vec![0], Vec::new(), Vec::new());
    let mut info = TransferInfo::default();
    for batch in batches {
        for length in batch.lengths {
            offsets.push(offsets[offsets.len() - 1] + length);
        }
        entries.extend(batch.nodes);
        values.extend(batch.values);
        info.outside += batch.info.outside;
        info.fallbacks += batch.info.fallbacks;
    }
    let rows = Rows::new(nodes.len(), offsets, entries, values, Unity::Within(1e-9))?;
    Ok((PointRows::new(targets.to_vec(), rows)?, info))
}

/// Rows of one chunk of targets.
struct Batch {
    lengths: Vec<usize>,
    nodes: Vec<u32>,
    values: Vec<f64>,
    info: TransferInfo,
}

impl Batch {
    fn new(targets: impl Iterator<Item = Point3>, hull: &Hull, voronoi: &Voronoi) -> Batch {
        let mut batch = Batch {
            lengths: Vec::new(),
            nodes: Vec::new(),
            values: Vec::new(),
            info: TransferInfo::default(),
        };
        let mut at = Workspace::new(voronoi);
        for x in targets {
            match hull.place(&x) {
                Place::Inside => voronoi.coordinates(&x, None, &mut at),
                Place::Near { inner, outside } => {
                    voronoi.coordinates(&x, Some(&inner), &mut at);
                    batch.info.outside += usize::from(outside);
                }
            }
            batch.info.fallbacks += usize::from(at.fallback);
            batch.lengths.push(at.nodes.len());
            batch.nodes.extend_from_slice(&at.nodes);
            batch.values.extend_from_slice(&at.values);
        }
        batch
    }
}
