#![allow(non_snake_case)] // G and H as in the formulas
//! Gradient rows prepared for assembly, in which two points with nearly the same nodes are bundled.
//!
//! The sum `G_ij = sum_q w g_i g_j^T` reads and writes a block for every pair of nodes of every point: there
//! are as many stores as products. Two points with common nodes also share these stores.

use std::ops::Range;

use algebra::{Connectivity, Incidence};
use lanes::{LanePath, on_path};
use rayon::prelude::*;
use shape::{Matrix3, Vector3, locality_order};

use crate::body::{LinearBody, region_of};
use crate::dilation::{Averaged, averaged, group_bulk};
use crate::error::SolveError;

/// Bundles per task.
const CHUNK: usize = 64;

/// Number of gradients whose forces one task sums.
const TASK: usize = 4096;

/// Largest number of points in a bundle.
const POINTS: usize = 2;

/// Number of neighbours above which sorting the points in space pays off. For linear elements, sorting takes
/// as long as the sums.
const LONG: usize = 16;

/// A vector at each point of a bundle, padded to four numbers each: one register of AVX-512, two of AVX2, or
/// one cache line.
pub(crate) type Pair = [f64; 4 * POINTS];

/// Gradients of bundles of one or two consecutive points. Nodes ascend in each bundle, so the partners
/// `j <= i` of an entry are the entries before it. Bundles are ordered by law, and all points of a bundle
/// have the same law.
pub(crate) struct GradTable {
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    /// Points of the bundle whose rows contain the node, one bit each.
    seen_by: Vec<u8>,
    /// Gradients, 1/m; zero at points whose rows do not contain the node.
    grads: Vec<Pair>,
    /// Weight of each point, repeated for every component of its gradients.
    weights: Vec<Pair>,
    /// Bundles of each law that has any, in order, with its lambda and mu, Pa.
    laws: Vec<(Range<usize>, (f64, f64))>,
}

/// Input of a table: the order of the points, and the row of gradients, weight and law of each. A row may
/// name a node twice; its gradients add up.
struct Rows<R, W, L> {
    order: Vec<u32>,
    row: R,
    weight: W,
    law: L,
}

impl GradTable {
    /// Builds the table of the body's own quadrature. With a projection it contains the deviatoric part only,
    /// `lambda' = -2 mu / 3`.
    pub fn points(body: &LinearBody) -> GradTable {
        let moduli = body.materials.iter().map(|m| match body.dilation {
            Some(_) => (-2.0 / 3.0 * m.mu(), m.mu()),
            None => (m.lambda(), m.mu()),
        });
        let law = |q| region_of(body.region, q);
        let mut order = in_space(body);
        order.sort_by_key(|&q| law(q as usize));
        let rows = Rows {
            order,
            row: |q| {
                let (nodes, grads) = body.volume.row(q);
                nodes.iter().copied().zip(grads.iter().copied())
            },
            weight: |q| body.volume.weights()[q],
            law,
        };
        GradTable::new(body.nodes.len(), &rows, &moduli.collect::<Vec<_>>())
    }

    /// Builds the table of the body's dilation groups `a`, each with the stiffness `kappa V_a b_a b_a^T`. The
    /// row `b_a` (1/m) is the gradient of the group's mean dilation with respect to the nodal displacements,
    /// `V_a` (m^3) its volume and `kappa` (Pa) its mean bulk modulus. Returns `None` for a body without
    /// groups.
    pub fn groups(body: &LinearBody) -> Result<Option<GradTable>, SolveError> {
        let Some(groups) = body.dilation else { return Ok(None) };
        let averaged = averaged(body, groups)?;
        let weight = |a: usize| group_bulk(body, a) * averaged[a].0;
        Ok(Some(GradTable::of_groups(body.nodes.len(), &averaged, weight)))
    }

