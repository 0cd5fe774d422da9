//! Mass matrices, stored as tables of values with the mass of each point: `M v` is a product with the table.

use algebra::{BlockPattern, Stiffness};
use shape::{Matrix3, Rows, Vector3, VolumeRows};

use super::error::TimeError;
use crate::body::check_len;
use crate::nonlinear::SurfaceTable;

/// Residual of the initial accelerations, relative to their forces.
const ACCURACY: f64 = 1e-13;
/// Limit of iterations. A consistent mass matrix scaled by its diagonal has a condition number below about
/// 100: 1e-13 takes 60 iterations.
const ITERATIONS: usize = 1000;

/// A mass matrix.
#[derive(Clone, Debug)]
pub struct Mass {
    table: SurfaceTable,
    diagonal: Vec<f64>,
}

impl Mass {
    /// Builds a consistent mass matrix, `M_IJ = sum_q w rho N_I N_J`.
    ///
    /// `density` is in kg/m^3 by region; `region` gives the region of every point and is empty if all points
    /// are in region 0. The quadrature may differ from that of the forces, and must do so for quadratic
    /// elements: 4 points of a tet10 give a matrix of rank 4, 14 points (degree 5) the exact matrix.
    ///
    /// # Errors
    /// A length that does not match, or a density that is not positive.
    pub fn consistent(volume: &VolumeRows, density: &[f64], region: &[u16]) -> Result<Mass, TimeError> {
        let weights = volume.weights();
        if !region.is_empty() {
            check_len("regions of the mass table", region.len(), weights.len())?;
        }
        let mut masses = Vec::with_capacity(weights.len());
        for (q, w) in weights.iter().enumerate() {
            let value =
                density.get(region.get(q).copied().unwrap_or(0) as usize).copied().unwrap_or(f64::NAN);
            if !(value > 0.0 && value.is_finite()) {
                return Err(TimeError::Parameter {
                    what: "a density",
                    value,
                    need: "every region needs a positive one",
                });
            }
            masses.push(value * w);
        }
        Mass::of(SurfaceTable::weighted(volume.rows(), masses), volume.rows().node_count())
    }

    /// Builds a diagonal mass matrix from nodal masses, kg.
    pub fn lumped(nodal: &[f64]) -> Result<Mass, TimeError> {
        Mass::of(SurfaceTable::nodal(nodal.to_vec()), nodal.len())
    }

    /// Builds the matrix of masses (kg) that move with the displacements at nodes, for a basis whose nodal
    /// parameters are not displacements.
    ///
    /// With `Lambda_IJ = N_J(x_I)` in the rows of `at_nodes`, `M = Lambda^T diag(m) Lambda`. This is the
    /// lumped mass after the transformation to nodal displacements `d = Lambda u` (Chen, Pan, Wu & Liu,
    /// Comput. Methods Appl. Mech. Engrg. 139 (1996) 195-227). For a basis with the Kronecker property the
    /// result is [`Mass::lumped`].
    pub fn transformed(at_nodes: &Rows, nodal: &[f64]) -> Result<Mass, TimeError> {
        check_len("rows at the nodes", at_nodes.len(), nodal.len())?;
        check_len("nodes of the mass table", at_nodes.node_count(), nodal.len())?;
        positive(nodal)?;
        Mass::of(SurfaceTable::weighted(at_nodes, nodal.to_vec()), nodal.len())
    }

    fn of(table: SurfaceTable, nodes: usize) -> Result<Mass, TimeError> {
        let diagonal = table.diagonal(nodes);
        positive(&diagonal)?;
        Ok(Mass { table, diagonal })
    }

    /// Returns `M v`: the momentum of each node, kg m/s, if `v` is a velocity in m/s.
    pub fn times(&self, v: &[Vector3]) -> Vec<Vector3> {
        self.table.product(v)
    }

    pub(crate) fn node_count(&self) -> usize {
        self.diagonal.len()
    }

    /// Returns the assembled matrix with blocks `M_IJ I`, kg.
    pub(crate) fn matrix(&self) -> Stiffness {
        let rows = &self.table.rows;
        let of_node = rows.incidence(self.node_count());
        let mut matrix =
            Stiffness::zeros(BlockPattern::new(self.node_count(), &[(rows.connectivity(), &of_node)]));
        matrix.for_each_row(|i, slot, row| {
            for &(q, k) in of_node.of(i) {
                let (q, k) = (q as usize, k as usize);
                let weighted = self.table.weights[q] * rows.data[k];
                for j in rows.offsets[q]..=k {
                    row[slot[rows.nodes[j] as usize] as usize] +=
                        Matrix3::identity() * (weighted * rows.data[j]);
                }
            }
        });
        matrix
    }

    pub(crate) fn table(&self) -> &SurfaceTable {
        &self.table
    }

    /// Solves `M a = force` in the free degrees of freedom by conjugate gradients with diagonal
    /// preconditioning. Constrained degrees of freedom keep the values of `a`.
    pub(crate) fn accelerate(
        &self,
        force: &[Vector3],
        constrained: impl Fn(usize, usize) -> bool,
        a: &mut [Vector3],
    ) -> Result<(), TimeError> {
        let free = |v: &mut [Vector3]| {
            for (i, v) in v.iter_mut().enumerate() {
                (0..3).filter(|&axis| constrained(i, axis)).for_each(|axis| v[axis] = 0.0);
            }
        };
        let dot = |x: &[Vector3], y: &[Vector3]| x.iter().zip(y).map(|(x, y)| x.dot(y)).sum::<f64>();
        let scaled =
            |r: &[Vector3]| -> Vec<Vector3> { r.iter().zip(&self.diagonal).map(|(r, m)| r / *m).collect() };
        let mut r: Vec<Vector3> = force.iter().zip(self.times(a)).map(|(f, m)| f - m).collect();
        free(&mut r);
        let size = dot(&r, &r).sqrt();
        if size == 0.0 {
            return Ok(());
        }
        let mut z = scaled(&r);
        let (mut d, mut rz) = (z.clone(), dot(&r, &z));
        let mut iterations = 0;
        loop {
            let residual = dot(&r, &r).sqrt() / size;
            if residual <= ACCURACY {
                return Ok(());
            }
            if iterations == ITERATIONS || !residual.is_finite() {
                return Err(TimeError::SingularMass { iterations, residual });
            }
            let mut product = self.times(&d);
            free(&mut product);
            let step = rz / dot(&d, &product);
            a.iter_mut().zip(&d).for_each(|(a, d)| *a += d * step);
            r.iter_mut().zip(&product).for_each(|(r, p)| *r -= p * step);
            z = scaled(&r);
            let next = dot(&r, &z);
            d.iter_mut().zip(&z).for_each(|(d, z)| *d = z + *d * (next / rz));
            rz = next;
            iterations += 1;
        }
    }
}

fn positive(nodal: &[f64]) -> Result<(), TimeError> {
    match nodal.iter().position(|&m| !(m > 0.0 && m.is_finite())) {
        Some(node) => Err(TimeError::NodalMass { node, mass: nodal[node] }),
        None => Ok(()),
    }
}
