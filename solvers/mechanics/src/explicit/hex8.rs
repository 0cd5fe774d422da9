//! Trilinear hexahedra with 2 x 2 x 2 Gauss points, standard or with one mean dilation per element: eight elements in
//! the lanes of one block.
//!
//! At every point `grad N_a = A_q dN_a/dxi`, with `dN_a/dxi` the same for all elements: nine numbers instead of 24 are
//! stored per point (704 bytes per element instead of 1664). With the corners at `xi, eta, zeta = +-1` the eight nodal
//! values become the coefficients of 1, xi, eta, ..., xi eta zeta by sums and differences, and `du/dxi`, which does
//! not depend on xi, takes four values at the eight points: 156 operations per element and three components for what
//! would be 576. Forces go back by the transpose of each step.

use shape::DilationGroups;

use super::chunks::{Border, ChunkNodes, Slot, load, split};
use super::force::ExplicitBody;
use super::lane_math::madd;
use super::moduli::Moduli;
use super::neo_lanes::{Strained, close_group, strained};
use super::order::locality_order;
use super::path::{LANES, LanePath, on_path};
use super::quad::{add, lanes_of_differences, quads_of_lanes};
use crate::{Matrix3, Point3, Vector3};

/// Elements per chunk: some 1000 distinct nodes.
const SIZE: usize = 512;

/// Corner signs in the order of the nodes.
const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// 1 / sqrt 3.
const GAUSS: f64 = 0.577_350_269_189_625_8;

type Lanes = [f64; LANES];

pub(super) struct Hex8 {
    border: Border,
    chunks: Vec<Chunk>,
    u: Vec<Slot>,
    f: Vec<Slot>,
    mean: bool,
}

struct Chunk {
    blocks: Vec<Block>,
    runs: Vec<(usize, Moduli)>,
}

#[repr(C, align(64))]
struct Block {
    points: [Point; 8],
    nodes: [[u16; LANES]; 8],
}

/// `A_q / 8`, [3 beta + j], and the weight.
#[derive(Clone, Copy)]
struct Point {
    map: [Lanes; 9],
    weight: Lanes,
}

/// `dN_a/dxi` at the Gauss point of the given signs.
fn reference(signs: &[f64; 3]) -> [Vector3; 8] {
    let xi = signs.map(|s| s * GAUSS);
    CORNERS.map(|c| {
        let n = [0, 1, 2].map(|k| 1.0 + c[k] * xi[k]);
        Vector3::new(c[0] * n[1] * n[2], n[0] * c[1] * n[2], n[0] * n[1] * c[2]) * 0.125
    })
}

/// The `A` of `grad N_a = A dN_a/dxi` by least squares, if it leaves nothing over.
fn fit(grads: &[Vector3], table: &[Vector3; 8]) -> Option<Matrix3> {
    let (mut cross, mut square) = (Matrix3::zeros(), Matrix3::zeros());
    for (g, t) in grads.iter().zip(table) {
        cross += g * t.transpose();
        square += t * t.transpose();
    }
    let map = cross * square.try_inverse()?;
    let size = grads.iter().map(Vector3::norm).fold(0.0, f64::max);
    let fits = grads.iter().zip(table).all(|(g, t)| (g - map * t).norm() <= 1e-13 * size);
    fits.then_some(map)
}

