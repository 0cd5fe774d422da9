#![allow(non_snake_case)] // D, K, M as in the formulas
//! The inner loops of a tangent in wide registers: products of the points, rows of the groups, and products
//! of these rows.
//!
//! Multiplication and addition stay separate and in the same order on every path, so the bits do not depend
//! on the processor. A block has nine numbers: eight fill the lanes, and the ninth alone would cost as much
//! as the eight. The three products of the ninth number therefore occupy lanes of their own and are summed at
//! the end.

use algebra::Connectivity;
use lanes::on_path;
use material::Tangent;
use shape::{Matrix3, Vector3};

use super::sorted_rows::Sorted;

pub(crate) type Vector4 = nalgebra::Vector4<f64>;

/// Eight numbers in one cache line: two vectors, each padded to four numbers.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Lanes([f64; 8]);

impl Lanes {
    pub const ZERO: Lanes = Lanes([0.0; 8]);

    pub fn pair(a: &Vector3, b: &Vector3) -> Lanes {
        Lanes([a.x, a.y, a.z, 0.0, b.x, b.y, b.z, 0.0])
    }

    pub fn of_pair(self) -> (Vector3, Vector3) {
        let [ax, ay, az, _, bx, by, bz, _] = self.0;
        (Vector3::new(ax, ay, az), Vector3::new(bx, by, bz))
    }
}

/// A block under construction: its first eight numbers by columns, and the summands of the ninth.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct BlockSum {
    eight: [f64; 8],
    ninth: [f64; 4],
}

impl BlockSum {
    pub const ZERO: BlockSum = BlockSum { eight: [0.0; 8], ninth: [0.0; 4] };

    pub fn block(&self) -> Matrix3 {
        let [a, b, c, _] = self.ninth;
        let ninth = a + b + c;
        Matrix3::from_iterator(self.eight.iter().copied().chain([ninth]))
    }
}

/// The tangent of a point in the layout of [`point_products`]. `M_l = sum_k g_k D_kl` are three blocks. Lanes
/// `8 l` onwards hold the first eight numbers of block l, and lanes 24 onwards the three ninth numbers. For
/// every k the same lanes hold `D_kl`.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct PointTangent([[f64; 32]; 3]);

impl PointTangent {
    pub fn new(D: &Tangent) -> PointTangent {
        let mut lanes = [[0.0; 32]; 3];
        for (k, l, at) in PointTangent::entries() {
            lanes[k][PointTangent::lane(l, at)] = D[(3 * k + at % 3, 3 * l + at / 3)];
        }
        PointTangent(lanes)
    }

    /// Returns the tangent as a matrix.
    pub fn matrix(&self) -> Tangent {
        let mut D = Tangent::zeros();
        for (k, l, at) in PointTangent::entries() {
            D[(3 * k + at % 3, 3 * l + at / 3)] = self.0[k][PointTangent::lane(l, at)];
        }
        D
    }

    fn entries() -> impl Iterator<Item = (usize, usize, usize)> {
        (0..3).flat_map(|k| (0..3).flat_map(move |l| (0..9).map(move |at| (k, l, at))))
    }

    fn lane(l: usize, at: usize) -> usize {
        if at < 8 { 8 * l + at } else { 24 + l }
    }
}

/// Contribution of one dilation group to the second derivatives: `k b b^T + b m^T + m b^T`, of rank two,
/// written as `b n^T + n b^T` with `n = m + k b / 2`.
///
/// Here `b = dJ_a / du` (1/m), `m` is `d2 psi / dF d theta` transferred to the nodes (N), and `k` is
/// `d2 psi / d theta2` over the group (J).
pub(crate) struct GroupHessian {
    /// Stiffness k of the group against its volume change, J.
    pub bulk: f64,
    /// Rows by the nodes of the group, ascending.
    pub rows: Vec<GroupRow>,
}

/// Entries of one node in the vectors `b` (1/m) and `n` (N) of [`GroupHessian`].
/// The component of column c is repeated in all lanes of that column of a block.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct GroupRow {
    b: [f64; 8],
    n: [f64; 8],
    /// Last components of b and n.
    ninth: [f64; 4],
}

impl GroupRow {
    pub fn new(b: &Vector3, n: &Vector3) -> GroupRow {
        let by_column = |v: &Vector3| std::array::from_fn(|l| v[l / 3]);
        GroupRow { b: by_column(b), n: by_column(n), ninth: [b.z, n.z, 0.0, 0.0] }
    }

    /// Takes the part `excess` (J) of k out of `k b b^T`.
    pub fn take(&mut self, excess: f64) {
        let part = -0.5 * excess;
        self.n.iter_mut().zip(&self.b).for_each(|(n, b)| *n += part * b);
        self.ninth[1] += part * self.ninth[0];
    }

    /// Returns the entries of the node in `b` (1/m) and `n` (N).
    pub fn both(&self) -> (Vector3, Vector3) {
        let vector = |v: &[f64; 8]| Vector3::new(v[0], v[3], v[6]);
        (vector(&self.b), vector(&self.n))
    }
}

on_path! {
    /// Adds `sum_l M_l g_jl` to `K_ij` over the points `seen` by node i and their nodes j <= i, at `slot[j]`
    /// of `sums`.
    pub(super) fn point_products(
        points: &Sorted<Vector4>,
        tangents: &[PointTangent],
        seen: &[(u32, u32)],
        slot: &[u32],
        sums: &mut [BlockSum],
    ) = point_products_in
}

