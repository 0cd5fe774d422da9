//! Kernels of cells with several points: one element in each lane of a block.
//!
//! The kernels make three passes over the points: `H` with its invariants, the law, and the stress carried
//! back. In a single pass a point is a chain of some 150 cycles that fills the out-of-order window of the
//! processor. In separate passes the points overlap, and with one dilation per element the second half
//! reuses `H` of the first half (together 0.70 and 0.57 of the time of hex8). The last pass consists of
//! products, at one vector per cycle. The sums and shuffles of the next block's gather fit between them (0.95
//! of the time).
//!
//! Every loop over lanes is in a function of its own. Arrays passed by reference are known not to overlap;
//! without that knowledge a loop of eight stays scalar, at three times the time.

use super::moduli::{LaneLaw, Moduli, VolumeModuli, close_group, stress};
use super::scalar::{Scalar, Slot, within};
use lanes::{LanePath, fetch, on_path};
use material::Law;
use material::lane::LaneStrain;
use material::lane::invariants::{Coefficients, add_cofactor, piola, pressed};
use shape::{Matrix3, VolumeRows};

/// Kind of cell: derivatives of the displacement at its `Q` points from the displacements of its `N` nodes,
/// and the transpose.
pub(super) trait Cell<T: Scalar, const N: usize, const Q: usize>: Sized + Send + Sync {
    /// Values that the points share.
    type Slopes;
    /// Initial values.
    const SLOPES: Self::Slopes;
    /// Index of each node in the rows of the table.
    const NODE: [usize; N];

    /// Fits the rows of a table. Returns the cell, the place of each point of a cell in its blocks, and the
    /// map `A_q` of every row, for which `grad N_a = A_q t_a` with the same `t_a` in all cells. Returns
    /// `None` if the rows are not such cells.
    fn fitted(volume: &VolumeRows) -> Option<(Self, [usize; Q], Vec<Matrix3>)>;

    /// Computes what the points share from the displacements relative to the first node,
    /// [component][node], m.
    fn slopes(&self, u: &[[T::Lanes; N]; 3], out: &mut Self::Slopes);

    /// Computes `H_ij = sum_a u_ai (A t_a)_j` at point `q`, with the map [3 beta + j].
    fn strain<const FMA: bool>(
        &self,
        u: &[[T::Lanes; N]; 3],
        slopes: &Self::Slopes,
        map: &[T::Lanes; 9],
        q: usize,
        out: &mut LaneStrain<T>,
    );

    /// Computes the nodal forces `f_ai = sum_q sum_beta S_i beta t_a beta`, [component][node], N. The `h` of
    /// each point is `S`, [3 i + beta].
    fn forces<const FMA: bool>(&self, points: &[LaneStrain<T>; Q], f: &mut [[T::Lanes; N]; 3]);
}

/// Block of one element in each lane.
#[repr(C, align(64))]
pub(super) struct Block<T: Scalar, const N: usize, const Q: usize> {
    pub points: [Point<T>; Q],
    pub nodes: [T::Nodes; N],
}

impl<T: Scalar, const N: usize, const Q: usize> Block<T, N, Q> {
    pub fn empty() -> Block<T, N, Q> {
        Block { points: [Point::EMPTY; Q], nodes: [T::Nodes::default(); N] }
    }
}

/// Map `A_q`, [3 beta + j], and weight of a point.
#[derive(Clone, Copy)]
pub(super) struct Point<T: Scalar> {
    pub map: [T::Lanes; 9],
    pub weight: T::Lanes,
}

impl<T: Scalar> Point<T> {
    pub const EMPTY: Point<T> = Point { map: [T::ZEROS; 9], weight: T::ZEROS };
}

