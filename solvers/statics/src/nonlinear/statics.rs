//! Quasi-static loading: load steps with cut-back and regrowth, each solved by Newton's method.

use algebra::SolverPath;
use contact::{ContactCounts, ContactHistory};
use shape::{Resultant, Vector3};

use super::error::StaticError;
use super::newton::{Descent, Newton, NewtonParams, State, Totals, near, shortest_travel};
use super::problem::StaticProblem;
use super::stages::Stages;
use super::step::{StaticWork, Step};
use super::stepper::{Attempt, Stepper};

/// Parameters of load stepping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticParams {
    /// Number of equal output intervals. Steps are never longer; a step that fails is halved.
    pub steps: usize,
    /// Smallest step as a fraction of the output interval; shorter steps are given up. For a tool that
    /// travels too far in a step, the limit is a travel of an eighth of the tool's deepest allowed
    /// penetration, if that is less.
    pub smallest: f64,
    /// Parameters of Newton's method.
    pub newton: NewtonParams,
    /// Uzawa iterations of the augmented Lagrangian per step; 0 for a plain penalty.
    pub augmentations: usize,
    /// Load fraction to within which the first limit or bifurcation point is located; `None` if it is not
    /// sought. Steps with an indefinite tangent are halved down to this fraction or to twice the smallest
    /// step. Without this search such a point is noticed only if a step ends beyond it.
    pub limit_within: Option<f64>,
}

/// Result of a static solution up to its end, with the reason of an early end.
#[derive(Clone, Debug)]
pub struct StaticPath {
    /// Converged steps in order.
    pub steps: Vec<Step>,
    /// Nodal parameters after the last converged step, m.
    pub u: Vec<Vector3>,
    /// Pressure parameters of the mixed method, Pa.
    pub pressure: Vec<f64>,
    /// Contact history of each tool after the last converged step.
    pub history: Vec<ContactHistory>,
    /// Number of steps that failed and were cut back.
    pub cut_back: usize,
    /// Counters of the contact search.
    pub counts: ContactCounts,
    /// Counters of the whole solution.
    pub work: StaticWork,
    /// Iterative solver of the tangents; `None` if every step was found by a factor.
    pub solver: Option<SolverPath>,
    /// Reason of an early end.
    pub failure: Option<StaticError>,
}

impl StaticPath {
    /// Applied load fraction reached, 0 to 1.
    pub fn time(&self) -> f64 {
        self.steps.last().map_or(0.0, |s| s.time)
    }
}

/// Equilibrium at the end of a step: nodal parameters (m), parameters of a pressure field (Pa), the reaction
/// force of the nodal supports on every node (N), zero in free degrees of freedom, and the force of each surface
/// constrained by penalty.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Rest<'a> {
    pub u: &'a [Vector3],
    pub pressure: &'a [f64],
    pub reaction: &'a [Vector3],
    pub penalties: &'a [Resultant],
}

/// Solves a static problem in load steps. `observe` is called after every converged step with the step and
/// the state at its end. A solution that ends early is returned as a [`StaticPath`] whose `failure` gives the
/// reason.
///
/// # Errors
/// Errors of the problem itself, such as a rigid motion that neither the supports nor, at the end, the tools
/// prevent: its result would be arbitrary.
pub fn solve_static(
    problem: &StaticProblem,
    params: &StaticParams,
    mut observe: impl FnMut(&Step, Rest),
) -> Result<StaticPath, StaticError> {
    let mut stages = Stages::new(problem, 1.0);
    let mut course = Course::new(problem, params);
    let mut totals = Totals::default();
    loop {
        let stage = stages.stage(&course.state.u);
        let staged = stage.as_ref().map(|stage| stage.problem(problem));
        let body = staged.as_ref().unwrap_or(problem);
        let mut newton = Newton::new(body, &params.newton)?.continuing(&totals);
        if body.tools.is_empty() {
            match newton.check_rigid(&course.state) {
                // The equilibria of the earlier stages are results nevertheless.
                Err(cause) if !stages.is_first() => course.loosen(cause),
                checked => checked?,
            }
        }
        course.follow(&mut newton, stages.until(), &mut observe);
        totals = newton.totals();
        let gone = course.stepper.next_output();
        if course.failure.is_some() || !stages.advance(&course.state.u, newton.reaction(), Some(gone)) {
            if course.failure.is_none() && !body.tools.is_empty() {
                newton.check_rigid(&course.state)?;
            }
            break;
        }
    }
    Ok(course.path(&totals))
}

