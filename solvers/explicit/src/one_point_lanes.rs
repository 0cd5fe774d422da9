//! Kernels of the hexahedron with one point: one element in each lane of a block.
//!
//! Three passes over a few blocks, as in the kernels of the linear tetrahedron: strains and patterns, the law,
//! then stress and forces.

use lanes::{LanePath, fetch, on_path};
use material::Law;
use material::lane::LaneStrain;
use material::lane::invariants::piola;

use super::moduli::{LaneLaw, Moduli, stress};
use super::scalar::{Scalar, Slot, within};

/// Number of blocks that go through each pass together.
const TOGETHER: usize = 2;

/// Node at the corner with the given index bits: bit 0 for xi, 1 for eta, 2 for zeta.
pub(super) const NODE: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// Index among the seven coefficients of each pattern, in the order of [`shape::HOURGLASS`]: `xi eta`,
/// `eta zeta`, `xi zeta`, `xi eta zeta`.
pub(super) const PATTERNS: [usize; 4] = [2, 5, 4, 6];

#[repr(C, align(64))]
pub(super) struct Block<T: Scalar> {
    /// `B_k`, [3 k + j], 1/m.
    pub vectors: [T::Lanes; 21],
    /// `X_m`, [3 m + j], m.
    pub moments: [T::Lanes; 12],
    /// Volume, m^3.
    pub weight: T::Lanes,
    /// Stiffness of the patterns, N/m.
    pub stiffness: T::Lanes,
    /// Nodes by the index bits of their corners.
    pub nodes: [T::Nodes; 8],
}

impl<T: Scalar> Block<T> {
    /// Returns a block whose lanes have no element.
    pub fn empty() -> Block<T> {
        let nodes = [T::Nodes::default(); 8];
        let (weight, stiffness) = (T::ZEROS, T::ZEROS);
        Block { vectors: [T::ZEROS; 21], moments: [T::ZEROS; 12], weight, stiffness, nodes }
    }

    /// Prefetches the block after the next two, which the passes reach next.
    #[inline(always)]
    fn fetch_ahead(&self) {
        fetch(std::ptr::from_ref(self).wrapping_add(TOGETHER));
    }
}

/// Intermediate results of a block between the passes, aligned like [`LaneStrain<T>`].
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Passed<T: Scalar> {
    /// Coefficients `c_k` of the displacements, [i][k], m; those of the patterns become `k q_m`, N.
    c: [[T::Lanes; 7]; 3],
    strain: LaneStrain<T>,
    /// Coefficients of the neo-Hookean stress.
    law: [T::Lanes; 3],
}

impl<T: Scalar> Passed<T> {
    const EMPTY: Passed<T> = Passed { c: [[T::ZEROS; 7]; 3], strain: LaneStrain::ZERO, law: [T::ZEROS; 3] };
}

/// Returns displacements relative to the first node, [i][corner], m.
///
/// # Safety
///
/// Registers of `BITS` must be available, and the block's nodes must lie within `u`.
#[inline(always)]
unsafe fn gather<const BITS: usize, T: Scalar>(block: &Block<T>, u: &[Slot<T>]) -> [[T::Lanes; 8]; 3] {
    let mut d = [[T::ZEROS; 8]; 3];
    // SAFETY: guaranteed by the caller.
    let origin = unsafe { T::lanes_of::<BITS>(u, &block.nodes[0], &[T::ZEROS; 3]) };
    for c in 1..8 {
        // SAFETY: as above.
        let lanes = unsafe { T::lanes_of::<BITS>(u, &block.nodes[c], &origin) };
        (d[0][c], d[1][c], d[2][c]) = (lanes[0], lanes[1], lanes[2]);
    }
    d
}

/// Adds the forces of the corners, [i][corner], N.
///
/// # Safety
///
/// As for [`gather`].
#[inline(always)]
unsafe fn scatter<const BITS: usize, T: Scalar>(
    block: &Block<T>,
    [x, y, z]: &[[T::Lanes; 8]; 3],
    f: &mut [Slot<T>],
) {
    for c in 0..8 {
        // SAFETY: guaranteed by the caller.
        unsafe { T::add_lanes::<BITS>([&x[c], &y[c], &z[c]], &block.nodes[c], f) };
    }
}

