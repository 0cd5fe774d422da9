//! Rows of any length, mainly from meshless methods: the three components (and a pad) of one node in one
//! register, eight points together for the law.
//!
//! Lanes over points would need a gather and a scatter for every component, because neighbours differ from
//! point to point. Along x, y, z both are a single load or store of 32 bytes.

use super::body::ExplicitBody;
use super::chunks::{Border, ChunkNodes, load, split};
use super::moduli::{LaneLaw, Moduli, stress};
use super::quad::axpy;
use super::scalar::Slot;
use crate::kernel::{Engine, Kernel};
use lanes::{LanePath, on_path};
use material::Law;
use material::lane::invariants::{Invariants, piola};
use material::lane::{LANES, LaneStrain, Lanes};
use shape::Vector3;
use shape::locality_order;

/// Points per chunk. The displacements and forces of their nodes (64 bytes each) stay in the second-level
/// cache, and copies of nodes are few compared with the entries.
const SIZE: usize = 1024;

/// Number of batches that pass through each step together. The law is a chain of some 150 cycles, and two
/// batches overlap (0.92 of the time; four gain no more).
const TOGETHER: usize = 2;

/// Kernel for standard internal forces of any table.
pub(super) struct Ragged {
    border: Border,
    chunks: Vec<Chunk>,
    u: Vec<Slot<f64>>,
    f: Vec<Slot<f64>>,
    laws: Vec<LaneLaw>,
}

struct Chunk {
    batches: Vec<Batch>,
    /// Position of each entry's node among the chunk's nodes, points in the order of the batches.
    nodes: Vec<u16>,
    /// Gradient of each entry, 1/m.
    grads: Vec<[f64; 3]>,
}

/// Batch of eight points of one law; an unused lane has no entry and no weight.
struct Batch {
    ends: [u32; LANES],
    weights: [f64; LANES],
    region: u16,
}

impl Ragged {
    /// Builds the kernel for rows of any length. Returns `None` if a chunk has more nodes than 16 bits can
    /// number.
    pub fn new(body: &ExplicitBody, laws: Vec<LaneLaw>) -> Option<Ragged> {
        let rows = body.volume.rows();
        let order = locality_order(body.volume.points());
        let parts = split(rows.node_count(), &order, SIZE, |q| rows.row(q).0.to_vec());
        if parts.iter().any(|p| p.nodes.len() > usize::from(u16::MAX)) {
            return None;
        }
        let chunks = parts.iter().map(|part| Chunk::new(body, part)).collect();
        let lists: Vec<Vec<u32>> = parts.into_iter().map(|p| p.nodes).collect();
        let border = Border::new(rows.node_count(), &lists);
        let slots = vec![Slot::ZERO; border.slot_count()];
        Some(Ragged { border, chunks, u: slots.clone(), f: slots, laws })
    }
}

impl Engine for Ragged {
    fn kernel(&self) -> Kernel {
        Kernel::Rows
    }

    fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool {
        let Ragged { border, chunks, u: slots, f: sums, laws } = self;
        let not_inverted = border.for_each(slots, sums, |c, slots, sums| {
            load(border.chunk(c), u, 0.0, slots);
            sums.fill(Slot::ZERO);
            let mut not_inverted = true;
            internal(path, path, laws, &chunks[c], slots, sums, &mut not_inverted);
            not_inverted
        });
        border.forces(sums, f);
        not_inverted
    }
}

impl Chunk {
    fn new(body: &ExplicitBody, part: &ChunkNodes) -> Chunk {
        let region = |k: &usize| body.region(part.items[*k] as usize);
        let mut order: Vec<usize> = (0..part.items.len()).collect();
        order.sort_by_key(region);
        let mut chunk = Chunk { batches: Vec::new(), nodes: Vec::new(), grads: Vec::new() };
        for alike in order.chunk_by(|a, b| region(a) == region(b)) {
            for group in alike.chunks(LANES) {
                let mut batch = Batch { ends: [0; LANES], weights: [0.0; LANES], region: region(&group[0]) };
                for l in 0..LANES {
                    if let Some(&k) = group.get(l) {
                        let q = part.items[k] as usize;
                        batch.weights[l] = body.volume.weights()[q];
                        chunk.nodes.extend(part.local[k].iter().map(|&node| node as u16));
                        chunk.grads.extend(body.volume.row(q).1.iter().map(|g| [g.x, g.y, g.z]));
                    }
                    batch.ends[l] = chunk.nodes.len() as u32;
                }
                chunk.batches.push(batch);
            }
        }
        chunk
    }
}

on_path! {
    /// Adds internal forces of one chunk to `f`; `not_inverted` becomes false if `J` is not positive
    /// somewhere.
    fn internal(path: LanePath, laws: &[LaneLaw], chunk: &Chunk, u: &[Slot<f64>], f: &mut [Slot<f64>], not_inverted: &mut bool) = internal_lanes
}

