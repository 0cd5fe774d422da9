//! The tangent of an iteration: assembly, factorisation, and the resulting step.

use algebra::{Border, Symmetric};
use shape::{Matrix3, Vector3};

use super::Newton;
use super::direction::Direction;
use super::equations::{Balance, Equations};
use super::factors::Entries;
use super::policy::Descent;
use super::state::State;
use crate::error::SolveError;
use crate::nonlinear::energy::Hessian;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::problem::LinearSystems;
use crate::nonlinear::system::SurfaceStiffness;

impl Equations<'_> {
    /// Returns the stiffness of the surfaces: those constrained by penalty come first, then the contact
    /// surface, then the points of the mass table with the tangent of the inertia.
    pub(super) fn surface_stiffness(&self, state: &State, balance: &Balance) -> SurfaceStiffness {
        let rate = self.terms.as_ref().and_then(|t| t.rate.as_ref()).map_or(0.0, |rate| rate.factor);
        let mut blocks: Vec<Vec<Matrix3>> = (self.problem.penalties.iter()).map(|h| h.blocks(rate)).collect();
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
        let beside = self.beside_internal();
        if let Some(part) = beside {
            blocks.iter_mut().flatten().for_each(|block| *block *= part);
        }
        let beside = beside.unwrap_or(1.0);
        let part = |index| beside * self.problem.curves.following.of(index).value(state.time);
        let following = self.problem.following.iter().enumerate();
        let pressed = following.map(|(index, load)| load.pressed(&state.u, part(index))).collect();
        SurfaceStiffness { blocks, pressed }
    }

    /// Returns the tangent in a state, its unsymmetric part, and the right-hand side for the unknowns.
    /// `prescribed_move` is the move of constrained degrees of freedom in the same iteration.
    pub(super) fn linearise(
        &mut self,
        state: &State,
        balance: &Balance,
        prescribed_move: Option<&[Vector3]>,
    ) -> Result<(Symmetric, Entries, Vec<f64>), StaticError> {
        let hessian = self.hessian(state)?;
        let surface = self.surface_stiffness(state, balance);
        self.system.assemble(&hessian, &surface);
        let matrix = self.system.reduced(&hessian);
        let skew = self.system.entries(&self.system.skew(&surface));
        let mut right_pressure = balance.pressure.clone();
        if let Some(moves) = prescribed_move {
            self.system.subtract_held_pressure(&hessian, moves, &mut right_pressure);
        }
        let right = self.right(balance, prescribed_move);
        Ok((matrix, skew, self.system.gather(&right, &right_pressure)))
    }

    /// Returns the second derivatives of the energy in a state.
    pub(super) fn hessian(&self, state: &State) -> Result<Hessian, StaticError> {
        let (solid, pairs) = (&self.solid(state.time), self.system.pairs.as_ref());
        let mut hessian = solid.hessian(pairs, &state.u, &state.pressure)?;
        if let Some(relaxing) = self.terms.as_ref().and_then(|t| t.relaxing.as_ref()) {
            relaxing.relax_tangent(solid, pairs, &state.u, &state.pressure, &mut hessian)?;
        }
        Ok(hessian)
    }

    /// Returns the nodal forces of the right-hand side, N, for the assembled tangent.
    pub(super) fn right(&self, balance: &Balance, prescribed_move: Option<&[Vector3]>) -> Vec<Vector3> {
        let mut right = balance.out.clone();
        if let Some(moves) = prescribed_move {
            for (r, k) in right.iter_mut().zip(self.system.held_part(moves)) {
                *r -= k;
            }
            let scaled: Vec<Vector3>;
            let moves = match self.beside_internal() {
                None => moves,
                Some(part) => {
                    scaled = moves.iter().map(|by| by * part).collect();
                    &scaled
                }
            };
            // The accelerations of constrained degrees of freedom are given, so they do not depend on this
            // move.
            if let Some(inertia) = self.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
                let mass = self.system.surfaces.last().expect("inertia has a mass table");
                inertia.give_back(mass, moves, &mut right);
            }
            if let Some(rate) = self.terms.as_ref().and_then(|t| t.rate.as_ref()) {
                for (penalty, table) in self.problem.penalties.iter().zip(&self.system.surfaces) {
                    penalty.give_back(table, rate.factor, moves, &mut right);
                }
            }
        }
        right
    }
}

impl Newton<'_> {
    /// Computes the Newton step: free unknowns, and displacements of the force-driven tools.
    pub(super) fn direction(
        &mut self,
        state: &State,
        balance: &Balance,
        time: f64,
        prescribed_move: Option<&[Vector3]>,
    ) -> Result<Direction, StaticError> {
        if let LinearSystems::Modal(basis) = self.equations.problem.systems {
            return self.modal(basis, state, balance, time, prescribed_move);
        }
        if self.iterates()
            && let Some(direction) = self.iterated(state, balance, time, prescribed_move)?
        {
            return Ok(direction);
        }
        let (matrix, skew, right) = self.equations.linearise(state, balance, prescribed_move)?;
        let policy = &self.policy;
        let factors = &mut self.factors;
        factors.work.assemblies += 1;
        let (tools, borders): (Vec<usize>, Vec<Border>) = self.equations.borders(balance).into_iter().unzip();
        let (step, closures) = (Vec::new(), Vec::new());
        let (matrix, skew) = match factors.with_kept(policy, matrix, skew, &right, borders.is_empty())? {
            Ok((factored, solution)) => {
                let definite = !factors.doubtful;
                let last = Direction { step, closures, definite, proven: false, factored, tools };
                return Ok(self.finish(last, solution, state, time));
            }
            Err(parts) => parts,
        };
        let factored = factors.factor(policy, matrix, skew, borders)?;
        let definite = !factors.indefinite && factored.stable();
        if policy.descent == Descent::Smooth && !definite {
            return Err(SolveError::NotPositiveDefinite.into());
        }
        let lifted = policy.descent == Descent::Down && !definite;
        let proven = factors.exact || lifted || factored.is_clear();
        let last = Direction { step, closures, definite, proven, factored, tools };
        self.take(last, right, state, balance, time)
    }

    /// Computes a chord: a step with the tangent of `last`.
    pub(super) fn again(
        &mut self,
        last: Direction,
        state: &State,
        balance: &Balance,
        time: f64,
    ) -> Result<Direction, StaticError> {
        let right = self.equations.system.gather(&balance.out, &balance.pressure);
        self.take(last, right, state, balance, time)
    }

    /// Solves for the step with the factor of `last`.
    pub(super) fn take(
        &mut self,
        last: Direction,
        mut step: Vec<f64>,
        state: &State,
        balance: &Balance,
        time: f64,
    ) -> Result<Direction, StaticError> {
        let lacking = self.equations.lacking(balance, time);
        step.extend(last.tools.iter().map(|&k| lacking[k]));
        self.factors.solve(&last.factored, &self.equations.system, &mut step)?;
        Ok(self.finish(last, step, state, time))
    }

    /// Builds the direction of a solution: free unknowns, then the displacements of the tools that have a
    /// border.
    pub(super) fn finish(&self, last: Direction, mut step: Vec<f64>, state: &State, time: f64) -> Direction {
        let moves = step.split_off(self.equations.system.dim());
        let mut closures = vec![0.0; self.equations.problem.tools.len()];
        for (k, closure) in closures.iter_mut().enumerate() {
            let Some(force) = self.equations.force(k, time) else { continue };
            *closure = match last.tools.iter().position(|&t| t == k) {
                Some(at) => moves[at],
                None => self.equations.approach(k, state, force),
            };
        }
        Direction { step, closures, ..last }
    }
}
