//! Forces in a state, their residual, and the remaining error of prescribed degrees of freedom.

use contact::Contacts;
use material::Material as _;
use shape::Vector3;

use super::{Newton, State};
use crate::nonlinear::error::{StaticError, Worst};
use crate::nonlinear::in_time::{Ended, Scales};
use crate::nonlinear::solid::{Internal, Solid};

/// Rounding error of a nodal force, relative to the force due to the node's own displacement.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Returns `sum of w (lambda + 2 mu) |grad N|^2` for each node, N/m.
pub(super) fn stiffness(solid: &Solid) -> Vec<f64> {
    let mut sums = vec![0.0; solid.node_count()];
    for (q, w) in solid.volume.weights().iter().enumerate() {
        let law = solid.law(q);
        let modulus = law.lambda() + 2.0 * law.mu();
        let (nodes, grads) = solid.volume.row(q);
        nodes.iter().zip(grads).for_each(|(&node, g)| sums[node as usize] += w * modulus * g.norm_squared());
    }
    sums
}

/// Forces in a trial state.
pub(super) struct Balance {
    pub(super) internal: Internal,
    /// External minus internal nodal forces, N, including constrained degrees of freedom.
    pub(super) out: Vec<Vector3>,
    /// Negative derivative of the energy with respect to the pressures, m^3.
    pub(super) pressure: Vec<f64>,
    pub(super) contacts: Vec<Option<Contacts>>,
    /// Separate forces and deviators, for implicit dynamics.
    pub(super) ended: Option<Ended>,
    /// Norm of the internal or external forces, whichever is larger, N.
    pub(super) scale: f64,
}

impl Newton<'_> {
    /// Returns the increments that bring constrained degrees of freedom to their prescribed values at `time`,
    /// m; `None` if all are reached.
    pub(super) fn prescribed_move(&self, state: &State, time: f64) -> Option<Vec<Vector3>> {
        let scale = self.scales(time).supports;
        let mut lacking = false;
        let moves: Vec<Vector3> = (state.u.iter().enumerate())
            .map(|(i, u)| {
                Vector3::from_fn(|a, _| match self.prescribed[3 * i + a] {
                    Some(value) if u[a] != value * scale => {
                        lacking = true;
                        value * scale - u[a]
                    }
                    _ => 0.0,
                })
            })
            .collect();
        lacking.then_some(moves)
    }

    /// Sets constrained degrees of freedom to their values at `time`.
    pub(super) fn prescribe(&self, u: &mut [Vector3], time: f64) {
        let scale = self.scales(time).supports;
        for (dof, value) in self.prescribed.iter().enumerate() {
            if let Some(value) = value {
                u[dof / 3][dof % 3] = value * scale;
            }
        }
    }

    /// Returns the relative residual at displacement `u`: the largest of the forces on free degrees of
    /// freedom, the volume residuals of the pressures, and the missing forces of force-driven tools.
    ///
    /// The scale of forces is at least the rounding error of the displacement's forces over the tolerance,
    /// because a body that moves as a whole has no other forces.
    pub(super) fn residual(&self, balance: &Balance, u: &[Vector3], time: f64) -> f64 {
        let unknowns = self.system.gather(&balance.out, &balance.pressure);
        let (forces, volumes) = unknowns.split_at(self.system.free);
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
        let squares = self.stiffness.iter().zip(u).map(|(k, u)| k * k * u.norm_squared());
        let rounding = ROUNDING * squares.sum::<f64>().sqrt();
        let scale = balance.scale.max(rounding / self.params.tolerance);
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let mut residual = norm(forces) / scale;
        residual = residual.max(norm(volumes) / self.volume);
        for (k, lacking) in self.lacking(balance, time).into_iter().enumerate() {
            if let Some(force) = self.force(k, time) {
                residual = residual.max(lacking.abs() / force.abs());
            }
        }
        residual
    }

    /// Returns the forces that balance `out` in constrained degrees of freedom, N.
    pub(super) fn held_back(&self, out: &[Vector3]) -> Vec<Vector3> {
        let held = |i: usize, a: usize| self.prescribed[3 * i + a].is_some();
        (0..out.len()).map(|i| Vector3::from_fn(|a, _| if held(i, a) { -out[i][a] } else { 0.0 })).collect()
    }

    pub(super) fn not_converged(&self, balance: &Balance, residual: f64, iterations: usize) -> StaticError {
        let force = |i: usize| {
            (0..3)
                .filter(|a| self.prescribed[3 * i + a].is_none())
                .map(|a| balance.out[i][a].powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let node = (0..balance.out.len()).max_by(|&i, &j| force(i).total_cmp(&force(j))).unwrap_or(0);
        let (smallest_at, smallest) = balance.internal.smallest;
        let worst = Worst { node, at: self.problem.nodes[node], force: force(node) };
        let tolerance = self.params.tolerance;
        StaticError::NotConverged { iterations, residual, tolerance, worst, smallest, smallest_at }
    }

    /// Computes the forces in a state.
    pub(super) fn balance(&mut self, state: &State, time: f64) -> Result<Balance, StaticError> {
        self.work.forces += 1;
        let Scales { loads, supports, .. } = self.scales(time);
        let pairs = self.system.pairs.as_ref();
        let mut internal = self.problem.solid.internal(pairs, &state.u, &state.pressure)?;
        let mut deviator = Vec::new();
        if let Some(relaxing) = self.terms.as_ref().and_then(|t| t.relaxing.as_ref()) {
            let solid = &self.problem.solid;
            deviator = relaxing.relax(solid, pairs, &state.u, &state.pressure, &mut internal)?;
        }
        let inner = self.system.internal_force(&internal);
        let mut out: Vec<Vector3> = self.load.iter().map(|f| f * loads).collect();
        for (penalty, table) in self.problem.penalties.iter().zip(&self.system.surfaces) {
            let at = table.displacement(&state.u);
            let traction: Vec<Vector3> = (at.iter().zip(&penalty.values))
                .map(|(u, g)| {
                    Vector3::from_fn(|a, _| {
                        if penalty.axes[a] { penalty.beta * (g[a] * supports - u[a]) } else { 0.0 }
                    })
                })
                .collect();
            table.add_force(&traction, &mut out);
        }
        let mut contacts = Vec::new();
        for (tool, ((driven, &closure), history)) in
            self.problem.tools.iter().zip(&state.closures).zip(&state.history).enumerate()
        {
            let found = match self.problem.contact {
                Some(surface) => surface
                    .evaluate(driven.tool, closure, &state.u, history, &mut self.counts)
                    .map_err(|cause| StaticError::Contact { tool, cause })?,
                None => None,
            };
            if let (Some(found), Some(surface)) = (&found, self.problem.contact) {
                found.add_force(surface.rows(), &mut out);
            }
            contacts.push(found);
        }
        let norm = |f: &[Vector3]| f.iter().map(|v| v.norm_squared()).sum::<f64>().sqrt();
        let mut scale = norm(&inner).max(norm(&out)).max(self.peak);
        let ended =
            self.terms.as_ref().map(|_| Ended { external: out.clone(), internal: inner.clone(), deviator });
        if let Some(inertia) = self.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
            let mass = self.system.surfaces.last().expect("inertia has a mass table");
            scale = scale.max(inertia.add_force(mass, &self.prescribed, &state.u, &mut out));
        }
        for (out, inner) in out.iter_mut().zip(&inner) {
            *out -= inner;
        }
        let pressure = self.system.pressure_gradient(&internal).iter().map(|g| -g).collect();
        Ok(Balance { internal, out, pressure, contacts, ended, scale })
    }
}