#[inline(always)]
fn internal_lanes<const FMA: bool>(
    path: LanePath,
    laws: &[LaneLaw],
    chunk: &Chunk,
    u: &[Slot<f64>],
    f: &mut [Slot<f64>],
    not_inverted: &mut bool,
) {
    // Holds `H` of each batch, later replaced by `w P`.
    let mut x = [[[0.0; LANES]; 9]; TOGETHER];
    let mut good = [1.0; LANES];
    let mut first = 0;
    for batches in chunk.batches.chunks(TOGETHER) {
        let mut start = first;
        for (batch, h) in batches.iter().zip(&mut x) {
            for l in 0..LANES {
                let end = batch.ends[l] as usize;
                let columns = gradient::<FMA>(&chunk.nodes[start..end], &chunk.grads[start..end], u);
                for j in 0..3 {
                    for i in 0..3 {
                        h[3 * i + j][l] = columns[j].0[i];
                    }
                }
                start = end;
            }
        }
        let mut rest = x.as_mut_slice();
        for alike in batches.chunk_by(|a, b| a.region == b.region) {
            let (x, after) = std::mem::take(&mut rest).split_at_mut(alike.len());
            rest = after;
            match &laws[alike[0].region as usize] {
                LaneLaw::NeoHookean(moduli) => {
                    for (batch, x) in alike.iter().zip(x) {
                        neo_hookean::<FMA>(batch, *moduli, x, &mut good);
                    }
                }
                LaneLaw::Other(law, _) => other::<FMA>(path, alike, law, x, &mut good),
            }
        }
        start = first;
        for (batch, p) in batches.iter().zip(&x) {
            for l in 0..LANES {
                let end = batch.ends[l] as usize;
                let columns: [Slot<f64>; 3] =
                    std::array::from_fn(|j| Slot::new([p[j][l], p[3 + j][l], p[6 + j][l], 0.0]));
                for (&node, g) in chunk.nodes[start..end].iter().zip(&chunk.grads[start..end]) {
                    let at = &mut f[node as usize];
                    for j in 0..3 {
                        axpy::<FMA>(g[j], &columns[j], at);
                    }
                }
                start = end;
            }
        }
        first = start;
    }
    *not_inverted = good == [1.0; LANES];
}

/// Replaces `H` by `w P`. `good` becomes 0 in lanes in which `J` is not positive. [`other`] takes 1.06 (AVX2)
/// and 1.08 (AVX-512) of the time of the whole kernel.
#[inline(always)]
fn neo_hookean<const FMA: bool>(
    batch: &Batch,
    Moduli { mu, lambda }: Moduli,
    x: &mut [Lanes; 9],
    good: &mut Lanes,
) {
    // The stress is written to `x` at the end, because the loop would otherwise stay scalar.
    for l in 0..LANES {
        let h = [x[0][l], x[1][l], x[2][l], x[3][l], x[4][l], x[5][l], x[6][l], x[7][l], x[8][l]];
        let (at, minors) = Invariants::of::<FMA>(&h);
        good[l] = if 1.0 + at.j > 0.0 { good[l] } else { 0.0 };
        let stress = piola::<FMA, _>(&h, minors, at.stress::<FMA>(batch.weights[l], mu, lambda));
        for k in 0..9 {
            x[k][l] = stress[k];
        }
    }
}

/// Replaces `H` as [`neo_hookean`], for any other law and up to [`TOGETHER`] batches.
#[inline(always)]
fn other<const FMA: bool>(
    path: LanePath,
    batches: &[Batch],
    law: &Law,
    x: &mut [[Lanes; 9]],
    good: &mut Lanes,
) {
    let mut strains = [LaneStrain::ZERO; TOGETHER];
    for (h, strain) in x.iter().zip(&mut strains) {
        strained::<FMA>(h, strain);
        strain.check(good);
    }
    stress(path, law, &strains[..batches.len()], x);
    for (batch, p) in batches.iter().zip(x) {
        for p in p {
            for l in 0..LANES {
                p[l] *= batch.weights[l];
            }
        }
    }
}

#[inline(always)]
fn strained<const FMA: bool>(x: &[Lanes; 9], out: &mut LaneStrain) {
    for l in 0..LANES {
        let h = [x[0][l], x[1][l], x[2][l], x[3][l], x[4][l], x[5][l], x[6][l], x[7][l], x[8][l]];
        out.set::<FMA>(l, &h);
    }
}

/// Returns the columns `H_.j = sum_I u_I g_Ij`. Two sums run at once: a single sum would wait four cycles for
/// each term.
#[inline(always)]
fn gradient<const FMA: bool>(nodes: &[u16], grads: &[[f64; 3]], u: &[Slot<f64>]) -> [Slot<f64>; 3] {
    let mut sums = [[Slot::ZERO; 3]; 2];
    let pairs = (nodes.as_chunks::<2>(), grads.as_chunks::<2>());
    let mut add = |side: usize, node: u16, g: &[f64; 3]| {
        let v = &u[node as usize];
        for j in 0..3 {
            axpy::<FMA>(g[j], v, &mut sums[side][j]);
        }
    };
    for (n, g) in pairs.0.0.iter().zip(pairs.1.0) {
        add(0, n[0], &g[0]);
        add(1, n[1], &g[1]);
    }
    if let ([n], [g]) = (pairs.0.1, pairs.1.1) {
        add(0, *n, g);
    }
    std::array::from_fn(|j| Slot::new(std::array::from_fn(|i| sums[0][j].0[i] + sums[1][j].0[i])))
}