/// Computes the seven coefficients of one component from its corner values, of which the first is zero.
#[inline(always)]
fn coefficients<T: Scalar>(v: &[T::Lanes; 8], out: &mut [T::Lanes; 7]) {
    for l in 0..T::LANES {
        let (a0, a1) = (v[1][l], v[1][l]);
        let (a2, a3) = (v[3][l] + v[2][l], v[3][l] - v[2][l]);
        let (a4, a5) = (v[5][l] + v[4][l], v[5][l] - v[4][l]);
        let (a6, a7) = (v[7][l] + v[6][l], v[7][l] - v[6][l]);
        let ((b0, b2), (b1, b3)) = ((a2 + a0, a2 - a0), (a3 + a1, a3 - a1));
        let ((b4, b6), (b5, b7)) = ((a6 + a4, a6 - a4), (a7 + a5, a7 - a5));
        (out[0][l], out[4][l]) = (b5 + b1, b5 - b1);
        (out[1][l], out[5][l]) = (b6 + b2, b6 - b2);
        (out[2][l], out[6][l]) = (b7 + b3, b7 - b3);
        out[3][l] = b4 - b0;
    }
}

/// Computes the corner values of one component whose constant coefficient is zero: the transpose of
/// [`coefficients`] with the first corner.
#[inline(always)]
fn corners<T: Scalar>(c: &[T::Lanes; 7], out: &mut [T::Lanes; 8]) {
    for l in 0..T::LANES {
        let (b0, b4) = (-c[3][l], c[3][l]);
        let (b1, b5) = (c[0][l] - c[4][l], c[0][l] + c[4][l]);
        let (b2, b6) = (c[1][l] - c[5][l], c[1][l] + c[5][l]);
        let (b3, b7) = (c[2][l] - c[6][l], c[2][l] + c[6][l]);
        let ((a0, a2), (a1, a3)) = ((b0 - b2, b0 + b2), (b1 - b3, b1 + b3));
        let ((a4, a6), (a5, a7)) = ((b4 - b6, b4 + b6), (b5 - b7, b5 + b7));
        (out[0][l], out[1][l]) = (a0 - a1, a0 + a1);
        (out[2][l], out[3][l]) = (a2 - a3, a2 + a3);
        (out[4][l], out[5][l]) = (a4 - a5, a4 + a5);
        (out[6][l], out[7][l]) = (a6 - a7, a6 + a7);
    }
}

/// Computes `H`.
#[inline(always)]
fn strain<const FMA: bool, T: Scalar>(block: &Block<T>, c: &[[T::Lanes; 7]; 3], out: &mut LaneStrain<T>) {
    let (m, b) = (T::madd::<FMA>, &block.vectors);
    for l in 0..T::LANES {
        let mut h = [T::ZERO; 9];
        for n in 0..9 {
            let (i, j) = (n / 3, n % 3);
            let c = |k: usize| c[i][k][l];
            let b = |k: usize| b[3 * k + j][l];
            let first = m(c(0), b(0), m(c(1), b(1), c(3) * b(3)));
            let second = m(c(2), b(2), m(c(4), b(4), m(c(5), b(5), c(6) * b(6))));
            h[n] = first + second;
        }
        out.set::<FMA>(l, &h);
    }
}

/// Replaces the coefficients of the patterns of component `i` by `k q_m`.
#[inline(always)]
fn resist<const FMA: bool, T: Scalar>(block: &Block<T>, h: &[T::Lanes; 9], i: usize, c: &mut [T::Lanes; 7]) {
    let (m, x) = (T::madd::<FMA>, &block.moments);
    for l in 0..T::LANES {
        let (hx, hy, hz) = (h[3 * i][l], h[3 * i + 1][l], h[3 * i + 2][l]);
        let q = |n: usize, c: T| {
            block.stiffness[l] * (c - m(hx, x[3 * n][l], m(hy, x[3 * n + 1][l], hz * x[3 * n + 2][l])))
        };
        let [p0, p1, p2, p3] = PATTERNS;
        (c[p0][l], c[p1][l]) = (q(0, c[p0][l]), q(1, c[p1][l]));
        (c[p2][l], c[p3][l]) = (q(2, c[p2][l]), q(3, c[p3][l]));
    }
}

