//! One load step: Newton's method with line search on the balance of internal, external and contact forces.

use std::sync::Arc;

use super::error::{StaticError, Worst};
use super::in_time::{Ended, Scales, TimeTerms};
use super::solid::Internal;
use super::statics::{Drive, StaticProblem, Step, ToolState};
use super::system::{SurfaceTable, System};
use crate::contact::{ContactCounts, ContactHistory as History, Contacts};
use crate::linear_solver::{self, DENSE_LIMIT, FactorError, Factorization, Kind, Symbolic, Unsymmetric};
use crate::load::nodal_forces;
use crate::support::prescribed;
use crate::{Matrix3, SolveError, Vector3};

/// How Newton's method runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonParams {
    /// Residual of the free degrees of freedom relative to the larger of internal and external forces.
    pub tolerance: f64,
    /// Iterations per step.
    pub iterations: usize,
}

/// One iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Relative residual before it.
    pub residual: f64,
    /// `|du . r|` of the step it took, relative to that of the first iteration.
    pub energy: f64,
    /// Part of the Newton step that the line search left.
    pub length: f64,
    /// Whether the tangent was positive definite (on the kernel of the pressures).
    pub definite: bool,
}

/// What a load step starts from and ends with.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub time: f64,
    pub u: Vec<Vector3>,
    pub pressure: Vec<f64>,
    pub closures: Vec<f64>,
    pub history: Vec<History>,
}

impl State {
    pub fn start(problem: &StaticProblem) -> State {
        let points = problem.contact.map_or(0, |c| c.rows().weights().len());
        State {
            time: 0.0,
            u: vec![Vector3::zeros(); problem.nodes.len()],
            pressure: vec![0.0; problem.solid.pressure_count()],
            closures: vec![0.0; problem.tools.len()],
            history: (problem.tools.iter())
                .map(|t| {
                    let mut history = History::new(t.tool, points);
                    if let Some(surface) = problem.contact {
                        let still = vec![Vector3::zeros(); problem.nodes.len()];
                        history.commit_all(None, surface, t.tool, 0.0, &still);
                    }
                    history
                })
                .collect(),
        }
    }
}

/// Forces in a trial state.
struct Balance {
    internal: Internal,
    /// External less internal nodal forces, N; supports not yet taken out.
    out: Vec<Vector3>,
    /// Negative derivative of the energy by the pressures, m^3.
    pressure: Vec<f64>,
    contacts: Vec<Option<Contacts>>,
    /// The forces and deviators by themselves, in real time.
    ended: Option<Ended>,
    /// Larger of internal and external forces, N.
    scale: f64,
}

/// The system of a problem with what is kept from one iteration to the next.
pub(crate) struct Newton<'a> {
    problem: &'a StaticProblem<'a>,
    params: &'a NewtonParams,
    system: System<'a>,
    load: Vec<Vector3>,
    prescribed: Vec<Option<f64>>,
    symbolic: Option<Option<Arc<Symbolic>>>,
    counts: ContactCounts,
    volume: f64,
    terms: Option<TimeTerms>,
    ended: Option<Ended>,
    /// Largest forces so far in real time, N: what swings passes through states without any.
    peak: f64,
    /// Where a tangent that is not definite leads.
    descent: Descent,
    /// Whether the last tangent was not definite.
    indefinite: bool,
}

/// What Newton's method looks for where the tangent is not definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Descent {
    /// The nearest equilibrium: a symmetric one stays symmetric.
    Nearest,
    /// A stable one, down the energy.
    Down,
}

/// `x . r`.
fn work(x: &[f64], r: &[f64]) -> f64 {
    x.iter().zip(r).map(|(x, r)| x * r).sum()
}

/// A factored tangent.
enum Factored {
    Symmetric(Factorization),
    Unsymmetric(Unsymmetric),
}

impl Factored {
    fn solve(&self, b: &mut [f64]) -> Result<(), SolveError> {
        match self {
            Factored::Symmetric(f) => f.solve(b),
            Factored::Unsymmetric(f) => f.solve(b),
        }
        .map(|_| ())
    }
}

