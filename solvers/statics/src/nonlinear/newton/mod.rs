//! A load step: Newton's method with line search on the balance of internal, external and contact forces.

mod balance;
mod drive;
mod factor;
mod passage;
mod rigid;
mod search;
mod tangent;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use algebra::{Curvature, Factor, Symbolic};
use contact::{ContactCounts, ContactHistory as History, Drive, ToolState};
use shape::Vector3;

use self::balance::{Balance, stiffness};
pub(crate) use self::passage::shortest_travel;
use self::tangent::Direction;
use crate::body::check_len;
use crate::load::nodal_forces;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::in_time::{Ended, Scales, TimeTerms};
use crate::nonlinear::statics::{StaticProblem, StaticWork, Step};
use crate::nonlinear::system::{SurfaceTable, System};
use crate::support::prescribed;

/// Parameters of Newton's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonParams {
    /// Residual of the free degrees of freedom relative to the larger of internal and external forces.
    pub tolerance: f64,
    /// Largest number of iterations per step.
    pub iterations: usize,
    /// Allows the last iterations to reuse the previous tangent if the expected residual reduction suffices.
    /// Convergence is then no longer quadratic, but the run is a quarter faster (the published kidney, tet4).
    pub chords: bool,
    /// Cost ratio of factorisation to solution (in multiplications) above which factors are kept from one
    /// tangent to the next and computed in single precision. Systems are then solved iteratively, to the
    /// accuracy that the next step needs.
    pub keeps: f64,
}

impl NewtonParams {
    /// Ratio above which keeping factors pays off. Measured on the kidney between jaws (7 mm; factors kept /
    /// renewed for each tangent, in CPU seconds): 1.5 / 2.2 at a ratio of 83 (hex20 with reduced integration,
    /// 1,201 nodes), 6.3 / 11.5 at 98 (tet10, 2,273 nodes).
    pub const KEEPS: f64 = 80.0;
}

/// Record of one Newton iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Relative residual before the iteration.
    pub residual: f64,
    /// `|du . r|` of the step, relative to that of the first iteration.
    pub energy: f64,
    /// Length of the step relative to the Newton step: below 1 if the line search cut the step, above 1 if it
    /// extended the step.
    pub length: f64,
    /// Whether the tangent was positive definite (on the kernel of the pressures), force-driven tools
    /// included.
    pub definite: bool,
    /// Whether the tangent was that of the previous iteration (a chord).
    pub chord: bool,
}

/// State at the start or end of a load step.
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

/// The system of a problem, with all data kept from one iteration to the next.
pub(crate) struct Newton<'a> {
    problem: &'a StaticProblem<'a>,
    params: &'a NewtonParams,
    system: System<'a>,
    load: Vec<Vector3>,
    prescribed: Vec<Option<f64>>,
    symbolic: Option<Option<Arc<Symbolic>>>,
    counts: ContactCounts,
    work: StaticWork,
    volume: f64,
    /// Stiffness of each node of the undeformed body against its own displacement, N/m.
    stiffness: Vec<f64>,
    terms: Option<TimeTerms>,
    ended: Option<Ended>,
    /// Force of the nodal supports at the end of the last step, N.
    reaction: Vec<Vector3>,
    /// Largest forces so far in implicit dynamics and in loops, N: an oscillation passes through states
    /// without forces.
    peak: f64,
    /// Forces at the end of the last step, N.
    reached: f64,
    /// Treatment of a tangent that is not definite.
    descent: Descent,
    /// Whether the last tangent was not definite.
    indefinite: bool,
    /// Whether the last factored tangent was not definite; the next tangent is then rarely definite.
    doubtful: bool,
    /// Whether factors are computed in double precision.
    exact: bool,
    /// The last factor, if it is large enough to be kept.
    factor: Option<Arc<Factor>>,
    /// Last direction of negative curvature of a tangent.
    curvature: Curvature,
    /// Relative residual to which unsymmetric systems are solved.
    forcing: f64,
    /// Force-driven tools that are temporarily under displacement control.
    displacement_driven: Vec<bool>,
    /// Whether steps are the frames of a simulator's loop. A frame starts with the last tangent if that is
    /// expected to suffice, and a step that is cut is extended until a point touches.
    repeats: bool,
    /// The last tangent.
    kept: Option<Direction>,
}

