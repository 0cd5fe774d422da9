//! Factors of the tangents: new factors, and kept factors that serve as preconditioners.

use std::sync::Arc;

use algebra::{
    AlgebraError, Border, Curvature, DENSE_LIMIT, Factor, FactorError, Factorization, Kind, Symbolic,
    Symmetric, Unsymmetric,
};

use super::direction::{Direction, Factored};
use super::levels::Levels;
use super::policy::{Descent, NewtonParams, Policy};
use crate::error::SolveError;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::step::StaticWork;
use crate::nonlinear::system::System;

/// Ratio of the multiplications of a factorisation to those of a solution that pays for one iteration with a
/// kept factor. A factorisation runs in the caches and does nine multiplications in the time of one
/// multiplication of a solution.
const ITERATION: f64 = 9.0;
/// Largest number of iterations with a kept factor: `MOST` for expensive factors, `LEAST` for cheap factors.
const MOST: usize = 12;
const LEAST: usize = 4;

/// Entries of the skew part.
pub(super) type Entries = Vec<(usize, usize, f64)>;

/// A tangent with a kept factor and the resulting step, or the unchanged tangent if the kept factor does not
/// suffice.
type Kept = Result<(Factored, Vec<f64>), (Symmetric, Entries)>;

/// Relative shifts of the diagonal that are tried during descent.
const SHIFTS: [f64; 7] = [0.0, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0];

/// Memory of the last tangents: their structure, the last factor, and whether they were definite.
pub(super) struct Factors {
    symbolic: Option<Option<Arc<Symbolic>>>,
    /// The last factor, if it is large enough to be kept.
    factor: Option<Arc<Factor>>,
    /// Memory of the systems that are iterated.
    pub levels: Levels,
    /// Last direction of negative curvature of a tangent.
    curvature: Curvature,
    /// The last direction of a simulator's loop, with which the next frame starts.
    pub kept: Option<Direction>,
    /// Whether the last tangent was not definite.
    pub indefinite: bool,
    /// Whether the last factored tangent was not definite; the next tangent is then rarely definite.
    pub doubtful: bool,
    /// Whether factors are computed in double precision.
    pub exact: bool,
    /// Relative residual to which systems are solved iteratively.
    pub forcing: f64,
    /// Counters, without those of the forces.
    pub work: StaticWork,
}

impl Factors {
    pub fn new() -> Factors {
        Factors {
            symbolic: None,
            factor: None,
            levels: Levels::default(),
            curvature: Curvature::default(),
            kept: None,
            indefinite: false,
            doubtful: false,
            exact: true,
            forcing: 1e-7,
            work: StaticWork::default(),
        }
    }

    /// Returns the ratio of the multiplications of a factorisation to those of a solution; 0 for a dense,
    /// hence small, factor.
    fn solutions(&self) -> f64 {
        self.symbolic.as_ref().and_then(Option::as_ref).map_or(0.0, |symbolic| symbolic.solutions())
    }

    /// Whether a factor is so expensive that attempts which are likely to fail should be avoided.
    fn dear(&self) -> bool {
        self.solutions() > NewtonParams::KEEPS
    }

    /// Whether factors are large enough to be kept and to be computed in single precision.
    pub fn keeps(&self, policy: &Policy) -> bool {
        policy.keeps(self.solutions())
    }

    /// Computes the step with the last factor as preconditioner if this is expected to be faster than a new
    /// factorisation. This is allowed only on the way to the nearest equilibrium, whose steps do not require
    /// a definite tangent.
    pub fn with_kept(
        &mut self,
        policy: &Policy,
        matrix: Symmetric,
        skew: Entries,
        right: &[f64],
        borderless: bool,
    ) -> Result<Kept, StaticError> {
        let Some(factor) = self.factor.clone() else { return Ok(Err((matrix, skew))) };
        if !(self.keeps(policy) && policy.descent == Descent::Nearest && borderless) {
            return Ok(Err((matrix, skew)));
        }
        let most = ((self.solutions() / ITERATION) as usize).clamp(LEAST, MOST);
        let kind = matrix.kind();
        let near = Unsymmetric::new(Factorization { matrix, factor, kind }, skew, Vec::new())?;
        let mut step = right.to_vec();
        let (iterations, solved) = near.solve_within(&mut step, self.forcing, most)?;
        self.work.inner += iterations as u64;
        if !solved {
            return Ok(Err(near.into_parts()));
        }
        self.work.solves += 1;
        Ok(Ok((Factored::Unsymmetric(near), step)))
    }

