//! Elements in chunks of fixed size, each with its own copy of its nodes.
//!
//! A chunk reads displacements into its own slots and sums forces in its own slots. Each node then adds up
//! its copies in the order of the chunks. The bits of a sum therefore depend on the chunks, never on the
//! thread that processed them. Colouring costs 30 to 60 % more, and racing sums change from run to run.

use std::ops::Range;

use rayon::prelude::*;

use shape::Vector3;

use super::lists::Lists;
use super::scalar::{Scalar, Slot};

/// Nodes per task of the sum over copies.
const NODES: usize = 1024;

/// Assignment of slots to chunks and nodes.
pub(super) struct Border {
    /// Start of each chunk's slots, chunks + 1 entries.
    offsets: Vec<usize>,
    /// Node of each slot.
    nodes: Vec<u32>,
    /// Start of each node's entries in `copies`, nodes + 1 entries.
    copy_offsets: Vec<u32>,
    /// Slots of each node, by ascending chunk.
    copies: Vec<u32>,
}

impl Border {
    /// Assigns a slot to each node of each chunk. `chunks` has the distinct nodes of every chunk.
    pub fn new(node_count: usize, chunks: &[Vec<u32>]) -> Border {
        let nodes: Vec<u32> = chunks.concat();
        let mut offsets = vec![0];
        for chunk in chunks {
            offsets.push(offsets.last().unwrap() + chunk.len());
        }
        let slots = nodes.iter().zip(0u32..).map(|(&node, slot)| (node, slot));
        let Lists { offsets: copy_offsets, items: copies } = Lists::new(node_count, slots);
        Border { offsets, nodes, copy_offsets, copies }
    }

    pub fn slot_count(&self) -> usize {
        self.nodes.len()
    }

    pub fn chunk_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Nodes of one chunk, in the order of its slots.
    pub fn chunk(&self, chunk: usize) -> &[u32] {
        &self.nodes[self.range(chunk)]
    }

    pub fn range(&self, chunk: usize) -> Range<usize> {
        self.offsets[chunk]..self.offsets[chunk + 1]
    }

    /// Runs `work(chunk, a, b)` on every chunk, in parallel. `a` and `b` are arrays with one value per slot,
    /// of which each call receives the slots of its chunk. Returns true if every call returned true.
    pub fn for_each<A: Send, B: Send>(
        &self,
        a: &mut [A],
        b: &mut [B],
        work: impl Fn(usize, &mut [A], &mut [B]) -> bool + Sync,
    ) -> bool {
        let (mut a, mut b) = (a, b);
        let mut tasks = Vec::with_capacity(self.chunk_count());
        for chunk in 0..self.chunk_count() {
            let n = self.range(chunk).len();
            let (a_head, a_tail) = std::mem::take(&mut a).split_at_mut(n);
            let (b_head, b_tail) = std::mem::take(&mut b).split_at_mut(n);
            (a, b) = (a_tail, b_tail);
            tasks.push((chunk, a_head, b_head));
        }
        let run = |(chunk, a, b): (usize, &mut [A], &mut [B])| work(chunk, a, b);
        // Not `all`, which stops early: later chunks would keep the forces of an earlier call.
        tasks.into_par_iter().map(run).reduce(|| true, |x, y| x & y)
    }

    /// Sums the copies of each node, applies `finish` to the sum and writes the result to `out`. Nodes are
    /// finished one by one. Summing a whole task first would pass through memory once more; avoiding this
    /// takes 0.97 of the time of tet4 and hex8.
    pub fn sum<const W: usize, T: Send>(
        &self,
        copy: impl Fn(usize) -> [f64; W] + Sync,
        finish: impl Fn([f64; W]) -> T + Sync,
        out: &mut [T],
    ) {
        out.par_chunks_mut(NODES).enumerate().for_each(|(task, out)| {
            let offsets = &self.copy_offsets[task * NODES..][..out.len() + 1];
            for (out, range) in out.iter_mut().zip(offsets.windows(2)) {
                let mut sum = [0.0; W];
                for &slot in &self.copies[range[0] as usize..range[1] as usize] {
                    let copy = copy(slot as usize);
                    for c in 0..W {
                        sum[c] += copy[c];
                    }
                }
                *out = finish(sum);
            }
        });
    }

    /// Sums the slots of each node in double precision, and writes the nodal forces (N) to `f`.
    pub fn forces<T: Scalar>(&self, slots: &[Slot<T>], f: &mut [Vector3]) {
        self.sum(|slot| slots[slot].0.map(T::double), |[x, y, z, _]| Vector3::new(x, y, z), f);
    }
}

/// Copies the displacements of a chunk's nodes into its slots; see [`Scalar::displacement`] for `small`.
#[inline(always)]
pub(super) fn load<T: Scalar>(nodes: &[u32], u: &[Vector3], small: f64, slots: &mut [Slot<T>]) {
    let Some(&first) = nodes.first() else { return };
    let first = u[first as usize];
    for (slot, &node) in slots.iter_mut().zip(nodes) {
        let v = &u[node as usize];
        let of = |axis: usize| T::displacement(v[axis], first[axis], small);
        *slot = Slot::new([of(0), of(1), of(2), T::ZERO]);
    }
}

/// Divides `order` into consecutive runs of at most `size` items, with the distinct nodes of each run in the
/// order of first use and the positions of each item's nodes among them.
pub(super) fn split(
    node_count: usize,
    order: &[u32],
    size: usize,
    nodes_of: impl Fn(usize) -> Vec<u32>,
) -> Vec<ChunkNodes> {
    let mut place = vec![u32::MAX; node_count];
    let mut chunks = Vec::with_capacity(order.len().div_ceil(size));
    for items in order.chunks(size) {
        let (mut nodes, mut local) = (Vec::new(), Vec::with_capacity(items.len()));
        for &item in items {
            let of_item = nodes_of(item as usize).into_iter().map(|node| {
                let at = &mut place[node as usize];
                if *at == u32::MAX {
                    *at = nodes.len() as u32;
                    nodes.push(node);
                }
                *at
            });
            local.push(of_item.collect());
        }
        nodes.iter().for_each(|&node| place[node as usize] = u32::MAX);
        chunks.push(ChunkNodes { items: items.to_vec(), nodes, local });
    }
    chunks
}

/// Items of one chunk with their nodes.
pub(super) struct ChunkNodes {
    /// Indices of the items, which are elements or quadrature points, in the body's table.
    pub items: Vec<u32>,
    /// Distinct nodes of all items of the chunk, in the order of first use.
    pub nodes: Vec<u32>,
    /// For each item, the positions of its nodes in `nodes`.
    pub local: Vec<Vec<u32>>,
}