impl<'a> Newton<'a> {
    pub fn new(problem: &'a StaticProblem<'a>, params: &'a NewtonParams) -> Result<Newton<'a>, StaticError> {
        Newton::with_mass(problem, params, None)
    }

    /// With a mass table, for steps in real time that have inertia.
    pub fn with_mass(
        problem: &'a StaticProblem<'a>,
        params: &'a NewtonParams,
        mass: Option<&SurfaceTable>,
    ) -> Result<Newton<'a>, StaticError> {
        for (what, value) in [("tolerance", params.tolerance), ("iterations", params.iterations as f64)] {
            if !(value > 0.0) {
                return Err(StaticError::Parameter { what, value, need: "it must be positive" });
            }
        }
        let nodes = problem.nodes.len();
        let prescribed = prescribed(nodes, problem.fixed)?;
        let load = nodal_forces(problem.solid.volume, problem.loads)?;
        crate::body::check_len("nodes of the volume rows", problem.solid.node_count(), nodes)?;
        let mut surfaces: Vec<SurfaceTable> =
            problem.held.iter().map(|h| SurfaceTable::new(h.surface)).collect();
        if let (Some(contact), false) = (problem.contact, problem.tools.is_empty()) {
            surfaces.push(SurfaceTable::new(contact.rows()));
        }
        surfaces.extend(mass.cloned());
        let held: Vec<bool> = prescribed.iter().map(Option::is_some).collect();
        let system = System::new(problem.solid, &held, surfaces);
        let volume = problem.solid.volume.weights().iter().sum();
        Ok(Newton {
            problem,
            params,
            system,
            load,
            prescribed,
            symbolic: None,
            counts: ContactCounts::default(),
            volume,
            terms: None,
            ended: None,
            peak: 0.0,
            descent: Descent::Nearest,
            indefinite: false,
        })
    }

    pub fn counts(&self) -> ContactCounts {
        self.counts
    }

    /// What the next step has besides the forces of statics.
    pub fn set_terms(&mut self, terms: TimeTerms) {
        self.terms = Some(terms);
    }

    /// Forces at the end of the last step in real time.
    pub fn ended(&mut self) -> Ended {
        self.ended.take().expect("a step in real time has ended")
    }

    /// Prescribed value at the end of the ramp by degree of freedom.
    pub fn prescribed(&self) -> &[Option<f64>] {
        &self.prescribed
    }

    /// Forces in a state, without inertia, and the strain energy, J.
    pub fn forces_at(&mut self, state: &State) -> Result<(Ended, f64), StaticError> {
        let balance = self.balance(state, state.time)?;
        Ok((balance.ended.expect("terms of real time are set"), balance.internal.energy))
    }

    /// The parts of loads, supports and drives at `time`.
    fn scales(&self, time: f64) -> Scales {
        self.terms.as_ref().map_or(Scales::all(time), |t| t.scales)
    }

