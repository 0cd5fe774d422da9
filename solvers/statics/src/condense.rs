//! Repeated linear solves without a solve: what few outputs answer to loads on few nodes, as a dense matrix.

use shape::Rows;
use shape::Vector3;

use crate::{Factored, SolveError};

/// Displacement at a few points as a linear function of forces on a few nodes: rows of the inverse stiffness, one solve
/// for each component of each output. What a simulator keeps that asks for the same points again and again; the
/// condensation of Bro-Nielsen and Cotin (1996), with outputs and loads apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Condensed {
    /// `3 outputs x 3 loaded nodes`, m/N, by rows.
    operator: Vec<f64>,
    loaded: usize,
    /// What the supports' own displacements make of each output, m.
    constrained: Vec<Vector3>,
}

impl Factored<'_> {
    /// Condenses to the points of `outputs` (rows over the nodes) and the nodes that `loaded` names.
    pub fn condense(&self, outputs: &Rows, loaded: &[u32]) -> Result<Condensed, SolveError> {
        let count = self.node_count();
        let constrained = outputs.apply(&self.solve_forces(&vec![Vector3::zeros(); count], 1.0)?.u);
        let mut operator = Vec::with_capacity(9 * outputs.len() * loaded.len());
        for output in 0..outputs.len() {
            let (nodes, values) = outputs.row(output);
            for axis in 0..3 {
                let mut unit = vec![Vector3::zeros(); count];
                for (&node, value) in nodes.iter().zip(values) {
                    unit[node as usize][axis] += *value;
                }
                // The stiffness is symmetric: what a unit force on the output does everywhere is what the output
                // makes of a unit force anywhere.
                let u = self.solve_forces(&unit, 0.0)?.u;
                operator.extend(loaded.iter().flat_map(|&node| u[node as usize].iter().copied()));
            }
        }
        Ok(Condensed { operator, loaded: loaded.len(), constrained })
    }
}

impl Condensed {
    /// Displacement of every output, m, under `forces` (N) on the loaded nodes and `supports` times what supports
    /// prescribe.
    pub fn apply(&self, forces: &[Vector3], supports: f64, out: &mut [Vector3]) {
        assert_eq!(
            (forces.len(), out.len()),
            (self.loaded, self.constrained.len()),
            "forces and outputs of this operator"
        );
        let rows = self.operator.chunks_exact((3 * self.loaded).max(1));
        for (output, row) in out.iter_mut().zip(&self.constrained) {
            *output = row * supports;
        }
        for (at, row) in rows.enumerate() {
            // Three sums side by side: one of its own would wait for each addition.
            let mut sums = [0.0; 3];
            for (three, force) in row.chunks_exact(3).zip(forces) {
                sums[0] += three[0] * force.x;
                sums[1] += three[1] * force.y;
                sums[2] += three[2] * force.z;
            }
            out[at / 3][at % 3] += sums[0] + sums[1] + sums[2];
        }
    }

    /// Numbers kept.
    pub fn len(&self) -> usize {
        self.operator.len()
    }

    /// Whether nothing is loaded or nothing asked for.
    pub fn is_empty(&self) -> bool {
        self.operator.is_empty()
    }
}