/// Goal of Newton's method when the tangent is not definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Descent {
    /// The nearest equilibrium by tangents that are all definite, on a branch that stays stable.
    Smooth,
    /// The nearest equilibrium; a symmetric state stays symmetric. With a pressure field every step is a full
    /// step.
    Nearest,
    /// The nearest equilibrium; with a pressure field steps may be cut. This helps if full steps cycle
    /// between sticking and sliding points. Otherwise it takes about 1.6 times the iterations, so it is not
    /// the first choice.
    Guarded,
    /// A stable equilibrium, reached by reducing the energy.
    Down,
}

/// Finds the nearest equilibrium. With a pressure field, steps are cut if full steps do not converge.
pub(crate) fn near<T>(
    saddle: bool,
    to: &mut impl FnMut(Descent) -> Result<T, StaticError>,
) -> Result<T, StaticError> {
    to(Descent::Nearest).or_else(|error| if saddle { to(Descent::Guarded) } else { Err(error) })
}

/// Iterations without a reduction of the residual by a tenth after which the nearest equilibrium is given up.
/// Successful steps of the kidney between jaws took up to 7 such iterations. A limit of 40 doubled the time
/// of the whole path.
const PATIENCE: usize = 10;

/// Relative residual to which a chord is solved if factors are expensive. The chord itself leaves as much.
const CHORD: f64 = 0.03;

/// Ratio of residual to tolerance up to which a frame starts with the last tangent. The step leaves at most a
/// tenth of the residual while no point starts or ceases to touch or to slide. If a point does, a second such
/// step rarely helps.
const NEAR: f64 = 10.0;

/// The limit replacing `PATIENCE` if every one of these iterations took at most an eighth of its step with an
/// indefinite tangent: past a limit point no equilibrium is near. Ten such iterations took a sixth of the
/// time of the kidney's whole path.
const LOST: usize = 4;

/// Returns the number of iterations without a reduction of the residual by a tenth that are tolerated.
fn patience(log: &[Iteration]) -> usize {
    let last = log.len().saturating_sub(LOST);
    let lost = log.len() >= LOST && log[last..].iter().all(|i| !i.definite && i.length <= 0.125);
    if lost { LOST } else { PATIENCE }
}

/// Whether steps with the previous tangent are expected to converge from `residual` in at most three
/// iterations. Each costs a sixth of an iteration with its own tangent (tet4, 3855 unknowns). If residuals
/// fall as `C r^2`, the first step leaves `2 r / r_before` of the residual, and so do the next steps.
fn chord_suffices(log: &[Iteration], residual: f64, tolerance: f64) -> bool {
    if log.iter().all(|i| i.chord) {
        return log.is_empty() && residual <= NEAR * tolerance;
    }
    let chords = log.iter().rev().take_while(|i| i.chord).count();
    let Some(before) = log.last().filter(|i| i.length == 1.0 && i.definite) else { return false };
    let rate = residual / before.residual;
    match chords {
        0 => {
            let left = 2.0 * rate;
            left < 0.1 && residual * left.powi(3) <= tolerance
        }
        _ => chords < 4 && rate < 0.3,
    }
}

/// Returns the work `x . r`.
fn work(x: &[f64], r: &[f64]) -> f64 {
    x.iter().zip(r).map(|(x, r)| x * r).sum()
}

