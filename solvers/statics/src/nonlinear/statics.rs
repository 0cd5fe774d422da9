//! Quasi-static loading: load steps with cut-back and regrowth, each solved by Newton's method.

use contact::{ContactCounts, ContactHistory, ContactSurface, DrivenTool, ToolState};
use shape::SurfaceRows;
use shape::{FixedDof, Point3, Vector3};

use super::error::StaticError;
use super::newton::{Descent, Iteration, Newton, NewtonParams, State, near, shortest_travel};
use super::solid::Solid;
use crate::Load;

/// A surface constrained by a penalty: for bases whose parameters are not displacements.
#[derive(Clone, Debug)]
pub struct PenaltySurface<'a> {
    /// Values and weights.
    pub surface: &'a SurfaceRows,
    /// Which of x, y, z are constrained.
    pub axes: [bool; 3],
    /// Prescribed displacement at each point at the end of the loading, m.
    pub values: Vec<Vector3>,
    /// Penalty, Pa/m.
    pub beta: f64,
}

/// A body with loads, supports and tools. Loads are dead loads (per reference area or volume); loads, prescribed
/// displacements and drives grow in proportion to the time 0 to 1.
#[derive(Clone, Debug)]
pub struct StaticProblem<'a> {
    /// Reference positions, m.
    pub nodes: &'a [Point3],
    /// The body.
    pub solid: Solid<'a>,
    /// Loads; they add up.
    pub loads: &'a [Load<'a>],
    /// Nodal parameters prescribed.
    pub fixed: &'a [FixedDof],
    /// Surfaces constrained by penalty.
    pub penalties: &'a [PenaltySurface<'a>],
    /// Where tools may touch.
    pub contact: Option<&'a ContactSurface<'a>>,
    /// The tools.
    pub tools: &'a [DrivenTool<'a>],
}

/// How a static solution is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticParams {
    /// Number of equal steps at whose ends results are wanted. Steps are never longer; a step that fails is halved.
    pub steps: usize,
    /// Part of a step below which cutting back is given up; where a tool travels too far in it, an eighth of the deepest that
    /// the tool may penetrate, if that is less.
    pub smallest: f64,
    /// Newton's method.
    pub newton: NewtonParams,
    /// Uzawa iterations of the augmented Lagrangian per step; 0 for a plain penalty.
    pub augmentations: usize,
    /// Part of the load to within which the first limit or bifurcation point is sought, if it is: steps on which a tangent
    /// is not definite are halved down to it, or to twice the smallest step. Without it such a point is seen only where a step ends beyond it.
    pub limit_within: Option<f64>,
}

/// A converged step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Part of the loading, 0 to 1.
    pub time: f64,
    /// True where results were asked for (a multiple of `1 / steps`).
    pub wanted: bool,
    /// The iterations that led there.
    pub iterations: Vec<Iteration>,
    /// Whether it gave way on the way: no equilibrium was near, and where the tangent was not definite energy was still
    /// set free beyond the Newton step; or, where a limit point is sought, the nearest one was not stable.
    pub gave_way: bool,
    /// Whether it ends in a stable equilibrium: the last tangent was positive definite, with friction its symmetric part.
    /// One that is not is a point beyond a limit or a bifurcation, which a body left to itself does not keep to.
    pub stable: bool,
    /// One per tool.
    pub tools: Vec<ToolState>,
    /// Strain energy, J.
    pub energy: f64,
    /// Smallest J of all quadrature points.
    pub smallest: f64,
}

/// Work of a static solution: everything that was done, with steps that failed and trials that were thrown away.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StaticWork {
    /// Tangents assembled: one per iteration.
    pub assemblies: u64,
    /// Numeric factorisations, more than assemblies where a tangent is not definite.
    pub factorisations: u64,
    /// Linear systems solved: one per iteration, and with a pressure field one per trial whose residual did not fall.
    pub solves: u64,
    /// Iterations of the linear solver: with a factor kept from another tangent, or with sliding friction.
    pub inner: u64,
    /// Evaluations of the forces, one per trial state.
    pub forces: u64,
}

/// What a static solution gave: everything up to its end, and why it ended if that was early.
#[derive(Clone, Debug)]
pub struct StaticPath {
    /// Converged steps in order.
    pub steps: Vec<Step>,
    /// Nodal parameters after the last converged step, m.
    pub u: Vec<Vector3>,
    /// Pressure parameters (mixed method), Pa.
    pub pressure: Vec<f64>,
    /// What the contact of each tool remembers after the last converged step.
    pub history: Vec<ContactHistory>,
    /// Steps that failed and were cut back.
    pub cut_back: usize,
    /// What the contact search did and skipped.
    pub counts: ContactCounts,
    /// Work in all.
    pub work: StaticWork,
    /// Why it ended early, if it did.
    pub failure: Option<StaticError>,
}

