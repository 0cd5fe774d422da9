//! Tetrahedra with four nodes and one point, one of them in each lane of a block.
//!
//! The gradients of a partition of unity sum to zero, so only three of the four are stored, and
//! `H = sum_a (u_a - u_0) grad N_a`. The force on node 0 is minus the sum of the others, so momentum is
//! conserved to the last bit of each element. An element takes 88 bytes (9 gradients, weight, four 16-bit
//! nodes) instead of 120, and 48 in single precision.

use lanes::{LANES, LanePath};
use shape::{Vector3, locality_order};

use super::body::ExplicitBody;
use super::chunks::{Border, ChunkNodes, load, split};
use super::moduli::LaneLaw;
use super::nodal::Nodal;
use super::scalar::{Scalar, Slot};
use super::tet4_lanes::{Block, Chunk, dilated, dilations, internal};
use crate::kernel::{Engine, Kernel};

/// Elements per chunk in double precision, with about 512 distinct nodes, whose displacements and forces
/// stay in the first-level cache.
const SIZE: usize = 2048;

/// Kernel for tetrahedra with four nodes, standard or with nodal-mean dilation.
pub(super) struct Tet4<T: Scalar> {
    /// A displacement that is small for the body, m.
    small: f64,
    border: Border,
    chunks: Vec<Chunk<T>>,
    u: Vec<Slot<T>>,
    f: Vec<Slot<T>>,
    laws: Vec<LaneLaw>,
    nodal: Option<Nodal<T>>,
}

impl<T: Scalar> Tet4<T> {
    /// Builds the kernel for rows laid out as linear tetrahedra. Returns `None` if the body has dilation
    /// groups that [`Nodal::new`] does not support.
    pub fn new(body: &ExplicitBody, laws: Vec<LaneLaw>) -> Option<Tet4<T>> {
        let (volume, rows) = (body.volume, body.volume.rows());
        let mut order = locality_order(volume.points());
        // A chunk belongs to one part, so that each of its nodes represents one group.
        let part = |q: &u32| body.groups.and_then(|groups| groups.parts().get(*q as usize));
        order.sort_by_key(part);
        let parts: Vec<ChunkNodes> = order
            .chunk_by(|a, b| part(a) == part(b))
            .flat_map(|order| {
                split(rows.node_count(), order, SIZE * T::LANES / LANES, |q| rows.row(q).0.to_vec())
            })
            .collect();
        let lists: Vec<Vec<u32>> = parts.iter().map(|p| p.nodes.clone()).collect();
        let border = Border::new(rows.node_count(), &lists);
        let nodal = match body.groups {
            Some(groups) => Some(Nodal::new(body, groups, &laws, &parts)?),
            None => None,
        };
        let chunk = |part| {
            Chunk::new(
                part,
                |q| volume.row(q).1.try_into().unwrap(),
                |q| volume.weights()[q],
                |q| body.region(q),
            )
        };
        let chunks = parts.iter().map(chunk).collect();
        let slots = vec![Slot::ZERO; border.slot_count()];
        let small = body.small_displacement();
        Some(Tet4 { small, border, chunks, u: slots.clone(), f: slots, laws, nodal })
    }
}

impl<T: Scalar> Engine for Tet4<T> {
    fn kernel(&self) -> Kernel {
        if self.nodal.is_some() { Kernel::Tet4NodalDilation } else { Kernel::Tet4 }
    }

    fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool {
        let Tet4 { small, border, chunks, u: slots, f: sums, laws, nodal } = self;
        let not_inverted = match nodal {
            None => border.for_each(slots, sums, |c, slots, sums| {
                load(border.chunk(c), u, *small, slots);
                sums.fill(Slot::ZERO);
                internal(path, laws, &chunks[c], slots, sums)
            }),
            Some(nodal) => {
                let not_inverted = border.for_each(slots, nodal.slots(), |c, slots, sums| {
                    load(border.chunk(c), u, *small, slots);
                    sums.fill([T::ZERO; 2]);
                    let mut not_inverted = true;
                    dilations(path, laws, &chunks[c], slots, sums, &mut not_inverted);
                    not_inverted
                });
                nodal.close(path, border);
                let (closed, shared, groups) = nodal.closed(border);
                border.for_each(shared, sums, |c, shared, sums| {
                    for (shared, &group) in shared.iter_mut().zip(groups.chunk(c)) {
                        *shared = closed[group as usize].map(T::of);
                    }
                    sums.fill(Slot::ZERO);
                    dilated(path, laws, &chunks[c], &slots[border.range(c)], shared, sums);
                    true
                });
                not_inverted
            }
        };
        border.forces(sums, f);
        not_inverted
    }
}

impl<T: Scalar> Chunk<T> {
    pub fn new(
        chunk: &ChunkNodes,
        grads: impl Fn(usize) -> [Vector3; 4],
        weight: impl Fn(usize) -> f64,
        region: impl Fn(usize) -> u16,
    ) -> Chunk<T> {
        let mut order: Vec<usize> = (0..chunk.items.len()).collect();
        let region = |k: usize| region(chunk.items[k] as usize);
        order.sort_by_key(|&k| region(k));
        let (mut blocks, mut runs) = (Vec::new(), Vec::new());
        for alike in order.chunk_by(|&a, &b| region(a) == region(b)) {
            // Elements in the lanes are far apart: neighbours share nodes, and successive sums into one node
            // wait for each other (0.97 of the time, with nodal dilation 0.90).
            let stride = alike.len().div_ceil(T::LANES);
            for first in 0..stride {
                let group = alike[first..].iter().step_by(stride);
                // An unused lane has no weight and no gradient: J = 1 and no force, on the chunk's first
                // node.
                let mut block: Block<T> =
                    Block { grads: [T::ZEROS; 9], weight: T::ZEROS, nodes: [T::Nodes::default(); 4] };
                for (l, &k) in group.enumerate() {
                    let item = chunk.items[k] as usize;
                    let g = grads(item);
                    for a in 0..3 {
                        for j in 0..3 {
                            block.grads[3 * a + j][l] = T::of(g[a + 1][j]);
                        }
                    }
                    block.weight[l] = T::of(weight(item));
                    for a in 0..4 {
                        block.nodes[a][l] = chunk.local[k][a] as u16;
                    }
                }
                blocks.push(block);
            }
            runs.push((blocks.len(), region(alike[0])));
        }
        Chunk { blocks, runs }
    }
}
