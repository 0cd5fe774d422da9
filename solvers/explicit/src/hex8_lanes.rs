//! Kernels of the trilinear hexahedron: eight elements in the lanes of one block.
//!
//! The kernels make three passes over the eight points: `H` with its invariants, the law, and the stress
//! carried back. In a single pass a point is a chain of some 150 cycles that fills the out-of-order window of
//! the processor. In separate passes the points overlap, and with one dilation per element the second half
//! reuses `H` of the first half (together 0.70 and 0.57 of the time). The last pass consists of products, at
//! one vector per cycle. The sums and shuffles of the next block's gather fit between them (0.95 of the
//! time).
//!
//! Every loop over lanes is in a function of its own. Arrays passed by reference are known not to overlap;
//! without that knowledge a loop of eight stays scalar, at three times the time.

use super::chunks::Slot;
use super::moduli::{LaneLaw, Moduli, close_group, stress};
use super::quad::{add_lanes, lanes_of, within};
use super::trilinear::{slopes, slopes_back, value_at};
use lanes::{LanePath, fetch, madd, on_path};
use material::lane::invariants::{Coefficients, add_cofactor, piola, pressed};
use material::lane::{LANES, LaneStrain, Lanes};
use material::{Law, Volumetric};

/// Block of eight elements; points and nodes are indexed by corner bits.
#[repr(C, align(64))]
pub(super) struct Block {
    pub points: [Point; 8],
    pub nodes: [[u16; LANES]; 8],
}

/// Map `A_q / 8`, [3 beta + j], and weight of a point.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub map: [Lanes; 9],
    pub weight: Lanes,
}

impl Point {
    pub const EMPTY: Point = Point { map: [[0.0; LANES]; 9], weight: [0.0; LANES] };
}

/// Intermediate results of the passes. The alignment keeps 64-byte registers within cache lines.
#[repr(align(64))]
struct Scratch {
    /// Displacements of the nodes relative to the first node, [component][corner bits], m.
    u: [[Lanes; 8]; 3],
    /// Forces of the nodes, [component][corner bits], N.
    f: [[Lanes; 8]; 3],
    /// Derivatives `8 du_i/dxi_beta`, [i][beta][value].
    slopes: [[[Lanes; 4]; 3]; 3],
    /// Strains of the points. In the last pass `H` is replaced by `S_i beta = sum_j w P_ij A_j beta`, [3 i +
    /// beta].
    points: [LaneStrain; 8],
    /// Coefficients of the stress at the points.
    coefficients: [[Lanes; 3]; 8],
    /// Stress at the points, for laws with their own lane code, Pa.
    stress: [[Lanes; 9]; 8],
    /// Sums of each element: volume, `w (J - 1)`, `w mu b`.
    sums: [Lanes; 3],
    /// Shared values of each element: `J^(2/3)` and `p`.
    shared: [Lanes; 2],
}

impl Scratch {
    const EMPTY: Scratch = Scratch {
        u: [[[0.0; LANES]; 8]; 3],
        f: [[[0.0; LANES]; 8]; 3],
        slopes: [[[[0.0; LANES]; 4]; 3]; 3],
        points: [LaneStrain::ZERO; 8],
        coefficients: [[[0.0; LANES]; 3]; 8],
        stress: [[[0.0; LANES]; 9]; 8],
        sums: [[0.0; LANES]; 3],
        shared: [[0.0; LANES]; 2],
    };
}

/// Gathers the displacements of node `k` relative to the first node.
#[inline(always)]
fn gather<const BITS: usize>(block: &Block, k: usize, u: &[Slot], nodal: &mut [[Lanes; 8]; 3]) {
    assert!(within(&[block.nodes[0], block.nodes[k]], u.len()));
    // SAFETY: the nodes were checked above, and a kernel runs with the registers of its path.
    let lanes = unsafe {
        let origin = lanes_of::<BITS>(u, &block.nodes[0], &[[0.0; LANES]; 3]);
        lanes_of::<BITS>(u, &block.nodes[k], &origin)
    };
    for i in 0..3 {
        nodal[i][k] = lanes[i];
    }
}

/// Computes the derivatives of one component.
#[inline(always)]
fn derivatives(v: &[Lanes; 8], [x, y, z]: &mut [[Lanes; 4]; 3]) {
    for l in 0..LANES {
        // Values are relative to the first node.
        let d = slopes([0.0, v[1][l], v[2][l], v[3][l], v[4][l], v[5][l], v[6][l], v[7][l]]);
        (x[0][l], x[1][l], x[2][l], x[3][l]) = (d[0][0], d[0][1], d[0][2], d[0][3]);
        (y[0][l], y[1][l], y[2][l], y[3][l]) = (d[1][0], d[1][1], d[1][2], d[1][3]);
        (z[0][l], z[1][l], z[2][l], z[3][l]) = (d[2][0], d[2][1], d[2][2], d[2][3]);
    }
}

