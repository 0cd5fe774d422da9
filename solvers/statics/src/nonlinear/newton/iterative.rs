#![allow(non_snake_case)] // A, B, K, J, V as in the formulas
//! Iterative solution of the tangents: GCR, preconditioned by multigrid.
//!
//! Points that share dilations have the tangent `K = A + B^T (k / V) B`, with the change `B u` of the volumes
//! V of the groups and the part k of their bulk moduli above ten times the shear modulus. The pressures
//! `(k / V) B u` are iterated with the displacements, and the preconditioner approximates A alone (see
//! [`algebra::Multigrid`]). A contains the geometric stiffness, contact, friction and
//! following pressures.
//!
//! The levels of a tangent serve the following tangents too. If A has no direction of negative curvature, K
//! has none either.

use algebra::{FactorError, PressureGroup, TangentLevels};
use material::Material as _;
use shape::Vector3;

use super::Newton;
use super::direction::{Direction, Factored};
use super::equations::{Balance, Equations};
use super::policy::Descent;
use super::state::State;
use crate::nonlinear::energy::Hessian;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::lanes::GroupHessian;
use crate::nonlinear::problem::LinearSystems;
use crate::nonlinear::solid::SolidDilation;
use crate::nonlinear::system::Skew;
use crate::pressure::{KEPT, rest};

/// Largest relative residual to which a system is solved. Further iterations cost less than the Newton step
/// that they save: on a tet10 cube of 46,875 unknowns a limit of 1e-2 takes 13 tangents instead of 10.
const LOOSEST: f64 = 1e-3;

impl Equations<'_> {
    /// Assembles `A` and returns its skew part, the groups with pressures, and the right-hand side of K.
    fn split(
        &mut self,
        state: &State,
        balance: &Balance,
        prescribed_move: Option<&[Vector3]>,
    ) -> Result<(Skew, Vec<PressureGroup>, Vec<Vector3>), StaticError> {
        let mut hessian = self.hessian(state)?;
        let groups = self.take_pressures(&mut hessian);
        let surface = self.surface_stiffness(state, balance);
        self.system.assemble(&hessian, &surface);
        let mut right = self.right(balance, prescribed_move);
        if let Some(moves) = prescribed_move {
            for group in &groups {
                let change: f64 = group.row.iter().map(|(node, b)| b.dot(&moves[*node as usize])).sum();
                let pressure = group.excess / group.volume * change;
                group.row.iter().for_each(|(node, b)| right[*node as usize] -= b * pressure);
            }
        }
        Ok((self.system.skew(&surface), groups, right))
    }

    /// Takes the bulk stiffness above the kept part out of the groups' second derivatives and returns the
    /// groups that have such a part.
    fn take_pressures(&self, hessian: &mut Hessian) -> Vec<PressureGroup> {
        let solid = &self.problem.solid;
        let (SolidDilation::Groups(groups), Some(pairs)) = (solid.dilation, self.system.pairs.as_ref())
        else {
            return Vec::new();
        };
        let mu = solid.group_mean(groups, pairs, |q, _| solid.law(q).mu());
        let of_group = |(a, group): (usize, &mut GroupHessian)| {
            let (volume, kept) = (solid.group_volume(groups, a), KEPT * mu[a]);
            let excess = group.bulk / volume - kept;
            (excess > 0.0).then(|| {
                group.rows.iter_mut().for_each(|row| row.take(excess * volume));
                let row = pairs.nodes(a).iter().zip(&group.rows);
                let row = row.map(|(&node, row)| (node, row.both().0 * volume)).collect();
                PressureGroup { row, volume, excess, rest: rest(kept) }
            })
        };
        hessian.groups.iter_mut().enumerate().filter_map(of_group).collect()
    }
}

impl Newton<'_> {
    /// Whether the next tangent is iterated: on the way to the nearest equilibrium, while tangents are
    /// definite, without tools driven by force.
    pub(super) fn iterates(&self) -> bool {
        let Newton { equations, factors, policy, .. } = self;
        let tools = equations.problem.tools.len();
        matches!(equations.problem.systems, LinearSystems::Iterated { .. })
            && policy.descent == Descent::Nearest
            && factors.levels.serve()
            && !(policy.saddle || policy.repeats || factors.doubtful)
            && (0..tools).all(|k| equations.force(k, 1.0).is_none())
    }

    /// Largest relative residual to which systems may be solved; `None` if the next step's needs do not
    /// count.
    pub(super) fn loosest(&self) -> Option<f64> {
        if self.iterates() {
            return Some(LOOSEST);
        }
        self.policy.params.loosest.filter(|_| self.factors.keeps(&self.policy))
    }

    /// Computes the Newton step by iterations; `None` if they do not converge.
    pub(super) fn iterated(
        &mut self,
        state: &State,
        balance: &Balance,
        time: f64,
        prescribed_move: Option<&[Vector3]>,
    ) -> Result<Option<Direction>, StaticError> {
        let (skew, groups, right) = self.equations.split(state, balance, prescribed_move)?;
        self.factors.work.assemblies += 1;
        loop {
            let fresh = self.factors.levels.current().is_none();
            if fresh {
                self.build_levels()?;
            }
            let Newton { equations, factors, .. } = &mut *self;
            let Some(levels) = factors.levels.current() else { break };
            levels.set_pressures(&groups);
            let mut x = right.clone();
            let accuracy = (factors.forcing, fresh);
            let (count, solved) = factors.levels.iterate(&equations.system, &skew, &mut x, accuracy);
            factors.work.inner += count as u64;
            if solved {
                factors.work.solves += 1;
                factors.levels.succeed();
                let step = self.equations.system.gather(&x, &balance.pressure);
                let last = Direction {
                    step: Vec::new(),
                    closures: Vec::new(),
                    definite: true,
                    proven: false,
                    factored: Factored::Iterated(skew),
                    tools: Vec::new(),
                };
                return Ok(Some(self.finish(last, step, state, time)));
            }
            factors.levels.replace(None);
            if fresh {
                break;
            }
        }
        self.factors.levels.fail();
        Ok(None)
    }

    /// Builds the levels of the assembled tangent. There are none if its coarsest matrix is not definite.
    fn build_levels(&mut self) -> Result<(), StaticError> {
        let Newton { equations, factors, .. } = self;
        factors.levels.replace(None);
        let LinearSystems::Iterated { linear } = equations.problem.systems else { return Ok(()) };
        let held = equations.prescribed.iter().map(Option::is_some).collect();
        factors.work.factorisations += 1;
        match TangentLevels::new(&equations.system.stiffness, equations.problem.nodes, held, linear) {
            Ok(levels) => factors.levels.replace(Some(levels)),
            Err(FactorError::NotDefinite) => {}
            Err(FactorError::Other(error)) => return Err(error.into()),
        }
        Ok(())
    }
}
