//! The static procedure: load steps by Newton's method, with contact, and what each of them left.

use std::collections::BTreeSet;
use std::time::Instant;

use contact::{ContactSurface, DrivenTool};
use geometry::Vector3;
use statics::{Dilation, Solid, StaticError, StaticParams, StaticProblem, Step, solve_static};

use crate::Failure;
use crate::discretise::Discretisation;
use crate::outcome::{LoadStep, ToolStep};
use crate::prepare::Prepared;
use crate::relaxation::{self, Relaxed, Start};
use crate::setup::Setup;
use crate::work::Work;

/// A static path, whole or ended early.
pub struct Path {
    /// Nodal parameters after the last converged step, m.
    pub u: Vec<Vector3>,
    /// Unknowns, pressures included.
    pub dofs: usize,
    /// Parameters of the method's own pressure field there, Pa, tension positive; empty without one.
    pub pressure: Vec<f64>,
    /// What was told: the ends of the scene's load steps as far as they were reached.
    pub steps: Vec<LoadStep>,
    /// Nodal parameters at each of them, m.
    pub fields: Vec<Vec<Vector3>>,
    /// The last converged step, told or not.
    pub last: LoadStep,
    /// Relative residual of the last converged step.
    pub residual: f64,
    /// Linear systems solved on the way to converged steps.
    pub iterations: u64,
    /// Steps that failed and were cut back.
    pub cut_backs: u64,
    /// The last step in a stable equilibrium: before the first that ends in none or on which none was near, or the last one where
    /// Newton's method found none at all further on.
    pub limit: Option<LoadStep>,
    /// Seconds to get there.
    pub to_limit: f64,
    /// Why Newton's method ended early, if it did.
    pub failure: Option<StaticError>,
    /// How dynamic relaxation went on from there, if it was asked for and can.
    pub relaxed: Option<Relaxed>,
}

impl Path {
    /// Whether the whole load was carried, by relaxation where Newton's method ended early.
    pub fn whole(&self) -> bool {
        match (&self.failure, &self.relaxed) {
            (None, _) => true,
            (Some(_), Some(relaxed)) => relaxed.failure.is_none(),
            (Some(_), None) => false,
        }
    }
}

/// Solves. A path that carried nothing is an error, one that ended early is not.
pub fn solve(
    method: &Discretisation,
    setup: &Setup,
    params: &StaticParams,
    prepared: &Prepared,
    work: &mut Work,
) -> Result<Path, Failure> {
    let contact = prepared.contact.as_ref().map(ContactSurface::new);
    let (mut steps, mut fields) = (Vec::new(), Vec::new());
    let start = Instant::now();
    let (mut limit, mut to_limit, mut before) = (None, 0.0, LoadStep::at_start(setup.tools.len()));
    let path = with_problem(method, setup, prepared, contact.as_ref(), |problem| {
        solve_static(problem, params, |step, u, _| {
            if let Some(watch) = setup.watch {
                watch(&told(step, setup));
            }
            if (step.gave_way || !step.stable) && limit.is_none() {
                limit = Some(before.clone());
            }
            if limit.is_none() {
                (to_limit, before) = (start.elapsed().as_secs_f64(), told(step, setup));
            }
            if step.wanted {
                steps.push(told(step, setup));
                fields.push(u.to_vec());
            }
        })
    })?;
    let iterations = path.steps.iter().map(solves).sum();
    work.newton_iterations += iterations;
    work.assemblies += path.work.assemblies;
    work.factorisations += path.work.factorisations;
    work.solves += path.work.solves;
    work.contact_evaluations += path.counts.evaluations;
    work.contact_skips += path.counts.skipped;
    let relaxes = relaxation::possible(method, setup).0;
    let last = match (path.steps.last(), &path.failure) {
        (Some(last), _) => told(last, setup),
        // A matrix that has no solution is about the problem, and has none at rest either.
        (None, Some(StaticError::Stalled { cause, .. }))
            if relaxes && !matches!(**cause, StaticError::Solve(_)) =>
        {
            LoadStep::at_start(setup.tools.len())
        }
        // Nothing was carried: what stopped it is about the problem, not about how far it went.
        (None, Some(StaticError::Stalled { cause, .. })) if matches!(**cause, StaticError::Solve(_)) => {
            return Err((**cause).clone().into());
        }
        (None, Some(failure)) => return Err(failure.clone().into()),
        (None, None) => return Err(Failure::Run("the static solution has no step".into())),
    };
    let residual = path.steps.last().and_then(|s| s.iterations.last()).map_or(0.0, |i| i.residual);
    let (mut end, mut u, mut relaxed) = (last.clone(), path.u, None);
    if path.failure.is_some() && relaxes {
        let closures = last.tools.iter().map(|tool| tool.closure).collect();
        let start = Start { load: last.load, u: u.clone(), closures, history: path.history };
        let done = relaxation::go_on(setup, params.steps, prepared, start, work)?;
        steps.extend(done.steps.iter().cloned());
        fields.extend(done.fields.iter().cloned());
        if let (Some(step), Some(field)) = (done.steps.last(), done.fields.last()) {
            (end, u) = (step.clone(), field.clone());
        }
        relaxed = Some(done);
    }
    if path.failure.is_some() && limit.is_none() {
        limit = Some(last);
    }
    let held: BTreeSet<(u32, u8)> = prepared.fixed().iter().map(|f| (f.node, f.axis)).collect();
    Ok(Path {
        dofs: 3 * method.nodes().len() - held.len() + path.pressure.len(),
        last: end,
        residual,
        iterations,
        cut_backs: path.cut_back as u64,
        u,
        pressure: path.pressure,
        steps,
        fields,
        limit,
        to_limit,
        failure: path.failure,
        relaxed,
    })
}

/// Hands the full problem, of tables and loads that it borrows, to what solves it.
pub(crate) fn with_problem<T>(
    method: &Discretisation,
    setup: &Setup,
    prepared: &Prepared,
    contact: Option<&ContactSurface>,
    solve: impl FnOnce(&StaticProblem) -> T,
) -> T {
    let volume = &prepared.volume;
    let dilation = match (&volume.groups, &volume.pressure) {
        (_, Some(rows)) => Dilation::Mixed(rows),
        (Some(groups), None) => Dilation::Groups(groups),
        (None, None) => Dilation::Standard,
    };
    let tools: Vec<DrivenTool> =
        setup.tools.iter().map(|t| DrivenTool { tool: &t.tool, drive: t.drive }).collect();
    solve(&StaticProblem {
        nodes: method.nodes(),
        solid: Solid { volume: &volume.rows, laws: &setup.laws, region: &volume.region, dilation },
        loads: &prepared.loads(),
        fixed: prepared.fixed(),
        held: &prepared.held(),
        contact,
        tools: &tools,
    })
}

/// Linear systems solved in a step: an iteration of no length only found that it had converged.
pub(crate) fn solves(step: &Step) -> u64 {
    step.iterations.iter().filter(|i| i.length > 0.0).count() as u64
}

fn told(step: &Step, setup: &Setup) -> LoadStep {
    let tools = step.tools.iter().zip(&setup.tools).map(|(state, set)| ToolStep::of(state, &set.tool));
    LoadStep {
        load: step.time,
        tools: tools.collect(),
        strain_energy: Some(step.energy),
        smallest_j: step.smallest,
        iterations: solves(step),
        probes: Vec::new(),
        against: Vec::new(),
        more: Vec::new(),
    }
}
