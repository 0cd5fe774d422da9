//! Directions of negative curvature, along which a matrix is not definite.

use nalgebra::Matrix4;

use super::Factor;
use super::refine::dot;
use super::symmetric::Symmetric;
use crate::error::AlgebraError;

/// Largest number of iterations of the search. A search with a warm start ends after two to four.
const ROUNDS: usize = 8;
/// Relative change of the quotient at which the search ends. Shifts are tried by factors of ten.
const SETTLED: f64 = 0.1;

/// Vector x with a small quotient `x . K x / x . D x`, D the diagonal of K. A negative quotient -q proves
/// that `K + s D` is not definite for any s below q. The vector found for one matrix starts the search for
/// the next.
#[derive(Clone, Debug, Default)]
pub struct Curvature {
    x: Vec<f64>,
}

/// Trial vector x with its products `K x` and `D x`.
#[derive(Clone)]
struct Tried {
    x: Vec<f64>,
    k: Vec<f64>,
    d: Vec<f64>,
}

impl Tried {
    fn new(x: Vec<f64>, matrix: &Symmetric, diagonal: &[f64]) -> Tried {
        let mut k = vec![0.0; x.len()];
        matrix.subtract_product(&x, &mut k);
        k.iter_mut().for_each(|k| *k = -*k);
        let d = x.iter().zip(diagonal).map(|(x, d)| x * d).collect();
        Tried { x, k, d }
    }

    fn add(&mut self, other: &Tried, factor: f64) {
        let both = |a: &mut Vec<f64>, b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
        both(&mut self.x, &other.x);
        both(&mut self.k, &other.k);
        both(&mut self.d, &other.d);
    }

    fn scale(&mut self, factor: f64) {
        for of in [&mut self.x, &mut self.k, &mut self.d] {
            of.iter_mut().for_each(|v| *v *= factor);
        }
    }

    /// Makes x orthogonal to `others` in the metric D, with `x . D x = 1`. Returns false if nothing is left.
    fn orthonormal(&mut self, others: &[Tried]) -> bool {
        let before = dot(&self.x, &self.d);
        for other in others.iter().chain(others) {
            let along = dot(&other.d, &self.x);
            self.add(other, -along);
        }
        let left = dot(&self.x, &self.d);
        let some = left > 1e-20 * before && left.is_finite();
        if some {
            self.scale(1.0 / left.sqrt());
        }
        some
    }
}

