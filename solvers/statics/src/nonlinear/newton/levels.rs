//! Multigrid levels of a tangent, which precondition the iterations of the following tangents too.

use algebra::{SolverPath, TangentLevels};
use shape::{Matrix3, Vector3};

use crate::nonlinear::system::System;

/// Largest number of iterations, after which the tangent is factored.
const MOST: usize = 80;
/// Iterations that cost as much as new levels. Levels are renewed when the tangents since then have taken as
/// many iterations more than they would have taken with levels of their own.
const RENEWAL: f64 = 20.0;

/// Skew part of a tangent: (surface, point, block) for every sliding point.
pub(super) type SkewPoints = Vec<(usize, usize, Matrix3)>;

/// Memory of the iterations: the levels of an earlier tangent, and how well they serve.
#[derive(Default)]
pub(super) struct Levels {
    levels: Option<TangentLevels>,
    /// Iterations per decade of the residual with the tangent of the levels.
    rate: f64,
    /// Iterations beyond that rate since the levels were built.
    lost: f64,
    /// Whether iterations have failed since the last equilibrium, on a tangent that was not indefinite.
    pub failed: bool,
    /// Iterative solver that found a step, if any.
    pub path: Option<SolverPath>,
}

impl Levels {
    /// Returns the levels unless they are to be renewed.
    pub fn current(&mut self) -> Option<&mut TangentLevels> {
        self.levels.as_mut().filter(|_| self.lost <= RENEWAL)
    }

    /// Replaces the levels; `None` drops them.
    pub fn replace(&mut self, levels: Option<TangentLevels>) {
        (self.levels, self.lost) = (levels, 0.0);
    }

    /// Solves a system in place to a relative residual of `goal`, or as far as the iterations lead. Returns
    /// the number of iterations and whether the goal is reached. `fresh` states that the levels belong to
    /// this very tangent.
    pub fn iterate(
        &mut self,
        system: &System,
        skew: &SkewPoints,
        x: &mut [Vector3],
        (goal, fresh): (f64, bool),
    ) -> (usize, bool) {
        let Some(levels) = &self.levels else { return (0, false) };
        let product = |u: &[Vector3], out: &mut [Vector3]| {
            system.stiffness.multiply_into(u, out);
            system.add_skew(skew, u, out);
        };
        let (count, solved) = levels.solve(&product, x, goal, MOST);
        let decades = -goal.log10();
        if fresh {
            self.rate = count as f64 / decades;
        }
        self.lost += (count as f64 - self.rate * decades).max(0.0);
        if solved {
            self.path = Some(levels.path());
        }
        (count, solved)
    }

    /// Solves a chord in place, to a residual of `goal` or as far as the iterations lead: a chord reduces the
    /// residual of Newton's method in both cases. Returns the number of iterations.
    pub fn chord(&mut self, system: &System, skew: &SkewPoints, b: &mut [f64], goal: f64) -> usize {
        let mut x = vec![Vector3::zeros(); system.place.len() / 3];
        system.scatter_add(b, 1.0, &mut x, &mut []);
        let (count, _) = self.iterate(system, skew, &mut x, (goal, false));
        b.copy_from_slice(&system.gather(&x, &[]));
        count
    }

    /// Returns the number of conjugate-gradient iterations that prove the assembled tangent definite; `None`
    /// if they do not.
    pub fn prove_definite(&self, system: &System) -> Option<usize> {
        self.levels.as_ref().and_then(|levels| levels.proves_definite(&system.stiffness))
    }
}
