//! Extended position-based dynamics: one constraint after another is relaxed.

use shape::Vector3;

use super::colours::colours;
use super::equations::{Equations, Sweeper};
use super::parallel::fill;
use super::tetrahedra::{Tetrahedron, cofactor};
use crate::lists::Lists;

/// Tetrahedra per task.
const CHUNK: usize = 128;

/// Extended position-based dynamics with the stable neo-Hookean energy as two constraints of each
/// tetrahedron, `C_D = |F|` with the compliance `1 / (mu V)`, and `C_H = J - 1 - mu/bulk` with `1 / (bulk
/// V)`.
///
/// Each sweep changes the multiplier of each constraint once, from zero at the start of the time step: `dl =
/// (-C - a l) / (sum |grad C|^2 / w + a)`, `du = grad C dl / w`. Tetrahedra of one colour share no node.
/// Sources: Macklin, Muller and Chentanez, MIG (2016); Macklin and Muller, MIG (2021).
pub(super) struct Constraints {
    tetrahedra: Vec<Tetrahedron>,
    /// Tetrahedra of each colour.
    colours: Vec<Vec<u32>>,
    sweeps: usize,
    /// Multipliers of each tetrahedron, J.
    multipliers: Vec<[f64; 2]>,
    changed: Vec<([Vector3; 4], [f64; 2])>,
}

impl Constraints {
    /// Prepares the sweeps of a body with some number of `nodes`.
    pub fn new(tetrahedra: Vec<Tetrahedron>, nodes: usize, sweeps: usize) -> Constraints {
        let pairs = (tetrahedra.iter().zip(0u32..)).flat_map(|(of, t)| of.nodes.map(|node| (node, t)));
        let around = Lists::new(nodes, pairs);
        let colours = colours(tetrahedra.len(), |t, see| {
            for node in tetrahedra[t as usize].nodes {
                around.of(node as usize).iter().for_each(|&other| see(other));
            }
        });
        let multipliers = vec![[0.0; 2]; tetrahedra.len()];
        Constraints { tetrahedra, colours, sweeps, multipliers, changed: Vec::new() }
    }

    /// Displacements (m) of the corners of a tetrahedron and its multipliers after both constraints.
    fn relaxed(&self, t: u32, equations: &Equations, u: &[Vector3]) -> ([Vector3; 4], [f64; 2]) {
        let of = &self.tetrahedra[t as usize];
        let mut at = of.nodes.map(|node| u[node as usize]);
        let yields = of.nodes.map(|node| equations.yields(node as usize));
        let [mut shape, mut volume] = self.multipliers[t as usize];
        let h = of.gradient(&at);
        // |F|^2 = 3 + 2 tr H + H : H.
        let norm = (3.0 + 2.0 * h.trace() + h.norm_squared()).sqrt();
        let grads = of.grads.map(|g| (h * g + g) / norm);
        shape += relax(norm, &grads, 1.0 / (of.mu * of.volume), shape, &yields, &mut at);
        let (cof, j_minus_1) = cofactor(&of.gradient(&at));
        let grads = of.grads.map(|g| cof * g);
        let lacking = j_minus_1 - of.mu / of.bulk;
        volume += relax(lacking, &grads, 1.0 / (of.bulk * of.volume), volume, &yields, &mut at);
        (at, [shape, volume])
    }

    /// Pushes the contact points out of the tools, one after another.
    fn push(&self, equations: &Equations, u: &mut [Vector3], multipliers: &mut [f64]) {
        let Some(touch) = equations.touch else { return };
        touch.relax(&|node| equations.yields(node), u, multipliers);
    }
}

/// Changes the displacements `at` (m) by one relaxation of a constraint, and returns the change of its
/// multiplier.
fn relax(
    value: f64,
    grads: &[Vector3; 4],
    compliance: f64,
    multiplier: f64,
    yields: &[Vector3; 4],
    at: &mut [Vector3; 4],
) -> f64 {
    let stiff: f64 = grads.iter().zip(yields).map(|(g, y)| g.component_mul(g).dot(y)).sum();
    let change = (-value - compliance * multiplier) / (stiff + compliance);
    for ((at, g), y) in at.iter_mut().zip(grads).zip(yields) {
        *at += g.component_mul(y) * change;
    }
    change
}

impl Sweeper for Constraints {
    fn solve(&mut self, equations: &Equations, u: &mut [Vector3]) {
        self.multipliers.fill([0.0; 2]);
        let mut pushed = vec![0.0; equations.touch.map_or(0, |touch| touch.pairs())];
        for (i, u) in u.iter_mut().enumerate() {
            *u += equations.load[i].component_mul(&equations.yields(i));
        }
        for _ in 0..self.sweeps {
            for k in 0..self.colours.len() {
                let mut changed = std::mem::take(&mut self.changed);
                let colour = &self.colours[k];
                changed.resize(colour.len(), ([Vector3::zeros(); 4], [0.0; 2]));
                fill(&mut changed, CHUNK, |k| self.relaxed(colour[k], equations, u));
                for (&t, (at, multipliers)) in colour.iter().zip(&changed) {
                    let nodes = self.tetrahedra[t as usize].nodes;
                    nodes.into_iter().zip(at).for_each(|(node, at)| u[node as usize] = *at);
                    self.multipliers[t as usize] = *multipliers;
                }
                self.changed = changed;
            }
            self.push(equations, u, &mut pushed);
        }
    }
}