    /// Tests by a factor of its own whether a tangent is definite that was solved with a kept or rounded
    /// factor, or iterated. This factor is kept next. The test uses single precision, and double precision if
    /// rounding leaves the result open.
    pub fn prove(&mut self, matrix: &Symmetric) -> Result<bool, StaticError> {
        self.analyse(matrix)?;
        if !self.doubtful {
            self.exact = false;
            if let Ok(factor) = self.numbers(matrix, matrix.kind())
                && factor.is_clear(matrix)
            {
                self.factor = Some(factor);
                return Ok(true);
            }
        }
        self.exact = true;
        let definite = match self.numbers(matrix, matrix.kind()) {
            Ok(factor) => {
                self.factor = Arc::into_inner(factor).map(|factor| Arc::new(factor.rounded()));
                true
            }
            Err(FactorError::NotDefinite) => false,
            Err(FactorError::Other(AlgebraError::NearlySingular { .. } | AlgebraError::ZeroPivot)) => false,
            Err(FactorError::Other(error)) => return Err(error.into()),
        };
        self.doubtful = !definite;
        Ok(definite)
    }

    /// Analyses the structure that all tangents have in common.
    fn analyse(&mut self, matrix: &Symmetric) -> Result<(), AlgebraError> {
        if self.symbolic.is_none() {
            self.symbolic = Some(algebra::analyse(matrix, DENSE_LIMIT)?);
        }
        Ok(())
    }

    /// Computes a numerical factor, in single precision if the factor is only a preconditioner.
    fn numbers(&mut self, matrix: &Symmetric, kind: Kind) -> Result<Arc<Factor>, FactorError> {
        let symbolic = self.symbolic.as_ref().expect("analysed").as_ref();
        self.work.factorisations += 1;
        let got = match self.exact {
            true => algebra::factor_as(symbolic, matrix, kind),
            false => algebra::factor_roughly(symbolic, matrix, kind),
        };
        got.map(Arc::new)
    }

    /// Factors the tangent: Cholesky, or `L D L^T` with a pressure field. With sliding friction or an
    /// unbalanced following pressure the factor of the symmetric part is a preconditioner.
    ///
    /// Past a limit point the tangent is not definite, and its step leads to the nearest equilibrium, stable
    /// or not. With [`Descent::Down`] the diagonal is raised until the tangent is definite, and the step
    /// reduces the energy.
    pub fn factor(
        &mut self,
        policy: &Policy,
        mut matrix: Symmetric,
        skew: Entries,
        borders: Vec<Border>,
    ) -> Result<Factored, StaticError> {
        self.analyse(&matrix)?;
        self.exact = !self.keeps(policy) || !borders.is_empty() || policy.descent == Descent::Smooth;
        let (factor, kind) = match policy.descent {
            Descent::Down => self.lifted(policy, &mut matrix)?,
            Descent::Smooth | Descent::Nearest | Descent::Guarded => self.as_it_is(policy, &matrix)?,
        };
        self.doubtful = self.indefinite;
        self.levels.factored(!self.indefinite);
        if self.keeps(policy) {
            self.factor = Some(factor.clone());
        }
        let whole = Factorization { matrix, factor, kind };
        Ok(match skew.is_empty() && borders.is_empty() && self.exact {
            true => Factored::Symmetric(whole),
            false => Factored::Unsymmetric(Unsymmetric::new(whole, skew, borders)?),
        })
    }