/// Computes `H_ij = sum_beta du_i/dxi_beta A_j beta` at the point with corner bits `q`.
#[inline(always)]
fn strain<const FMA: bool>(d: &[[[Lanes; 4]; 3]; 3], map: &[Lanes; 9], q: usize, out: &mut LaneStrain) {
    let m = madd::<FMA>;
    let v = [value_at(0, q) & 3, value_at(1, q) & 3, value_at(2, q) & 3];
    for l in 0..LANES {
        let mut h = [0.0; 9];
        for i in 0..3 {
            let (x, y, z) = (d[i][0][v[0]][l], d[i][1][v[1]][l], d[i][2][v[2]][l]);
            for j in 0..3 {
                h[3 * i + j] = m(x, map[j][l], m(y, map[3 + j][l], z * map[6 + j][l]));
            }
        }
        out.set::<FMA>(l, &h);
    }
}

/// Computes the stress coefficients of a point. `good` becomes 0 in lanes in which `J` is not positive.
#[inline(always)]
fn law<const FMA: bool>(
    w: &Lanes,
    Moduli { mu, lambda }: Moduli,
    strain: &LaneStrain,
    out: &mut [Lanes; 3],
    good: &mut Lanes,
) {
    for l in 0..LANES {
        let (x, _) = strain.invariants(l);
        good[l] = if 1.0 + x.j > 0.0 { good[l] } else { 0.0 };
        let c = x.stress::<FMA>(w[l], mu, lambda);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

/// Computes the coefficients as [`law`] without the shared dilation, and adds the point's parts of volume,
/// `w (J - 1)` and `w mu b` to `sums`.
#[inline(always)]
fn isochoric<const FMA: bool>(
    w: &Lanes,
    mu: f64,
    strain: &LaneStrain,
    out: &mut [Lanes; 3],
    sums: &mut [Lanes; 3],
    good: &mut Lanes,
) {
    for l in 0..LANES {
        let (x, _) = strain.invariants(l);
        good[l] = if 1.0 + x.j > 0.0 { good[l] } else { 0.0 };
        let (b, c) = x.isochoric::<FMA>(&strain.lane(l), w[l] * mu);
        sums[0][l] += w[l];
        sums[1][l] = madd::<FMA>(w[l], x.j, sums[1][l]);
        sums[2][l] = madd::<FMA>(w[l] * mu, b, sums[2][l]);
        (out[0][l], out[1][l], out[2][l]) = (c[0], c[1], c[2]);
    }
}

/// Adds the point's parts of volume and `w (J - 1)` to `sums`.
#[inline(always)]
fn volumes<const FMA: bool>(w: &Lanes, strain: &LaneStrain, sums: &mut [Lanes; 3]) {
    for l in 0..LANES {
        let (x, _) = strain.invariants(l);
        sums[0][l] += w[l];
        sums[1][l] = madd::<FMA>(w[l], x.j, sums[1][l]);
    }
}

/// Computes `J^(2/3)` and `p` of the elements.
#[inline(always)]
fn share<const FMA: bool>(sums: &[Lanes; 3], [mu, lambda, quadratic]: [f64; 3], out: &mut [Lanes; 2]) {
    for l in 0..LANES {
        let v = sums[0][l];
        // An unused lane has no volume.
        let per_volume = if v > 0.0 { 1.0 / v } else { 0.0 };
        let [s, p] = close_group::<FMA>(
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
fn pull_back<const FMA: bool>(
    map: &[Lanes; 9],
    strain: &mut LaneStrain,
    coefficients: impl Fn(usize, &[f64; 9]) -> Coefficients,
) {
    for l in 0..LANES {
        let (at, (_, minors)) = (strain.lane(l), strain.invariants(l));
        let p = piola::<FMA>(&at, minors, coefficients(l, &at));
        pull_back_lane::<FMA>(map, &p, l, &mut strain.h);
    }
}

/// Replaces `H` as [`pull_back`], for the stress `p` and the pressure of the element.
#[inline(always)]
fn pull_back_stress<const FMA: bool>(
    point: &Point,
    p: &[Lanes; 9],
    pressure: Option<&Lanes>,
    strain: &mut LaneStrain,
) {
    for l in 0..LANES {
        let w = point.weight[l];
        let mut wp = [0.0; 9];
        for k in 0..9 {
            wp[k] = w * p[k][l];
        }
        if let Some(pressure) = pressure {
            let (x, minors) = strain.invariants(l);
            add_cofactor::<FMA>(&strain.lane(l), minors, x.trace, w * pressure[l], &mut wp);
        }
        pull_back_lane::<FMA>(&point.map, &wp, l, &mut strain.h);
    }
}

#[inline(always)]
fn pull_back_lane<const FMA: bool>(map: &[Lanes; 9], p: &[f64; 9], l: usize, out: &mut [Lanes; 9]) {
    let m = madd::<FMA>;
    for i in 0..3 {
        for beta in 0..3 {
            let (x, y, z) = (map[3 * beta][l], map[3 * beta + 1][l], map[3 * beta + 2][l]);
            out[3 * i + beta][l] = m(p[3 * i], x, m(p[3 * i + 1], y, p[3 * i + 2] * z));
        }
    }
}

/// Applies the transpose of [`derivatives`], for component `i`.
#[inline(always)]
fn derivatives_back(s: &[LaneStrain; 8], i: usize, out: &mut [Lanes; 8]) {
    for l in 0..LANES {
        // Each value belongs to the two points along the axis on which it does not depend.
        let two = |beta: usize, a: usize, b: usize| s[a].h[3 * i + beta][l] + s[b].h[3 * i + beta][l];
        let v = slopes_back(&[
            [two(0, 0, 1), two(0, 2, 3), two(0, 4, 5), two(0, 6, 7)],
            [two(1, 0, 2), two(1, 1, 3), two(1, 4, 6), two(1, 5, 7)],
            [two(2, 0, 4), two(2, 1, 5), two(2, 2, 6), two(2, 3, 7)],
        ]);
        (out[0][l], out[1][l], out[2][l], out[3][l]) = (v[0], v[1], v[2], v[3]);
        (out[4][l], out[5][l], out[6][l], out[7][l]) = (v[4], v[5], v[6], v[7]);
    }
}

#[inline(always)]
fn scatter<const BITS: usize>(block: &Block, [x, y, z]: &[[Lanes; 8]; 3], f: &mut [Slot]) {
    assert!(within(&block.nodes, f.len()));
    for k in 0..8 {
        // SAFETY: as in `gather`.
        unsafe { add_lanes::<BITS>(&x[k], &y[k], &z[k], &block.nodes[k], f) };
    }
}

/// Computes `H` and invariants of the points from the gathered displacements.
#[inline(always)]
fn strains<const FMA: bool>(block: &Block, x: &mut Scratch) {
    for i in 0..3 {
        derivatives(&x.u[i], &mut x.slopes[i]);
    }
    for q in 0..8 {
        strain::<FMA>(&x.slopes, &block.points[q].map, q, &mut x.points[q]);
    }
}

/// Computes nodal forces from `S` of the points, and adds them to `f`.
#[inline(always)]
fn forces<const FMA: bool, const BITS: usize>(block: &Block, x: &mut Scratch, f: &mut [Slot]) {
    for i in 0..3 {
        derivatives_back(&x.points, i, &mut x.f[i]);
    }
    scatter::<BITS>(block, &x.f, f);
}

on_path! {
    /// Adds internal forces of blocks (at least one) of one law to `f`. Returns false if `J` is not positive
    /// somewhere.
    pub(super) fn internal(path: LanePath, blocks: &[Block], law: &LaneLaw, u: &[Slot], f: &mut [Slot]) -> bool = internal_lanes::<BITS>
}

#[inline(always)]
fn internal_lanes<const FMA: bool, const BITS: usize>(
    path: LanePath,
    blocks: &[Block],
    law: &LaneLaw,
    u: &[Slot],
    f: &mut [Slot],
) -> bool {
    match law {
        LaneLaw::NeoHookean(moduli) => neo_hookean::<FMA, BITS>(blocks, *moduli, u, f),
        LaneLaw::Other(law, _) => other::<FMA, BITS>(path, blocks, law, None, u, f),
    }
}

on_path! {
    /// Adds internal forces as [`internal`], with one dilation per element, the mean over its points.
    pub(super) fn dilated(path: LanePath, blocks: &[Block], law: &LaneLaw, u: &[Slot], f: &mut [Slot]) -> bool = dilated_lanes::<BITS>
}

#[inline(always)]
fn dilated_lanes<const FMA: bool, const BITS: usize>(
    path: LanePath,
    blocks: &[Block],
    law: &LaneLaw,
    u: &[Slot],
    f: &mut [Slot],
) -> bool {
    match law {
        LaneLaw::NeoHookean(moduli) => dilated_neo_hookean::<FMA, BITS>(blocks, *moduli, u, f),
        LaneLaw::Other(law, volume) => other::<FMA, BITS>(path, blocks, law, Some(volume), u, f),
    }
}

/// Computes the neo-Hookean law. [`other`] takes 1.11 (AVX2) and 1.12 (AVX-512) of the time.
#[inline(always)]
fn neo_hookean<const FMA: bool, const BITS: usize>(
    blocks: &[Block],
    moduli: Moduli,
    u: &[Slot],
    f: &mut [Slot],
) -> bool {
    let mut x = Scratch::EMPTY;
    let mut good = [1.0; LANES];
    for k in 0..8 {
        gather::<BITS>(&blocks[0], k, u, &mut x.u);
    }
    for (k, block) in blocks.iter().enumerate() {
        let next = blocks.get(k + 1).unwrap_or(block);
        strains::<FMA>(block, &mut x);
        for q in 0..8 {
            law::<FMA>(&block.points[q].weight, moduli, &x.points[q], &mut x.coefficients[q], &mut good);
        }
        for q in 0..8 {
            fetch(&next.points[q]);
            gather::<BITS>(next, q, u, &mut x.u);
            let c = &x.coefficients[q];
            pull_back::<FMA>(&block.points[q].map, &mut x.points[q], |l, _| [c[0][l], c[1][l], c[2][l]]);
        }
        forces::<FMA, BITS>(block, &mut x, f);
    }
    good == [1.0; LANES]
}

#[inline(always)]
fn dilated_neo_hookean<const FMA: bool, const BITS: usize>(
    blocks: &[Block],
    moduli: Moduli,
    u: &[Slot],
    f: &mut [Slot],
) -> bool {
    let mut x = Scratch::EMPTY;
    let mut good = [1.0; LANES];
    for k in 0..8 {
        gather::<BITS>(&blocks[0], k, u, &mut x.u);
    }
    for (k, block) in blocks.iter().enumerate() {
        let next = blocks.get(k + 1).unwrap_or(block);
        strains::<FMA>(block, &mut x);
        x.sums = [[0.0; LANES]; 3];
        for q in 0..8 {
            let w = &block.points[q].weight;
            isochoric::<FMA>(w, moduli.mu, &x.points[q], &mut x.coefficients[q], &mut x.sums, &mut good);
        }
        share::<FMA>(&x.sums, [moduli.mu, moduli.lambda, 0.0], &mut x.shared);
        for q in 0..8 {
            fetch(&next.points[q]);
            gather::<BITS>(next, q, u, &mut x.u);
            let w = &block.points[q].weight;
            let c = &x.coefficients[q];
            let [s, p] = &x.shared;
            pull_back::<FMA>(&block.points[q].map, &mut x.points[q], |l, h| {
                pressed::<FMA>([c[0][l], c[1][l], c[2][l]], h[0] + h[4] + h[8], s[l], w[l] * p[l])
            });
        }
        forces::<FMA, BITS>(block, &mut x, f);
    }
    good == [1.0; LANES]
}

/// Computes any other law point by point; the mean dilation acts on its `volume`.
#[inline(always)]
fn other<const FMA: bool, const BITS: usize>(
    path: LanePath,
    blocks: &[Block],
    law: &Law,
    volume: Option<&Volumetric>,
    u: &[Slot],
    f: &mut [Slot],
) -> bool {
    let mut x = Scratch::EMPTY;
    let mut good = [1.0; LANES];
    for k in 0..8 {
        gather::<BITS>(&blocks[0], k, u, &mut x.u);
    }
    for (k, block) in blocks.iter().enumerate() {
        let next = blocks.get(k + 1).unwrap_or(block);
        strains::<FMA>(block, &mut x);
        for q in 0..8 {
            x.points[q].check(&mut good);
        }
        if let Some(volume) = volume {
            x.sums = [[0.0; LANES]; 3];
            for q in 0..8 {
                volumes::<FMA>(&block.points[q].weight, &x.points[q], &mut x.sums);
            }
            share::<FMA>(&x.sums, [0.0, volume.logarithmic, volume.quadratic], &mut x.shared);
        }
        let pressure = volume.map(|_| &x.shared[1]);
        stress(path, law, &x.points, &mut x.stress);
        for q in 0..8 {
            fetch(&next.points[q]);
            gather::<BITS>(next, q, u, &mut x.u);
            pull_back_stress::<FMA>(&block.points[q], &x.stress[q], pressure, &mut x.points[q]);
        }
        forces::<FMA, BITS>(block, &mut x, f);
    }
    good == [1.0; LANES]
}
