//! The static procedure: load steps by Newton's method, with contact, and what each of them left.

use std::collections::BTreeSet;

use geometry::Vector3;
use mechanics::{
    ContactSurface, Dilation, DrivenTool, Solid, StaticError, StaticParams, StaticProblem, Step, solve_static,
};

use crate::Failure;
use crate::discretise::Discretisation;
use crate::outcome::{LoadStep, ToolStep};
use crate::prepare::Prepared;
use crate::setup::Setup;
use crate::work::Work;

/// A static path, whole or ended early.
pub struct Path {
    /// Nodal parameters after the last converged step, m.
    pub u: Vec<Vector3>,
    /// Unknowns, pressures included.
    pub dofs: usize,
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
    /// Why it ended early, if it did.
    pub failure: Option<StaticError>,
}

/// Solves. A path that carried nothing is an error, one that ended early is not.
pub fn solve(
    method: &Discretisation,
    setup: &Setup,
    params: &StaticParams,
    prepared: &Prepared,
    work: &mut Work,
) -> Result<Path, Failure> {
    let loads = prepared.loads();
    let held = prepared.held();
    let contact = prepared.contact.as_ref().map(ContactSurface::new);
    let tools: Vec<DrivenTool> =
        setup.tools.iter().map(|t| DrivenTool { tool: &t.tool, drive: t.drive }).collect();
    let volume = &prepared.volume;
    let dilation = match (&volume.groups, &volume.pressure) {
        (_, Some(rows)) => Dilation::Mixed(rows),
        (Some(groups), None) => Dilation::Groups(groups),
        (None, None) => Dilation::Standard,
    };
    let problem = StaticProblem {
        nodes: method.nodes(),
        solid: Solid { volume: &volume.rows, laws: &setup.laws, region: &volume.region, dilation },
        loads: &loads,
        fixed: prepared.fixed(),
        held: &held,
        contact: contact.as_ref(),
        tools: &tools,
    };
    let (mut steps, mut fields) = (Vec::new(), Vec::new());
    let path = solve_static(&problem, params, |step, u, _| {
        if step.wanted {
            steps.push(told(step, setup));
            fields.push(u.to_vec());
        }
    })?;
    let iterations = path.steps.iter().map(solves).sum();
    work.newton_iterations += iterations;
    work.assemblies += path.work.assemblies;
    work.factorisations += path.work.factorisations;
    work.solves += path.work.solves;
    work.contact_evaluations += path.counts.evaluations;
    work.contact_skips += path.counts.skipped;
    let Some(last) = path.steps.last() else {
        // Nothing was carried: what stopped it is about the problem, not about how far it went.
        return Err(match path.failure {
            Some(StaticError::Stalled { cause, .. }) if matches!(*cause, StaticError::Solve(_)) => {
                (*cause).into()
            }
            Some(failure) => failure.into(),
            None => Failure::Run("the static solution has no step".into()),
        });
    };
    let held: BTreeSet<(u32, u8)> = prepared.fixed().iter().map(|f| (f.node, f.axis)).collect();
    Ok(Path {
        dofs: 3 * method.nodes().len() - held.len() + path.pressure.len(),
        last: told(last, setup),
        residual: last.iterations.last().map_or(0.0, |i| i.residual),
        iterations,
        cut_backs: path.cut_back as u64,
        u: path.u,
        steps,
        fields,
        failure: path.failure,
    })
}

/// Linear systems solved in a step: an iteration of no length only found that it had converged.
fn solves(step: &Step) -> u64 {
    step.iterations.iter().filter(|i| i.length > 0.0).count() as u64
}

fn told(step: &Step, setup: &Setup) -> LoadStep {
    let tools = step.tools.iter().zip(&setup.tools).map(|(state, set)| ToolStep {
        closure: state.closure,
        force: state.force,
        pushed: -state.force.dot(&set.tool.along()),
        active: state.active as u64,
        penetration: state.penetration,
    });
    LoadStep {
        load: step.time,
        tools: tools.collect(),
        strain_energy: step.energy,
        smallest_j: step.smallest,
        iterations: solves(step),
        probes: Vec::new(),
        against: Vec::new(),
        more: Vec::new(),
    }
}