/// Replaces the coefficients of component `i`, of which those of the patterns are `k q_m`, by those of the
/// forces, with row `i` of `w P`.
#[inline(always)]
fn pull_back<const FMA: bool, T: Scalar>(block: &Block<T>, p: [&T::Lanes; 3], c: &mut [T::Lanes; 7]) {
    let (m, x, b) = (T::madd::<FMA>, &block.moments, &block.vectors);
    for l in 0..T::LANES {
        let [p0, p1, p2, p3] = PATTERNS;
        let (q0, q1, q2, q3) = (c[p0][l], c[p1][l], c[p2][l], c[p3][l]);
        let s = |j: usize| {
            let given = m(q0, x[j][l], m(q1, x[3 + j][l], m(q2, x[6 + j][l], q3 * x[9 + j][l])));
            p[j][l] - given
        };
        let (sx, sy, sz) = (s(0), s(1), s(2));
        let along = |k: usize| m(sx, b[3 * k][l], m(sy, b[3 * k + 1][l], sz * b[3 * k + 2][l]));
        (c[0][l], c[1][l], c[3][l]) = (along(0), along(1), along(3));
        (c[p0][l], c[p1][l]) = (q0 + along(p0), q1 + along(p1));
        (c[p2][l], c[p3][l]) = (q2 + along(p2), q3 + along(p3));
    }
}