impl<'a> Newton<'a> {
    pub fn new(problem: &'a StaticProblem<'a>, params: &'a NewtonParams) -> Result<Newton<'a>, StaticError> {
        Newton::with_mass(problem, params, None)
    }

    /// Prepares a problem with a mass table, for implicit dynamics with inertia.
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
        check_len("nodes of the volume rows", problem.solid.node_count(), nodes)?;
        let mut surfaces: Vec<SurfaceTable> =
            problem.penalties.iter().map(|h| SurfaceTable::new(h.surface)).collect();
        if let (Some(contact), false) = (problem.contact, problem.tools.is_empty()) {
            surfaces.push(SurfaceTable::new(contact.rows()));
        }
        surfaces.extend(mass.cloned());
        let constrained: Vec<bool> = prescribed.iter().map(Option::is_some).collect();
        let system = System::new(problem.solid, &constrained, surfaces);
        let volume = problem.solid.volume.weights().iter().sum();
        Ok(Newton {
            problem,
            params,
            system,
            load,
            prescribed,
            symbolic: None,
            counts: ContactCounts::default(),
            work: StaticWork::default(),
            volume,
            stiffness: stiffness(&problem.solid),
            terms: None,
            ended: None,
            reaction: Vec::new(),
            peak: 0.0,
            reached: 0.0,
            descent: Descent::Nearest,
            indefinite: false,
            doubtful: false,
            exact: true,
            factor: None,
            curvature: Curvature::default(),
            forcing: 1e-7,
            displacement_driven: vec![false; problem.tools.len()],
            repeats: false,
            kept: None,
        })
    }

