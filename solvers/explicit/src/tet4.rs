//! Tetrahedra of four nodes and one point: eight of them in the lanes of one block.
//!
//! Gradients of a partition of unity sum to zero, so three of the four are stored and
//! `H = sum_a (u_a - u_0) grad N_a`; the force on node 0 is minus the sum of the others, momentum is conserved to the
//! last bit of each element. 88 bytes per element (9 gradients, weight, four 16-bit nodes) instead of 120.

use super::Kernel;
use super::chunks::{Border, ChunkNodes, Slot, load, split};
use super::force::ExplicitBody;
use super::moduli::{LaneLaw, Moduli, stress};

use super::nodal::Nodal;
use super::quad::{add, axpy, lanes_of_differences, lanes_of_sums, quads_of_lanes};
use lanes::{LanePath, on_path};
use material::Law;
use material::lane::invariants::{Invariants, add_cofactor, piola, pressed};
use material::lane::math::madd;
use material::lane::{LANES, LaneStrain, Lanes};
use shape::Vector3;
use shape::locality_order;

/// Elements per chunk: 512 distinct nodes or so, whose displacements and forces stay in the first-level cache.
const SIZE: usize = 2048;

/// Blocks that go through each step together where the law is called.
const TOGETHER: usize = 4;

/// Standard or nodal-mean dilation on tetrahedra of four nodes.
pub(super) struct Tet4 {
    border: Border,
    chunks: Vec<Chunk>,
    u: Vec<Slot>,
    f: Vec<Slot>,
    laws: Vec<LaneLaw>,
    nodal: Option<Nodal>,
}

