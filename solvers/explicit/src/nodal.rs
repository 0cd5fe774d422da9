//! Nodal-mean dilation on tetrahedra: `J_a = sum_q share w J_q / V_a` at the nodes, between two passes over the elements.
//!
//! For the neo-Hookean law the sum over pairs (node a, point q) splits,
//!
//! ```text
//! E = sum_q w mu/2 (J_q^(-2/3) I1_q S_q - 3) + sum_a (-M_a ln J_a + L_a/2 (ln J_a)^2),
//! S_q = sum_a share J_a^(2/3),  M_a = sum_q share w mu,  L_a = sum_q share w lambda,
//! ```
//!
//! so the first pass brings two numbers to each node, `sum share w (J - 1)` and `B_a = sum share w mu b_q` with
//! `b = J^(-2/3) I1 / 3 - 1`; the second takes two back, `J_a^(2/3)` and
//! `p_a = (1/V_a) dE/dJ_a = (B_a (1 + sigma) + sigma M_a + L_a ln J_a) / (J_a V_a)`, `sigma = J_a^(2/3) - 1`.
//!
//! Laws whose shape part does not change with `J` have no `B_a` and `M_a`. Their volumetric energies `L_a/2 (ln J_a)^2` and
//! `K_a/2 (J_a - 1)^2` give `p_a = (L_a ln J_a / J_a + K_a (J_a - 1)) / V_a`; a node may have parts of several laws.

use rayon::prelude::*;
use shape::DilationGroups;

use super::chunks::Border;
use super::force::ExplicitBody;
use super::moduli::{LaneLaw, close_group};
use lanes::{LANES, LanePath, on_path};

/// Nodes per task.
const NODES: usize = 1024;

pub(super) struct Nodal {
    /// `sum share w (J - 1)` and `B_a` of each slot, then what `closed` has for it.
    slots: Vec<[f64; 2]>,
    constants: Vec<Constants>,
    /// `sum share w (J - 1)` and `B_a` of each node, then `J_a^(2/3)` and `p_a`.
    closed: Vec<[f64; 2]>,
}

/// Of one node: `1 / V_a` (1/m^3), `M_a`, `L_a` and `K_a` (J).
#[derive(Clone, Copy)]
struct Constants {
    per_volume: f64,
    mu: f64,
    lambda: f64,
    quadratic: f64,
}

impl Nodal {
    /// None unless the groups are those of [`DilationGroups::nodal`] with four even shares.
    pub fn new(
        body: &ExplicitBody,
        groups: &DilationGroups,
        laws: &[LaneLaw],
        slots: usize,
    ) -> Option<Nodal> {
        let (rows, weights) = (body.volume.rows(), body.volume.weights());
        let even = rows.values().iter().all(|n| (n - 0.25).abs() < 1e-14);
        if !even || DilationGroups::nodal(body.volume).as_ref() != Ok(groups) {
            return None;
        }
        let mut sums = vec![[0.0; 4]; rows.node_count()];
        let moduli: Vec<[f64; 3]> = laws.iter().map(LaneLaw::of_group).collect();
        for (q, &w) in weights.iter().enumerate() {
            let [mu, lambda, quadratic] = moduli[body.region(q) as usize];
            for &node in rows.row(q).0 {
                let s = &mut sums[node as usize];
                s[0] += 0.25 * w;
                s[1] += 0.25 * w * mu;
                s[2] += 0.25 * w * lambda;
                s[3] += 0.25 * w * quadratic;
            }
        }
        // A node of no element has no volume; nothing reads what comes out there.
        let constants = |s: &[f64; 4]| Constants {
            per_volume: if s[0] > 0.0 { 1.0 / s[0] } else { 0.0 },
            mu: s[1],
            lambda: s[2],
            quadratic: s[3],
        };
        Some(Nodal {
            slots: vec![[0.0; 2]; slots],
            constants: sums.iter().map(constants).collect(),
            closed: vec![[0.0; 2]; rows.node_count()],
        })
    }

    pub fn slots(&mut self) -> &mut [[f64; 2]] {
        &mut self.slots
    }

    /// From the sums of the first pass to what the second needs.
    pub fn close(&mut self, path: LanePath, border: &Border) {
        let Nodal { slots, constants, closed } = self;
        border.sum(|slot| slots[slot], |sum| sum, closed);
        let tasks = constants.par_chunks(NODES).zip(closed.par_chunks_mut(NODES));
        tasks.for_each(|(constants, closed)| close(path, constants, closed));
    }

    /// `J_a^(2/3)` and `p_a` of each node, and the slots to bring them to.
    pub fn closed(&mut self) -> (&[[f64; 2]], &mut [[f64; 2]]) {
        (&self.closed, &mut self.slots)
    }
}

on_path! {
    fn close(constants: &[Constants], closed: &mut [[f64; 2]]) = close_lanes
}

#[inline(always)]
fn close_lanes<const FMA: bool>(constants: &[Constants], closed: &mut [[f64; 2]]) {
    let one = |c: &Constants, [j, b]: [f64; 2]| {
        close_group::<FMA>(j * c.per_volume, b, c.per_volume, [c.mu, c.lambda, c.quadratic])
    };
    // In blocks of fixed length, so that the loop becomes vector instructions.
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