impl Hex8 {
    /// None for anything but runs of eight points over the same eight nodes with the gradients of a trilinear
    /// hexahedron and one law, and for groups other than one per element.
    pub fn new(body: &ExplicitBody, moduli: &[Moduli]) -> Option<Hex8> {
        let (volume, rows) = (body.volume, body.volume.rows());
        let count = rows.len() / 8;
        let like = |q: usize| {
            let first = q - q % 8;
            rows.row(q).0 == rows.row(first).0 && body.region(q) == body.region(first)
        };
        if count == 0 || rows.len() % 8 != 0 || rows.uniform_len() != Some(8) || !(0..rows.len()).all(like) {
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
        // Which Gauss point comes where: lowest axis fastest, corner order, ... whatever the first element shows.
        let tables = CORNERS.map(|c| reference(&c));
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
        let chunk = |part: &ChunkNodes| Chunk::new(body, moduli, part, &maps, &place);
        let chunks = parts.iter().map(chunk).collect();
        let lists: Vec<Vec<u32>> = parts.iter().map(|p| p.nodes.clone()).collect();
        let border = Border::new(rows.node_count(), &lists);
        let slots = vec![[0.0; 4]; border.slot_count()];
        Some(Hex8 { border, chunks, u: slots.clone(), f: slots, mean: body.groups.is_some() })
    }

    pub fn name(&self) -> &'static str {
        if self.mean { "hex8 mean dilation" } else { "hex8" }
    }

    /// Internal forces; false where some `J` is not positive.
    pub fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool {
        let Hex8 { border, chunks, u: slots, f: sums, mean } = self;
        let upright = border.for_each(slots, sums, |c, slots, sums| {
            load(border.chunk(c), u, slots);
            sums.fill([0.0; 4]);
            let mut upright = true;
            if *mean {
                dilated(path, &chunks[c], slots, sums, &mut upright);
            } else {
                internal(path, &chunks[c], slots, sums, &mut upright);
            }
            upright
        });
        border.forces(sums, f);
        upright
    }
}

impl Chunk {
    fn new(
        body: &ExplicitBody,
        moduli: &[Moduli],
        part: &ChunkNodes,
        maps: &[Matrix3],
        place: &[usize],
    ) -> Chunk {
        let region = |k: &usize| body.region(8 * part.items[*k] as usize);
        let mut order: Vec<usize> = (0..part.items.len()).collect();
        order.sort_by_key(region);
        let mut chunk = Chunk { blocks: Vec::new(), runs: Vec::new() };
        for alike in order.chunk_by(|a, b| region(a) == region(b)) {
            for group in alike.chunks(LANES) {
                let empty = Point { map: [[0.0; LANES]; 9], weight: [0.0; LANES] };
                let mut block = Block { points: [empty; 8], nodes: [[0; LANES]; 8] };
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
                    for a in 0..8 {
                        block.nodes[a][l] = part.local[k][a] as u16;
                    }
                }
                chunk.blocks.push(block);
            }
            chunk.runs.push((chunk.blocks.len(), moduli[region(&alike[0]) as usize]));
        }
        chunk
    }
}

/// Sums and differences of pairs along the three axes: corner values to coefficients times eight. By index bits: bit 0
/// for xi, 1 for eta, 2 for zeta. Its own transpose up to the order, as the corner signs are symmetric.
#[inline(always)]
fn butterfly(mut v: [f64; 8]) -> [f64; 8] {
    for bit in [1, 2, 4] {
        for k in 0..8 {
            if k & bit == 0 {
                let (low, high) = (v[k], v[k | bit]);
                v[k] = high + low;
                v[k | bit] = high - low;
            }
        }
    }
    v
}

/// The transpose of [`butterfly`].
#[inline(always)]
fn butterfly_back(mut v: [f64; 8]) -> [f64; 8] {
    for bit in [1, 2, 4] {
        for k in 0..8 {
            if k & bit == 0 {
                let (sum, difference) = (v[k], v[k | bit]);
                v[k] = sum - difference;
                v[k | bit] = sum + difference;
            }
        }
    }
    v
}

/// Node at the corner of the given index bits.
const NODE: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// Index bits of the coefficients that `du/dxi_beta` has, by the signs (low, high) of the two other axes.
#[inline(always)]
const fn others(beta: usize) -> (usize, [usize; 2]) {
    match beta {
        0 => (1, [2, 4]),
        1 => (2, [1, 4]),
        _ => (4, [1, 2]),
    }
}