/// Computes the coefficients of `w P` of the neo-Hookean law.
#[inline(always)]
fn neo_hookean_law<const FMA: bool, T: Scalar>(
    block: &Block<T>,
    Moduli { mu, lambda }: Moduli<T>,
    strain: &LaneStrain<T>,
    out: &mut [T::Lanes; 3],
) {
    for l in 0..T::LANES {
        let (x, _) = strain.invariants(l);
        let c = x.stress::<FMA>(block.weight[l], mu, lambda);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

/// Computes `w P` of the neo-Hookean law.
#[inline(always)]
fn weighted_piola<const FMA: bool, T: Scalar>(
    strain: &LaneStrain<T>,
    law: &[T::Lanes; 3],
    out: &mut [T::Lanes; 9],
) {
    for l in 0..T::LANES {
        let (_, minors) = strain.invariants(l);
        let p = piola::<FMA, _>(&strain.lane(l), minors, [law[0][l], law[1][l], law[2][l]]);
        for k in 0..9 {
            out[k][l] = p[k];
        }
    }
}

#[inline(always)]
fn weighted<T: Scalar>(weight: &T::Lanes, p: &mut [T::Lanes; 9]) {
    for p in p {
        for l in 0..T::LANES {
            p[l] = weight[l] * p[l];
        }
    }
}

/// Makes the first pass of a block: coefficients, `H` and patterns.
#[inline(always)]
fn strained<const FMA: bool, const BITS: usize, T: Scalar>(
    block: &Block<T>,
    u: &[Slot<T>],
    x: &mut Passed<T>,
    good: &mut T::Lanes,
) {
    block.fetch_ahead();
    // SAFETY: the nodes were checked, and a kernel runs with the registers of its path.
    let d = unsafe { gather::<BITS, T>(block, u) };
    for i in 0..3 {
        coefficients::<T>(&d[i], &mut x.c[i]);
    }
    strain::<FMA, T>(block, &x.c, &mut x.strain);
    x.strain.check(good);
    for i in 0..3 {
        resist::<FMA, T>(block, &x.strain.h, i, &mut x.c[i]);
    }
}

/// Makes the last pass of a block: adds the forces of the stress `w P` and of the patterns.
#[inline(always)]
fn forced<const FMA: bool, const BITS: usize, T: Scalar>(
    block: &Block<T>,
    p: &[T::Lanes; 9],
    x: &mut Passed<T>,
    f: &mut [Slot<T>],
) {
    let mut out = [[T::ZEROS; 8]; 3];
    for i in 0..3 {
        pull_back::<FMA, T>(block, [&p[3 * i], &p[3 * i + 1], &p[3 * i + 2]], &mut x.c[i]);
        corners::<T>(&x.c[i], &mut out[i]);
    }
    // SAFETY: as in `strained`.
    unsafe { scatter::<BITS, T>(block, &out, f) };
}

/// Checks that all nodes of the blocks lie within the given number of slots.
#[inline(always)]
fn check<T: Scalar>(blocks: &[Block<T>], slots: usize) {
    for block in blocks {
        assert!(within::<T>(&block.nodes, slots), "a node outside the chunk's slots");
    }
}

/// Adds internal forces of blocks of one law to `f`. Returns false if `J` is not positive somewhere.
pub(super) fn internal<T: Scalar>(
    path: LanePath,
    blocks: &[Block<T>],
    law: &LaneLaw,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    match law {
        LaneLaw::NeoHookean(moduli) => neo_hookean(path, blocks, moduli.of(), u, f),
        LaneLaw::Other(law, _) => other(path, path, blocks, law, u, f),
    }
}

on_path! {
    /// Adds the forces of the neo-Hookean law.
    fn neo_hookean<; T: [Scalar]>(blocks: &[Block<T>], moduli: Moduli<T>, u: &[Slot<T>], f: &mut [Slot<T>]) -> bool = neo_hookean_lanes::<BITS>
}

#[inline(always)]
fn neo_hookean_lanes<const FMA: bool, const BITS: usize, T: Scalar>(
    blocks: &[Block<T>],
    moduli: Moduli<T>,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    let mut good = T::ONES;
    let mut passed = [Passed::EMPTY; TOGETHER];
    let mut p = [T::ZEROS; 9];
    for blocks in blocks.chunks(TOGETHER) {
        check(blocks, u.len().min(f.len()));
        for (block, x) in blocks.iter().zip(&mut passed) {
            strained::<FMA, BITS, T>(block, u, x, &mut good);
        }
        for (block, x) in blocks.iter().zip(&mut passed) {
            neo_hookean_law::<FMA, T>(block, moduli, &x.strain, &mut x.law);
        }
        for (block, x) in blocks.iter().zip(&mut passed) {
            weighted_piola::<FMA, T>(&x.strain, &x.law, &mut p);
            forced::<FMA, BITS, T>(block, &p, x, f);
        }
    }
    good == T::ONES
}

on_path! {
    /// Adds the forces of any other law.
    fn other<; T: [Scalar]>(path: LanePath, blocks: &[Block<T>], law: &Law, u: &[Slot<T>], f: &mut [Slot<T>]) -> bool = other_lanes::<BITS>
}

#[inline(always)]
fn other_lanes<const FMA: bool, const BITS: usize, T: Scalar>(
    path: LanePath,
    blocks: &[Block<T>],
    law: &Law,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    let mut good = T::ONES;
    let mut passed = [Passed::EMPTY; TOGETHER];
    let mut strains = [LaneStrain::ZERO; TOGETHER];
    let mut p = [[T::ZEROS; 9]; TOGETHER];
    for blocks in blocks.chunks(TOGETHER) {
        check(blocks, u.len().min(f.len()));
        for ((block, x), strain) in blocks.iter().zip(&mut passed).zip(&mut strains) {
            strained::<FMA, BITS, T>(block, u, x, &mut good);
            *strain = x.strain;
        }
        stress(path, law, &strains[..blocks.len()], &mut p);
        for ((block, x), p) in blocks.iter().zip(&mut passed).zip(&mut p) {
            weighted::<T>(&block.weight, p);
            forced::<FMA, BITS, T>(block, p, x, f);
        }
    }
    good == T::ONES
}
