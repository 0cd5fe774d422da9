//! The equations of Newton's method: forces in a state, their residual, and the remaining error of prescribed
//! degrees of freedom.

use contact::{ContactCounts, Contacts};
use material::Material as _;
use shape::Vector3;

use super::direction::Direction;
use super::state::State;
use crate::body::check_len;
use crate::load::nodal_forces;
use crate::nonlinear::energy::Internal;
use crate::nonlinear::error::{StaticError, Worst};
use crate::nonlinear::in_time::{Ended, Scales, TimeTerms};
use crate::nonlinear::problem::StaticProblem;
use crate::nonlinear::solid::Solid;
use crate::nonlinear::system::{SurfaceTable, System};
use crate::support::prescribed;

/// Rounding error of a nodal force, relative to the force due to the node's own displacement.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Returns the work `x . r`.
pub(super) fn work(x: &[f64], r: &[f64]) -> f64 {
    x.iter().zip(r).map(|(x, r)| x * r).sum()
}

/// Returns `sum of w (lambda + 2 mu) |grad N|^2` for each node, N/m.
fn stiffness(solid: &Solid) -> Vec<f64> {
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
    pub internal: Internal,
    /// External minus internal nodal forces, N, including constrained degrees of freedom.
    pub out: Vec<Vector3>,
    /// Negative derivative of the energy with respect to the pressures, m^3.
    pub pressure: Vec<f64>,
    pub contacts: Vec<Option<Contacts>>,
    /// Separate forces and deviators, for implicit dynamics.
    pub ended: Option<Ended>,
    /// Norm of the internal or external forces, whichever is larger, N.
    pub scale: f64,
}

/// The balance of forces of a problem, and the terms that the current step adds to it.
pub(super) struct Equations<'a> {
    pub problem: &'a StaticProblem<'a>,
    pub system: System<'a>,
    /// Prescribed value of each degree of freedom at the end of the ramp.
    pub prescribed: Vec<Option<f64>>,
    /// Terms of implicit dynamics in the current step.
    pub terms: Option<TimeTerms>,
    /// Force-driven tools that are temporarily under displacement control.
    pub displacement_driven: Vec<bool>,
    /// Largest forces so far in implicit dynamics and in loops, N: an oscillation passes through states
    /// without forces.
    pub peak: f64,
    /// Counters of the contact search.
    pub counts: ContactCounts,
    /// Number of evaluated states.
    pub evaluations: u64,
    /// Full nodal forces of the dead loads, N.
    load: Vec<Vector3>,
    /// Volume of the body, m^3.
    volume: f64,
    /// Stiffness of each node of the undeformed body against its own displacement, N/m.
    stiffness: Vec<f64>,
}

impl<'a> Equations<'a> {
    /// Prepares a problem, with a mass table for implicit dynamics with inertia.
    pub fn new(
        problem: &'a StaticProblem<'a>,
        mass: Option<&SurfaceTable>,
    ) -> Result<Equations<'a>, StaticError> {
        let nodes = problem.nodes.len();
        let prescribed = prescribed(nodes, problem.fixed)?;
        let load = nodal_forces(problem.solid.volume, problem.loads)?;
        check_len("nodes of the volume rows", problem.solid.node_count(), nodes)?;
        let mut surfaces: Vec<SurfaceTable> =
            problem.penalties.iter().map(|h| SurfaceTable::new(h.surface)).collect();
        if let (Some(contact), false) = (problem.contact, problem.tools.is_empty()) {
            surfaces.push(SurfaceTable::new(contact.rows()));
        }
        surfaces.extend(mass.cloned());
        let constrained: Vec<bool> = prescribed.iter().map(Option::is_some).collect();
        Ok(Equations {
            problem,
            system: System::new(problem.solid, &constrained, surfaces, problem.following),
            prescribed,
            terms: None,
            displacement_driven: vec![false; problem.tools.len()],
            peak: 0.0,
            counts: ContactCounts::default(),
            evaluations: 0,
            load,
            volume: problem.solid.volume.weights().iter().sum(),
            stiffness: stiffness(&problem.solid),
        })
    }

    /// Returns the body with the active stress at `time`, which grows with the loads.
    pub fn solid(&self, time: f64) -> Solid<'a> {
        Solid { activation: self.scales(time).loads, ..self.problem.solid }
    }

    /// Returns the fractions of loads, supports and drives at `time`.
    pub fn scales(&self, time: f64) -> Scales {
        self.terms.as_ref().map_or(Scales::all(time), |t| t.scales)
    }

    /// Returns the increments that bring constrained degrees of freedom to their prescribed values at `time`,
    /// m; `None` if all are reached.
    pub fn prescribed_move(&self, state: &State, time: f64) -> Option<Vec<Vector3>> {
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
    pub fn prescribe(&self, u: &mut [Vector3], time: f64) {
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
    pub fn residual(&self, balance: &Balance, u: &[Vector3], time: f64, tolerance: f64) -> f64 {
        let unknowns = self.system.gather(&balance.out, &balance.pressure);
        let (forces, volumes) = unknowns.split_at(self.system.free);
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
        let squares = self.stiffness.iter().zip(u).map(|(k, u)| k * k * u.norm_squared());
        let rounding = ROUNDING * squares.sum::<f64>().sqrt();
        let scale = balance.scale.max(rounding / tolerance);
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

    /// Returns the work, J, of the unbalanced forces along a step.
    pub fn work_along(&self, direction: &Direction, balance: &Balance, time: f64) -> f64 {
        let unknowns = self.system.gather(&balance.out, &balance.pressure);
        work(&direction.step, &unknowns) + work(&direction.closures, &self.lacking(balance, time))
    }

    /// Returns the forces that balance `out` in constrained degrees of freedom, N.
    pub fn held_back(&self, out: &[Vector3]) -> Vec<Vector3> {
        let held = |i: usize, a: usize| self.prescribed[3 * i + a].is_some();
        (0..out.len()).map(|i| Vector3::from_fn(|a, _| if held(i, a) { -out[i][a] } else { 0.0 })).collect()
    }

    pub fn not_converged(
        &self,
        balance: &Balance,
        residual: f64,
        tolerance: f64,
        iterations: usize,
    ) -> StaticError {
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
        StaticError::NotConverged { iterations, residual, tolerance, worst, smallest, smallest_at }
    }

    /// Computes the forces in a state.
    pub fn balance(&mut self, state: &State, time: f64) -> Result<Balance, StaticError> {
        self.evaluations += 1;
        let Scales { loads, supports, .. } = self.scales(time);
        let pairs = self.system.pairs.as_ref();
        let solid = self.solid(time);
        let mut internal = solid.internal(pairs, &state.u, &state.pressure)?;
        let mut deviator = Vec::new();
        if let Some(relaxing) = self.terms.as_ref().and_then(|t| t.relaxing.as_ref()) {
            deviator = relaxing.relax(&solid, pairs, &state.u, &state.pressure, &mut internal)?;
        }
        let inner = self.system.internal_force(&internal);
        let mut out: Vec<Vector3> = self.load.iter().map(|f| f * loads).collect();
        for pressure in self.problem.following {
            pressure.add_force(&state.u, loads, &mut out);
        }
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