    /// From `start` to equilibrium at `time`; `before` is the state before `start`, for extrapolation.
    pub fn step(
        &mut self,
        start: &State,
        before: Option<&State>,
        time: f64,
        augmentations: usize,
        descent: Descent,
    ) -> Result<(State, Step), StaticError> {
        self.descent = descent;
        let mut state = State { time, ..start.clone() };
        let mut moved = false;
        if let Some(inertia) = self.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
            state.u.clone_from(&inertia.guess);
            self.prescribe(&mut state.u, time);
            moved = true;
        } else if let Some(before) = before {
            moved = self.extrapolate(&mut state, start, before, time);
        }
        for (closure, driven) in state.closures.iter_mut().zip(self.problem.tools) {
            if let Drive::Closure(full) = driven.drive {
                *closure = full * self.scales(time).tools;
            }
        }
        let mut iterations = Vec::new();
        let mut balance = match self.balance(&state, time) {
            Ok(balance) => balance,
            // The guess is no use; the last converged state is always valid.
            Err(_) if moved => {
                state.u.clone_from(&start.u);
                state.pressure.clone_from(&start.pressure);
                self.balance(&state, time)?
            }
            Err(error) => return Err(error),
        };
        for round in 0..=augmentations {
            balance = self.equilibrate(&mut state, balance, time, &mut iterations)?;
            if round < augmentations {
                for (history, contacts) in state.history.iter_mut().zip(&balance.contacts) {
                    history.augment(contacts.as_ref());
                }
                balance = self.balance(&state, time)?;
            }
        }
        if let Some(surface) = self.problem.contact {
            for (k, (history, contacts)) in state.history.iter_mut().zip(&balance.contacts).enumerate() {
                let (tool, closure) = (self.problem.tools[k].tool, state.closures[k]);
                history.commit_all(contacts.as_ref(), surface, tool, closure, &state.u);
            }
        }
        if let Some(ended) = &balance.ended {
            self.peak = self.peak.max(ended.size());
        }
        self.ended = balance.ended;
        let tools = (balance.contacts.iter().zip(&state.closures))
            .map(|(contacts, &closure)| match contacts {
                Some(c) => ToolState {
                    closure,
                    force: c.force(),
                    moment: c.moment(),
                    active: c.points().len(),
                    penetration: c.max_penetration(),
                },
                None => ToolState {
                    closure,
                    force: Vector3::zeros(),
                    moment: Vector3::zeros(),
                    active: 0,
                    penetration: 0.0,
                },
            })
            .collect();
        let step = Step {
            time,
            wanted: false,
            iterations,
            tools,
            energy: balance.internal.energy,
            smallest: balance.internal.smallest.1,
        };
        Ok((state, step))
    }

    /// Carries the motion of the last step on; prescribed values come out right by themselves, as they are linear in
    /// time.
    fn extrapolate(&self, state: &mut State, start: &State, before: &State, time: f64) -> bool {
        let ratio = (time - start.time) / (start.time - before.time);
        if !(ratio > 0.0 && ratio.is_finite()) || before.time == 0.0 && !self.problem.tools.is_empty() {
            return false;
        }
        for ((u, a), b) in state.u.iter_mut().zip(&start.u).zip(&before.u) {
            *u += (a - b) * ratio;
        }
        self.prescribe(&mut state.u, time);
        for ((p, a), b) in state.pressure.iter_mut().zip(&start.pressure).zip(&before.pressure) {
            *p += (a - b) * ratio;
        }
        for ((c, a), b) in state.closures.iter_mut().zip(&start.closures).zip(&before.closures) {
            *c += (a - b) * ratio;
        }
        true
    }

    /// Newton's iterations at fixed multipliers.
    fn equilibrate(
        &mut self,
        state: &mut State,
        mut balance: Balance,
        time: f64,
        log: &mut Vec<Iteration>,
    ) -> Result<Balance, StaticError> {
        let first = log.len();
        let mut first_energy = 0.0f64;
        loop {
            let held_move = self.held_move(state, time);
            let residual = self.residual(&balance, time);
            let settled = held_move.is_none() && residual <= self.params.tolerance;
            if settled {
                log.push(Iteration { residual, energy: 0.0, length: 0.0, definite: true });
                return Ok(balance);
            }
            if log.len() - first >= self.params.iterations || !residual.is_finite() {
                return Err(self.not_converged(&balance, residual, log.len() - first));
            }
            self.indefinite = false;
            let (step, closures) = self.direction(state, &balance, time, held_move.as_deref())?;
            let unknowns = self.system.gather(&balance.out, &balance.pressure);
            let lacking = self.lacking(&balance, time);
            let slope = work(&step, &unknowns) + work(&closures, &lacking);
            if first_energy == 0.0 {
                first_energy = slope.abs();
            }
            let (next, length) =
                self.search(state, &step, &closures, held_move.as_deref(), slope, &balance, time)?;
            let energy = if first_energy > 0.0 { slope.abs() / first_energy } else { 0.0 };
            log.push(Iteration { residual, energy, length, definite: !self.indefinite });
            balance = next;
        }
    }

    /// What held degrees of freedom still lack of their values at `time`.
    fn held_move(&self, state: &State, time: f64) -> Option<Vec<Vector3>> {
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

    /// Sets held degrees of freedom to their values at `time`.
    fn prescribe(&self, u: &mut [Vector3], time: f64) {
        let scale = self.scales(time).supports;
        for (dof, value) in self.prescribed.iter().enumerate() {
            if let Some(value) = value {
                u[dof / 3][dof % 3] = value * scale;
            }
        }
    }

    /// Relative residual: forces on free degrees of freedom, volumes of the pressures, forces of driven tools.
    fn residual(&self, balance: &Balance, time: f64) -> f64 {
        let unknowns = self.system.gather(&balance.out, &balance.pressure);
        let (forces, volumes) = unknowns.split_at(self.system.free);
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
        let tools = self.scales(time).tools;
        let scale = if balance.scale > 0.0 { balance.scale } else { 1.0 };
        let mut residual = norm(forces) / scale;
        residual = residual.max(norm(volumes) / self.volume);
        for (driven, lacking) in self.problem.tools.iter().zip(self.lacking(balance, time)) {
            if let Drive::Force(full) = driven.drive {
                residual = residual.max(lacking.abs() / (full * tools).abs());
            }
        }
        residual
    }

    /// What each tool driven by force still lacks of it, N: its share in the line search's work, without which a tool
    /// alone out of balance gives a slope of zero and every step is cut. 0 for one driven by closure.
    fn lacking(&self, balance: &Balance, time: f64) -> Vec<f64> {
        let scale = self.scales(time).tools;
        (self.problem.tools.iter().zip(&balance.contacts))
            .map(|(driven, contacts)| match driven.drive {
                Drive::Force(full) => {
                    full * scale + contacts.as_ref().map_or(0.0, |c| c.force().dot(&driven.tool.along()))
                }
                Drive::Closure(_) => 0.0,
            })
            .collect()
    }

    fn not_converged(&self, balance: &Balance, residual: f64, iterations: usize) -> StaticError {
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

    /// Forces in a state.
    fn balance(&mut self, state: &State, time: f64) -> Result<Balance, StaticError> {
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
        for (held, table) in self.problem.held.iter().zip(&self.system.surfaces) {
            let at = table.displacement(&state.u);
            let traction: Vec<Vector3> = (at.iter().zip(&held.values))
                .map(|(u, g)| {
                    Vector3::from_fn(
                        |a, _| if held.axes[a] { held.beta * (g[a] * supports - u[a]) } else { 0.0 },
                    )
                })
                .collect();
            table.add_force(&traction, &mut out);
        }
        let mut contacts = Vec::new();
        for ((driven, &closure), history) in
            self.problem.tools.iter().zip(&state.closures).zip(&state.history)
        {
            let found = match self.problem.contact {
                Some(surface) => {
                    surface.evaluate(driven.tool, closure, &state.u, history, &mut self.counts)?
                }
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

    /// `-w dt/dx` of every surface point, by surface: held ones first, then contact.
    fn surface_blocks(&self, balance: &Balance) -> Vec<Vec<Matrix3>> {
        let mut blocks: Vec<Vec<Matrix3>> = (self.problem.held.iter())
            .map(|h| {
                let held = Vector3::from_fn(|a, _| if h.axes[a] { h.beta } else { 0.0 });
                h.surface.weights().iter().map(|w| Matrix3::from_diagonal(&(held * *w))).collect()
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
    fn direction(
        &mut self,
        state: &State,
        balance: &Balance,
        time: f64,
        held_move: Option<&[Vector3]>,
    ) -> Result<(Vec<f64>, Vec<f64>), StaticError> {
        let pairs = self.system.pairs.as_ref();
        let mut hessian = self.problem.solid.hessian(pairs, &state.u, &state.pressure)?;
        if let Some(relaxing) = self.terms.as_ref().and_then(|t| t.relaxing.as_ref()) {
            let solid = &self.problem.solid;
            relaxing.relax_tangent(solid, pairs, &state.u, &state.pressure, &mut hessian)?;
        }
        let blocks = self.surface_blocks(balance);
        let matrix = self.system.assemble(&hessian, &blocks);
        let skew = self.system.skew(&blocks);
        let mut right = balance.out.clone();
        let mut right_pressure = balance.pressure.clone();
        if let Some(moves) = held_move {
            for (r, k) in right.iter_mut().zip(self.system.held_part(moves)) {
                *r -= k;
            }
            // The accelerations of held degrees of freedom are given: they don't follow the move.
            if let Some(inertia) = self.terms.as_ref().and_then(|t| t.inertia.as_ref()) {
                let mass = self.system.surfaces.last().expect("inertia has a mass table");
                inertia.give_back(mass, moves, &mut right);
            }
            self.system.subtract_held_pressure(&hessian, moves, &mut right_pressure);
        }
        let mut step = self.system.gather(&right, &right_pressure);
        let factored = self.factor(matrix, skew)?;
        self.solve(&factored, &mut step)?;
        let closures = self.drive(&factored, state, balance, time, &mut step)?;
        Ok((step, closures))
    }

    /// Solves with the matrix as it was assembled, pressures scaled.
    fn solve(&self, factored: &Factored, b: &mut [f64]) -> Result<(), SolveError> {
        let scale = self.system.pressure_scale;
        b[self.system.free..].iter_mut().for_each(|p| *p *= scale);
        factored.solve(b)?;
        b[self.system.free..].iter_mut().for_each(|p| *p *= scale);
        Ok(())
    }

    /// Cholesky, or `L D L^T` with a pressure field; the factor of the symmetric part as a preconditioner with sliding
    /// friction. Past a limit point the tangent is not definite and its step leads to the nearest equilibrium, stable
    /// or not; with [`Descent::Down`] its diagonal is raised until it is definite, and the step leads down.
    fn factor(
        &mut self,
        matrix: linear_solver::Symmetric,
        skew: Vec<(usize, usize, f64)>,
    ) -> Result<Factored, StaticError> {
        if self.symbolic.is_none() {
            self.symbolic = Some(linear_solver::analyse(&matrix, DENSE_LIMIT)?);
        }
        let symbolic = self.symbolic.as_ref().expect("just analysed").as_ref();
        let (kind, pressures) = (matrix.kind(), matrix.dim() - matrix.multipliers);
        let with_skew = |factor| match skew.is_empty() {
            true => Factored::Symmetric(factor),
            false => Factored::Unsymmetric(Unsymmetric::new(factor, skew.clone())),
        };
        let shifts: &[f64] = match self.descent {
            Descent::Nearest => &[0.0],
            Descent::Down => &[0.0, 1e-3, 1e-2, 0.1, 1.0],
        };
        for &shift in shifts {
            let mut shifted = matrix.clone();
            shifted.shift(shift);
            match linear_solver::factor_as(symbolic, shifted, kind) {
                Ok(factor) if self.descent == Descent::Nearest || factor.negative_pivots() == pressures => {
                    self.indefinite |= shift > 0.0 || factor.negative_pivots() != pressures;
                    return Ok(with_skew(factor));
                }
                Ok(_) | Err(FactorError::NotDefinite) => {}
                Err(FactorError::Other(SolveError::NearlySingular { .. } | SolveError::ZeroPivot)) => {}
                Err(FactorError::Other(error)) => return Err(error.into()),
            }
        }
        if self.descent == Descent::Nearest && kind == Kind::Definite {
            self.indefinite = true;
            return match linear_solver::factor_as(symbolic, matrix, Kind::Indefinite) {
                Ok(factor) => Ok(with_skew(factor)),
                Err(FactorError::Other(error)) => Err(error.into()),
                Err(FactorError::NotDefinite) => Err(SolveError::NotPositiveDefinite.into()),
            };
        }
        Err(SolveError::NotPositiveDefinite.into())
    }

    /// Closures of the tools driven by force, by elimination: with `a = sum w N S along` (S = -dt/dx) the step is
    /// `du = x + X dd`, `K X = a`, and `dd` balances the tool: `(D - a' . X) dd = F - Q + a' . x`,
    /// `D = sum w along . S along`. One tool at a time: the columns of all tools make a small dense system.
    fn drive(
        &self,
        factored: &Factored,
        state: &State,
        balance: &Balance,
        time: f64,
        step: &mut [f64],
    ) -> Result<Vec<f64>, StaticError> {
        let mut moves = vec![0.0; self.problem.tools.len()];
        let Some(surface) = self.problem.contact else { return Ok(moves) };
        let rows = surface.rows();
        let nodes = self.problem.nodes.len();
        let none = vec![0.0; state.pressure.len()];
        // (tool, X, a', D, what its force lacks)
        let mut driven = Vec::new();
        for (k, tool) in self.problem.tools.iter().enumerate() {
            let Drive::Force(full) = tool.drive else { continue };
            let full = full * self.scales(time).tools;
            let along = tool.tool.along();
            let mut columns = [vec![Vector3::zeros(); nodes], vec![Vector3::zeros(); nodes]];
            let (mut own, mut pushed) = (0.0, 0.0);
            if let Some(contacts) = &balance.contacts[k] {
                pushed = -contacts.force().dot(&along);
                for (&q, dt) in contacts.points().iter().zip(contacts.stiffness()) {
                    let w = rows.weights()[q as usize];
                    let (right, left) = (dt * along * -w, dt.tr_mul(&along) * -w);
                    own += right.dot(&along);
                    let (at, values) = rows.rows().row(q as usize);
                    for (&node, value) in at.iter().zip(values) {
                        columns[0][node as usize] += right * *value;
                        columns[1][node as usize] += left * *value;
                    }
                }
            }
            if !(own > 0.0) {
                moves[k] = self.approach(k, state, full)?;
                continue;
            }
            let mut x = self.system.gather(&columns[0], &none);
            self.solve(factored, &mut x)?;
            driven.push((k, x, self.system.gather(&columns[1], &none), own, full - pushed));
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let m = driven.len();
        if m > 0 {
            let matrix = nalgebra::DMatrix::from_fn(m, m, |i, j| {
                f64::from(u8::from(i == j)) * driven[i].3 - dot(&driven[i].2, &driven[j].1)
            });
            let right = nalgebra::DVector::from_fn(m, |i, _| driven[i].4 + dot(&driven[i].2, step));
            let solution = matrix.lu().solve(&right).ok_or(SolveError::NotPositiveDefinite)?;
            for (i, (k, x, _, _, _)) in driven.iter().enumerate() {
                moves[*k] = solution[i];
                for (s, x) in step.iter_mut().zip(x) {
                    *s += x * solution[i];
                }
            }
        }
        Ok(moves)
    }

    /// Closure that brings a tool which does not touch into contact, with the penetration that a hundredth of the
    /// surface would need for `force`.
    fn approach(&self, tool: usize, state: &State, force: f64) -> Result<f64, StaticError> {
        let Some(surface) = self.problem.contact else { return Ok(0.0) };
        let driven = self.problem.tools[tool].tool;
        let gap = surface.gap(driven, state.closures[tool], &state.u);
        let area: f64 = surface.rows().weights().iter().sum();
        Ok(gap.max(0.0) + force.abs() / (driven.law().penalty() * 0.01 * area))
    }

    /// Takes the step, or the part of it that brings the residual's work along the step down: a step past the minimum
    /// is cut by the secant, one that inverts a point is halved.
    fn search(
        &mut self,
        state: &mut State,
        step: &[f64],
        closures: &[f64],
        held_move: Option<&[Vector3]>,
        slope: f64,
        last: &Balance,
        time: f64,
    ) -> Result<(Balance, f64), StaticError> {
        let start = (state.u.clone(), state.pressure.clone(), state.closures.clone());
        let norm = |x: &[f64]| x.iter().map(|v| v * v).sum::<f64>().sqrt();
        let none = vec![0.0; state.pressure.len()];
        let before = norm(&self.system.gather(&last.out, &none)).hypot(norm(&self.lacking(last, time)));
        // A tool driven by force that does not touch yet is on its approach: no force on its way tells where to stop.
        let approaches = (self.problem.tools.iter().zip(&last.contacts)).any(|(driven, contacts)| {
            matches!(driven.drive, Drive::Force(_)) && contacts.as_ref().is_none_or(|c| c.points().is_empty())
        });
        let mut length = 1.0;
        for trial in 0.. {
            state.u.clone_from(&start.0);
            state.pressure.clone_from(&start.1);
            state.closures.clone_from(&start.2);
            // Held degrees of freedom go all the way, whatever part of the step the free ones take.
            self.prescribe(&mut state.u, time);
            self.system.scatter_add(step, length, &mut state.u, &mut state.pressure);
            state.closures.iter_mut().zip(closures).for_each(|(c, d)| *c += length * d);
            let balance = match self.balance(state, time) {
                Ok(balance) => balance,
                Err(error) if trial >= 10 || held_move.is_some() => return Err(error),
                Err(_) => {
                    length *= 0.5;
                    continue;
                }
            };
            let saddle = !state.pressure.is_empty();
            let unknowns = self.system.gather(&balance.out, &balance.pressure);
            let lacking = self.lacking(&balance, time);
            let now = work(step, &unknowns) + work(closures, &lacking);
            // The pressure's saddle has no descent direction; there, and while held values move, the full step goes.
            let smaller = norm(&unknowns).hypot(norm(&lacking)) <= (1.0 - 0.1 * length) * before;
            if now.abs() <= (1.0 - 0.2 * length) * slope.abs()
                || smaller
                || held_move.is_some()
                || saddle
                || approaches
                || trial >= 6
            {
                return Ok((balance, length));
            }
            // Secant between slope at 0 and now at `length`, kept between a tenth and a half of it.
            let secant = length * slope / (slope - now);
            length = if secant.is_finite() { secant.clamp(0.1 * length, 0.5 * length) } else { 0.5 * length };
        }
        unreachable!("the loop returns or fails by its eleventh trial")
    }
}
