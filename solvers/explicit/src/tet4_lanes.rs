//! Kernels of the tetrahedron with four nodes: one element in each lane of a block.
//!
//! The kernels make three passes over a few blocks: strains, the law, then stress and forces. In a single
//! pass a block is a chain that fills the out-of-order window of the processor. The neo-Hookean law in two
//! passes takes 0.8 of the time; separated from gather and scatter in a pass of its own it takes 0.77 of
//! that. The loop of each law over blocks is compiled separately, because two in one function spoil each
//! other's vectorisation. The benchmark `tet4` reports the distance of the kernel from its bounds.

use super::moduli::{LaneLaw, Moduli, stress};
use super::scalar::{Scalar, Slot, within};
use lanes::{LanePath, fetch, on_path};
use material::Law;
use material::lane::LaneStrain;
use material::lane::invariants::{Invariants, add_cofactor, piola, pressed};

/// Number of blocks that go through each pass together; two and eight take as long.
const TOGETHER: usize = 4;

#[repr(C, align(64))]
pub(super) struct Block<T: Scalar> {
    /// Gradients of nodes 1 to 3, [3 a + j].
    pub grads: [T::Lanes; 9],
    pub weight: T::Lanes,
    pub nodes: [T::Nodes; 4],
}

/// Blocks of one chunk, by law.
pub(super) struct Chunk<T: Scalar> {
    pub blocks: Vec<Block<T>>,
    /// Consecutive blocks of one region: index after the last block, and region index.
    pub runs: Vec<(usize, u16)>,
}

/// Intermediate results between passes, aligned like [`LaneStrain<T>`].
#[repr(align(64))]
struct Passed<P>([P; TOGETHER]);

impl<T: Scalar> Block<T> {
    /// Prefetches a later block; without this, a hundred thousand elements take 1.8 times as long. Four to
    /// sixteen blocks ahead are equivalent. Prefetching all blocks of a pass at once is too much (1.5 times).
    #[inline(always)]
    fn fetch_ahead(&self) {
        fetch(std::ptr::from_ref(self).wrapping_add(8));
    }
}

/// Checks that all nodes of the blocks lie within the given number of slots.
#[inline(always)]
fn check<T: Scalar>(blocks: &[Block<T>], slots: usize) {
    for block in blocks {
        assert!(within::<T>(&block.nodes, slots), "a node outside the chunk's slots");
    }
}

/// Returns displacements relative to node 0, [3 a + i].
///
/// # Safety
///
/// Registers of `BITS` must be available, and the block's nodes must lie within `u`.
#[inline(always)]
unsafe fn gather<const BITS: usize, T: Scalar>(block: &Block<T>, u: &[Slot<T>]) -> [T::Lanes; 9] {
    let mut d = [T::ZEROS; 9];
    // SAFETY: guaranteed by the caller.
    let origin = unsafe { T::lanes_of::<BITS>(u, &block.nodes[0], &[T::ZEROS; 3]) };
    for a in 0..3 {
        // SAFETY: as above.
        let lanes = unsafe { T::lanes_of::<BITS>(u, &block.nodes[a + 1], &origin) };
        d[3 * a..3 * a + 3].copy_from_slice(&lanes);
    }
    d
}

/// Adds the forces of nodes 1 to 3 and 0.
///
/// # Safety
///
/// Registers of `BITS` must be available, and the block's nodes must lie within `f`.
#[inline(always)]
unsafe fn scatter<const BITS: usize, T: Scalar>(block: &Block<T>, out: &[T::Lanes; 12], f: &mut [Slot<T>]) {
    for a in 0..4 {
        let nodes = &block.nodes[(a + 1) % 4];
        // SAFETY: guaranteed by the caller.
        unsafe { T::add_lanes::<BITS>([&out[3 * a], &out[3 * a + 1], &out[3 * a + 2]], nodes, f) };
    }
}

/// Returns `H_ij = sum_a d_ai g_aj` of one lane.
#[inline(always)]
fn gradient<const FMA: bool, T: Scalar>(d: &[T::Lanes; 9], g: &[T::Lanes; 9], l: usize) -> [T; 9] {
    let m = T::madd::<FMA>;
    let mut h = [T::ZERO; 9];
    for k in 0..9 {
        let (i, j) = (k / 3, k % 3);
        h[k] = m(d[i][l], g[j][l], m(d[3 + i][l], g[3 + j][l], d[6 + i][l] * g[6 + j][l]));
    }
    h
}