/// Intermediate results of the passes. The alignment keeps 64-byte registers within cache lines.
#[repr(align(64))]
struct Scratch<T: Scalar, const N: usize, const Q: usize, S> {
    /// Displacements of the nodes relative to the first node, [component][node], m.
    u: [[T::Lanes; N]; 3],
    /// Forces of the nodes, [component][node], N.
    f: [[T::Lanes; N]; 3],
    slopes: S,
    /// Strains of the points. In the last pass `H` is replaced by `S_i beta = sum_j w P_ij A_j beta`, [3 i +
    /// beta].
    points: [LaneStrain<T>; Q],
    /// Coefficients of the stress at the points.
    coefficients: [[T::Lanes; 3]; Q],
    /// Stress at the points, for laws with their own lane code, Pa.
    stress: [[T::Lanes; 9]; Q],
    /// Sums of each element: volume, `w (J - 1)`, `w mu b`.
    sums: [T::Lanes; 3],
    /// Shared values of each element: `J^(2/3)` and `p`.
    shared: [T::Lanes; 2],
}

impl<T: Scalar, const N: usize, const Q: usize, S> Scratch<T, N, Q, S> {
    /// Starts with the displacements of the first block.
    #[inline(always)]
    fn new<const BITS: usize>(slopes: S, first: &Block<T, N, Q>, u: &[Slot<T>]) -> Scratch<T, N, Q, S> {
        let mut scratch = Scratch {
            u: [[T::ZEROS; N]; 3],
            f: [[T::ZEROS; N]; 3],
            slopes,
            points: [LaneStrain::ZERO; Q],
            coefficients: [[T::ZEROS; 3]; Q],
            stress: [[T::ZEROS; 9]; Q],
            sums: [T::ZEROS; 3],
            shared: [T::ZEROS; 2],
        };
        for k in 0..N {
            gather::<BITS, T, N, Q>(first, k, u, &mut scratch.u);
        }
        scratch
    }
}

/// Gathers the displacements of node `k` relative to the first node.
#[inline(always)]
fn gather<const BITS: usize, T: Scalar, const N: usize, const Q: usize>(
    block: &Block<T, N, Q>,
    k: usize,
    u: &[Slot<T>],
    nodal: &mut [[T::Lanes; N]; 3],
) {
    assert!(within::<T>(&[block.nodes[0], block.nodes[k]], u.len()));
    // SAFETY: the nodes were checked above, and a kernel runs with the registers of its path.
    let lanes = unsafe {
        let origin = T::lanes_of::<BITS>(u, &block.nodes[0], &[T::ZEROS; 3]);
        T::lanes_of::<BITS>(u, &block.nodes[k], &origin)
    };
    for i in 0..3 {
        nodal[i][k] = lanes[i];
    }
}

/// Fetches point `q` of a block and gathers the part of its nodes that belongs to this point.
#[inline(always)]
fn prepare<const BITS: usize, T: Scalar, const N: usize, const Q: usize>(
    next: &Block<T, N, Q>,
    q: usize,
    u: &[Slot<T>],
    nodal: &mut [[T::Lanes; N]; 3],
) {
    fetch(&next.points[q]);
    for k in q * N / Q..(q + 1) * N / Q {
        gather::<BITS, T, N, Q>(next, k, u, nodal);
    }
}