    /// Builds the table of the terms `weight(a) b_a b_a^T`, with the rows `b_a` (1/m) of the groups
    /// `averaged` and a weight in J. A group is stored like a point with the gradients `b_a`,
    /// `lambda = 1`, `mu = 0` and this weight.
    pub fn of_groups(
        node_count: usize,
        averaged: &[Averaged],
        weight: impl Fn(usize) -> f64 + Sync,
    ) -> GradTable {
        let rows = Rows {
            order: (0..averaged.len() as u32).collect(),
            row: |a: usize| averaged[a].1.iter().copied(),
            weight,
            law: |_| 0,
        };
        GradTable::new(node_count, &rows, &[(1.0, 0.0)])
    }

    fn new<I, R, W, L>(node_count: usize, rows: &Rows<R, W, L>, moduli: &[(f64, f64)]) -> GradTable
    where
        I: Iterator<Item = (u32, Vector3)>,
        R: Fn(usize) -> I + Sync,
        W: Fn(usize) -> f64 + Sync,
        L: Fn(usize) -> usize + Sync,
    {
        let (mut offsets, mut nodes, mut firsts) = (vec![0], Vec::new(), vec![0]);
        let (row, law) = (|p| (rows.row)(rows.order[p] as usize), |p| (rows.law)(rows.order[p] as usize));
        // First point of the bundle that contained a node most recently.
        let mut met = vec![usize::MAX; node_count];
        let mut first = 0;
        for p in 0..rows.order.len() {
            let (mut all, mut new) = (0, 0);
            for (node, _) in row(p) {
                all += 1;
                new += usize::from(met[node as usize] != first);
            }
            // All pairs of nodes of a bundle cost the same, even if only one of its points contributes.
            let here: usize = nodes.len() - offsets[offsets.len() - 1];
            let pays = (here + new).pow(2) <= here.pow(2) + all * all;
            let joins = p < first + POINTS && law(p) == law(first) && pays;
            if p > first && !joins {
                offsets.push(nodes.len());
                firsts.push(p);
                first = p;
            }
            for (node, _) in row(p) {
                if std::mem::replace(&mut met[node as usize], first) != first {
                    nodes.push(node);
                }
            }
        }
        if !rows.order.is_empty() {
            offsets.push(nodes.len());
            firsts.push(rows.order.len());
        }
        let bundles = firsts.len() - 1;
        let mut weights = vec![[0.0; 8]; bundles];
        for (weights, range) in weights.iter_mut().zip(firsts.windows(2)) {
            for (at, p) in (range[0]..range[1]).enumerate() {
                weights[places(at)].fill((rows.weight)(rows.order[p] as usize));
            }
        }
        let mut laws: Vec<(Range<usize>, (f64, f64))> = Vec::new();
        for (l, &moduli) in moduli.iter().enumerate() {
            let start = laws.last().map_or(0, |last| last.0.end);
            let end = firsts[..bundles].partition_point(|&p| law(p) <= l);
            if end > start {
                laws.push((start..end, moduli));
            }
        }
        let seen_by = vec![0; nodes.len()];
        let grads = vec![[0.0; 8]; nodes.len()];
        let mut table = GradTable { offsets, nodes, seen_by, grads, weights, laws };
        table.fill(&firsts, &row, node_count);
        table
    }

    /// Sorts the nodes of every bundle and adds up its gradients. `firsts` holds the first point of each
    /// bundle.
    fn fill<I: Iterator<Item = (u32, Vector3)>>(
        &mut self,
        firsts: &[usize],
        row: &(impl Fn(usize) -> I + Sync),
        node_count: usize,
    ) {
        let GradTable { offsets, nodes, seen_by, grads, .. } = self;
        let mut rest = (&mut nodes[..], &mut seen_by[..], &mut grads[..]);
        let mut tasks = Vec::new();
        for first in (0..firsts.len() - 1).step_by(CHUNK) {
            let bundles = first..(first + CHUNK).min(firsts.len() - 1);
            let entries = offsets[bundles.end] - offsets[bundles.start];
            let (nodes, nodes_left) = rest.0.split_at_mut(entries);
            let (seen_by, seen_by_left) = rest.1.split_at_mut(entries);
            let (grads, grads_left) = rest.2.split_at_mut(entries);
            rest = (nodes_left, seen_by_left, grads_left);
            tasks.push((bundles, nodes, seen_by, grads));
        }
        let offsets = &offsets[..];
        tasks.into_par_iter().for_each_init(
            || vec![0; node_count],
            |at, (bundles, nodes, seen_by, grads)| {
                let base = offsets[bundles.start];
                for bundle in bundles {
                    let entries = offsets[bundle] - base..offsets[bundle + 1] - base;
                    nodes[entries.clone()].sort_unstable();
                    for k in entries {
                        at[nodes[k] as usize] = k;
                    }
                    for (p, point) in (firsts[bundle]..firsts[bundle + 1]).enumerate() {
                        for (node, g) in row(point) {
                            let k = at[node as usize];
                            seen_by[k] |= 1 << p;
                            let grad = &mut grads[k][places(p)];
                            (0..3).for_each(|axis| grad[axis] += g[axis]);
                        }
                    }
                }
            },
        );
    }

