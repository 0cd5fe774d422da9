//! Trilinear hexahedra with 2 x 2 x 2 Gauss points, standard or with one mean dilation per element; eight
//! elements in the lanes of one block.
//!
//! At every point `grad N_a = A_q dN_a/dxi`, with `dN_a/dxi` the same for all elements. Nine numbers instead
//! of 24 are stored per point (656 bytes per element instead of 1616). `du/dxi` takes 156 operations per
//! element and three components instead of 576. Forces are computed by the transpose of each step.

use geometry::element::HEX_CORNERS;
use lanes::{LANES, LanePath};
use shape::{DilationGroups, Matrix3, Point3, Vector3, locality_order};

use super::body::ExplicitBody;
use super::chunks::{Border, ChunkNodes, Slot, load, split};
use super::hex8_lanes::{Block, Point, dilated, internal};
use super::moduli::LaneLaw;
use super::trilinear::{NODE, fit, reference};
use crate::kernel::Kernel;

/// Elements per chunk, with some 1400 distinct nodes.
const SIZE: usize = 1024;

pub(super) struct Hex8 {
    border: Border,
    chunks: Vec<Chunk>,
    u: Vec<Slot>,
    f: Vec<Slot>,
    laws: Vec<LaneLaw>,
    mean: bool,
}

struct Chunk {
    blocks: Vec<Block>,
    /// Consecutive blocks of one region: index after the last block, and region index.
    runs: Vec<(usize, u16)>,
}

impl Hex8 {
    /// Builds the kernel for rows laid out as trilinear hexahedra. Returns `None` if the body has dilation
    /// groups other than one per element, or if the law changes within an element.
    pub fn new(body: &ExplicitBody, laws: Vec<LaneLaw>) -> Option<Hex8> {
        let (volume, rows) = (body.volume, body.volume.rows());
        let count = rows.len() / 8;
        // A cell belongs to one region; a table in which it does not is not from a mesh.
        if (0..rows.len()).any(|q| body.region(q) != body.region(q - q % 8)) {
            return None;
        }
        if let Some(groups) = body.groups {
            let offsets = (0..=count).map(|e| 8 * e).collect();
            let points = (0..rows.len() as u32).collect();
            if DilationGroups::new(rows.len(), offsets, points, vec![1.0; rows.len()]).as_ref() != Ok(groups)
            {
                return None;
            }
        }
        // Order of the Gauss points, such as lowest axis fastest or corner order, as found in the first
        // element.
        let tables = NODE.map(|a| reference(&HEX_CORNERS[a]));
        let place: Vec<usize> = (0..8)
            .map(|q| (0..8).find(|&c| fit(volume.row(q).1, &tables[c]).is_some()))
            .collect::<Option<_>>()?;
        let maps: Vec<Matrix3> =
            (0..rows.len()).map(|q| fit(volume.row(q).1, &tables[place[q % 8]])).collect::<Option<_>>()?;

        let centre = |e: usize| {
            let sum: Vector3 = (0..8).map(|q| volume.points()[8 * e + q].coords).sum();
            Point3::from(sum * 0.125)
        };
        let order = locality_order(&(0..count).map(centre).collect::<Vec<_>>());
        let parts = split(rows.node_count(), &order, SIZE, |e| rows.row(8 * e).0.to_vec());
        let chunk = |part: &ChunkNodes| Chunk::new(body, part, &maps, &place);
        let chunks = parts.iter().map(chunk).collect();
        let lists: Vec<Vec<u32>> = parts.iter().map(|p| p.nodes.clone()).collect();
        let border = Border::new(rows.node_count(), &lists);
        let slots = vec![Slot::ZERO; border.slot_count()];
        Some(Hex8 { border, chunks, u: slots.clone(), f: slots, laws, mean: body.groups.is_some() })
    }

    pub fn kernel(&self) -> Kernel {
        if self.mean { Kernel::Hex8MeanDilation } else { Kernel::Hex8 }
    }

    /// Computes internal forces, N. Returns false if `J` is not positive somewhere.
    pub fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool {
        let Hex8 { border, chunks, u: slots, f: sums, laws, mean } = self;
        let not_inverted = border.for_each(slots, sums, |c, slots, sums| {
            load(border.chunk(c), u, slots);
            sums.fill(Slot::ZERO);
            let (mut not_inverted, mut first) = (true, 0);
            for &(end, region) in &chunks[c].runs {
                let kernel = if *mean { dilated } else { internal };
                let law = &laws[region as usize];
                not_inverted &= kernel(path, path, &chunks[c].blocks[first..end], law, slots, sums);
                first = end;
            }
            not_inverted
        });
        border.forces(sums, f);
        not_inverted
    }
}

impl Chunk {
    fn new(body: &ExplicitBody, part: &ChunkNodes, maps: &[Matrix3], place: &[usize]) -> Chunk {
        let region = |k: &usize| body.region(8 * part.items[*k] as usize);
        let mut order: Vec<usize> = (0..part.items.len()).collect();
        order.sort_by_key(region);
        let mut chunk = Chunk { blocks: Vec::new(), runs: Vec::new() };
        for alike in order.chunk_by(|a, b| region(a) == region(b)) {
            for group in alike.chunks(LANES) {
                let mut block = Block { points: [Point::EMPTY; 8], nodes: [[0; LANES]; 8] };
                for (l, &k) in group.iter().enumerate() {
                    for q in 0..8 {
                        let row = 8 * part.items[k] as usize + q;
                        let point = &mut block.points[place[q]];
                        for beta in 0..3 {
                            for j in 0..3 {
                                point.map[3 * beta + j][l] = 0.125 * maps[row][(j, beta)];
                            }
                        }
                        point.weight[l] = body.volume.weights()[row];
                    }
                    for c in 0..8 {
                        block.nodes[c][l] = part.local[k][NODE[c]] as u16;
                    }
                }
                chunk.blocks.push(block);
            }
            chunk.runs.push((chunk.blocks.len(), region(&alike[0])));
        }
        chunk
    }
}