/// Index 0 to 3 of the value of `du/dxi_beta` at the point of corner `q` (in the order of the nodes).
#[inline(always)]
fn value_at(beta: usize, q: usize) -> usize {
    let bits = NODE[q]; // its own inverse
    let (_, [a, b]) = others(beta);
    usize::from(bits & a != 0) + 2 * usize::from(bits & b != 0)
}

/// `8 du_i/dxi_beta`, [3 i + beta][value].
#[inline(always)]
fn derivatives<const FMA: bool>(block: &Block, u: &[Slot]) -> [[Lanes; 4]; 9] {
    let mut origin = [[0.0; 4]; LANES];
    for l in 0..LANES {
        origin[l] = u[block.nodes[0][l] as usize];
    }
    let mut nodal = [[[0.0; LANES]; 3]; 8];
    for a in 1..8 {
        nodal[a] = lanes_of_differences::<FMA>(u, &block.nodes[a], &origin);
    }
    let mut d = [[[0.0; LANES]; 4]; 9];
    for i in 0..3 {
        for l in 0..LANES {
            let c = butterfly(std::array::from_fn(|k| nodal[NODE[k]][i][l]));
            for beta in 0..3 {
                let (own, [a, b]) = others(beta);
                let (flat, along_a) = (c[own], GAUSS * c[own | a]);
                let (along_b, both) = (GAUSS * c[own | b], GAUSS * GAUSS * c[7]);
                let (low, high) = ((flat - along_a, along_b - both), (flat + along_a, along_b + both));
                let d = &mut d[3 * i + beta];
                d[0][l] = low.0 - low.1;
                d[1][l] = high.0 - high.1;
                d[2][l] = low.0 + low.1;
                d[3][l] = high.0 + high.1;
            }
        }
    }
    d
}

/// The transpose of [`derivatives`], added to `f`.
#[inline(always)]
fn scatter<const FMA: bool>(block: &Block, s: &[[Lanes; 4]; 9], f: &mut [Slot]) {
    let mut nodal = [[[0.0; LANES]; 3]; 8];
    for i in 0..3 {
        for l in 0..LANES {
            let mut c = [0.0; 8];
            for beta in 0..3 {
                let (own, [a, b]) = others(beta);
                let v = &s[3 * i + beta];
                let (up, down) =
                    ((v[2][l] + v[0][l], v[3][l] + v[1][l]), (v[2][l] - v[0][l], v[3][l] - v[1][l]));
                c[own] += up.1 + up.0;
                c[own | a] += GAUSS * (up.1 - up.0);
                c[own | b] += GAUSS * (down.1 + down.0);
                c[7] += GAUSS * GAUSS * (down.1 - down.0);
            }
            let v = butterfly_back(c);
            for k in 0..8 {
                nodal[NODE[k]][i][l] = v[k];
            }
        }
    }
    for a in 0..8 {
        let quads = quads_of_lanes::<FMA>(&nodal[a][0], &nodal[a][1], &nodal[a][2]);
        for l in 0..LANES {
            add::<FMA>(&quads[l], &mut f[block.nodes[a][l] as usize]);
        }
    }
}

/// `H_ij = sum_beta du_i/dxi_beta A_j beta` at the point of corner `q`, one lane.
#[inline(always)]
fn strain<const FMA: bool>(d: &[[Lanes; 4]; 9], point: &Point, q: usize, l: usize) -> Strained {
    let value: [f64; 9] = std::array::from_fn(|k| d[k][value_at(k % 3, q)][l]);
    let m = madd::<FMA>;
    strained::<FMA>(std::array::from_fn(|k| {
        let (i, j) = (k / 3, k % 3);
        let a = |beta: usize| point.map[3 * beta + j][l];
        m(value[3 * i], a(0), m(value[3 * i + 1], a(1), value[3 * i + 2] * a(2)))
    }))
}