/// Computes `f_a = w P grad N_a` of one lane, and minus their sum for node 0.
#[inline(always)]
fn forces<const FMA: bool, T: Scalar>(p: &[T; 9], g: &[T::Lanes; 9], l: usize, out: &mut [T::Lanes; 12]) {
    let m = T::madd::<FMA>;
    for i in 0..3 {
        let row = |a: usize| {
            m(p[3 * i], g[3 * a][l], m(p[3 * i + 1], g[3 * a + 1][l], p[3 * i + 2] * g[3 * a + 2][l]))
        };
        let (x, y, z) = (row(0), row(1), row(2));
        (out[i][l], out[3 + i][l], out[6 + i][l], out[9 + i][l]) = (x, y, z, -x - y - z);
    }
}

/// Computes `H` of eight elements.
#[inline(always)]
fn strain<const FMA: bool, T: Scalar>(d: &[T::Lanes; 9], g: &[T::Lanes; 9], out: &mut LaneStrain<T>) {
    for l in 0..T::LANES {
        let h = gradient::<FMA, T>(d, g, l);
        out.set::<FMA>(l, &h);
    }
}

#[inline(always)]
fn weighted<T: Scalar>(p: &[T::Lanes; 9], w: T, l: usize) -> [T; 9] {
    let mut out = [T::ZERO; 9];
    for k in 0..9 {
        out[k] = w * p[k][l];
    }
    out
}

/// Computes the forces of eight elements for the stress `p`.
#[inline(always)]
fn forces_of<const FMA: bool, T: Scalar>(block: &Block<T>, p: &[T::Lanes; 9], out: &mut [T::Lanes; 12]) {
    for l in 0..T::LANES {
        let w = block.weight[l];
        let p = weighted::<T>(p, w, l);
        forces::<FMA, T>(&p, &block.grads, l, out);
    }
}

/// Computes the forces as [`forces_of`] with the mean pressure of the groups; `pressure` is four times the
/// mean.
#[inline(always)]
fn dilated_forces_of<const FMA: bool, T: Scalar>(
    block: &Block<T>,
    strain: &LaneStrain<T>,
    p: &[T::Lanes; 9],
    pressure: &T::Lanes,
    out: &mut [T::Lanes; 12],
) {
    for l in 0..T::LANES {
        let w = block.weight[l];
        let mut p = weighted::<T>(p, w, l);
        let (x, minors) = strain.invariants(l);
        add_cofactor::<FMA, _>(&strain.lane(l), minors, x.trace, T::of(0.25) * w * pressure[l], &mut p);
        forces::<FMA, T>(&p, &block.grads, l, out);
    }
}

