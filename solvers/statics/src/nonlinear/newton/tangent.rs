//! The tangent of an iteration: assembled, factored, and the step it gives.

use algebra::{AlgebraError, Border, DENSE_LIMIT, FactorError, Factorization, Kind, Unsymmetric};
use shape::{Matrix3, Vector3};

use super::{Balance, Descent, Newton, State};
use crate::SolveError;
use crate::nonlinear::StaticError;

/// A factored tangent, of the free unknowns and of the closures of the tools that have a border.
pub(super) enum Factored {
    Symmetric(Factorization),
    Unsymmetric(Unsymmetric),
}

/// The Newton step with the factor that gave it.
pub(super) struct Direction {
    /// Of the free unknowns.
    pub step: Vec<f64>,
    /// Of the closures of tools driven by force.
    pub closures: Vec<f64>,
    /// Whether the tangent was positive definite, tools driven by force included.
    pub definite: bool,
    pub factored: Factored,
    /// The tools whose borders the factor has.
    tools: Vec<usize>,
}

impl Factored {
    /// Whether tools driven by force leave the tangent definite, if it is so with them constrained.
    fn stable(&self) -> bool {
        match self {
            Factored::Symmetric(_) => true,
            Factored::Unsymmetric(f) => f.stable(),
        }
    }

    fn solve(&self, b: &mut [f64], goal: f64) -> Result<(), AlgebraError> {
        match self {
            Factored::Symmetric(f) => f.solve(b),
            Factored::Unsymmetric(f) => f.solve(b, goal),
        }
        .map(|_| ())
    }
}