    pub fn connectivity(&self) -> Connectivity<'_> {
        Connectivity { offsets: &self.offsets, nodes: &self.nodes, seen_by: &self.seen_by }
    }

    /// Returns the bundles that contain each node, ascending.
    pub fn incidence(&self, node_count: usize) -> Incidence {
        Incidence::new(node_count, self.connectivity(), 0..self.weights.len())
    }

    /// Returns the number of bundles, at least one, that have about `gradients` gradients together.
    pub fn bundles_of(&self, gradients: usize) -> usize {
        (gradients * self.weights.len() / self.nodes.len().max(1)).max(1)
    }

    /// Returns the range of bundles of each law, with its lambda and mu, Pa, in order. Laws without bundles
    /// are left out.
    pub fn laws(&self) -> &[(Range<usize>, (f64, f64))] {
        &self.laws
    }

    /// Subtracts the nodal forces `sum_q w sigma grad N`, N, from `force`, with
    /// `sigma = lambda tr H I + mu (H + H^T)`.
    ///
    /// Gradients come from the outermost cache and are therefore read only once: the forces of a bundle are
    /// summed while its gradients are in the inner cache. Tasks are the same at any number of threads.
    pub fn subtract_force(&self, u: &[Vector3], force: &mut [Vector3]) {
        let path = LanePath::best();
        let tasks: Vec<usize> = (0..self.weights.len()).step_by(self.bundles_of(TASK)).collect();
        let of_task = |scratch: &mut Forces, &first: &usize| {
            let end = (first + self.bundles_of(TASK)).min(self.weights.len());
            scratch.start(&self.nodes[self.offsets[first]..self.offsets[end]]);
            add_force(path, self, first..end, u, scratch);
            scratch.finish()
        };
        let start = || Forces { slot: vec![u32::MAX; force.len()], nodes: Vec::new(), sums: Vec::new() };
        let parts: Vec<Vec<(u32, Vector3)>> = tasks.par_iter().map_init(start, of_task).collect();
        for (node, part) in parts.into_iter().flatten() {
            force[node as usize] -= part;
        }
    }

    /// Returns `w sigma` at the points of a bundle for the given displacement gradients, both row by row.
    fn stress(&self, bundle: usize, H: &[Pair; 3]) -> [Pair; 3] {
        let law = self.laws.partition_point(|(bundles, _)| bundles.end <= bundle);
        let (lambda, mu) = self.laws[law].1;
        let mut stress = [[0.0; 8]; 3];
        for p in 0..POINTS {
            let at = places(p);
            let H = Matrix3::from_fn(|a, b| H[a][at.start + b]);
            let weight = self.weights[bundle][at.start];
            let sigma = ((H + H.transpose()) * mu + Matrix3::identity() * (lambda * H.trace())) * weight;
            for (a, row) in stress.iter_mut().enumerate() {
                (0..3).for_each(|b| row[at.start + b] = sigma[(a, b)]);
            }
        }
        stress
    }
}

