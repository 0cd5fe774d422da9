//! Multigrid levels of a tangent, which precondition the iterations of the following tangents too.

use algebra::{SolverPath, TangentLevels};
use shape::Vector3;

use crate::nonlinear::system::{Skew, System};

/// Largest number of iterations, after which the tangent is factored.
const MOST: usize = 80;
/// Iterations that cost as much as new levels. Levels are renewed when the tangents since then have taken as
/// many iterations more than they would have taken with levels of their own.
const RENEWAL: f64 = 20.0;

/// Number of failures since the last equilibrium after which tangents are factored until the next one.
const FAILURES: usize = 2;
/// Number of solved tangents that pay for a failure: the time of levels and of their iterations in vain.
const PRICE: usize = 4;
/// Unpaid price from which on all tangents of the path are factored.
const DEBT: usize = 3 * PRICE;

/// Memory of the iterations: the levels of an earlier tangent, and how well they serve.
#[derive(Default)]
pub(super) struct Levels {
    levels: Option<TangentLevels>,
    /// Iterations per decade of the residual with the tangent of the levels.
    rate: f64,
    /// Iterations beyond that rate since the levels were built.
    lost: f64,
    /// Whether iterations failed on a tangent that was not factored since.
    failed: bool,
    /// Number of failures since the last equilibrium.
    failures: usize,
    /// Price of all failures that is not yet paid by solved tangents.
    debt: usize,
    /// Iterative solver that found a step, if any.
    pub path: Option<SolverPath>,
}

impl Levels {
    /// Whether iterations may be tried.
    pub fn serve(&self) -> bool {
        !self.failed && self.failures < FAILURES && self.debt < DEBT
    }

    /// Records that a tangent was solved.
    pub fn succeed(&mut self) {
        self.debt = self.debt.saturating_sub(1);
    }

    /// Records that a tangent was not solved by levels of its own.
    pub fn fail(&mut self) {
        self.failed = true;
        self.failures += 1;
        self.debt += PRICE;
    }

    /// Records whether the factor of a tangent showed the tangent to be definite. Iterations that failed on
    /// an indefinite tangent may succeed on the next one. After a failure on a definite tangent they are not
    /// tried again before the next equilibrium.
    pub fn factored(&mut self, definite: bool) {
        if std::mem::take(&mut self.failed) && definite {
            self.failures = FAILURES;
        }
    }

    /// Records an equilibrium.
    pub fn settle(&mut self) {
        (self.failed, self.failures) = (false, 0);
    }

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
        skew: &Skew,
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
    pub fn chord(&mut self, system: &System, skew: &Skew, b: &mut [f64], goal: f64) -> usize {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn iterations_are_given_up_for_a_step_and_then_for_the_path() {
        let mut levels = Levels::default();
        let fails = |levels: &mut Levels, definite: bool| {
            assert!(levels.serve());
            levels.fail();
            assert!(!levels.serve());
            levels.factored(definite);
        };
        fails(&mut levels, false);
        fails(&mut levels, false);
        assert!(!levels.serve(), "the second failure of a step");
        levels.settle();
        (0..PRICE).for_each(|_| levels.succeed());
        fails(&mut levels, true);
        assert!(!levels.serve(), "a failure on a definite tangent");
        levels.settle();
        fails(&mut levels, false);
        levels.settle();
        assert!(!levels.serve(), "three failures that four solved tangents do not pay");
        (0..PRICE).for_each(|_| levels.succeed());
        assert!(levels.serve());
    }
}