impl Newton<'_> {
    /// `-w dt/dx` of every surface point, by surface: constrained ones first, then contact.
    fn surface_blocks(&self, balance: &Balance) -> Vec<Vec<Matrix3>> {
        let mut blocks: Vec<Vec<Matrix3>> = (self.problem.penalties.iter())
            .map(|h| {
                let constrained = Vector3::from_fn(|a, _| if h.axes[a] { h.beta } else { 0.0 });
                h.surface.weights().iter().map(|w| Matrix3::from_diagonal(&(constrained * *w))).collect()
            })
            .collect();
        if self.problem.contact.is_some() && !self.problem.tools.is_empty() {
            let table = &self.system.surfaces[blocks.len()];
            let mut of_points = vec![Matrix3::zeros(); table.weights.len()];
            for contacts in balance.contacts.iter().flatten() {
                for (&q, dt) in contacts.points().iter().zip(contacts.stiffness()) {
                    of_points[q as usize] -= dt * table.weights[q as usize];
                }
            }
            blocks.push(of_points);
        }
        if let Some(inertia) = self.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
            let mass = &self.system.surfaces[blocks.len()];
            blocks.push(inertia.blocks(mass));
        }
        blocks
    }

    /// The Newton step: free unknowns, and closures of the tools driven by force.
    pub(super) fn direction(
        &mut self,
        state: &State,
        balance: &Balance,
        time: f64,
        prescribed_move: Option<&[Vector3]>,
    ) -> Result<Direction, StaticError> {
        let pairs = self.system.pairs.as_ref();
        let mut hessian = self.problem.solid.hessian(pairs, &state.u, &state.pressure)?;
        if let Some(relaxing) = self.terms.as_ref().and_then(|t| t.relaxing.as_ref()) {
            let solid = &self.problem.solid;
            relaxing.relax_tangent(solid, pairs, &state.u, &state.pressure, &mut hessian)?;
        }
        let blocks = self.surface_blocks(balance);
        let matrix = self.system.assemble(&hessian, &blocks);
        self.work.assemblies += 1;
        let skew = self.system.skew(&blocks);
        let mut right = balance.out.clone();
        let mut right_pressure = balance.pressure.clone();
        if let Some(moves) = prescribed_move {
            for (r, k) in right.iter_mut().zip(self.system.held_part(moves)) {
                *r -= k;
            }
            // The accelerations of constrained degrees of freedom are given: they don't follow the move.
            if let Some(inertia) = self.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
                let mass = self.system.surfaces.last().expect("inertia has a mass table");
                inertia.give_back(mass, moves, &mut right);
            }
            self.system.subtract_held_pressure(&hessian, moves, &mut right_pressure);
        }
        let right = self.system.gather(&right, &right_pressure);
        let (tools, borders): (Vec<usize>, Vec<Border>) = self.borders(balance).into_iter().unzip();
        let factored = self.factor(matrix, skew, borders)?;
        let definite = !self.indefinite && factored.stable();
        if self.descent == Descent::Smooth && !definite {
            return Err(SolveError::NotPositiveDefinite.into());
        }
        let last = Direction { step: Vec::new(), closures: Vec::new(), definite, factored, tools };
        self.take(last, right, state, balance, time)
    }

    /// The chord: a step with the tangent of `last`.
    pub(super) fn again(
        &mut self,
        last: Direction,
        state: &State,
        balance: &Balance,
        time: f64,
    ) -> Result<Direction, StaticError> {
        let right = self.system.gather(&balance.out, &balance.pressure);
        self.take(last, right, state, balance, time)
    }

    fn take(
        &mut self,
        Direction { definite, factored, tools, .. }: Direction,
        mut step: Vec<f64>,
        state: &State,
        balance: &Balance,
        time: f64,
    ) -> Result<Direction, StaticError> {
        let lacking = self.lacking(balance, time);
        step.extend(tools.iter().map(|&k| lacking[k]));
        self.solve(&factored, &mut step)?;
        let moves = step.split_off(self.system.dim());
        let mut closures = vec![0.0; self.problem.tools.len()];
        for (k, closure) in closures.iter_mut().enumerate() {
            let Some(force) = self.force(k, time) else { continue };
            *closure = match tools.iter().position(|&t| t == k) {
                Some(at) => moves[at],
                None => self.approach(k, state, force),
            };
        }
        Ok(Direction { step, closures, definite, factored, tools })
    }

    /// Solves with the matrix as it was assembled, pressures scaled.
    pub(super) fn solve(&mut self, factored: &Factored, b: &mut [f64]) -> Result<(), SolveError> {
        self.work.solves += 1;
        let (scale, pressures) = (self.system.pressure_scale, self.system.free..self.system.dim());
        b[pressures.clone()].iter_mut().for_each(|p| *p *= scale);
        factored.solve(b, self.forcing)?;
        b[pressures].iter_mut().for_each(|p| *p *= scale);
        Ok(())
    }

    /// Cholesky, or `L D L^T` with a pressure field; the factor of the symmetric part as a preconditioner with sliding
    /// friction. Past a limit point the tangent is not definite and its step leads to the nearest equilibrium, stable
    /// or not; with [`Descent::Down`] its diagonal is raised until it is definite, and the step leads down.
    fn factor(
        &mut self,
        mut matrix: algebra::Symmetric,
        skew: Vec<(usize, usize, f64)>,
        borders: Vec<Border>,
    ) -> Result<Factored, StaticError> {
        if self.symbolic.is_none() {
            self.symbolic = Some(algebra::analyse(&matrix, DENSE_LIMIT)?);
        }
        let symbolic = self.symbolic.as_ref().expect("just analysed").as_ref();
        let (kind, pressures) = (matrix.kind(), matrix.dim() - matrix.multipliers);
        let whole = |factor| match skew.is_empty() && borders.is_empty() {
            true => Ok(Factored::Symmetric(factor)),
            false => Unsymmetric::new(factor, skew, borders).map(Factored::Unsymmetric),
        };
        let shifts: &[f64] = match self.descent {
            Descent::Smooth | Descent::Nearest | Descent::Guarded => &[0.0],
            Descent::Down => &[0.0, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0],
        };
        let diagonal: Vec<f64> = (0..matrix.dim()).map(|j| matrix.diagonal(j)).collect();
        for &shift in shifts {
            matrix.shift(&diagonal, shift);
            self.work.factorisations += 1;
            match algebra::factor_as(symbolic, &matrix, kind) {
                Ok(factor) if self.descent != Descent::Down || factor.negative_pivots() == pressures => {
                    self.indefinite |= shift > 0.0 || factor.negative_pivots() != pressures;
                    return Ok(whole(Factorization { matrix, factor, kind })?);
                }
                Ok(_) | Err(FactorError::NotDefinite) => {}
                Err(FactorError::Other(AlgebraError::NearlySingular { .. } | AlgebraError::ZeroPivot)) => {}
                Err(FactorError::Other(error)) => return Err(error.into()),
            }
        }
        if matches!(self.descent, Descent::Nearest | Descent::Guarded) && kind == Kind::Definite {
            self.indefinite = true;
            self.work.factorisations += 1;
            let kind = Kind::Indefinite;
            return match algebra::factor_as(symbolic, &matrix, kind) {
                Ok(factor) => Ok(whole(Factorization { matrix, factor, kind })?),
                Err(FactorError::Other(error)) => Err(error.into()),
                Err(FactorError::NotDefinite) => Err(SolveError::NotPositiveDefinite.into()),
            };
        }
        Err(SolveError::NotPositiveDefinite.into())
    }
}
