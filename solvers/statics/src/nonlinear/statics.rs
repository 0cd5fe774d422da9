//! Quasi-static loading: load steps with cut-back and regrowth, each solved by Newton's method.

use algebra::SolverPath;
use contact::{ContactCounts, ContactHistory};
use shape::Vector3;

use super::error::StaticError;
use super::newton::{Descent, Newton, NewtonParams, State, near, shortest_travel};
use super::problem::StaticProblem;
use super::step::{StaticWork, Step};
use super::stepper::Stepper;

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

/// Equilibrium at the end of a step: nodal parameters (m), parameters of a pressure field (Pa), and the
/// reaction force of the nodal supports on every node (N), zero in free degrees of freedom.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Rest<'a> {
    pub u: &'a [Vector3],
    pub pressure: &'a [f64],
    pub reaction: &'a [Vector3],
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
    let mut newton = Newton::new(problem, &params.newton)?;
    let mut state = State::start(problem);
    if problem.tools.is_empty() {
        newton.check_rigid(&state)?;
    }
    let mut before: Option<State> = None;
    let (mut steps, mut failure) = (Vec::new(), None);
    let mut stepper = Stepper::new(1.0, params.steps, params.smallest, problem.curves.points());
    let shortest = shortest_travel(problem);
    // At least a step that can still be halved once: a step that cannot be halved has to accept any
    // equilibrium.
    let finest = 2.0 * stepper.smallest;
    let mut within = params.limit_within.map(|within| within.max(finest));
    let mut near_limit = false;
    let is_curved = !problem.curves.points().is_empty();
    while let Some(attempt) = stepper.attempt() {
        // The displacement so far gives the best guess. Without a converged step, or if the guess inverts a
        // point, the last state is the guess.
        let guess = before.as_ref();
        let rounds = params.augmentations;
        let mut to = |descent| newton.find(&state, guess, attempt.time, rounds, descent);
        let reached = if within.is_some_and(|within| attempt.length > within) {
            to(Descent::Smooth)
        } else {
            match near(!state.pressure.is_empty(), &mut to) {
                // The sought limit point: the solution continues to the next stable equilibrium.
                Ok((_, done)) if within.is_some() && !done.stable => {
                    to(Descent::Down).map(|(reached, done)| (reached, Step { gave_way: true, ..done }))
                }
                nearest => nearest.or_else(|_| to(Descent::Down)),
            }
        };
        let reached = reached.and_then(|(reached, done)| match attempt.output {
            Some(ends) => newton.check_overlap(&reached, &done, ends).map(|()| (reached, done)),
            None => Ok((reached, done)),
        });
        match reached {
            Ok((reached, mut done)) => {
                done.wanted = attempt.output.is_some();
                if done.gave_way {
                    within = None;
                }
                let grows = done.is_quick() && !std::mem::take(&mut near_limit);
                let State { u, pressure, .. } = &reached;
                observe(&done, Rest { u, pressure, reaction: newton.reaction() });
                steps.push(done);
                before = Some(std::mem::replace(&mut state, reached));
                // The forces so far are the only scale once all curves have returned to zero.
                if is_curved {
                    newton.keep_scale();
                }
                stepper.accept(attempt, if grows { 2.0 } else { 1.0 });
            }
            Err(cause) => {
                near_limit = within.is_some();
                if !stepper.cut(attempt, 0.5, cause.finest(stepper.smallest, shortest)) {
                    let (time, step) = (stepper.time, attempt.length);
                    failure = Some(StaticError::Stalled { time, step, cause: Box::new(cause) });
                    break;
                }
            }
        }
    }
    let counts = newton.counts();
    let work = newton.work();
    let solver = newton.solver();
    let cut_back = stepper.cut_back;
    if failure.is_none() && !problem.tools.is_empty() {
        newton.check_rigid(&state)?;
    }
    let State { u, pressure, history, .. } = state;
    Ok(StaticPath { steps, u, pressure, history, cut_back, counts, work, solver, failure })
}
