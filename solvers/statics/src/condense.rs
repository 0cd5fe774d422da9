//! Static condensation: the response of a few outputs to loads on a few nodes, as a dense matrix.

use shape::{Rows, Vector3};

use crate::error::SolveError;
use crate::solve::Factored;

/// Displacement of a few points as a linear function of the forces on a few nodes. The operator consists of
/// rows of the inverse stiffness, with one solve for each component of each output. It suits a simulator that
/// evaluates the same points repeatedly. This is the condensation of Bro-Nielsen and Cotin (1996), with
/// separate sets of outputs and loaded nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Condensed {
    /// `3 outputs x 3 loaded nodes`, m/N, row by row.
    operator: Vec<f64>,
    loaded: usize,
    /// Displacement of each output due to the prescribed displacements of the supports alone, m.
    constrained: Vec<Vector3>,
}

impl Factored<'_> {
    /// Condenses the solution to the points of `outputs` (rows over the nodes) and the nodes listed in
    /// `loaded`.
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
                // The stiffness is symmetric. The displacement at all nodes under a unit force on the output
                // is therefore the displacement of the output under a unit force on each node.
                let u = self.solve_forces(&unit, 0.0)?.u;
                operator.extend(loaded.iter().flat_map(|&node| u[node as usize].iter().copied()));
            }
        }
        Ok(Condensed { operator, loaded: loaded.len(), constrained })
    }
}

impl Condensed {
    /// Writes the displacement of every output, m, to `out`: the response to `forces` (N) on the loaded nodes
    /// plus `supports` times the response to the prescribed displacements.
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
            // Three independent sums: in a single sum each addition would wait for the previous addition.
            let mut sums = [0.0; 3];
            for (three, force) in row.chunks_exact(3).zip(forces) {
                sums[0] += three[0] * force.x;
                sums[1] += three[1] * force.y;
                sums[2] += three[2] * force.z;
            }
            out[at / 3][at % 3] += sums[0] + sums[1] + sums[2];
        }
    }

    /// Number of stored coefficients.
    pub fn len(&self) -> usize {
        self.operator.len()
    }

    /// Whether the operator has no loaded node or no output.
    pub fn is_empty(&self) -> bool {
        self.operator.is_empty()
    }
}
