//! Vertex block descent: one vertex after another moves to the minimum of the energy.

use shape::{Matrix3, Vector3};

use super::colours::colours;
use super::equations::{Equations, Sweeper};
use super::parallel::fill;
use super::tetrahedra::{Tetrahedron, cofactor};
use crate::lists::Lists;

/// Vertices per task.
const CHUNK: usize = 128;

/// Vertex block descent. In a sweep each vertex minimises `w/2 |u - y|^2 + E(u) - f_ext . u` over its own
/// position.
///
/// The stable neo-Hookean energy is quadratic in the position of one vertex, since `J` is linear in it, so
/// one Newton step is the minimum: `H = w I + sum V (mu |g|^2 I + bulk q q^T)`, `q = cof(F) g`. Vertices of
/// one colour share no tetrahedron; their order does not matter. Source: Chen, Liu, Yang and Yuksel, ACM
/// Trans. Graph. 43 (2024) 116.
pub(super) struct VertexDescent {
    tetrahedra: Vec<Tetrahedron>,
    /// Tetrahedra of each vertex.
    around: Lists,
    /// Vertices of each colour.
    colours: Vec<Vec<u32>>,
    sweeps: usize,
    moved: Vec<Vector3>,
}

impl VertexDescent {
    /// Prepares the sweeps of `nodes` vertices.
    pub fn new(tetrahedra: Vec<Tetrahedron>, nodes: usize, sweeps: usize) -> VertexDescent {
        let pairs = (tetrahedra.iter().zip(0u32..)).flat_map(|(of, t)| of.nodes.map(|node| (node, t)));
        let around = Lists::new(nodes, pairs);
        let colours = colours(nodes, |node, see| {
            for &t in around.of(node as usize) {
                tetrahedra[t as usize].nodes.into_iter().for_each(&mut *see);
            }
        });
        VertexDescent { tetrahedra, around, colours, sweeps, moved: Vec::new() }
    }

    /// Displacement of a vertex (m) at the minimum of the energy with all others fixed; NaN if there is none.
    fn minimum(&self, node: u32, equations: &Equations, u: &[Vector3]) -> Vector3 {
        let i = node as usize;
        let weight = equations.weights[i];
        let mut force = equations.load[i] - (u[i] - equations.inertial[i]) * weight;
        let mut stiffness = Matrix3::identity() * weight;
        for &t in self.around.of(i) {
            let of = &self.tetrahedra[t as usize];
            let corner = of.nodes.iter().position(|&other| other == node).unwrap_or(0);
            let (g, h) = (of.grads[corner], of.gradient(&of.nodes.map(|a| u[a as usize])));
            let (cof, j_minus_1) = cofactor(&h);
            let q = cof * g;
            // P g with P = mu (F - cof F) + bulk (J - 1) cof F.
            force -= ((h * g + g - q) * of.mu + q * (of.bulk * j_minus_1)) * of.volume;
            stiffness += Matrix3::identity() * (of.volume * of.mu * g.norm_squared());
            stiffness += q * q.transpose() * (of.volume * of.bulk);
        }
        if let Some(touch) = equations.touch {
            let (pushed, resists) = touch.on_node(i, u);
            force += pushed;
            stiffness += resists;
        }
        for axis in (0..3).filter(|&axis| equations.constrained[i][axis]) {
            force[axis] = 0.0;
            stiffness.row_mut(axis).fill(0.0);
            stiffness.column_mut(axis).fill(0.0);
            stiffness[(axis, axis)] = 1.0;
        }
        match stiffness.cholesky() {
            Some(factor) => u[i] + factor.solve(&force),
            None => Vector3::repeat(f64::NAN),
        }
    }
}

impl Sweeper for VertexDescent {
    fn solve(&mut self, equations: &Equations, u: &mut [Vector3]) {
        for _ in 0..self.sweeps {
            for k in 0..self.colours.len() {
                let mut moved = std::mem::take(&mut self.moved);
                let colour = &self.colours[k];
                moved.resize(colour.len(), Vector3::zeros());
                fill(&mut moved, CHUNK, |k| self.minimum(colour[k], equations, u));
                colour.iter().zip(&moved).for_each(|(&node, to)| u[node as usize] = *to);
                self.moved = moved;
            }
        }
    }
}