/// Computes the coefficients of `w P`.
#[inline(always)]
fn neo_hookean_law<const FMA: bool, T: Scalar>(
    block: &Block<T>,
    strain: &LaneStrain<T>,
    Moduli { mu, lambda }: Moduli<T>,
    out: &mut [T::Lanes; 3],
) {
    for l in 0..T::LANES {
        let (x, _) = strain.invariants(l);
        let c = x.stress::<FMA>(block.weight[l], mu, lambda);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

/// Computes the forces of eight elements for the stress with these coefficients.
#[inline(always)]
fn combined_forces<const FMA: bool, T: Scalar>(
    block: &Block<T>,
    strain: &LaneStrain<T>,
    c: &[T::Lanes; 3],
    out: &mut [T::Lanes; 12],
) {
    for l in 0..T::LANES {
        let (_, minors) = strain.invariants(l);
        let p = piola::<FMA, _>(&strain.lane(l), minors, [c[0][l], c[1][l], c[2][l]]);
        forces::<FMA, T>(&p, &block.grads, l, out);
    }
}

/// Computes the coefficients as [`neo_hookean_law`] with the dilation of the groups. The `shared` numbers are
/// four times the means of `J_a^(2/3)` and `p_a`.
#[inline(always)]
fn dilated_neo_hookean_law<const FMA: bool, T: Scalar>(
    block: &Block<T>,
    strain: &LaneStrain<T>,
    mu: T,
    shared: &[T::Lanes; 2],
    out: &mut [T::Lanes; 3],
) {
    for l in 0..T::LANES {
        let (x, _) = strain.invariants(l);
        let w = block.weight[l];
        let (_, isochoric) = x.isochoric::<FMA>(&strain.lane(l), w * mu);
        let (s, wp) = (T::of(0.25) * shared[0][l], T::of(0.25) * w * shared[1][l]);
        let c = pressed::<FMA, _>(isochoric, x.trace, s, wp);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

/// Adds internal forces of one chunk to `f`. Returns false if `J` is not positive somewhere.
pub(super) fn internal<T: Scalar>(
    path: LanePath,
    laws: &[LaneLaw],
    chunk: &Chunk<T>,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    let mut first = 0;
    let mut good = T::ONES;
    for &(end, region) in &chunk.runs {
        let blocks = &chunk.blocks[first..end];
        match &laws[region as usize] {
            LaneLaw::NeoHookean(moduli) => neo_hookean(path, blocks, moduli.of(), u, f, &mut good),
            LaneLaw::Other(law, _) => other(path, path, blocks, law, u, f, &mut good),
        }
        first = end;
    }
    good == T::ONES
}

on_path! {
    /// Adds the forces of the neo-Hookean law. [`other`] takes 2.4 % more instructions and 1.03 of the time
    /// with 80,000 elements. With 6,000 elements, in cache, it takes 1.02 (AVX2) and 1.03 (AVX-512) in the
    /// median of twelve processes, but up to 1.14 and 1.18 if this kernel is fast.
    fn neo_hookean<; T: [Scalar]>(blocks: &[Block<T>], moduli: Moduli<T>, u: &[Slot<T>], f: &mut [Slot<T>], good: &mut T::Lanes) = neo_hookean_lanes::<BITS>
}

#[inline(always)]
fn neo_hookean_lanes<const FMA: bool, const BITS: usize, T: Scalar>(
    blocks: &[Block<T>],
    moduli: Moduli<T>,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
    good: &mut T::Lanes,
) {
    let (mut x, mut c) = ([LaneStrain::ZERO; TOGETHER], Passed([[T::ZEROS; 3]; TOGETHER]));
    let mut out = [T::ZEROS; 12];
    for blocks in blocks.chunks(TOGETHER) {
        check(blocks, u.len().min(f.len()));
        for (block, x) in blocks.iter().zip(&mut x) {
            block.fetch_ahead();
            // SAFETY: the nodes were checked, and a kernel runs with the registers of its path.
            strain::<FMA, T>(&unsafe { gather::<BITS, T>(block, u) }, &block.grads, x);
            x.check(good);
        }
        for ((block, x), c) in blocks.iter().zip(&x).zip(&mut c.0) {
            neo_hookean_law::<FMA, T>(block, x, moduli, c);
        }
        for ((block, x), c) in blocks.iter().zip(&x).zip(&c.0) {
            combined_forces::<FMA, T>(block, x, c, &mut out);
            // SAFETY: as above.
            unsafe { scatter::<BITS, T>(block, &out, f) };
        }
    }
}

on_path! {
    /// Adds the forces of any other law.
    fn other<; T: [Scalar]>(path: LanePath, blocks: &[Block<T>], law: &Law, u: &[Slot<T>], f: &mut [Slot<T>], good: &mut T::Lanes) = other_lanes::<BITS>
}

#[inline(always)]
fn other_lanes<const FMA: bool, const BITS: usize, T: Scalar>(
    path: LanePath,
    blocks: &[Block<T>],
    law: &Law,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
    good: &mut T::Lanes,
) {
    let (mut x, mut p) = ([LaneStrain::ZERO; TOGETHER], Passed([[T::ZEROS; 9]; TOGETHER]));
    let mut out = [T::ZEROS; 12];
    for blocks in blocks.chunks(TOGETHER) {
        check(blocks, u.len().min(f.len()));
        for (block, x) in blocks.iter().zip(&mut x) {
            block.fetch_ahead();
            // SAFETY: the nodes were checked, and a kernel runs with the registers of its path.
            strain::<FMA, T>(&unsafe { gather::<BITS, T>(block, u) }, &block.grads, x);
            x.check(good);
        }
        stress(path, law, &x[..blocks.len()], &mut p.0);
        for (block, p) in blocks.iter().zip(&p.0) {
            forces_of::<FMA, T>(block, p, &mut out);
            // SAFETY: as above.
            unsafe { scatter::<BITS, T>(block, &out, f) };
        }
    }
}

on_path! {
    /// Makes the first pass of nodal-mean dilation: adds `sum share w (J - 1)` and `sum share w mu b` to
    /// `sums`.
    pub(super) fn dilations<; T: [Scalar]>(laws: &[LaneLaw], chunk: &Chunk<T>, u: &[Slot<T>], sums: &mut [[T; 2]], not_inverted: &mut bool) = dilations_lanes::<BITS>
}

#[inline(always)]
fn dilations_lanes<const FMA: bool, const BITS: usize, T: Scalar>(
    laws: &[LaneLaw],
    chunk: &Chunk<T>,
    u: &[Slot<T>],
    sums: &mut [[T; 2]],
    not_inverted: &mut bool,
) {
    let mut first = 0;
    let mut good = T::ONES;
    for &(end, region) in &chunk.runs {
        // Only the first sum is used for other laws.
        let mu = T::of(laws[region as usize].of_group()[0]);
        for block in &chunk.blocks[first..end] {
            check(std::slice::from_ref(block), u.len());
            block.fetch_ahead();
            // SAFETY: the nodes were checked, and a kernel runs with the registers of its path.
            let d = unsafe { gather::<BITS, T>(block, u) };
            let mut out = [T::ZEROS; 2];
            for l in 0..T::LANES {
                let h = gradient::<FMA, T>(&d, &block.grads, l);
                let (x, _) = Invariants::of::<FMA>(&h);
                good[l] = if T::ONE + x.j > T::ZERO { good[l] } else { T::ZERO };
                let share = T::of(0.25) * block.weight[l];
                out[0][l] = share * x.j;
                out[1][l] = share * mu * x.isochoric::<FMA>(&h, T::ZERO).0;
            }
            for l in 0..T::LANES {
                for a in 0..4 {
                    let at = &mut sums[block.nodes[a][l] as usize];
                    at[0] += out[0][l];
                    at[1] += out[1][l];
                }
            }
        }
        first = end;
    }
    *not_inverted = good == T::ONES;
}

/// Makes the second pass: adds forces to `f`; `closed` has `J_a^(2/3)` and `p_a` of the nodes.
pub(super) fn dilated<T: Scalar>(
    path: LanePath,
    laws: &[LaneLaw],
    chunk: &Chunk<T>,
    u: &[Slot<T>],
    closed: &[[T; 2]],
    f: &mut [Slot<T>],
) {
    let mut first = 0;
    for &(end, region) in &chunk.runs {
        let blocks = &chunk.blocks[first..end];
        match &laws[region as usize] {
            LaneLaw::NeoHookean(moduli) => dilated_neo_hookean(path, blocks, T::of(moduli.mu), u, closed, f),
            LaneLaw::Other(law, _) => dilated_other(path, path, blocks, law, u, closed, f),
        }
        first = end;
    }
}

on_path! {
    fn dilated_neo_hookean<; T: [Scalar]>(blocks: &[Block<T>], mu: T, u: &[Slot<T>], closed: &[[T; 2]], f: &mut [Slot<T>]) = dilated_neo_hookean_lanes::<BITS>
}

#[inline(always)]
fn dilated_neo_hookean_lanes<const FMA: bool, const BITS: usize, T: Scalar>(
    blocks: &[Block<T>],
    mu: T,
    u: &[Slot<T>],
    closed: &[[T; 2]],
    f: &mut [Slot<T>],
) {
    let (mut x, mut c) = ([LaneStrain::ZERO; TOGETHER], Passed([[T::ZEROS; 3]; TOGETHER]));
    let mut out = [T::ZEROS; 12];
    for blocks in blocks.chunks(TOGETHER) {
        check(blocks, u.len().min(f.len()));
        for (block, x) in blocks.iter().zip(&mut x) {
            block.fetch_ahead();
            // SAFETY: the nodes were checked, and a kernel runs with the registers of its path.
            strain::<FMA, T>(&unsafe { gather::<BITS, T>(block, u) }, &block.grads, x);
        }
        for ((block, x), c) in blocks.iter().zip(&x).zip(&mut c.0) {
            let shared = T::lanes_of_sums::<FMA>(closed, &block.nodes);
            dilated_neo_hookean_law::<FMA, T>(block, x, mu, &shared, c);
        }
        for ((block, x), c) in blocks.iter().zip(&x).zip(&c.0) {
            combined_forces::<FMA, T>(block, x, c, &mut out);
            // SAFETY: as above.
            unsafe { scatter::<BITS, T>(block, &out, f) };
        }
    }
}

on_path! {
    /// Adds the forces of any other law.
    fn dilated_other<; T: [Scalar]>(path: LanePath, blocks: &[Block<T>], law: &Law, u: &[Slot<T>], closed: &[[T; 2]], f: &mut [Slot<T>]) = dilated_other_lanes::<BITS>
}

#[inline(always)]
fn dilated_other_lanes<const FMA: bool, const BITS: usize, T: Scalar>(
    path: LanePath,
    blocks: &[Block<T>],
    law: &Law,
    u: &[Slot<T>],
    closed: &[[T; 2]],
    f: &mut [Slot<T>],
) {
    let (mut x, mut p) = ([LaneStrain::ZERO; TOGETHER], Passed([[T::ZEROS; 9]; TOGETHER]));
    let mut out = [T::ZEROS; 12];
    for blocks in blocks.chunks(TOGETHER) {
        check(blocks, u.len().min(f.len()));
        for (block, x) in blocks.iter().zip(&mut x) {
            block.fetch_ahead();
            // SAFETY: the nodes were checked, and a kernel runs with the registers of its path.
            strain::<FMA, T>(&unsafe { gather::<BITS, T>(block, u) }, &block.grads, x);
        }
        stress(path, law, &x[..blocks.len()], &mut p.0);
        for ((block, x), p) in blocks.iter().zip(&x).zip(&p.0) {
            let [_, pressure] = T::lanes_of_sums::<FMA>(closed, &block.nodes);
            dilated_forces_of::<FMA, T>(block, x, p, &pressure, &mut out);
            // SAFETY: as above.
            unsafe { scatter::<BITS, T>(block, &out, f) };
        }
    }
}
