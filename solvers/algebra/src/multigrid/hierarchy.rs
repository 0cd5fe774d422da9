//! Levels of a stiffness, from the finest to the coarsest.

use rayon::prelude::*;
use shape::{Coarser, Point3, Vector3};

use super::aggregate::Modes;
use super::level::{self, Level};
use super::lower_triangle::{Held, LowerRows};
use super::transfer::Transfer;
use crate::linear_solver::FactorError;
use crate::stiffness::Stiffness;
use crate::vectors::GRAIN;

/// Levels of a stiffness, with its constrained degrees of freedom.
pub(super) struct Hierarchy {
    pub(super) finest: Box<dyn Level<3>>,
    /// Whether each degree of freedom `3 node + axis` is constrained.
    pub(super) held: Vec<bool>,
    /// Number of unconstrained degrees of freedom.
    pub(super) free: usize,
    /// Degrees of freedom and matrix entries of each level, finest first.
    pub(super) levels: Vec<(usize, usize)>,
    /// Factor on the finest matrix.
    pub(super) scale: f64,
}

impl Hierarchy {
    /// Builds the hierarchy of a positive definite stiffness.
    ///
    /// `nodes` are the node positions, m. `held` marks the constrained degrees of freedom `3 node + axis`.
    /// `linear` is the mesh of the next level, if there is one. `patch` lists the nodes on weak supports,
    /// ascending.
    ///
    /// # Errors
    ///
    /// [`FactorError`] if the coarsest matrix cannot be factored.
    pub(super) fn new(
        stiffness: &Stiffness,
        nodes: &[Point3],
        held: Vec<bool>,
        linear: Option<&Coarser>,
        patch: &[u32],
    ) -> Result<Hierarchy, FactorError> {
        let lower = Held::new(stiffness, &held);
        let scale = if lower.unit() > 0.0 { 1.0 / lower.unit() } else { 1.0 };
        let modes = rigid_motions(nodes, &held);
        let finest = match linear {
            Some(linear) => {
                let modes: Vec<Modes<3>> = linear.places.iter().map(|&i| modes[i as usize]).collect();
                level::nested(&lower, Transfer::nested(linear, &held), &modes, scale)?
            }
            None => level::by_aggregates(&lower, &modes, scale, patch)?,
        };
        let mut levels = Vec::new();
        finest.sizes(&mut levels);
        let free = held.iter().filter(|held| !**held).count();
        Ok(Hierarchy { finest, held, free, levels, scale })
    }

    /// Returns a first solution, zero except on weak supports, and its residual. `b` is zero at constrained
    /// degrees of freedom.
    pub(super) fn start(&self, stiffness: &Stiffness, b: &[Vector3]) -> (Vec<Vector3>, Vec<Vector3>) {
        let mut x = vec![Vector3::zeros(); b.len()];
        if !self.finest.has_patch() {
            return (x, b.to_vec());
        }
        self.finest.start(b, &mut x);
        let mut rest = stiffness.multiply(&x);
        self.release(&mut rest);
        rest.iter_mut().zip(b).for_each(|(rest, b)| *rest = b - *rest);
        (x, rest)
    }

    /// Sets the entries of constrained degrees of freedom to zero.
    pub(super) fn release(&self, x: &mut [Vector3]) {
        let of_nodes = x.par_iter_mut().zip(self.held.par_chunks_exact(3)).with_min_len(GRAIN);
        of_nodes.for_each(|(x, held)| (0..3).filter(|&a| held[a]).for_each(|a| x[a] = 0.0));
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
