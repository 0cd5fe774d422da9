//! Nodal-mean dilation on tetrahedra: `J_a = sum_q share w J_q / V_a` at the nodes, between two passes over
//! the elements.
//!
//! For the neo-Hookean law the sum over pairs (node a, point q) splits,
//!
//! ```text
//! E = sum_q w mu/2 (J_q^(-2/3) I1_q S_q - 3) + sum_a (-M_a ln J_a + L_a/2 (ln J_a)^2),
//! S_q = sum_a share J_a^(2/3),  M_a = sum_q share w mu,  L_a = sum_q share w lambda,
//! ```
//! The first pass over the elements therefore adds two numbers to each node, `sum share w (J - 1)` and
//! `B_a = sum share w mu b_q` with `b = J^(-2/3) I1 / 3 - 1`. The second pass reads two numbers from each
//! node, `J_a^(2/3)` and `p_a = (1/V_a) dE/dJ_a = (B_a (1 + sigma) + sigma M_a + L_a ln J_a) / (J_a V_a)`,
//! `sigma = J_a^(2/3) - 1`.
//!
//! Laws whose shape part does not change with `J` have neither `B_a` nor `M_a`. Their volumetric energies
//! `L_a/2 (ln J_a)^2` and `K_a/2 (J_a - 1)^2` give `p_a = (L_a ln J_a / J_a + K_a (J_a - 1)) / V_a`. A node
//! may combine several laws.

use rayon::prelude::*;
use shape::DilationGroups;

use super::body::ExplicitBody;
use super::chunks::{Border, ChunkNodes};
use super::moduli::{LaneLaw, close_group};
use super::scalar::Scalar;
use lanes::{LANES, LanePath, on_path};

/// Nodes per task.
const NODES: usize = 1024;

pub(super) struct Nodal<T> {
    /// Slots by node and part, if groups end at the borders of parts; `None` if every group is a node.
    border: Option<Border>,
    /// Values of each slot: `sum share w (J - 1)` and `B_a` after the first pass, then the slot's copy of
    /// `closed`.
    slots: Vec<[T; 2]>,
    constants: Vec<Constants>,
    /// Values of each group in double precision: `sum share w (J - 1)` and `B_a`, then `J_a^(2/3)` and `p_a`.
    closed: Vec<[f64; 2]>,
}

/// Constants of one group: `1 / V_a` (1/m^3), `M_a`, `L_a` and `K_a` (J).
#[derive(Clone, Copy)]
struct Constants {
    per_volume: f64,
    mu: f64,
    lambda: f64,
    quadratic: f64,
}