    /// Factors the unshifted matrix. A tangent that follows an indefinite tangent is rarely definite, so
    /// `L D L^T` is then used at once.
    fn as_it_is(&mut self, policy: &Policy, matrix: &Symmetric) -> Result<(Arc<Factor>, Kind), StaticError> {
        let kind = matrix.kind();
        let pressures = matrix.dim() - matrix.multipliers;
        let at_once =
            kind == Kind::Definite && self.doubtful && self.dear() && policy.descent != Descent::Smooth;
        if !at_once {
            match self.numbers(matrix, kind) {
                Ok(factor) => {
                    self.indefinite |= factor.negative_pivots() != pressures;
                    return Ok((factor, kind));
                }
                Err(FactorError::NotDefinite) => {}
                Err(FactorError::Other(AlgebraError::NearlySingular { .. } | AlgebraError::ZeroPivot)) => {}
                Err(FactorError::Other(error)) => return Err(error.into()),
            }
        }
        if kind != Kind::Definite || policy.descent == Descent::Smooth {
            return Err(SolveError::NotPositiveDefinite.into());
        }
        match self.numbers(matrix, Kind::Indefinite) {
            Ok(factor) => {
                self.indefinite |= !at_once || factor.negative_pivots() != 0;
                Ok((factor, Kind::Indefinite))
            }
            Err(FactorError::Other(error)) => Err(error.into()),
            Err(FactorError::NotDefinite) => Err(SolveError::NotPositiveDefinite.into()),
        }
    }

    /// Factors the matrix with the smallest of the shifts that makes it definite. Directions of negative
    /// curvature, found with the last factor, show that most shifts are too small. This saves a factorisation
    /// for each of these shifts.
    fn lifted(
        &mut self,
        policy: &Policy,
        matrix: &mut Symmetric,
    ) -> Result<(Arc<Factor>, Kind), StaticError> {
        let kind = matrix.kind();
        let pressures = matrix.dim() - matrix.multipliers;
        let diagonal: Vec<f64> = (0..matrix.dim()).map(|j| matrix.diagonal(j)).collect();
        let searches = kind == Kind::Definite && self.keeps(policy);
        let mut known = -1.0;
        if let (true, true, Some(factor)) = (searches, self.doubtful, self.factor.clone()) {
            known = self.curvature.shift(matrix, &diagonal, &factor, false)?;
            if known <= 0.0 {
                // A failed Cholesky factorisation gives no further information; an indefinite factor does.
                if let Ok(factor) = self.numbers(matrix, Kind::Indefinite) {
                    if factor.negative_pivots() == 0 {
                        return Ok((factor, Kind::Indefinite));
                    }
                    known = self.curvature.shift(matrix, &diagonal, &factor, true)?.max(0.0);
                }
            }
        }
        for shift in SHIFTS {
            if shift <= known {
                continue;
            }
            if shift == SHIFTS[1]
                && searches
                && known < 0.0
                && let Some(factor) = &self.factor
            {
                known = self.curvature.shift(matrix, &diagonal, factor, true)?.max(0.0);
                if shift <= known {
                    continue;
                }
            }
            matrix.shift(&diagonal, shift);
            match self.numbers(matrix, kind) {
                Ok(factor) if factor.negative_pivots() == pressures => {
                    self.indefinite |= shift > 0.0;
                    return Ok((factor, kind));
                }
                Ok(_) | Err(FactorError::NotDefinite) => {}
                Err(FactorError::Other(AlgebraError::NearlySingular { .. } | AlgebraError::ZeroPivot)) => {}
                Err(FactorError::Other(error)) => return Err(error.into()),
            }
        }
        self.doubtful = true;
        Err(SolveError::NotPositiveDefinite.into())
    }

    /// Solves with the assembled matrix, whose pressures are scaled. A system that is iterated may be solved
    /// less accurately than [`Factors::forcing`].
    pub fn solve(&mut self, factored: &Factored, system: &System, b: &mut [f64]) -> Result<(), SolveError> {
        self.work.solves += 1;
        let scale = system.pressure_scale;
        let pressures = system.free..system.dim();
        b[pressures.clone()].iter_mut().for_each(|p| *p *= scale);
        match factored {
            Factored::Symmetric(f) => f.solve(b).map(drop)?,
            Factored::Unsymmetric(f) => self.work.inner += f.solve(b, self.forcing)? as u64,
            Factored::Modal(f) => f.solve(b)?,
            Factored::Iterated(skew) => {
                self.work.inner += self.levels.chord(system, skew, b, self.forcing) as u64;
            }
        }
        b[pressures].iter_mut().for_each(|p| *p *= scale);
        Ok(())
    }
}