/// Computes the stress coefficients of a point. `good` becomes 0 in lanes in which `J` is not positive.
#[inline(always)]
fn law<const FMA: bool, T: Scalar>(
    w: &T::Lanes,
    Moduli { mu, lambda }: Moduli<T>,
    strain: &LaneStrain<T>,
    out: &mut [T::Lanes; 3],
    good: &mut T::Lanes,
) {
    for l in 0..T::LANES {
        let (x, _) = strain.invariants(l);
        good[l] = if T::ONE + x.j > T::ZERO { good[l] } else { T::ZERO };
        let c = x.stress::<FMA>(w[l], mu, lambda);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

/// Computes the coefficients as [`law`] without the shared dilation, and adds the point's parts of volume,
/// `w (J - 1)` and `w mu b` to `sums`.
#[inline(always)]
fn isochoric<const FMA: bool, T: Scalar>(
    w: &T::Lanes,
    mu: T,
    strain: &LaneStrain<T>,
    out: &mut [T::Lanes; 3],
    sums: &mut [T::Lanes; 3],
    good: &mut T::Lanes,
) {
    for l in 0..T::LANES {
        let (x, _) = strain.invariants(l);
        good[l] = if T::ONE + x.j > T::ZERO { good[l] } else { T::ZERO };
        let (b, c) = x.isochoric::<FMA>(&strain.lane(l), w[l] * mu);
        sums[0][l] += w[l];
        sums[1][l] = T::madd::<FMA>(w[l], x.j, sums[1][l]);
        sums[2][l] = T::madd::<FMA>(w[l] * mu, b, sums[2][l]);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

/// Adds the point's parts of volume and `w (J - 1)` to `sums`.
#[inline(always)]
fn volumes<const FMA: bool, T: Scalar>(w: &T::Lanes, strain: &LaneStrain<T>, sums: &mut [T::Lanes; 3]) {
    for l in 0..T::LANES {
        let (x, _) = strain.invariants(l);
        sums[0][l] += w[l];
        sums[1][l] = T::madd::<FMA>(w[l], x.j, sums[1][l]);
    }
}

/// Computes `J^(2/3)` and `p` of the elements.
#[inline(always)]
fn share<const FMA: bool, T: Scalar>(
    sums: &[T::Lanes; 3],
    [mu, lambda, quadratic]: [T; 3],
    out: &mut [T::Lanes; 2],
) {
    for l in 0..T::LANES {
        let v = sums[0][l];
        // An unused lane has no volume.
        let per_volume = if v > T::ZERO { T::ONE / v } else { T::ZERO };
        let [s, p] = close_group::<FMA, T>(
            sums[1][l] * per_volume,
            sums[2][l],
            per_volume,
            [v * mu, v * lambda, v * quadratic],
        );
        (out[0][l], out[1][l]) = (s, p);
    }
}

/// Replaces `H` of one point by `S_i beta`.
#[inline(always)]
fn pull_back<const FMA: bool, T: Scalar>(
    map: &[T::Lanes; 9],
    strain: &mut LaneStrain<T>,
    coefficients: impl Fn(usize, &[T; 9]) -> Coefficients<T>,
) {
    for l in 0..T::LANES {
        let (at, (_, minors)) = (strain.lane(l), strain.invariants(l));
        let p = piola::<FMA, _>(&at, minors, coefficients(l, &at));
        pull_back_lane::<FMA, T>(map, &p, l, &mut strain.h);
    }
}

/// Replaces `H` as [`pull_back`], for the stress `p` and the pressure of the element.
#[inline(always)]
fn pull_back_stress<const FMA: bool, T: Scalar>(
    point: &Point<T>,
    p: &[T::Lanes; 9],
    pressure: Option<&T::Lanes>,
    strain: &mut LaneStrain<T>,
) {
    for l in 0..T::LANES {
        let w = point.weight[l];
        let mut wp = [T::ZERO; 9];
        for k in 0..9 {
            wp[k] = w * p[k][l];
        }
        if let Some(pressure) = pressure {
            let (x, minors) = strain.invariants(l);
            add_cofactor::<FMA, _>(&strain.lane(l), minors, x.trace, w * pressure[l], &mut wp);
        }
        pull_back_lane::<FMA, T>(&point.map, &wp, l, &mut strain.h);
    }
}

#[inline(always)]
fn pull_back_lane<const FMA: bool, T: Scalar>(
    map: &[T::Lanes; 9],
    p: &[T; 9],
    l: usize,
    out: &mut [T::Lanes; 9],
) {
    let m = T::madd::<FMA>;
    for i in 0..3 {
        for beta in 0..3 {
            let (x, y, z) = (map[3 * beta][l], map[3 * beta + 1][l], map[3 * beta + 2][l]);
            out[3 * i + beta][l] = m(p[3 * i], x, m(p[3 * i + 1], y, p[3 * i + 2] * z));
        }
    }
}

#[inline(always)]
fn scatter<const BITS: usize, T: Scalar, const N: usize>(
    nodes: &[T::Nodes; N],
    [x, y, z]: &[[T::Lanes; N]; 3],
    f: &mut [Slot<T>],
) {
    assert!(within::<T>(nodes, f.len()));
    for k in 0..N {
        // SAFETY: as in `gather`.
        unsafe { T::add_lanes::<BITS>([&x[k], &y[k], &z[k]], &nodes[k], f) };
    }
}

/// Computes `H` and invariants of the points from the gathered displacements.
#[inline(always)]
fn strains<const FMA: bool, const N: usize, const Q: usize, T: Scalar, C: Cell<T, N, Q>>(
    cell: &C,
    block: &Block<T, N, Q>,
    x: &mut Scratch<T, N, Q, C::Slopes>,
) {
    cell.slopes(&x.u, &mut x.slopes);
    for q in 0..Q {
        cell.strain::<FMA>(&x.u, &x.slopes, &block.points[q].map, q, &mut x.points[q]);
    }
}

/// Computes nodal forces from `S` of the points, and adds them to `f`.
#[inline(always)]
fn forces<const FMA: bool, const BITS: usize, const N: usize, const Q: usize, T: Scalar, C: Cell<T, N, Q>>(
    cell: &C,
    block: &Block<T, N, Q>,
    x: &mut Scratch<T, N, Q, C::Slopes>,
    f: &mut [Slot<T>],
) {
    cell.forces::<FMA>(&x.points, &mut x.f);
    scatter::<BITS, T, N>(&block.nodes, &x.f, f);
}

on_path! {
    /// Adds internal forces of blocks (at least one) of one law to `f`. Returns false if `J` is not positive
    /// somewhere.
    pub(super) fn internal<const N: usize, const Q: usize; T: [Scalar], C: [Cell<T, N, Q>]>(path: LanePath, cell: &C, blocks: &[Block<T, N, Q>], law: &LaneLaw, u: &[Slot<T>], f: &mut [Slot<T>]) -> bool = internal_lanes::<BITS>
}

#[inline(always)]
fn internal_lanes<
    const FMA: bool,
    const BITS: usize,
    const N: usize,
    const Q: usize,
    T: Scalar,
    C: Cell<T, N, Q>,
>(
    path: LanePath,
    cell: &C,
    blocks: &[Block<T, N, Q>],
    law: &LaneLaw,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    match law {
        LaneLaw::NeoHookean(moduli) => neo_hookean::<FMA, BITS, N, Q, T, C>(cell, blocks, moduli.of(), u, f),
        LaneLaw::Other(law, _) => other::<FMA, BITS, N, Q, T, C>(path, cell, blocks, law, None, u, f),
    }
}

on_path! {
    /// Adds internal forces as [`internal`], with one dilation per element, the mean over its points.
    pub(super) fn dilated<const N: usize, const Q: usize; T: [Scalar], C: [Cell<T, N, Q>]>(path: LanePath, cell: &C, blocks: &[Block<T, N, Q>], law: &LaneLaw, u: &[Slot<T>], f: &mut [Slot<T>]) -> bool = dilated_lanes::<BITS>
}

#[inline(always)]
fn dilated_lanes<
    const FMA: bool,
    const BITS: usize,
    const N: usize,
    const Q: usize,
    T: Scalar,
    C: Cell<T, N, Q>,
>(
    path: LanePath,
    cell: &C,
    blocks: &[Block<T, N, Q>],
    law: &LaneLaw,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    match law {
        LaneLaw::NeoHookean(moduli) => {
            dilated_neo_hookean::<FMA, BITS, N, Q, T, C>(cell, blocks, moduli.of(), u, f)
        }
        LaneLaw::Other(law, volume) => {
            other::<FMA, BITS, N, Q, T, C>(path, cell, blocks, law, Some(volume), u, f)
        }
    }
}

/// Computes the neo-Hookean law. For hex8 [`other`] takes 1.11 (AVX2) and 1.12 (AVX-512) of the time.
#[inline(always)]
fn neo_hookean<
    const FMA: bool,
    const BITS: usize,
    const N: usize,
    const Q: usize,
    T: Scalar,
    C: Cell<T, N, Q>,
>(
    cell: &C,
    blocks: &[Block<T, N, Q>],
    moduli: Moduli<T>,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    let mut x = Scratch::new::<BITS>(C::SLOPES, &blocks[0], u);
    let mut good = T::ONES;
    for (k, block) in blocks.iter().enumerate() {
        let next = blocks.get(k + 1).unwrap_or(block);
        strains::<FMA, N, Q, T, C>(cell, block, &mut x);
        for q in 0..Q {
            law::<FMA, T>(&block.points[q].weight, moduli, &x.points[q], &mut x.coefficients[q], &mut good);
        }
        for q in 0..Q {
            prepare::<BITS, T, N, Q>(next, q, u, &mut x.u);
            let c = &x.coefficients[q];
            pull_back::<FMA, T>(&block.points[q].map, &mut x.points[q], |l, _| [c[0][l], c[1][l], c[2][l]]);
        }
        forces::<FMA, BITS, N, Q, T, C>(cell, block, &mut x, f);
    }
    good == T::ONES
}

#[inline(always)]
fn dilated_neo_hookean<
    const FMA: bool,
    const BITS: usize,
    const N: usize,
    const Q: usize,
    T: Scalar,
    C: Cell<T, N, Q>,
>(
    cell: &C,
    blocks: &[Block<T, N, Q>],
    moduli: Moduli<T>,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    let mut x = Scratch::new::<BITS>(C::SLOPES, &blocks[0], u);
    let mut good = T::ONES;
    for (k, block) in blocks.iter().enumerate() {
        let next = blocks.get(k + 1).unwrap_or(block);
        strains::<FMA, N, Q, T, C>(cell, block, &mut x);
        x.sums = [T::ZEROS; 3];
        for q in 0..Q {
            let w = &block.points[q].weight;
            isochoric::<FMA, T>(w, moduli.mu, &x.points[q], &mut x.coefficients[q], &mut x.sums, &mut good);
        }
        share::<FMA, T>(&x.sums, [moduli.mu, moduli.lambda, T::ZERO], &mut x.shared);
        for q in 0..Q {
            prepare::<BITS, T, N, Q>(next, q, u, &mut x.u);
            let w = &block.points[q].weight;
            let c = &x.coefficients[q];
            let [s, p] = &x.shared;
            pull_back::<FMA, T>(&block.points[q].map, &mut x.points[q], |l, h| {
                pressed::<FMA, _>([c[0][l], c[1][l], c[2][l]], h[0] + h[4] + h[8], s[l], w[l] * p[l])
            });
        }
        forces::<FMA, BITS, N, Q, T, C>(cell, block, &mut x, f);
    }
    good == T::ONES
}

/// Computes any other law point by point; the mean dilation acts on its `volume`.
#[inline(always)]
fn other<const FMA: bool, const BITS: usize, const N: usize, const Q: usize, T: Scalar, C: Cell<T, N, Q>>(
    path: LanePath,
    cell: &C,
    blocks: &[Block<T, N, Q>],
    law: &Law,
    volume: Option<&VolumeModuli>,
    u: &[Slot<T>],
    f: &mut [Slot<T>],
) -> bool {
    let mut x = Scratch::new::<BITS>(C::SLOPES, &blocks[0], u);
    let mut good = T::ONES;
    for (k, block) in blocks.iter().enumerate() {
        let next = blocks.get(k + 1).unwrap_or(block);
        strains::<FMA, N, Q, T, C>(cell, block, &mut x);
        for q in 0..Q {
            x.points[q].check(&mut good);
        }
        if let Some(volume) = volume {
            x.sums = [T::ZEROS; 3];
            for q in 0..Q {
                volumes::<FMA, T>(&block.points[q].weight, &x.points[q], &mut x.sums);
            }
            share::<FMA, T>(
                &x.sums,
                [T::ZERO, T::of(volume.logarithmic), T::of(volume.quadratic)],
                &mut x.shared,
            );
        }
        let pressure = volume.map(|_| &x.shared[1]);
        stress(path, law, &x.points, &mut x.stress);
        for q in 0..Q {
            prepare::<BITS, T, N, Q>(next, q, u, &mut x.u);
            pull_back_stress::<FMA, T>(&block.points[q], &x.stress[q], pressure, &mut x.points[q]);
        }
        forces::<FMA, BITS, N, Q, T, C>(cell, block, &mut x, f);
    }
    good == T::ONES
}
