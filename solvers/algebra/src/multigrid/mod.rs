//! Conjugate gradients with a multigrid preconditioner: smoothed aggregation with the six rigid motions.
//!
//! The finest level has blocks of 3 x 3. The nodes of the other levels are aggregates that move as rigid
//! bodies, with blocks of 6 x 6. The first coarse level of a quadratic mesh is its linear mesh ([`Coarser`]).
//! Each level is smoothed by forward and backward sweeps of block Gauss-Seidel in chunks. The coarsest level
//! is solved directly. The hierarchy is stored in single precision, but its coarse matrices are computed in
//! double precision. The iteration and its residual are in double precision.
//!
//! Nearly incompressible stiffnesses are split: see [`pressure`].
//!
//! Source: Vanek, Mandel and Brezina 1996, Computing 56, 179.

mod aggregate;
mod conjugate;
mod galerkin;
mod graph;
mod level;
mod lower_triangle;
mod operator;
mod pressure;
mod row_sets;
mod sweep;
#[cfg(test)]
mod tests;
mod transfer;

use shape::{Coarser, Point3};

use crate::linear_solver::FactorError;
use crate::{SolverPath, Stiffness};
use aggregate::Modes;
use level::Level;
use lower_triangle::{Held, LowerRows};
use operator::Entry;
use pressure::Pressures;
use transfer::Transfer;

pub use conjugate::Iterations;
pub use pressure::PressureGroup;

/// Multigrid hierarchy of a stiffness, for any number of right-hand sides.
pub struct Multigrid {
    finest: Box<dyn Level<3>>,
    /// Whether each degree of freedom `3 node + axis` is constrained.
    held: Vec<bool>,
    /// Number of unconstrained degrees of freedom.
    free: usize,
    levels: Vec<(usize, usize)>,
    /// Factor on the finest matrix.
    scale: f64,
    pressures: Option<Box<Pressures>>,
}

impl Multigrid {
    /// Builds the hierarchy of a positive definite stiffness.
    ///
    /// `nodes` are the node positions, m. `held` marks the constrained degrees of freedom `3 node + axis`.
    /// `linear` is the linear mesh of the next level, for quadratic elements.
    ///
    /// # Errors
    ///
    /// [`FactorError`] if the coarsest matrix cannot be factored.
    pub fn new(
        stiffness: &Stiffness,
        nodes: &[Point3],
        held: Vec<bool>,
        linear: Option<&Coarser>,
    ) -> Result<Multigrid, FactorError> {
        let lower = Held::new(stiffness, &held);
        let scale = if lower.unit() > 0.0 { 1.0 / lower.unit() } else { 1.0 };
        let modes = rigid_motions(nodes, &held);
        let finest = match linear {
            Some(linear) => {
                let modes: Vec<Modes<3>> = linear.places.iter().map(|&i| modes[i as usize]).collect();
                level::nested(&lower, Transfer::nested(linear, &held), &modes, scale)?
            }
            None => level::by_aggregates(&lower, &modes, scale)?,
        };
        let mut levels = Vec::new();
        finest.sizes(&mut levels);
        let free = held.iter().filter(|held| !**held).count();
        Ok(Multigrid { finest, held, free, levels, scale, pressures: None })
    }

    /// Adds pressures as unknowns, for a nearly incompressible stiffness.
    ///
    /// `without` is the stiffness from which the hierarchy was built. The stiffness to be solved adds
    /// `excess / volume row row^T` for every group. The pressures of the groups are iterated with the
    /// displacements.
    pub fn with_pressures(self, without: Stiffness, groups: &[PressureGroup]) -> Multigrid {
        let pressures = Pressures::new(without, groups, &self.held);
        Multigrid { pressures: Some(Box::new(pressures)), ..self }
    }

    /// Returns the solver path under which a solution is recorded.
    pub fn path(&self) -> SolverPath {
        if self.pressures.is_some() { SolverPath::MultigridPressures } else { SolverPath::Multigrid }
    }

    /// Number of unknowns.
    pub fn dim(&self) -> usize {
        self.free
    }

    /// Degrees of freedom and matrix entries of each level, finest first.
    pub fn levels(&self) -> &[(usize, usize)] {
        &self.levels
    }

    /// Operator complexity: matrix entries of all levels over those of the finest.
    pub fn complexity(&self) -> f64 {
        self.levels.iter().map(|level| level.1 as f64).sum::<f64>() / self.levels[0].1 as f64
    }
}

/// Returns the translations and the rotations about the centre of the nodes. Lengths are relative to the
/// largest distance from the centre. Entries of constrained degrees of freedom are zero.
fn rigid_motions(nodes: &[Point3], held: &[bool]) -> Vec<Modes<3>> {
    let centre = nodes.iter().fold(nalgebra::Vector3::zeros(), |sum, x| sum + x.coords) / nodes.len() as f64;
    let reach = nodes.iter().map(|x| (x.coords - centre).norm()).fold(0.0, f64::max);
    let over = if reach > 0.0 { 1.0 / reach } else { 1.0 };
    let of_node = |(i, x): (usize, &Point3)| {
        let d = (x.coords - centre) * over;
        let mut rows = [
            [1.0, 0.0, 0.0, 0.0, d.z, -d.y],
            [0.0, 1.0, 0.0, -d.z, 0.0, d.x],
            [0.0, 0.0, 1.0, d.y, -d.x, 0.0],
        ];
        for (row, held) in rows.iter_mut().zip(&held[3 * i..]) {
            if *held {
                *row = [0.0; 6];
            }
        }
        rows
    };
    nodes.iter().enumerate().map(of_node).collect()
}