impl Curvature {
    /// Returns a shift s such that `K + t D` is known not to be positive definite for every `t < s`. A
    /// negative shift means that nothing is known about K.
    ///
    /// `factor` belongs to a matrix near K and preconditions the search (locally optimal conjugate gradients,
    /// Knyazev 2001). With `sure` the search starts afresh and does not give up early. The shift is infinite
    /// if `diagonal` (D) has an entry that is not positive.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::TooLarge`] if there is no memory for a solve.
    pub fn shift(
        &mut self,
        matrix: &Symmetric,
        diagonal: &[f64],
        factor: &Factor,
        sure: bool,
    ) -> Result<f64, AlgebraError> {
        if diagonal.iter().any(|d| !(*d > 0.0)) {
            return Ok(f64::INFINITY);
        }
        if sure || self.x.len() != matrix.dim() {
            // A start vector that does not happen to lie along a single mode.
            self.x =
                (0..matrix.dim()).map(|i| (1.0 + i as f64 * 0.618_033_988_749_895).fract() - 0.5).collect();
            factor.solve(&mut self.x)?;
        }
        let mut best = Tried::new(std::mem::take(&mut self.x), matrix, diagonal);
        if !best.orthonormal(&[]) {
            return Ok(-1.0);
        }
        let mut quotient = dot(&best.x, &best.k);
        let mut last: Option<Tried> = None;
        for round in 0..ROUNDS {
            let mut rest: Vec<f64> = best.k.iter().zip(&best.d).map(|(k, d)| k - quotient * d).collect();
            // The factor finds modes of many elements. The diagonal finds modes of a few elements, far below
            // zero.
            let near: Vec<f64> = rest.iter().zip(diagonal).map(|(r, d)| r / d).collect();
            factor.solve(&mut rest)?;
            let mut basis = vec![best];
            let tried = [rest, near].map(|x| Tried::new(x, matrix, diagonal)).into_iter().chain(last.take());
            for mut tried in tried {
                if tried.orthonormal(&basis) {
                    basis.push(tried);
                }
            }
            // A missing basis vector gets a value that is never the least: the values of all modes add up to
            // the dimension.
            let of = |i: usize, j: usize| match (basis.get(i), basis.get(j)) {
                (Some(a), Some(b)) => dot(&a.x, &b.k),
                _ if i == j => matrix.dim() as f64,
                _ => 0.0,
            };
            let small = Matrix4::from_fn(|i, j| of(i.min(j), i.max(j))).symmetric_eigen();
            let at = small.eigenvalues.imin();
            let part = small.eigenvectors.column(at);
            let mut step = basis[0].clone();
            step.scale(0.0);
            for (tried, part) in basis.iter().zip(part.iter()).skip(1) {
                step.add(tried, *part);
            }
            best = step.clone();
            best.add(&basis[0], part[0]);
            last = Some(step);
            let before = std::mem::replace(&mut quotient, small.eigenvalues[at]);
            let settled = quotient < 0.0 && (before - quotient).abs() <= SETTLED * quotient.abs();
            let hopeless = !sure && round >= 1 && quotient > 0.3 * before && quotient > 0.0;
            if settled || hopeless || quotient < -1.0 {
                break;
            }
        }
        // The quotient of the vector itself is the proof.
        let quotient = dot(&best.x, &best.k) / dot(&best.x, &best.d);
        self.x = best.x;
        Ok(-quotient * (1.0 - 1e-6))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_solver::{Kind, analyse, factor_as};

    /// Chain of springs on ground springs, some of which are unstable: `2 + ground` on the diagonal, -1 next
    /// to it.
    fn chain(ground: &[f64]) -> Symmetric {
        let n = ground.len();
        let column = |j: usize| {
            if j > 0 { vec![(j - 1, -1.0), (j, 2.0 + ground[j])] } else { vec![(0, 2.0 + ground[0])] }
        };
        let entries: Vec<(usize, f64)> = (0..n).flat_map(column).collect();
        Symmetric {
            offsets: (0..=n).map(|j| (2 * j).saturating_sub(1)).collect(),
            rows: entries.iter().map(|e| e.0).collect(),
            values: entries.iter().map(|e| e.1).collect(),
            multipliers: n,
            vertices: (0..=n).collect(),
        }
    }

    #[test]
    fn a_shift_is_proven_too_small_up_to_the_least_that_does() {
        let stable = chain(&[0.01; 60]);
        let mut ground = [0.01; 60];
        ground[40] = -0.5;
        let matrix = chain(&ground);
        let symbolic = analyse(&matrix, 0).unwrap();
        let definite = |shift: f64| {
            let mut raised = matrix.clone();
            let diagonal: Vec<f64> = (0..raised.dim()).map(|j| raised.diagonal(j)).collect();
            raised.shift(&diagonal, shift);
            factor_as(symbolic.as_ref(), &raised, Kind::Definite).is_ok()
        };
        let diagonal: Vec<f64> = (0..matrix.dim()).map(|j| matrix.diagonal(j)).collect();
        let of = |matrix: &Symmetric, kind| factor_as(symbolic.as_ref(), matrix, kind).unwrap();
        for (near, sure) in [(of(&stable, Kind::Definite), false), (of(&matrix, Kind::Indefinite), true)] {
            let shift = Curvature::default().shift(&matrix, &diagonal, &near, sure).unwrap();
            assert!(shift > 0.0 && !definite(shift), "{shift}");
            assert!(definite(1.2 * shift), "{shift}");
        }
        let none =
            Curvature::default().shift(&stable, &diagonal, &of(&stable, Kind::Definite), false).unwrap();
        assert!(none < 0.0, "{none}");
    }
}