    /// Declares the following steps as frames of a simulator's loop.
    pub fn repeat(mut self) -> Newton<'a> {
        self.repeats = true;
        self
    }

    pub fn counts(&self) -> ContactCounts {
        self.counts
    }

    /// Returns the counters so far, including failed steps and trials.
    pub fn work(&self) -> StaticWork {
        self.work
    }

    /// Sets the terms that the next step adds to the forces of statics.
    pub fn set_terms(&mut self, terms: TimeTerms) {
        self.terms = Some(terms);
    }

    /// Returns the forces at the end of the last time step, which is thereby accepted.
    pub fn ended(&mut self) -> Ended {
        let ended = self.ended.take().expect("a step in real time has ended");
        self.peak = self.peak.max(ended.size());
        ended
    }

    /// Returns the reaction force (N) of the nodal supports on every node at the end of the last step: the
    /// force that statics leaves unbalanced there, zero in free degrees of freedom.
    pub fn reaction(&self) -> &[Vector3] {
        &self.reaction
    }

    /// Makes the forces at the end of the last step the smallest scale of all following residuals.
    pub fn keep_scale(&mut self) {
        self.peak = self.peak.max(self.reached);
    }

    /// Returns the prescribed value at the end of the ramp for every degree of freedom.
    pub fn prescribed(&self) -> &[Option<f64>] {
        &self.prescribed
    }

    /// Returns the forces in a state, without inertia, and the strain energy, J.
    pub fn forces_at(&mut self, state: &State) -> Result<(Ended, f64), StaticError> {
        let balance = self.balance(state, state.time)?;
        Ok((balance.ended.expect("terms of real time are set"), balance.internal.energy))
    }

    /// Returns the fractions of loads, supports and drives at `time`.
    fn scales(&self, time: f64) -> Scales {
        self.terms.as_ref().map_or(Scales::all(time), |t| t.scales)
    }

    /// Finds the equilibrium at `time` from `start`; `before` is the state before `start`, for extrapolation.
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
            // The guess is invalid; the last converged state is always valid.
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
                let side = contacts.iter().try_for_each(|c| surface.check_side(c, &state.u));
                side.map_err(|cause| StaticError::Contact { tool: k, cause })?;
                history.commit_all(contacts.as_ref(), surface, tool, closure, &state.u);
            }
        }
        self.reached = balance.scale;
        self.reaction = self.held_back(&balance.out);
        self.ended = balance.ended;
        let tools = (balance.contacts.iter().zip(&state.closures))
            .map(|(contacts, &closure)| ToolState::new(closure, contacts.as_ref()))
            .collect();
        let step = Step {
            time,
            wanted: false,
            gave_way: descent == Descent::Down && iterations.iter().any(|i| !i.definite && i.length > 1.0),
            // The tangent of the last iteration belongs to the state one Newton step before the end.
            stable: iterations.iter().rev().find(|i| i.length > 0.0).is_none_or(|i| i.definite),
            iterations,
            tools,
            energy: balance.internal.energy,
            smallest: balance.internal.smallest.1,
        };
        Ok((state, step))
    }

    /// Extrapolates the displacement of the last step, or reverses it if the load reverses. Prescribed values
    /// are linear in time and are therefore extrapolated exactly.
    fn extrapolate(&self, state: &mut State, start: &State, before: &State, time: f64) -> bool {
        let ratio = (time - start.time) / (start.time - before.time);
        if !ratio.is_finite() || before.time == 0.0 && !self.problem.tools.is_empty() {
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

    /// Runs Newton's iterations at fixed multipliers.
    fn equilibrate(
        &mut self,
        state: &mut State,
        mut balance: Balance,
        time: f64,
        log: &mut Vec<Iteration>,
    ) -> Result<Balance, StaticError> {
        let first = log.len();
        let mut first_energy = 0.0f64;
        let mut best = (0, f64::INFINITY);
        let mut last = self.kept.take().filter(|_| self.descent == Descent::Nearest);
        loop {
            let prescribed_move = self.prescribed_move(state, time);
            let residual = self.residual(&balance, &state.u, time);
            let settled = prescribed_move.is_none() && residual <= self.params.tolerance;
            if settled {
                if let Some(unproven) = last.as_mut().filter(|last| !last.proven) {
                    self.prove(unproven)?;
                    // The proven tangent belongs to the last iteration that was not a chord and to all chords
                    // after it.
                    let own = log[first..].iter().rposition(|i| !i.chord).unwrap_or(0);
                    log[first + own..].iter_mut().for_each(|i| i.definite = unproven.definite);
                }
                log.push(Iteration { residual, energy: 0.0, length: 0.0, definite: true, chord: false });
                self.kept = last.filter(|last: &Direction| self.repeats && last.definite);
                return Ok(balance);
            }
            let done = log.len() - first;
            // Before constrained degrees of freedom have moved, the forces are those of the last state, hence
            // small.
            if prescribed_move.is_some() || residual < 0.9 * best.1 {
                best = (done, if prescribed_move.is_some() { f64::INFINITY } else { residual });
            }
            // During descent the forces grow at first.
            let stuck = self.descent != Descent::Down && done >= best.0 + patience(&log[first..]);
            if done >= self.params.iterations || stuck || !residual.is_finite() {
                return Err(self.not_converged(&balance, residual, done));
            }
            self.indefinite = false;
            // Systems with sliding friction are solved inexactly: a tenth of the residual preserves the order
            // of convergence (Dembo, Eisenstat & Steihaug 1982). Far from equilibrium further digits would be
            // useless.
            self.forcing = (0.1 * residual).clamp(1e-7, 1e-2);
            if self.keeps() {
                // The tolerance needs no further digits.
                self.forcing = self.forcing.max((0.1 * self.params.tolerance / residual).min(1e-2));
            }
            let chord = self.params.chords
                && last.is_some()
                && prescribed_move.is_none()
                && chord_suffices(&log[first..], residual, self.params.tolerance);
            if chord && self.keeps() {
                self.forcing = self.forcing.max(CHORD);
            }
            let direction = match last.take().filter(|_| chord) {
                Some(last) => self.again(last, state, &balance, time)?,
                None => self.direction(state, &balance, time, prescribed_move.as_deref())?,
            };
            let unknowns = self.system.gather(&balance.out, &balance.pressure);
            let lacking = self.lacking(&balance, time);
            let slope = work(&direction.step, &unknowns) + work(&direction.closures, &lacking);
            if first_energy == 0.0 {
                first_energy = slope.abs();
            }
            let (next, length) =
                self.search(state, &direction, prescribed_move.as_deref(), slope, &balance, time)?;
            let energy = if first_energy > 0.0 { slope.abs() / first_energy } else { 0.0 };
            log.push(Iteration { residual, energy, length, definite: direction.definite, chord });

            (balance, last) = (next, Some(direction));
        }
    }
}