on_path! {
    /// Adds `w g_i g_j^T` to `G_ij` over the bundles `seen` by node i and their nodes j <= i. This is the
    /// inner loop of assembly. `G` is the sum of two halves. Pairs of nodes that never share a point have no
    /// `slot`; the zeros they add go to an arbitrary block.
    ///
    /// Two points take three stores and three products and sums of eight lanes: 3 cycles per pair of nodes
    /// with AVX-512, as much as one point alone. The arithmetic and its order are the same on every path, and
    /// multiplication and addition stay separate, so the bits are the same.
    pub(crate) fn gather(
        table: &GradTable,
        seen: &[(u32, u32)],
        slot: &[u32],
        sums: &mut [[Pair; 3]],
    ) = gather_in
}

#[inline(always)]
fn gather_in<const FMA: bool>(table: &GradTable, seen: &[(u32, u32)], slot: &[u32], sums: &mut [[Pair; 3]]) {
    let last = sums.len() - 1;
    for &(b, k) in seen {
        let (b, k) = (b as usize, k as usize);
        let start = table.offsets[b];
        let (own, weight) = (&table.grads[k], &table.weights[b]);
        let mut x = [[0.0; 8]; 3];
        for axis in 0..3 {
            for l in 0..8 {
                x[axis][l] = weight[l] * own[l / 4 * 4 + axis];
            }
        }
        for (&j, gj) in table.nodes[start..=k].iter().zip(&table.grads[start..=k]) {
            let G = &mut sums[(slot[j as usize] as usize).min(last)];
            for axis in 0..3 {
                for l in 0..8 {
                    G[axis][l] += x[axis][l] * gj[l];
                }
            }
        }
    }
}

on_path! {
    /// Adds the forces of some bundles, with the same bits on every path.
    fn add_force(table: &GradTable, bundles: Range<usize>, u: &[Vector3], forces: &mut Forces) = add_force_in
}

#[inline(always)]
fn add_force_in<const FMA: bool>(
    table: &GradTable,
    bundles: Range<usize>,
    u: &[Vector3],
    forces: &mut Forces,
) {
    for bundle in bundles {
        let range = table.offsets[bundle]..table.offsets[bundle + 1];
        let nodes = &table.nodes[range.clone()];
        let grads = &table.grads[range];
        let Some(&first) = nodes.first() else { continue };
        let base = u[first as usize];
        let mut H = [[0.0; 8]; 3];
        for (&node, g) in nodes.iter().zip(grads) {
            // Gradients of a partition of unity sum to zero, so only differences of displacements count.
            let difference = u[node as usize] - base;
            for (row, d) in H.iter_mut().zip(&difference) {
                *row = add_product(*row, &[*d; 8], g);
            }
        }
        // Row a of w sigma at the points of the bundle; zero in unused places.
        let stress = table.stress(bundle, &H);
        for (&node, g) in nodes.iter().zip(grads) {
            let sum = &mut forces.sums[forces.slot[node as usize] as usize];
            for (sum, row) in sum.iter_mut().zip(&stress) {
                *sum = add_product(*sum, row, g);
            }
        }
    }
}

/// Adds by whole arrays: the compiler does not vectorise these products if they are added in place lane by
/// lane.
#[inline(always)]
fn add_product(sum: Pair, a: &Pair, b: &Pair) -> Pair {
    std::array::from_fn(|l| sum[l] + a[l] * b[l])
}

/// Forces on the nodes of some bundles.
struct Forces {
    /// Index of each node's sum; `u32::MAX` for nodes outside these bundles.
    slot: Vec<u32>,
    nodes: Vec<u32>,
    /// Sums by axis, still to be added over the lanes.
    sums: Vec<[Pair; 3]>,
}

impl Forces {
    /// Makes room for the given nodes, which may repeat.
    fn start(&mut self, seen: &[u32]) {
        for &node in seen {
            let slot = &mut self.slot[node as usize];
            if *slot == u32::MAX {
                *slot = self.nodes.len() as u32;
                self.nodes.push(node);
            }
        }
        self.sums.resize(self.nodes.len(), [[0.0; 8]; 3]);
    }

    /// Returns the forces, N, and resets the structure.
    fn finish(&mut self) -> Vec<(u32, Vector3)> {
        let total = |sum: [Pair; 3]| Vector3::from_fn(|axis, _| sum[axis].iter().sum::<f64>());
        self.nodes.iter().for_each(|&node| self.slot[node as usize] = u32::MAX);
        self.nodes.drain(..).zip(self.sums.drain(..)).map(|(node, sum)| (node, total(sum))).collect()
    }
}