impl StaticPath {
    /// The part of the load that was carried.
    pub fn time(&self) -> f64 {
        self.steps.last().map_or(0.0, |s| s.time)
    }
}

/// A body at rest at the end of a step: nodal parameters (m), parameters of a pressure field (Pa), and the force of the nodal supports
/// on every node (N), zero in free degrees of freedom.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Rest<'a> {
    pub u: &'a [Vector3],
    pub pressure: &'a [f64],
    pub reaction: &'a [Vector3],
}

/// Solves; `observe` is called after every converged step with the step and the body at its end.
/// An error here is one of the problem itself; a solution that ends early is a [`StaticPath`] with its failure.
/// Rigid motions that neither supports nor, at the end, tools prevent are such an error: where they went is chance.
pub fn solve_static(
    problem: &StaticProblem,
    params: &StaticParams,
    mut observe: impl FnMut(&Step, Rest),
) -> Result<StaticPath, StaticError> {
    let count = params.steps.max(1);
    let longest = 1.0 / count as f64;
    let mut newton = Newton::new(problem, &params.newton)?;
    let mut state = State::start(problem);
    if problem.tools.is_empty() {
        newton.check_rigid(&state)?;
    }
    let mut before: Option<State> = None;
    let mut path = StaticPath {
        steps: Vec::new(),
        u: Vec::new(),
        pressure: Vec::new(),
        history: Vec::new(),
        cut_back: 0,
        counts: ContactCounts::default(),
        work: StaticWork::default(),
        failure: None,
    };
    let (mut next, mut step) = (1, longest);
    // No finer than a step that can be halved once more: one that can't has to take any way there is.
    let finest = 2.0 * params.smallest * longest;
    let shortest = shortest_travel(problem);
    let (mut within, mut near_limit) = (params.limit_within.map(|within| within.max(finest)), false);
    while next <= count {
        let target = next as f64 * longest;
        let left = target - state.time;
        // A rest shorter than a tenth of the step would be one for its own sake.
        let reaches = step > 0.9 * left;
        let time = if reaches { target } else { state.time + step };
        // The way so far is the best guess of the way to come; without a converged step, or where the guess inverts
        // a point, the last state is.
        let mut to = |descent| newton.find(&state, before.as_ref(), time, params.augmentations, descent);
        let reached = if within.is_some_and(|within| time - state.time > within) {
            to(Descent::Smooth)
        } else {
            match near(!state.pressure.is_empty(), &mut to) {
                // The limit point that is sought: on to where the body comes to rest.
                Ok((_, done)) if within.is_some() && !done.stable => {
                    to(Descent::Down).map(|(reached, done)| (reached, Step { gave_way: true, ..done }))
                }
                nearest => nearest.or_else(|_| to(Descent::Down)),
            }
        };
        let reached = reached.and_then(|(reached, done)| match reaches {
            true => newton.check_overlap(&reached, &done, next == count).map(|()| (reached, done)),
            false => Ok((reached, done)),
        });
        match reached {
            Ok((reached, mut done)) => {
                done.wanted = reaches;
                if done.gave_way {
                    within = None;
                }
                let quick = done.iterations.len() <= 6;
                let State { u, pressure, .. } = &reached;
                observe(&done, Rest { u, pressure, reaction: newton.reaction() });
                path.steps.push(done);
                before = Some(std::mem::replace(&mut state, reached));
                if reaches {
                    next += 1;
                }
                let grows = quick && !std::mem::take(&mut near_limit);
                step = if grows { (2.0 * step).min(longest) } else { step };
            }
            Err(cause) => {
                path.cut_back += 1;
                near_limit = within.is_some();
                let failed = time - state.time;
                step = 0.5 * failed;
                if step < cause.finest(params.smallest * longest, shortest) {
                    path.failure =
                        Some(StaticError::Stalled { time: state.time, step: failed, cause: Box::new(cause) });
                    break;
                }
            }
        }
    }
    path.counts = newton.counts();
    path.work = newton.work();
    if path.failure.is_none() && !problem.tools.is_empty() {
        newton.check_rigid(&state)?;
    }
    path.u = state.u;
    path.pressure = state.pressure;
    path.history = state.history;
    Ok(path)
}
