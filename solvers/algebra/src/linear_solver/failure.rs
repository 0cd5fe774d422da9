//! Failures of a factorisation.

use crate::error::AlgebraError;

/// Smallest ratio of pivot to diagonal entry of a definite matrix. Rounding leaves about 1e-16 of a true
/// zero.
const PIVOT_LIMIT: f64 = 1e-14;

/// Failure of a factorisation. The caller adds the reason for which the matrix should have been definite.
#[derive(Debug)]
pub enum FactorError {
    /// A pivot is zero or negative.
    NotDefinite,
    /// Anything else.
    Other(AlgebraError),
}

impl From<AlgebraError> for FactorError {
    fn from(error: AlgebraError) -> FactorError {
        FactorError::Other(error)
    }
}

/// Refuses pivots that are rounding relative to their diagonal entries.
pub(super) fn check_pivots(ratios: impl Iterator<Item = f64>) -> Result<(), FactorError> {
    let ratio = ratios.fold(f64::INFINITY, f64::min);
    if ratio.is_nan() || ratio < PIVOT_LIMIT {
        return Err(AlgebraError::NearlySingular { ratio, limit: PIVOT_LIMIT }.into());
    }
    Ok(())
}