/// The course of the load steps.
struct Course<'a> {
    params: &'a StaticParams,
    stepper: Stepper,
    state: State,
    /// State before the last step of the current stage.
    before: Option<State>,
    steps: Vec<Step>,
    failure: Option<StaticError>,
    /// Accuracy of the sought limit point, until it is found.
    within: Option<f64>,
    near_limit: bool,
    /// Shortest travel of a tool, as a step.
    shortest: f64,
    is_curved: bool,
}

impl<'a> Course<'a> {
    fn new(problem: &StaticProblem, params: &'a StaticParams) -> Course<'a> {
        let is_curved = !problem.curves.points().is_empty();
        let stepper = Stepper::new(1.0, params.steps, params.smallest, problem.stops());
        // At least a step that can still be halved once: a step that cannot be halved has to accept any
        // equilibrium.
        let finest = 2.0 * stepper.smallest;
        Course {
            params,
            stepper,
            state: State::start(problem),
            before: None,
            steps: Vec::new(),
            failure: None,
            within: params.limit_within.map(|within| within.max(finest)),
            near_limit: false,
            shortest: shortest_travel(problem),
            is_curved,
        }
    }

    /// Makes the steps until the time `until`, or until one fails for good.
    fn follow(&mut self, newton: &mut Newton, until: f64, observe: &mut impl FnMut(&Step, Rest)) {
        self.before = None;
        while self.failure.is_none() && self.stepper.is_before(until) {
            let Some(attempt) = self.stepper.attempt() else { return };
            match self.find(newton, attempt) {
                Ok((reached, mut done)) => {
                    done.wanted = attempt.output.is_some();
                    if done.gave_way {
                        self.within = None;
                    }
                    let grows = done.is_quick() && !std::mem::take(&mut self.near_limit);
                    let penalties = newton.penalty_forces(&reached);
                    let State { u, pressure, .. } = &reached;
                    let (reaction, penalties) = (newton.reaction(), &penalties);
                    observe(&done, Rest { u, pressure, reaction, penalties });
                    self.steps.push(done);
                    self.before = Some(std::mem::replace(&mut self.state, reached));
                    // The forces so far are the only scale once all curves have returned to zero.
                    if self.is_curved {
                        newton.keep_scale();
                    }
                    self.stepper.accept(attempt, if grows { 2.0 } else { 1.0 });
                }
                Err(cause) => {
                    self.near_limit = self.within.is_some();
                    let finest = cause.finest(self.stepper.smallest, self.shortest);
                    if !self.stepper.cut(attempt, 0.5, finest) {
                        self.stall(attempt.length, cause);
                    }
                }
            }
        }
    }

    fn stall(&mut self, step: f64, cause: StaticError) {
        let time = self.stepper.time;
        self.failure = Some(StaticError::Stalled { time, step, cause: Box::new(cause) });
    }

    fn loosen(&mut self, cause: StaticError) {
        self.failure = Some(StaticError::Loose { time: self.stepper.time, cause: Box::new(cause) });
    }

    /// Finds the equilibrium at the end of a step.
    fn find(&self, newton: &mut Newton, attempt: Attempt) -> Result<(State, Step), StaticError> {
        let Course { params, state, within, .. } = self;
        // The displacement so far gives the best guess. Without a converged step, or if the guess inverts a
        // point, the last state is the guess.
        let guess = self.before.as_ref();
        let rounds = params.augmentations;
        let mut to = |descent| newton.find(state, guess, attempt.time, rounds, descent);
        let (reached, done) = if within.is_some_and(|within| attempt.length > within) {
            to(Descent::Smooth)?
        } else {
            match near(!state.pressure.is_empty(), &mut to) {
                // The sought limit point: the solution continues to the next stable equilibrium.
                Ok((_, done)) if within.is_some() && !done.stable => {
                    to(Descent::Down).map(|(reached, done)| (reached, Step { gave_way: true, ..done }))?
                }
                nearest => nearest.or_else(|_| to(Descent::Down))?,
            }
        };
        if let Some(ends) = attempt.output {
            newton.check_overlap(&reached, &done, ends)?;
        }
        Ok((reached, done))
    }

    fn path(self, totals: &Totals) -> StaticPath {
        let Course { stepper, state, steps, failure, .. } = self;
        let State { u, pressure, history, .. } = state;
        let &Totals { counts, work, solver, .. } = totals;
        StaticPath { steps, u, pressure, history, cut_back: stepper.cut_back, counts, work, solver, failure }
    }
}