impl<T: Scalar> Nodal<T> {
    /// Prepares the pass over the nodes, which turns the sums of each dilation group into its common dilation
    /// and pressure. The points of each of the `chunks` must belong to one part of the body.
    ///
    /// Returns `None` unless the groups are those of [`DilationGroups::nodal`], divided by part if there are
    /// several parts, and every element gives each of its four nodes a share of 1/4.
    pub fn new(
        body: &ExplicitBody,
        groups: &DilationGroups,
        laws: &[LaneLaw],
        chunks: &[ChunkNodes],
    ) -> Option<Nodal<T>> {
        let (rows, weights) = (body.volume.rows(), body.volume.weights());
        let even = rows.values().iter().all(|n| (n - 0.25).abs() < 1e-14);
        let part = |q: usize| groups.parts().get(q).map_or(0, |&part| usize::from(part));
        let parts = groups.parts().iter().max().map_or(1, |&part| usize::from(part) + 1);
        let mut nodal = DilationGroups::nodal(body.volume).ok()?;
        if !groups.parts().is_empty() {
            nodal = nodal.by_part(groups.parts(), weights).ok()?;
        }
        if !even || &nodal != groups {
            return None;
        }
        let group = |node: u32, part: usize| node as usize * parts + part;
        let count = rows.node_count() * parts;
        let border = (parts > 1).then(|| {
            let of_chunk = |chunk: &ChunkNodes| {
                let part = part(chunk.items[0] as usize);
                chunk.nodes.iter().map(|&node| group(node, part) as u32).collect()
            };
            Border::new(count, &chunks.iter().map(of_chunk).collect::<Vec<_>>())
        });
        let mut sums = vec![[0.0; 4]; count];
        let moduli: Vec<[f64; 3]> = laws.iter().map(LaneLaw::of_group).collect();
        for (q, &w) in weights.iter().enumerate() {
            let [mu, lambda, quadratic] = moduli[body.region(q) as usize];
            for &node in rows.row(q).0 {
                let s = &mut sums[group(node, part(q))];
                s[0] += 0.25 * w;
                s[1] += 0.25 * w * mu;
                s[2] += 0.25 * w * lambda;
                s[3] += 0.25 * w * quadratic;
            }
        }
        // A node without an element, or without one in a part, has no volume; its result is not used.
        let constants = |s: &[f64; 4]| Constants {
            per_volume: if s[0] > 0.0 { 1.0 / s[0] } else { 0.0 },
            mu: s[1],
            lambda: s[2],
            quadratic: s[3],
        };
        let slots = chunks.iter().map(|chunk| chunk.nodes.len()).sum();
        Some(Nodal {
            border,
            slots: vec![[T::ZERO; 2]; slots],
            constants: sums.iter().map(constants).collect(),
            closed: vec![[0.0; 2]; count],
        })
    }

    pub fn slots(&mut self) -> &mut [[T; 2]] {
        &mut self.slots
    }

    /// Sums the slots of each group after the first pass over the elements, and computes `J_a^(2/3)` and
    /// `p_a` (Pa) of the group for the second pass. `of_nodes` assigns the slots to nodes; it is used if
    /// every group is a node.
    pub fn close(&mut self, path: LanePath, of_nodes: &Border) {
        let Nodal { border, slots, constants, closed } = self;
        border.as_ref().unwrap_or(of_nodes).sum(|slot| slots[slot].map(T::double), |sum| sum, closed);
        let tasks = constants.par_chunks(NODES).zip(closed.par_chunks_mut(NODES));
        tasks.for_each(|(constants, closed)| close(path, constants, closed));
    }

    /// Returns three parts for the second pass: the pair `J_a^(2/3)`, `p_a` of each dilation group; the
    /// slots, into which the caller copies the pairs; and the assignment that gives the group of each slot.
    pub fn closed<'a>(&'a mut self, of_nodes: &'a Border) -> (&'a [[f64; 2]], &'a mut [[T; 2]], &'a Border) {
        (&self.closed, &mut self.slots, self.border.as_ref().unwrap_or(of_nodes))
    }
}

on_path! {
    fn close(constants: &[Constants], closed: &mut [[f64; 2]]) = close_lanes
}

#[inline(always)]
fn close_lanes<const FMA: bool>(constants: &[Constants], closed: &mut [[f64; 2]]) {
    let one = |c: &Constants, [j, b]: [f64; 2]| {
        close_group::<FMA, f64>(j * c.per_volume, b, c.per_volume, [c.mu, c.lambda, c.quadratic])
    };
    // Blocks of fixed length, so that the loop is vectorised.
    let (blocks, rest) = closed.as_chunks_mut::<LANES>();
    let (constants, last) = constants.as_chunks::<LANES>();
    for (c, at) in constants.iter().zip(blocks) {
        let mut lanes = [[0.0; LANES]; 2];
        for l in 0..LANES {
            let [a, b] = one(&c[l], at[l]);
            lanes[0][l] = a;
            lanes[1][l] = b;
        }
        for l in 0..LANES {
            at[l] = [lanes[0][l], lanes[1][l]];
        }
    }
    for (c, at) in last.iter().zip(rest) {
        *at = one(c, *at);
    }
}