/// Orders the points of a body along a space-filling curve, so that consecutive points have nearly the same
/// nodes, independently of the order of cells. Points with identical nodes, such as those of an element, stay
/// together.
fn in_space(body: &LinearBody) -> Vec<u32> {
    let rows = body.volume.rows();
    let mut order: Vec<u32> = (0..rows.len() as u32).collect();
    if rows.nodes().len() < LONG * rows.len() {
        return order;
    }
    let mut place = vec![0; rows.len()];
    for (at, q) in locality_order(body.volume.points()).into_iter().enumerate() {
        place[q as usize] = at;
    }
    for q in 1..rows.len() {
        if rows.row(q).0 == rows.row(q - 1).0 {
            place[q] = place[q - 1];
        }
    }
    order.sort_by_key(|&q| place[q as usize]);
    order
}

/// Range of the vector at one of the points within a [`Pair`].
fn places(point: usize) -> Range<usize> {
    4 * point..4 * point + 4
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of two alternating laws. One row names a node twice, and one shares no node with its neighbours.
    fn rows() -> Vec<Vec<(u32, Vector3)>> {
        let g = |k: u32| Vector3::new(f64::from(k), 1.0 - 0.5 * f64::from(k), 0.25 * f64::from(k * k));
        let of = |nodes: &[u32]| nodes.iter().map(|&n| (n, g(n))).collect();
        vec![of(&[3, 0, 2]), of(&[0, 2, 3]), of(&[2, 4, 2, 0]), of(&[5, 1]), of(&[4, 3, 0]), of(&[0, 3, 4])]
    }

    #[test]
    fn bundles_sum_what_their_points_do_by_law_on_every_path() {
        let rows = rows();
        let node_count = 6;
        let weight = |q: usize| 0.5 + q as f64;
        let law = |q: usize| usize::from(q == 1 || q >= 4);
        let mut order: Vec<u32> = (0..rows.len() as u32).collect();
        order.sort_by_key(|&q| law(q as usize));
        let parts = Rows { order, row: |q: usize| rows[q].iter().copied(), weight, law };
        let table = GradTable::new(node_count, &parts, &[(1.0, 2.0), (3.0, 4.0)]);
        // The bundles are: points 0 and 2, point 3, points 1 and 4, point 5.
        assert_eq!(table.offsets, [0, 4, 6, 10, 13]);
        assert_eq!(table.laws(), [(0..2, (1.0, 2.0)), (2..4, (3.0, 4.0))]);
        let incidence = table.incidence(node_count);
        let slot: Vec<u32> = (0..node_count as u32).collect();
        for (l, (bundles, _)) in table.laws().iter().enumerate() {
            for i in 0..node_count {
                let seen: Vec<(u32, u32)> =
                    incidence.of(i).iter().copied().filter(|of| bundles.contains(&(of.0 as usize))).collect();
                let sums: Vec<Vec<[Pair; 3]>> = LanePath::available()
                    .into_iter()
                    .map(|path| {
                        let mut sums = vec![[[0.0; 8]; 3]; node_count];
                        gather(path, &table, &seen, &slot, &mut sums);
                        sums
                    })
                    .collect();
                assert!(sums.windows(2).all(|two| two[0] == two[1]), "row {i}");
                for j in 0..=i {
                    let at = |q: usize, n: usize| {
                        let of = rows[q].iter().filter(|e| e.0 == n as u32);
                        of.map(|e| e.1).sum::<Vector3>()
                    };
                    let points = (0..rows.len()).filter(|&q| law(q) == l);
                    let exact: Matrix3 = points.map(|q| at(q, i) * at(q, j).transpose() * weight(q)).sum();
                    let sum = Matrix3::from_fn(|a, b| sums[0][j][a][b] + sums[0][j][a][4 + b]);
                    assert!((sum - exact).norm() <= 1e-14 * exact.norm(), "{i} {j}: {sum} {exact}");
                }
            }
        }
    }
}