/// `S_i beta += sum_j w P_ij A_j beta`.
#[inline(always)]
fn pull_back<const FMA: bool>(p: &[f64; 9], point: &Point, q: usize, l: usize, s: &mut [[Lanes; 4]; 9]) {
    let m = madd::<FMA>;
    for i in 0..3 {
        for beta in 0..3 {
            let at = &mut s[3 * i + beta][value_at(beta, q)][l];
            let a = &point.map[3 * beta..];
            *at = m(p[3 * i], a[0][l], m(p[3 * i + 1], a[1][l], m(p[3 * i + 2], a[2][l], *at)));
        }
    }
}

on_path! {
    /// Internal forces of one chunk, added to `f`; `upright` turns false where some `J` is not positive.
    fn internal(chunk: &Chunk, u: &[Slot], f: &mut [Slot], upright: &mut bool) = internal_lanes
}

#[inline(always)]
fn internal_lanes<const FMA: bool>(chunk: &Chunk, u: &[Slot], f: &mut [Slot], upright: &mut bool) {
    let (mut first, mut good) = (0, [1.0; LANES]);
    for &(end, Moduli { mu, lambda }) in &chunk.runs {
        for block in &chunk.blocks[first..end] {
            let d = derivatives::<FMA>(block, u);
            let mut s = [[[0.0; LANES]; 4]; 9];
            for (q, point) in block.points.iter().enumerate() {
                for l in 0..LANES {
                    let x = strain::<FMA>(&d, point, q, l);
                    good[l] = if 1.0 + x.j > 0.0 { good[l] } else { 0.0 };
                    let p = x.stress::<FMA>(point.weight[l], mu, lambda);
                    pull_back::<FMA>(&p, point, q, l, &mut s);
                }
            }
            scatter::<FMA>(block, &s, f);
        }
        first = end;
    }
    *upright = good == [1.0; LANES];
}

on_path! {
    /// As [`internal`] with one dilation per element, the mean over its points.
    fn dilated(chunk: &Chunk, u: &[Slot], f: &mut [Slot], upright: &mut bool) = dilated_lanes
}

#[inline(always)]
fn dilated_lanes<const FMA: bool>(chunk: &Chunk, u: &[Slot], f: &mut [Slot], upright: &mut bool) {
    let (mut first, mut good) = (0, [1.0; LANES]);
    for &(end, Moduli { mu, lambda }) in &chunk.runs {
        for block in &chunk.blocks[first..end] {
            let d = derivatives::<FMA>(block, u);
            let mut sums = [[0.0; LANES]; 3];
            for (q, point) in block.points.iter().enumerate() {
                for l in 0..LANES {
                    let x = strain::<FMA>(&d, point, q, l);
                    good[l] = if 1.0 + x.j > 0.0 { good[l] } else { 0.0 };
                    let w = point.weight[l];
                    sums[0][l] += w;
                    sums[1][l] = madd::<FMA>(w, x.j, sums[1][l]);
                    sums[2][l] = madd::<FMA>(w * mu, x.isochoric::<FMA>(), sums[2][l]);
                }
            }
            let mut shared = [[0.0; LANES]; 2];
            for l in 0..LANES {
                let v = sums[0][l];
                // A lane left over has no volume.
                let per_volume = if v > 0.0 { 1.0 / v } else { 0.0 };
                let [t, p] =
                    close_group::<FMA>(sums[1][l] * per_volume, sums[2][l], per_volume, v * mu, v * lambda);
                shared[0][l] = t;
                shared[1][l] = p;
            }
            let mut s = [[[0.0; LANES]; 4]; 9];
            for (q, point) in block.points.iter().enumerate() {
                for l in 0..LANES {
                    let x = strain::<FMA>(&d, point, q, l);
                    let p = x.dilated_stress::<FMA>(point.weight[l], mu, shared[0][l], shared[1][l]);
                    pull_back::<FMA>(&p, point, q, l, &mut s);
                }
            }
            scatter::<FMA>(block, &s, f);
        }
        first = end;
    }
    *upright = good == [1.0; LANES];
}
