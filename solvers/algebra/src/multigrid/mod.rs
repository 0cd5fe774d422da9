//! Conjugate gradients with a multigrid preconditioner: smoothed aggregation with the six rigid motions.
//!
//! The finest level has blocks of 3 x 3, the others, whose nodes are aggregates that move as rigid bodies, of 6 x 6. A quadratic mesh has
//! its linear one as first coarse level ([`Coarser`]). Each level is swept forward and backward by block Gauss-Seidel in
//! chunks, the coarsest is solved directly. The hierarchy is in single precision but for its coarse matrices while they are made,
//! the iteration and its residual in double.
//!
//! Nearly incompressible stiffnesses are split: see [`pressure`].
//!
//! Source: Vanek, Mandel and Brezina 1996, Computing 56, 179.

mod aggregate;
mod conjugate;
mod galerkin;
mod graph;
mod level;
mod lower;
mod operator;
mod pressure;
mod sets;
mod sweep;
#[cfg(test)]
mod tests;
mod transfer;

use shape::{Coarser, Point3};

use crate::linear_solver::FactorError;
use crate::{SolverPath, Stiffness};
use aggregate::Modes;
use level::Level;
use lower::{Held, LowerRows};
use operator::Entry;
use pressure::Pressures;
use transfer::Transfer;

pub use conjugate::Iterations;
pub use pressure::PressureGroup;

/// A stiffness with its hierarchy; serves any number of right-hand sides.
pub struct Multigrid {
    finest: Box<dyn Level<3>>,
    /// Per degree of freedom `3 node + axis`.
    held: Vec<bool>,
    /// Number of degrees of freedom that are not held.
    free: usize,
    levels: Vec<(usize, usize)>,
    /// What the finest matrix was multiplied by.
    scale: f64,
    pressures: Option<Box<Pressures>>,
}

impl Multigrid {
    /// The hierarchy of a positive definite stiffness at nodes, m; `held` per degree of freedom `3 node + axis`; `linear` is the mesh
    /// of the next level if there is one.
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

    /// For a nearly incompressible stiffness: `without` is what the hierarchy was made of, and the solved one adds
    /// `excess / volume row row^T` for every group. Their pressures are iterated with the displacements.
    pub fn with_pressures(self, without: Stiffness, groups: &[PressureGroup]) -> Multigrid {
        let pressures = Pressures::new(without, groups, &self.held);
        Multigrid { pressures: Some(Box::new(pressures)), ..self }
    }

    /// What a solution is recorded as.
    pub fn path(&self) -> SolverPath {
        if self.pressures.is_some() { SolverPath::MultigridPressures } else { SolverPath::Multigrid }
    }

    /// Number of unknowns.
    pub fn dim(&self) -> usize {
        self.free
    }

    /// Degrees of freedom and entries of the matrix of each level, the finest first.
    pub fn levels(&self) -> &[(usize, usize)] {
        &self.levels
    }

    /// Entries of the matrices of all levels over those of the finest.
    pub fn complexity(&self) -> f64 {
        self.levels.iter().map(|level| level.1 as f64).sum::<f64>() / self.levels[0].1 as f64
    }
}

/// Translations and rotations about the centre of the nodes, lengths over the largest distance from it; zero where held.
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
