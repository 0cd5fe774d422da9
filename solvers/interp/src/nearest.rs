//! The value of the nearest node.

use catalogue::{Build, Entry};
use shape::{Point3, PointRows, Unity};

use crate::error::InterpError;
use crate::neighbours::{Found, Neighbours, check_count, check_finite};
use crate::table::{Batch, in_chunks};
use crate::transfer::{Source, Transfer, TransferInfo};

/// The scheme of [`nearest`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest;

pub(crate) const ENTRY: Entry<Build<Nearest>> = Entry {
    name: "nearest",
    meaning: "value of the nearest node; discontinuous",
    source: "",
    parameters: &[],
    build: |_| Ok(Nearest),
};

impl Transfer for Nearest {
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
        Ok((nearest(source.nodes, targets)?, TransferInfo::default()))
    }
}

/// Builds the table `u(x) = u_i` with the nearest node `i` (the lower index at equal distance). The scheme is
/// exact for constants, interpolates, and is discontinuous.
pub fn nearest(nodes: &[Point3], targets: &[Point3]) -> Result<PointRows, InterpError> {
    check_finite(nodes, targets)?;
    check_count("nearest", nodes.len(), 1)?;
    let search = Neighbours::new(nodes, 1)?;
    let (rows, _) = in_chunks(nodes.len(), targets, Unity::Within(0.0), |targets| {
        let mut batch = Batch::with_capacity(targets.len(), targets.len());
        let mut found = Found::default();
        for x in targets {
            batch.nodes.push(search.of(x, &mut found)[0].1);
            batch.values.push(1.0);
            batch.close();
        }
        batch
    })?;
    Ok(rows)
}
