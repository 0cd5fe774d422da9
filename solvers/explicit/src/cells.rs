//! Cells with several points, standard or with one mean dilation per element; one element in each lane of a
//! block.
//!
//! At every point `grad N_a = A_q t_a`, with `t_a` the same for all elements. Nine numbers are stored per
//! point instead of three for each node: 656 bytes per element of hex8 instead of 1616, 2200 instead of 14800
//! for hex20. Forces are computed by the transpose of each step.

use lanes::LanePath;
use shape::{DilationGroups, Matrix3, Point3, Vector3, locality_order};

use super::body::ExplicitBody;
use super::cell_lanes::{Block, Cell, dilated, internal};
use super::chunks::{Border, ChunkNodes, load, split};
use super::moduli::LaneLaw;
use super::scalar::{Scalar, Slot};
use crate::kernel::{Engine, Kernel};

/// Points per chunk: 1024 elements of hex8, with some 1400 distinct nodes.
const SIZE: usize = 8192;

pub(super) struct Cells<T: Scalar, C, const N: usize, const Q: usize> {
    cell: C,
    /// A displacement that is small for the body, m.
    small: f64,
    border: Border,
    chunks: Vec<Chunk<T, N, Q>>,
    u: Vec<Slot<T>>,
    f: Vec<Slot<T>>,
    laws: Vec<LaneLaw>,
    mean: bool,
}

struct Chunk<T: Scalar, const N: usize, const Q: usize> {
    blocks: Vec<Block<T, N, Q>>,
    /// Consecutive blocks of one region: index after the last block, and region index.
    runs: Vec<(usize, u16)>,
}

impl<T: Scalar, C: Cell<T, N, Q>, const N: usize, const Q: usize> Cells<T, C, N, Q> {
    /// Builds the kernel for rows laid out as cells. Returns `None` if the body has dilation groups other
    /// than one per element, or if the law changes within an element.
    pub fn new(body: &ExplicitBody, laws: Vec<LaneLaw>) -> Option<Cells<T, C, N, Q>> {
        let (volume, rows) = (body.volume, body.volume.rows());
        let count = rows.len() / Q;
        // A cell belongs to one region; a table in which it does not is not from a mesh.
        if (0..rows.len()).any(|q| body.region(q) != body.region(q - q % Q)) {
            return None;
        }
        if let Some(groups) = body.groups {
            let offsets = (0..=count).map(|e| Q * e).collect();
            let points = (0..rows.len() as u32).collect();
            if DilationGroups::new(rows.len(), offsets, points, vec![1.0; rows.len()]).as_ref() != Ok(groups)
            {
                return None;
            }
        }
        let (cell, place, maps) = C::fitted(volume)?;
        let centre = |e: usize| {
            let sum: Vector3 = (0..Q).map(|q| volume.points()[Q * e + q].coords).sum();
            Point3::from(sum * (1.0 / Q as f64))
        };
        let order = locality_order(&(0..count).map(centre).collect::<Vec<_>>());
        let parts =
            split(rows.node_count(), &order, SIZE / Q / T::LANES * T::LANES, |e| rows.row(Q * e).0.to_vec());
        let chunk = |part: &ChunkNodes| Chunk::new(body, part, &maps, &place, &C::NODE);
        let chunks = parts.iter().map(chunk).collect();
        let lists: Vec<Vec<u32>> = parts.iter().map(|p| p.nodes.clone()).collect();
        let border = Border::new(rows.node_count(), &lists);
        let slots = vec![Slot::ZERO; border.slot_count()];
        let small = body.small_displacement();
        Some(Cells {
            cell,
            small,
            border,
            chunks,
            u: slots.clone(),
            f: slots,
            laws,
            mean: body.groups.is_some(),
        })
    }
}

impl<T: Scalar, C: Cell<T, N, Q> + 'static, const N: usize, const Q: usize> Engine for Cells<T, C, N, Q> {
    fn kernel(&self) -> Kernel {
        match (N, self.mean) {
            (8, false) => Kernel::Hex8,
            (8, true) => Kernel::Hex8MeanDilation,
            (10, false) => Kernel::Tet10,
            (10, true) => Kernel::Tet10MeanDilation,
            (_, false) => Kernel::Hex20,
            (_, true) => Kernel::Hex20MeanDilation,
        }
    }

    fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool {
        let Cells { cell, small, border, chunks, u: slots, f: sums, laws, mean } = self;
        let not_inverted = border.for_each(slots, sums, |c, slots, sums| {
            load(border.chunk(c), u, *small, slots);
            sums.fill(Slot::ZERO);
            let (mut not_inverted, mut first) = (true, 0);
            for &(end, region) in &chunks[c].runs {
                let kernel = if *mean { dilated::<N, Q, T, C> } else { internal::<N, Q, T, C> };
                let law = &laws[region as usize];
                not_inverted &= kernel(path, path, cell, &chunks[c].blocks[first..end], law, slots, sums);
                first = end;
            }
            not_inverted
        });
        border.forces(sums, f);
        not_inverted
    }
}

impl<T: Scalar, const N: usize, const Q: usize> Chunk<T, N, Q> {
    fn new(
        body: &ExplicitBody,
        part: &ChunkNodes,
        maps: &[Matrix3],
        place: &[usize; Q],
        node: &[usize; N],
    ) -> Chunk<T, N, Q> {
        let region = |k: &usize| body.region(Q * part.items[*k] as usize);
        let mut order: Vec<usize> = (0..part.items.len()).collect();
        order.sort_by_key(region);
        let mut chunk = Chunk { blocks: Vec::new(), runs: Vec::new() };
        for alike in order.chunk_by(|a, b| region(a) == region(b)) {
            for group in alike.chunks(T::LANES) {
                let mut block = Block::<T, N, Q>::empty();
                for (l, &k) in group.iter().enumerate() {
                    for q in 0..Q {
                        let row = Q * part.items[k] as usize + q;
                        let point = &mut block.points[place[q]];
                        for beta in 0..3 {
                            for j in 0..3 {
                                point.map[3 * beta + j][l] = T::of(maps[row][(j, beta)]);
                            }
                        }
                        point.weight[l] = T::of(body.volume.weights()[row]);
                    }
                    for c in 0..N {
                        block.nodes[c][l] = part.local[k][node[c]] as u16;
                    }
                }
                chunk.blocks.push(block);
            }
            chunk.runs.push((chunk.blocks.len(), region(&alike[0])));
        }
        chunk
    }
}