impl Tet4 {
    /// Of rows laid out as linear tetrahedra; none for groups other than one per node, weighted evenly.
    pub fn new(body: &ExplicitBody, laws: Vec<LaneLaw>) -> Option<Tet4> {
        let (volume, rows) = (body.volume, body.volume.rows());
        let order = locality_order(volume.points());
        let parts = split(rows.node_count(), &order, SIZE, |q| rows.row(q).0.to_vec());
        let lists: Vec<Vec<u32>> = parts.iter().map(|p| p.nodes.clone()).collect();
        let border = Border::new(rows.node_count(), &lists);
        let nodal = match body.groups {
            Some(groups) => Some(Nodal::new(body, groups, &laws, border.slot_count())?),
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
        Some(Tet4 { border, chunks, u: slots.clone(), f: slots, laws, nodal })
    }

    pub fn kernel(&self) -> Kernel {
        if self.nodal.is_some() { Kernel::Tet4NodalDilation } else { Kernel::Tet4 }
    }

    /// Internal forces; false where some `J` is not positive.
    pub fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool {
        let Tet4 { border, chunks, u: slots, f: sums, laws, nodal } = self;
        let upright = match nodal {
            None => border.for_each(slots, sums, |c, slots, sums| {
                load(border.chunk(c), u, slots);
                sums.fill(Slot::ZERO);
                internal(path, laws, &chunks[c], slots, sums)
            }),
            Some(nodal) => {
                let upright = border.for_each(slots, nodal.slots(), |c, slots, sums| {
                    load(border.chunk(c), u, slots);
                    sums.fill([0.0; 2]);
                    let mut upright = true;
                    dilations(path, laws, &chunks[c], slots, sums, &mut upright);
                    upright
                });
                nodal.close(path, border);
                let (closed, shared) = nodal.closed();
                border.for_each(shared, sums, |c, shared, sums| {
                    for (shared, &node) in shared.iter_mut().zip(border.chunk(c)) {
                        *shared = closed[node as usize];
                    }
                    sums.fill(Slot::ZERO);
                    dilated(path, laws, &chunks[c], &slots[border.range(c)], shared, sums);
                    true
                });
                upright
            }
        };
        border.forces(sums, f);
        upright
    }
}

#[repr(C, align(64))]
pub(super) struct Block {
    /// Gradients of nodes 1 to 3, [3 a + j].
    grads: [[f64; LANES]; 9],
    weight: [f64; LANES],
    nodes: [[u16; LANES]; 4],
}

/// Blocks of one chunk, by law.
pub(super) struct Chunk {
    blocks: Vec<Block>,
    /// Blocks up to this one are of this region.
    runs: Vec<(usize, u16)>,
}

impl Chunk {
    pub fn new(
        chunk: &ChunkNodes,
        grads: impl Fn(usize) -> [Vector3; 4],
        weight: impl Fn(usize) -> f64,
        region: impl Fn(usize) -> u16,
    ) -> Chunk {
        let mut order: Vec<usize> = (0..chunk.items.len()).collect();
        let region = |k: usize| region(chunk.items[k] as usize);
        order.sort_by_key(|&k| region(k));
        let (mut blocks, mut runs) = (Vec::new(), Vec::new());
        for alike in order.chunk_by(|&a, &b| region(a) == region(b)) {
            // Lanes far apart: neighbours share nodes, and eight sums in turn into one node wait for each other (0.97 of the
            // time, with nodal dilation 0.90).
            let stride = alike.len().div_ceil(LANES);
            for first in 0..stride {
                let group = alike[first..].iter().step_by(stride);
                // A lane left over has no weight and no gradient: J = 1 and no force, on the chunk's first node.
                let mut block =
                    Block { grads: [[0.0; LANES]; 9], weight: [0.0; LANES], nodes: [[0; LANES]; 4] };
                for (l, &k) in group.enumerate() {
                    let item = chunk.items[k] as usize;
                    let g = grads(item);
                    for a in 0..3 {
                        for j in 0..3 {
                            block.grads[3 * a + j][l] = g[a + 1][j];
                        }
                    }
                    block.weight[l] = weight(item);
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

/// Displacements relative to node 0, [3 a + i].
#[inline(always)]
fn gather<const FMA: bool>(block: &Block, u: &[Slot]) -> [[f64; LANES]; 9] {
    let mut origin = [Slot::ZERO; LANES];
    for l in 0..LANES {
        origin[l] = u[block.nodes[0][l] as usize];
    }
    let mut d = [[0.0; LANES]; 9];
    for a in 0..3 {
        let lanes = lanes_of_differences::<FMA>(u, &block.nodes[a + 1], &origin);
        d[3 * a..3 * a + 3].copy_from_slice(&lanes);
    }
    d
}

/// Adds the forces of nodes 1 to 3, and minus their sum on node 0.
#[inline(always)]
fn scatter<const FMA: bool>(block: &Block, out: &[[f64; LANES]; 9], f: &mut [Slot]) {
    let mut sum = [Slot::ZERO; LANES];
    for a in 0..3 {
        let quads = quads_of_lanes::<FMA>(&out[3 * a], &out[3 * a + 1], &out[3 * a + 2]);
        for l in 0..LANES {
            add::<FMA>(&quads[l], &mut f[block.nodes[a + 1][l] as usize]);
            axpy::<FMA>(-1.0, &quads[l], &mut sum[l]);
        }
    }
    for l in 0..LANES {
        add::<FMA>(&sum[l], &mut f[block.nodes[0][l] as usize]);
    }
}

/// `H_ij = sum_a d_ai g_aj` of one lane.
#[inline(always)]
fn gradient<const FMA: bool>(d: &[[f64; LANES]; 9], g: &[[f64; LANES]; 9], l: usize) -> [f64; 9] {
    let m = madd::<FMA>;
    let mut h = [0.0; 9];
    for k in 0..9 {
        let (i, j) = (k / 3, k % 3);
        h[k] = m(d[i][l], g[j][l], m(d[3 + i][l], g[3 + j][l], d[6 + i][l] * g[6 + j][l]));
    }
    h
}

/// `f_a = w P grad N_a` of one lane.
#[inline(always)]
fn forces<const FMA: bool>(p: &[f64; 9], g: &[[f64; LANES]; 9], l: usize, out: &mut [[f64; LANES]; 9]) {
    let m = madd::<FMA>;
    for a in 0..3 {
        for i in 0..3 {
            out[3 * a + i][l] =
                m(p[3 * i], g[3 * a][l], m(p[3 * i + 1], g[3 * a + 1][l], p[3 * i + 2] * g[3 * a + 2][l]));
        }
    }
}

/// `H` of eight elements.
#[inline(always)]
fn strain<const FMA: bool>(d: &[Lanes; 9], g: &[Lanes; 9], out: &mut LaneStrain) {
    for l in 0..LANES {
        let h = gradient::<FMA>(d, g, l);
        out.set::<FMA>(l, &h);
    }
}

#[inline(always)]
fn weighted(p: &[Lanes; 9], w: f64, l: usize) -> [f64; 9] {
    let mut out = [0.0; 9];
    for k in 0..9 {
        out[k] = w * p[k][l];
    }
    out
}

/// Forces of eight elements at the stress `p`.
#[inline(always)]
fn forces_of<const FMA: bool>(block: &Block, p: &[Lanes; 9], out: &mut [Lanes; 9]) {
    for l in 0..LANES {
        let w = block.weight[l];
        let p = weighted(p, w, l);
        forces::<FMA>(&p, &block.grads, l, out);
    }
}

/// As [`forces_of`] with the mean pressure of the groups, four times which is `pressure`.
#[inline(always)]
fn dilated_forces_of<const FMA: bool>(
    block: &Block,
    strain: &LaneStrain,
    p: &[Lanes; 9],
    pressure: &Lanes,
    out: &mut [Lanes; 9],
) {
    for l in 0..LANES {
        let w = block.weight[l];
        let mut p = weighted(p, w, l);
        let (x, minors) = strain.invariants(l);
        add_cofactor::<FMA>(&strain.lane(l), minors, x.trace, 0.25 * w * pressure[l], &mut p);
        forces::<FMA>(&p, &block.grads, l, out);
    }
}

#[inline(always)]
fn neo_hookean_forces<const FMA: bool>(
    block: &Block,
    strain: &LaneStrain,
    Moduli { mu, lambda }: Moduli,
    out: &mut [Lanes; 9],
) {
    for l in 0..LANES {
        let (x, minors) = strain.invariants(l);
        let p = piola::<FMA>(&strain.lane(l), minors, x.stress::<FMA>(block.weight[l], mu, lambda));
        forces::<FMA>(&p, &block.grads, l, out);
    }
}

/// The shared numbers are four times the means of `J_a^(2/3)` and `p_a`.
#[inline(always)]
fn dilated_neo_hookean_forces<const FMA: bool>(
    block: &Block,
    strain: &LaneStrain,
    mu: f64,
    shared: &[Lanes; 2],
    out: &mut [Lanes; 9],
) {
    for l in 0..LANES {
        let (h, (x, minors)) = (strain.lane(l), strain.invariants(l));
        let w = block.weight[l];
        let (_, isochoric) = x.isochoric::<FMA>(&h, w * mu);
        let (s, wp) = (0.25 * shared[0][l], 0.25 * w * shared[1][l]);
        let p = piola::<FMA>(&h, minors, pressed::<FMA>(isochoric, x.trace, s, wp));
        forces::<FMA>(&p, &block.grads, l, out);
    }
}

/// Internal forces of one chunk, added to `f`; false where some `J` is not positive.
fn internal(path: LanePath, laws: &[LaneLaw], chunk: &Chunk, u: &[Slot], f: &mut [Slot]) -> bool {
    let mut first = 0;
    let mut good = [1.0; LANES];
    for &(end, region) in &chunk.runs {
        let blocks = &chunk.blocks[first..end];
        match &laws[region as usize] {
            LaneLaw::NeoHookean(moduli) => neo_hookean(path, blocks, *moduli, u, f, &mut good),
            LaneLaw::Other(law, _) => other(path, path, blocks, law, u, f, &mut good),
        }
        first = end;
    }
    good == [1.0; LANES]
}

on_path! {
    fn neo_hookean(blocks: &[Block], moduli: Moduli, u: &[Slot], f: &mut [Slot], good: &mut Lanes) = neo_hookean_lanes
}

#[inline(always)]
fn neo_hookean_lanes<const FMA: bool>(
    blocks: &[Block],
    moduli: Moduli,
    u: &[Slot],
    f: &mut [Slot],
    good: &mut Lanes,
) {
    let (mut x, mut out) = ([LaneStrain::ZERO; TOGETHER], [[0.0; LANES]; 9]);
    for blocks in blocks.chunks(TOGETHER) {
        for (block, x) in blocks.iter().zip(&mut x) {
            strain::<FMA>(&gather::<FMA>(block, u), &block.grads, x);
            x.check(good);
        }
        for (block, x) in blocks.iter().zip(&x) {
            neo_hookean_forces::<FMA>(block, x, moduli, &mut out);
            scatter::<FMA>(block, &out, f);
        }
    }
}

on_path! {
    /// Any other law.
    fn other(path: LanePath, blocks: &[Block], law: &Law, u: &[Slot], f: &mut [Slot], good: &mut Lanes) = other_lanes
}

#[inline(always)]
fn other_lanes<const FMA: bool>(
    path: LanePath,
    blocks: &[Block],
    law: &Law,
    u: &[Slot],
    f: &mut [Slot],
    good: &mut Lanes,
) {
    let (mut x, mut p) = ([LaneStrain::ZERO; TOGETHER], [[[0.0; LANES]; 9]; TOGETHER]);
    let mut out = [[0.0; LANES]; 9];
    for blocks in blocks.chunks(TOGETHER) {
        for (block, x) in blocks.iter().zip(&mut x) {
            strain::<FMA>(&gather::<FMA>(block, u), &block.grads, x);
            x.check(good);
        }
        stress(path, law, &x[..blocks.len()], &mut p);
        for (block, p) in blocks.iter().zip(&p) {
            forces_of::<FMA>(block, p, &mut out);
            scatter::<FMA>(block, &out, f);
        }
    }
}

on_path! {
    /// First pass of the nodal-mean dilation: `sum share w (J - 1)` and `sum share w mu b` added to `sums`.
    fn dilations(laws: &[LaneLaw], chunk: &Chunk, u: &[Slot], sums: &mut [[f64; 2]], upright: &mut bool) = dilations_lanes
}

#[inline(always)]
fn dilations_lanes<const FMA: bool>(
    laws: &[LaneLaw],
    chunk: &Chunk,
    u: &[Slot],
    sums: &mut [[f64; 2]],
    upright: &mut bool,
) {
    let mut first = 0;
    let mut good = [1.0; LANES];
    for &(end, region) in &chunk.runs {
        // Of the other laws the first number alone.
        let [mu, ..] = laws[region as usize].of_group();
        for block in &chunk.blocks[first..end] {
            let d = gather::<FMA>(block, u);
            let mut out = [[0.0; LANES]; 2];
            for l in 0..LANES {
                let h = gradient::<FMA>(&d, &block.grads, l);
                let (x, _) = Invariants::of::<FMA>(&h);
                good[l] = if 1.0 + x.j > 0.0 { good[l] } else { 0.0 };
                let share = 0.25 * block.weight[l];
                out[0][l] = share * x.j;
                out[1][l] = share * mu * x.isochoric::<FMA>(&h, 0.0).0;
            }
            for l in 0..LANES {
                for a in 0..4 {
                    let at = &mut sums[block.nodes[a][l] as usize];
                    at[0] += out[0][l];
                    at[1] += out[1][l];
                }
            }
        }
        first = end;
    }
    *upright = good == [1.0; LANES];
}

/// Second pass: forces added to `f`; `closed` holds `J_a^(2/3)` and `p_a` of the nodes.
fn dilated(
    path: LanePath,
    laws: &[LaneLaw],
    chunk: &Chunk,
    u: &[Slot],
    closed: &[[f64; 2]],
    f: &mut [Slot],
) {
    let mut first = 0;
    for &(end, region) in &chunk.runs {
        let blocks = &chunk.blocks[first..end];
        match &laws[region as usize] {
            LaneLaw::NeoHookean(moduli) => dilated_neo_hookean(path, blocks, moduli.mu, u, closed, f),
            LaneLaw::Other(law, _) => dilated_other(path, path, blocks, law, u, closed, f),
        }
        first = end;
    }
}

on_path! {
    fn dilated_neo_hookean(blocks: &[Block], mu: f64, u: &[Slot], closed: &[[f64; 2]], f: &mut [Slot]) = dilated_neo_hookean_lanes
}

#[inline(always)]
fn dilated_neo_hookean_lanes<const FMA: bool>(
    blocks: &[Block],
    mu: f64,
    u: &[Slot],
    closed: &[[f64; 2]],
    f: &mut [Slot],
) {
    let (mut x, mut out) = ([LaneStrain::ZERO; TOGETHER], [[0.0; LANES]; 9]);
    for blocks in blocks.chunks(TOGETHER) {
        for (block, x) in blocks.iter().zip(&mut x) {
            strain::<FMA>(&gather::<FMA>(block, u), &block.grads, x);
        }
        for (block, x) in blocks.iter().zip(&x) {
            let shared = lanes_of_sums::<FMA>(closed, &block.nodes);
            dilated_neo_hookean_forces::<FMA>(block, x, mu, &shared, &mut out);
            scatter::<FMA>(block, &out, f);
        }
    }
}

on_path! {
    /// Any other law.
    fn dilated_other(path: LanePath, blocks: &[Block], law: &Law, u: &[Slot], closed: &[[f64; 2]], f: &mut [Slot]) = dilated_other_lanes
}

#[inline(always)]
fn dilated_other_lanes<const FMA: bool>(
    path: LanePath,
    blocks: &[Block],
    law: &Law,
    u: &[Slot],
    closed: &[[f64; 2]],
    f: &mut [Slot],
) {
    let (mut x, mut p) = ([LaneStrain::ZERO; TOGETHER], [[[0.0; LANES]; 9]; TOGETHER]);
    let mut out = [[0.0; LANES]; 9];
    for blocks in blocks.chunks(TOGETHER) {
        for (block, x) in blocks.iter().zip(&mut x) {
            strain::<FMA>(&gather::<FMA>(block, u), &block.grads, x);
        }
        stress(path, law, &x[..blocks.len()], &mut p);
        for ((block, x), p) in blocks.iter().zip(&x).zip(&p) {
            let [_, pressure] = lanes_of_sums::<FMA>(closed, &block.nodes);
            dilated_forces_of::<FMA>(block, x, p, &pressure, &mut out);
            scatter::<FMA>(block, &out, f);
        }
    }
}
