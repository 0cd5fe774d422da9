//! Iterative refinement of a solution.

use crate::error::AlgebraError;

/// Relative residual `|b - A x| / |b|` up to which every solution is accepted. Above this limit a final
/// answer is judged by its digits, and a step of an iteration is refused.
pub(super) const RESIDUAL_LIMIT: f64 = 1e-8;
/// Relative residual below which refinement stops.
const RESIDUAL_GOAL: f64 = 1e-14;

/// Euclidean norm.
pub(super) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// Product of two vectors.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Solution, residual vector `b - A x`, and relative residual.
pub(super) struct Refined {
    pub(super) x: Vec<f64>,
    pub(super) rest: Vec<f64>,
    pub(super) residual: f64,
}

/// Solves by `once` and refines until the residual is at rounding or no longer halves. With multipliers this
/// takes about three steps, else none or one.
pub(super) fn refine(
    b: &[f64],
    once: impl Fn(&mut [f64]) -> Result<(), AlgebraError>,
    subtract_product: impl Fn(&[f64], &mut [f64]),
) -> Result<Refined, AlgebraError> {
    let size = norm(b);
    let mut best = Refined { x: vec![0.0; b.len()], rest: b.to_vec(), residual: f64::INFINITY };
    if size == 0.0 {
        return Ok(Refined { residual: 0.0, ..best });
    }
    for _ in 0..12 {
        let mut step = best.rest.clone();
        once(&mut step)?;
        let trial: Vec<f64> = best.x.iter().zip(&step).map(|(x, d)| x + d).collect();
        let mut left = b.to_vec();
        subtract_product(&trial, &mut left);
        let reached = norm(&left) / size;
        // A NaN fails this comparison and keeps the last good solution, or none.
        if !(reached < best.residual) {
            break;
        }
        let stalled = reached > 0.5 * best.residual;
        best = Refined { x: trial, rest: left, residual: reached };
        if reached < RESIDUAL_GOAL || stalled {
            break;
        }
    }
    Ok(best)
}

/// Solves in place by `once` with refinement, and returns the relative residual.
///
/// # Errors
///
/// [`AlgebraError::Residual`] if the relative residual exceeds `RESIDUAL_LIMIT`.
pub(super) fn refined(
    b: &mut [f64],
    once: impl Fn(&mut [f64]) -> Result<(), AlgebraError>,
    subtract_product: impl Fn(&[f64], &mut [f64]),
) -> Result<f64, AlgebraError> {
    let Refined { x, residual, .. } = refine(b, once, subtract_product)?;
    if !(residual <= RESIDUAL_LIMIT) {
        return Err(AlgebraError::Residual { residual, limit: RESIDUAL_LIMIT });
    }
    b.copy_from_slice(&x);
    Ok(residual)
}
