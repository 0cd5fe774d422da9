//! Tables built in parallel from chunks of targets.

use rayon::prelude::*;
use shape::{Point3, PointRows, Rows, Unity};

use crate::error::InterpError;
use crate::transfer::TransferInfo;

/// Targets per parallel task. The number is fixed, so results have the same bits at any number of threads.
const CHUNK: usize = 128;

/// Rows of one chunk of targets.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Batch {
    /// Ends of the rows in `nodes` and `values`.
    ends: Vec<usize>,
    pub(crate) nodes: Vec<u32>,
    pub(crate) values: Vec<f64>,
    pub(crate) info: TransferInfo,
}

impl Batch {
    /// Reserves room for the rows of `targets` targets with about `entries` entries in total.
    pub(crate) fn with_capacity(targets: usize, entries: usize) -> Batch {
        Batch {
            ends: Vec::with_capacity(targets),
            nodes: Vec::with_capacity(entries),
            values: Vec::with_capacity(entries),
            info: TransferInfo::default(),
        }
    }

    /// Returns the start of the row of the next target.
    pub(crate) fn start(&self) -> usize {
        self.ends.last().map_or(0, |&end| end)
    }

    /// Ends the row of the next target, whose entries are already appended.
    pub(crate) fn close(&mut self) {
        self.ends.push(self.nodes.len());
    }

    /// Ends the row like [`Batch::close`], after division of its weights by their sum.
    pub(crate) fn close_over_sum(&mut self) {
        let start = self.start();
        let weights = &mut self.values[start..];
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|w| *w /= sum);
        self.close();
    }
}

/// Builds the table of all targets from the batches that `make` returns for each chunk.
pub(crate) fn in_chunks(
    node_count: usize,
    targets: &[Point3],
    unity: Unity,
    make: impl Fn(&[Point3]) -> Batch + Send + Sync,
) -> Result<(PointRows, TransferInfo), InterpError> {
    let mut batches: Vec<Batch> = Vec::new();
    targets.par_chunks(CHUNK).map(make).collect_into_vec(&mut batches);
    let entries = batches.iter().map(|batch| batch.values.len()).sum();
    let (mut nodes, mut values) = (Vec::with_capacity(entries), Vec::with_capacity(entries));
    let mut offsets = Vec::with_capacity(targets.len() + 1);
    offsets.push(0);
    let mut info = TransferInfo::default();
    for batch in batches {
        offsets.extend(batch.ends.iter().map(|end| nodes.len() + end));
        nodes.extend_from_slice(&batch.nodes);
        values.extend_from_slice(&batch.values);
        info.outside += batch.info.outside;
        info.fallbacks += batch.info.fallbacks;
    }
    let rows = Rows::new(node_count, offsets, nodes, values, unity)?;
    Ok((PointRows::new(targets.to_vec(), rows)?, info))
}
