//! The equations of Newton's method: forces in a state, their residual, and the remaining error of prescribed
//! degrees of freedom.

use contact::{ContactCounts, Contacts};
use material::Material as _;
use shape::{Curve, Vector3};

use super::direction::Direction;
use super::state::State;
use crate::body::check_len;
use crate::hourglass::springs;
use crate::load::nodal_forces_by_curve;
use crate::nonlinear::energy::Internal;
use crate::nonlinear::error::{StaticError, Worst};
use crate::nonlinear::in_time::{Ended, TimeTerms};
use crate::nonlinear::problem::{LinearSystems, StaticProblem};
use crate::nonlinear::solid::{Active, Solid};
use crate::nonlinear::system::{SurfaceTable, System};
use crate::support::prescribed;

/// Rounding error of a nodal force, relative to the force due to the node's own displacement.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Rounding error of the forces, relative to the largest of the path. When tools have lifted off, all forces
/// are rounding errors: 4e-15 of the largest where a plate lets a block go.
const UNLOADED: f64 = 1e-13;

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

/// Returns the number of the prescribed parameter that each of the degrees of freedom of `nodes` nodes
/// follows; nothing if none has a curve of its own. A parameter in several supports follows the first of
/// them.
fn prescribed_by(problem: &StaticProblem, nodes: usize) -> Vec<usize> {
    if problem.curves.fixed.own.is_empty() {
        return Vec::new();
    }
    let mut by = vec![usize::MAX; 3 * nodes];
    for (index, fixed) in problem.fixed.iter().enumerate() {
        let slot = &mut by[3 * fixed.node as usize + fixed.axis as usize];
        *slot = index.min(*slot);
    }
    by
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
    /// Full prescribed value of each degree of freedom.
    pub prescribed: Vec<Option<f64>>,
    /// Number of the prescribed parameter that each degree of freedom follows; empty if none has a curve of
    /// its own.
    prescribed_by: Vec<usize>,
    /// Terms of implicit dynamics in the current step.
    pub terms: Option<TimeTerms>,
    /// Force-driven tools that are temporarily under displacement control.
    pub displacement_driven: Vec<bool>,
    /// Largest forces so far in implicit dynamics and in loops, N: an oscillation passes through states
    /// without forces.
    pub peak: f64,
    /// Largest forces at the end of a step so far, N.
    pub largest: f64,
    /// Counters of the contact search.
    pub counts: ContactCounts,
    /// Number of evaluated states.
    pub evaluations: u64,
    /// Full nodal forces of the dead loads of each curve, N, then those of [`Equations::load_also`].
    loads: Vec<(Curve, Vec<Vector3>)>,
    /// Number of the problem's own curves of loads.
    own_loads: usize,
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
        let loads = nodal_forces_by_curve(problem.solid.volume, problem.loads, &problem.curves.loads)?;
        check_len("nodes of the volume rows", problem.solid.node_count(), nodes)?;
        let mut surfaces: Vec<SurfaceTable> =
            problem.penalties.iter().map(|h| SurfaceTable::new(h.surface)).collect();
        if let (Some(contact), false) = (problem.contact, problem.tools.is_empty()) {
            surfaces.push(SurfaceTable::new(contact.rows()));
        }
        surfaces.extend(mass.cloned());
        let constrained: Vec<bool> = prescribed.iter().map(Option::is_some).collect();
        let solid = problem.solid;
        let basis = match problem.systems {
            LinearSystems::Modal(basis) => Some(basis),
            LinearSystems::Factored | LinearSystems::Iterated { .. } => None,
        };
        let system = System::new(solid, &constrained, surfaces, problem.following);
        let mut system = system.restricted(basis);
        system.springs = springs(solid.volume, |q| [solid.law(q).lambda(), solid.law(q).mu()]);
        Ok(Equations {
            problem,
            system,
            prescribed,
            prescribed_by: prescribed_by(problem, nodes),
            terms: None,
            displacement_driven: vec![false; problem.tools.len()],
            peak: 0.0,
            largest: 0.0,
            counts: ContactCounts::default(),
            evaluations: 0,
            own_loads: loads.len(),
            loads,
            volume: problem.solid.volume.weights().iter().sum(),
            stiffness: stiffness(&problem.solid),
        })
    }

    /// Factor of all terms of the balance but the internal forces; `None` for 1. See
    /// [`TimeTerms::beside_internal`].
    pub fn beside_internal(&self) -> Option<f64> {
        TimeTerms::beside_internal(self.terms.as_ref())
    }

    /// Returns the body with the active stress at `time`.
    pub fn solid(&self, time: f64) -> Solid<'a> {
        let Solid { active: Active { full, .. }, .. } = self.problem.solid;
        Solid { active: Active { full, at: Some((&self.problem.curves.active, time)) }, ..self.problem.solid }
    }

    /// Returns the prescribed value at `time` of each degree of freedom, with its first and second
    /// derivative.
    pub fn prescribed_at(&self, time: f64) -> impl Fn(usize) -> Option<[f64; 3]> {
        let fixed = &self.problem.curves.fixed;
        let usual = fixed.usual.derivatives(time);
        move |dof| {
            let full = self.prescribed[dof]?;
            let own = self.prescribed_by.get(dof).map(|&index| fixed.of(index).derivatives(time));
            Some(own.unwrap_or(usual).map(|factor| full * factor))
        }
    }

    /// Returns the increments that bring constrained degrees of freedom to their prescribed values at `time`,
    /// m; `None` if all are reached.
    pub fn prescribed_move(&self, state: &State, time: f64) -> Option<Vec<Vector3>> {
        let prescribed = self.prescribed_at(time);
        let mut lacking = false;
        let moves: Vec<Vector3> = (state.u.iter().enumerate())
            .map(|(i, u)| {
                Vector3::from_fn(|a, _| match prescribed(3 * i + a) {
                    Some([value, ..]) if u[a] != value => {
                        lacking = true;
                        value - u[a]
                    }
                    _ => 0.0,
                })
            })
            .collect();
        lacking.then_some(moves)
    }

    /// Sets constrained degrees of freedom to their values at `time`.
    pub fn prescribe(&self, u: &mut [Vector3], time: f64) {
        let prescribed = self.prescribed_at(time);
        for dof in 0..self.prescribed.len() {
            if let Some([value, ..]) = prescribed(dof) {
                u[dof / 3][dof % 3] = value;
            }
        }
    }

    /// Returns the relative residual at displacement `u`: the largest of the forces on free degrees of
    /// freedom, the volume residuals of the pressures, and the missing forces of force-driven tools.
    ///
    /// The scale of forces is at least their rounding error over the tolerance: that of the displacement's
    /// forces, because a body that moves as a whole has no others, and that of the largest forces of the path,
    /// because a body that is let go has none.
    pub fn residual(&self, balance: &Balance, u: &[Vector3], time: f64, tolerance: f64) -> f64 {
        let unknowns = self.system.gather(&balance.out, &balance.pressure);
        let (forces, volumes) = unknowns.split_at(self.system.free);
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
        let squares = self.stiffness.iter().zip(u).map(|(k, u)| k * k * u.norm_squared());
        let rounding = (ROUNDING * squares.sum::<f64>().sqrt()).max(UNLOADED * self.largest);
        let scale = balance.scale.max(rounding / tolerance);
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let mut residual = norm(forces) / scale;
        residual = residual.max(norm(volumes) / self.volume);
        for (k, lacking) in self.lacking(balance, time).into_iter().enumerate() {
            if let Some(force) = self.force(k, time) {
                let scale = if force == 0.0 { self.full_force(k) } else { force.abs() };
                residual = residual.max(lacking.abs() / scale);
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

    /// Adds constant forces (N) on the nodes, in place of those added before; nothing if empty.
    pub fn load_also(&mut self, forces: Vec<Vector3>) {
        self.loads.truncate(self.own_loads);
        if !forces.is_empty() {
            self.loads.push((Curve::at_once(), forces));
        }
    }

    /// Computes the contact of each tool in a state.
    pub fn contacts(&mut self, state: &State) -> Result<Vec<Option<Contacts>>, StaticError> {
        let StaticProblem { contact, tools, .. } = self.problem;
        let each = tools.iter().zip(&state.closures).zip(&state.history).enumerate();
        each.map(|(tool, ((driven, &closure), history))| match contact {
            Some(surface) => surface
                .evaluate(driven.tool, closure, &state.u, history, &mut self.counts)
                .map_err(|cause| StaticError::Contact { tool, cause }),
            None => Ok(None),
        })
        .collect()
    }

    /// Computes the forces in a state.
    pub fn balance(&mut self, state: &State, time: f64) -> Result<Balance, StaticError> {
        self.evaluations += 1;
        let curves = &self.problem.curves;
        let pairs = self.system.pairs.as_ref();
        let solid = self.solid(time);
        let mut internal = solid.internal(pairs, &state.u, &state.pressure)?;
        let mut deviator = Vec::new();
        if let Some(relaxing) = self.terms.as_ref().and_then(|t| t.relaxing.as_ref()) {
            deviator = relaxing.relax(&solid, pairs, &state.u, &state.pressure, &mut internal)?;
        }
        let mut inner = self.system.internal_force(&internal);
        if let Some(springs) = &self.system.springs {
            let (forces, energy) = springs.spring_forces(&state.u);
            inner.iter_mut().zip(&forces).for_each(|(inner, force)| *inner += force);
            internal.energy += energy;
        }
        let (usual, own) = self.loads.split_first().expect("the usual curve comes first");
        let factor = usual.0.value(time);
        let mut out: Vec<Vector3> = usual.1.iter().map(|f| f * factor).collect();
        for (curve, forces) in own {
            let factor = curve.value(time);
            out.iter_mut().zip(forces).for_each(|(out, f)| *out += f * factor);
        }
        for (index, pressure) in self.problem.following.iter().enumerate() {
            pressure.add_force(&state.u, curves.following.of(index).value(time), &mut out);
        }
        let rate = self.terms.as_ref().and_then(|t| t.rate.as_ref());
        let velocities = rate.map(|rate| rate.velocities(&state.u, &self.prescribed));
        for (index, (penalty, table)) in self.problem.penalties.iter().zip(&self.system.surfaces).enumerate()
        {
            let factor = curves.penalties.of(index).value(time);
            let at = table.displacement(&state.u);
            let moving = match &velocities {
                Some(velocities) if penalty.damping > 0.0 => table.displacement(velocities),
                _ => Vec::new(),
            };
            table.add_force(&penalty.tractions(&at, &moving, factor), &mut out);
        }
        let contacts = self.contacts(state)?;
        if let Some(surface) = self.problem.contact {
            contacts.iter().flatten().for_each(|found| found.add_force(surface.rows(), &mut out));
        }
        let norm = |f: &[Vector3]| f.iter().map(|v| v.norm_squared()).sum::<f64>().sqrt();
        let mut scale = norm(&inner).max(norm(&out)).max(self.peak);
        let ended =
            self.terms.as_ref().map(|_| Ended { external: out.clone(), internal: inner.clone(), deviator });
        if let Some(inertia) = self.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
            let mass = self.system.surfaces.last().expect("inertia has a mass table");
            scale = scale.max(inertia.add_force(mass, &self.prescribed, &state.u, &mut out));
        }
        if let Some(damping) = self.terms.as_ref().and_then(|t| t.damping.as_ref()) {
            let part = self.beside_internal().unwrap_or(1.0);
            for (out, from) in out.iter_mut().zip(&damping.from) {
                *out = (*out + from * damping.factor) * part;
            }
            scale *= part;
        }
        for (out, inner) in out.iter_mut().zip(&inner) {
            *out -= inner;
        }
        let pressure = self.system.pressure_gradient(&internal).iter().map(|g| -g).collect();
        Ok(Balance { internal, out, pressure, contacts, ended, scale })
    }
}