#[inline(always)]
fn point_products_in<const FMA: bool>(
    points: &Sorted<Vector4>,
    tangents: &[PointTangent],
    seen: &[(u32, u32)],
    slot: &[u32],
    sums: &mut [BlockSum],
) {
    for &(q, k) in seen {
        let (q, k) = (q as usize, k as usize);
        let PointTangent(D) = &tangents[q];
        let g = &points.data[k];
        let mut M = [0.0; 32];
        for l in 0..32 {
            M[l] = D[0][l] * g[0] + D[1][l] * g[1] + D[2][l] * g[2];
        }
        let start = points.offsets[q];
        for (&j, g) in points.nodes[start..=k].iter().zip(&points.data[start..=k]) {
            let sum = &mut sums[slot[j as usize] as usize];
            for l in 0..8 {
                sum.eight[l] += M[l] * g[0] + M[8 + l] * g[1] + M[16 + l] * g[2];
            }
            for l in 0..4 {
                sum.ninth[l] += M[24 + l] * g[l];
            }
        }
    }
}

on_path! {
    /// Adds `b_i n_j^T + n_i b_j^T` to `K_ij` over the groups `seen` by node i and their nodes j <= i.
    pub(super) fn group_products(
        nodes: Connectivity<'_>,
        groups: &[GroupHessian],
        seen: &[(u32, u32)],
        slot: &[u32],
        sums: &mut [BlockSum],
    ) = group_products_in
}

#[inline(always)]
fn group_products_in<const FMA: bool>(
    nodes: Connectivity<'_>,
    groups: &[GroupHessian],
    seen: &[(u32, u32)],
    slot: &[u32],
    sums: &mut [BlockSum],
) {
    for &(a, at) in seen {
        let start = nodes.offsets[a as usize];
        let own = at as usize - start;
        let rows = &groups[a as usize].rows;
        let (b, n) = rows[own].both();
        let (bi, ni): ([f64; 8], [f64; 8]) =
            (std::array::from_fn(|l| b[l % 3]), std::array::from_fn(|l| n[l % 3]));
        let ninth = [n.z, b.z, 0.0, 0.0];
        for (&j, row) in nodes.nodes[start..=at as usize].iter().zip(&rows[..=own]) {
            let sum = &mut sums[slot[j as usize] as usize];
            for l in 0..8 {
                sum.eight[l] += bi[l] * row.n[l] + ni[l] * row.b[l];
            }
            for l in 0..4 {
                sum.ninth[l] += ninth[l] * row.ninth[l];
            }
        }
    }
}

on_path! {
    /// Adds `share` times the row of a point to the sums of its `nodes`, each at its slot.
    pub(super) fn add_row(
        nodes: &[u32],
        row: &[Lanes],
        share: f64,
        slot: &[u32],
        sums: &mut [Lanes],
    ) = add_row_in
}

#[inline(always)]
fn add_row_in<const FMA: bool>(nodes: &[u32], row: &[Lanes], share: f64, slot: &[u32], sums: &mut [Lanes]) {
    for (&node, Lanes(row)) in nodes.iter().zip(row) {
        let Lanes(sum) = &mut sums[slot[node as usize] as usize];
        for l in 0..8 {
            sum[l] += share * row[l];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lanes::LanePath;

    #[test]
    fn blocks_are_those_of_plain_matrices_with_the_same_bits_on_every_path() {
        let D = Tangent::from_fn(|i, j| (1.3 * (i * j) as f64 + 0.7 * (i + j) as f64).sin());
        let g = |k: usize| Vector3::from_fn(|a, _| (2.1 * k as f64 + 0.9 * a as f64).cos());
        let points = Sorted::new(std::iter::once((0..3).map(|k| (k as u32, g(k).push(0.0)))));
        let rows = (0..3).map(|k| GroupRow::new(&g(k + 5), &g(k + 9))).collect();
        let groups = [GroupHessian { bulk: 0.0, rows }];
        let offsets = [0, 3];
        let nodes = [0, 1, 2];
        let connectivity = Connectivity { offsets: &offsets, nodes: &nodes, seen_by: &[] };
        let tangents = [PointTangent::new(&D)];
        assert_eq!(tangents[0].matrix(), D);
        let blocks: Vec<Vec<Matrix3>> = LanePath::available()
            .into_iter()
            .map(|path| {
                let mut sums = [BlockSum::ZERO; 3];
                point_products(path, &points, &tangents, &[(0, 2)], &nodes, &mut sums);
                group_products(path, connectivity, &groups, &[(0, 2)], &nodes, &mut sums);
                let mut rows = [Lanes::ZERO; 3];
                add_row(
                    path,
                    &nodes,
                    &[0, 1, 2].map(|k| Lanes::pair(&g(k), &g(k + 1))),
                    0.3,
                    &nodes,
                    &mut rows,
                );
                for (k, row) in rows.iter().enumerate() {
                    assert_eq!(row.of_pair(), (g(k) * 0.3, g(k + 1) * 0.3));
                }
                sums.iter().map(BlockSum::block).collect()
            })
            .collect();
        assert!(blocks.iter().all(|of_path| of_path == &blocks[0]));
        for (j, block) in blocks[0].iter().enumerate() {
            let of_point = Matrix3::from_fn(|a, b| {
                let sum =
                    |k: usize| -> f64 { (0..3).map(|l| g(2)[k] * D[(3 * k + a, 3 * l + b)] * g(j)[l]).sum() };
                (0..3).map(sum).sum()
            });
            let of_group = g(7) * g(j + 9).transpose() + g(11) * g(j + 5).transpose();
            assert!((block - of_point - of_group).norm() < 1e-14 * block.norm(), "{j}: {block}");
        }
    }
}
