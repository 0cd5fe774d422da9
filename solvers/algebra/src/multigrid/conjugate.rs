//! Conjugate gradients.

use rayon::prelude::*;
use shape::Vector3;

use super::hierarchy::Hierarchy;
use super::level::Cycle;
use super::operator::Entry;
use crate::error::AlgebraError;
use crate::stiffness::Stiffness;
use crate::vectors::{CHUNK, GRAIN, dot, largest, norm, of_chunk, subtract, sums};

/// Outcome of an iterative solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterations {
    /// Number of iterations.
    pub count: usize,
    /// Relative residual `|b - A x| / |b|`, computed from the solution. With a patch on weak supports, it is
    /// relative to the residual of the solution of the patch alone.
    pub residual: f64,
}

/// Largest number of iterations; a solve that needs more has failed.
const MOST: usize = 500;
/// Residual relative to `|K| |x| + |b|` that is taken as rounding (Higham 2002, section 7.1).
const ROUNDING: f64 = 1e-15;

impl Hierarchy {
    /// Solves `K x = b` in place, to a relative residual of `tolerance` ([`Iterations::residual`]) or to
    /// one of rounding. On failure, `b` changes only at constrained degrees of freedom.
    ///
    /// The preconditioner is in single precision and therefore symmetric to rounding only. The flexible
    /// formula for the next direction (Polak and Ribiere) allows this, at the cost of one more product of
    /// vectors.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::Residual`] if the iteration does not reach the tolerance.
    pub(super) fn iterate(
        &self,
        stiffness: &Stiffness,
        b: &mut [Vector3],
        tolerance: f64,
        cycle: Cycle,
    ) -> Result<Iterations, AlgebraError> {
        self.release(b);
        let (mut x, mut rest) = self.start(stiffness, b);
        let size = norm(&rest);
        if size == 0.0 {
            b.copy_from_slice(&x);
            return Ok(Iterations { count: 0, residual: 0.0 });
        }
        let nodes = b.len();
        let mut before = vec![Vector3::zeros(); nodes];
        let mut direction = vec![Vector3::zeros(); nodes];
        let mut image = vec![Vector3::zeros(); nodes];
        let mut inner = Precondition::new(nodes);
        let (mut count, mut last, mut residual, mut at_rounding) = (0, 0.0, 1.0, false);
        // The recursive residual drifts from the true residual. A restart from the true residual needs an
        // iteration or two.
        for _ in 0..3 {
            direction.fill(Vector3::zeros());
            while norm(&rest) > tolerance * size && count < MOST {
                let preconditioned = inner.apply(self, &rest, cycle);
                let chunks = preconditioned.par_chunks(CHUNK);
                let chunks = chunks.zip(rest.par_chunks(CHUNK).zip(before.par_chunks(CHUNK)));
                let [product, turned] =
                    sums(chunks.map(|(z, (rest, before))| [of_chunk(rest, z), of_chunk(before, z)]));
                let beta = if count == 0 || last == 0.0 { 0.0 } else { (product - turned) / last };
                let along = direction.par_iter_mut().zip(preconditioned).with_min_len(GRAIN);
                along.for_each(|(d, z)| *d = z + *d * beta);
                stiffness.multiply_into(&direction, &mut image);
                self.release(&mut image);
                let energy = dot(&direction, &image);
                if !(energy > 0.0 && product > 0.0) {
                    return Err(AlgebraError::Residual { residual: norm(&rest) / size, limit: tolerance });
                }
                let step = product / energy;
                let solution = x.par_iter_mut().zip(&direction);
                let residual = rest.par_iter_mut().zip(&mut before).zip(&image);
                solution.zip(residual).with_min_len(GRAIN).for_each(|((x, d), ((rest, before), image))| {
                    *x += d * step;
                    *before = *rest;
                    *rest -= image * step;
                });
                last = product;
                count += 1;
            }
            stiffness.multiply_into(&x, &mut image);
            self.release(&mut image);
            subtract(b, &image, &mut rest);
            residual = norm(&rest) / size;
            if residual <= tolerance || count >= MOST {
                break;
            }
            // For a slender body `|K| |x|` is a million times `|b|` and more, so its rounding alone exceeds
            // the tolerance.
            at_rounding = is_rounding(stiffness, &x, b, &rest);
            if at_rounding {
                break;
            }
            last = 0.0;
        }
        if !(residual <= tolerance || at_rounding) {
            return Err(AlgebraError::Residual { residual, limit: tolerance });
        }
        b.copy_from_slice(&x);
        Ok(Iterations { count, residual })
    }
}

/// Preconditioner: a cycle between vectors in double precision.
pub(super) struct Precondition {
    b: Vec<Entry<3>>,
    x: Vec<Entry<3>>,
    out: Vec<Vector3>,
}

impl Precondition {
    pub fn new(nodes: usize) -> Precondition {
        Precondition {
            b: vec![[0.0; 3]; nodes],
            x: vec![[0.0; 3]; nodes],
            out: vec![Vector3::zeros(); nodes],
        }
    }

    /// Applies one cycle. The residual is scaled to a largest entry of one, because it falls below the range
    /// of single precision.
    pub fn apply(&mut self, hierarchy: &Hierarchy, rest: &[Vector3], cycle: Cycle) -> &[Vector3] {
        let largest = largest(rest);
        let scaled = self.b.par_iter_mut().zip(rest).with_min_len(GRAIN);
        scaled.for_each(|(b, r)| *b = std::array::from_fn(|a| (r[a] / largest) as f32));
        hierarchy.finest.solve(&self.b, &mut self.x, cycle);
        let out = self.out.par_iter_mut().zip(&self.x).with_min_len(GRAIN);
        out.for_each(|(out, x)| *out = Vector3::from_fn(|a, _| f64::from(x[a]) * largest));
        &self.out
    }
}

/// Whether a residual is rounding relative to `|K| |x| + |b|`.
pub(super) fn is_rounding(stiffness: &Stiffness, x: &[Vector3], b: &[Vector3], rest: &[Vector3]) -> bool {
    let mut sizes = vec![Vector3::zeros(); x.len()];
    stiffness.multiply_magnitudes(x, &mut sizes);
    sizes.iter_mut().zip(b).for_each(|(size, b)| *size += b.abs());
    norm(rest) <= ROUNDING * norm(&sizes)
}
