//! Dynamic relaxation beyond a limit point, from the last equilibrium to the remaining load steps.

use cases::scene::Dilation;
use catalogue::metric;
use contact::{ContactHistory, Drive};
use explicit::{
    ExplicitError, InternalForce, KernelInfo, LanczosParams, Lumping, Pressing, PressingTool, RelaxationInfo,
    RelaxationParams, Rested, lumped_mass, relax_under,
};
use geometry::{Point3, Vector3};
use lanes::LanePath;
use shape::FixedDof;
use statics::nodal_forces;

use super::explicit::{body, smallest_j};
use super::loading::{Led, led};
use crate::discretise::{Discretisation, Essential};
use crate::error::Failure;
use crate::outcome::{Counters, LoadStep, Metric, ToolStep};
use crate::prepare::{ConditionForces, Prepared};
use crate::scenario::setup::Setup;

/// Parameters of the relaxation. Displacements are accurate to 1e-6 of the largest, 10 nm for 10 mm. The
/// limit of steps is per load step; the kidney takes some thousand.
const RELAXATION: RelaxationParams = RelaxationParams {
    tolerance: 1e-6,
    steps: 100_000,
    critical: LanczosParams { steps: 15, safety: 0.95 },
    recheck: 500,
};

/// Density of all regions, kg/m^3. At rest the mass does not affect the forces, and a uniform density makes
/// the steps of all nodes similar.
const DENSITY: f64 = 1000.0;

/// Initial state of the relaxation.
pub struct Start {
    /// Fraction of the load reached, 0 to 1.
    pub load: f64,
    /// Nodal displacements, m.
    pub u: Vec<Vector3>,
    /// Travel of the tools from their start, m.
    pub closures: Vec<f64>,
    /// Contact history of each tool.
    pub history: Vec<ContactHistory>,
}

/// Result of the relaxation.
pub struct Relaxed {
    /// Load steps that came to rest.
    pub steps: Vec<LoadStep>,
    /// Nodal displacements at each load step, m.
    pub fields: Vec<Vec<Vector3>>,
    /// Number of relaxation steps over all load steps.
    pub made: u64,
    /// Kernel that evaluated the internal forces.
    pub forces: KernelInfo,
    /// Failure that ended the relaxation early, if any.
    pub failure: Option<ExplicitError>,
}

/// Whether a method can continue by relaxation after its static path stalls, with the reason.
pub(super) fn possible(method: &Discretisation, setup: &Setup) -> (bool, &'static str) {
    match method.dilation {
        _ if setup.pod.is_some() => {
            (false, "not available with a reduced model; the load path ends if the solver stalls")
        }
        _ if !setup.curved().is_empty() => {
            (false, "not available with curves over time; the load path ends if the solver stalls")
        }
        _ if !setup.staged().is_empty() => (
            false,
            "not available with supports that begin late or end early; the load path ends if the solver stalls",
        ),
        _ if !setup.foundations.is_empty() => {
            (false, "not available with springs on a surface; the load path ends if the solver stalls")
        }
        _ if !method.interpolates && !matches!(method.essential, Essential::Coupling(_)) => (
            false,
            "not available for clouds without coupled elements: a support by penalty with lumped parameters has no \
             usable time step; the load path ends if the solver stalls",
        ),
        Dilation::Mixed => (
            false,
            "not available with a pressure field, whose equations are not explicit; the load path ends if the solver stalls",
        ),
        _ => (true, "if Newton's method finds no equilibrium"),
    }
}

/// Relaxes to the end of each load step beyond `from` in turn.
pub(super) fn continue_from(
    (nodes, setup): (&[Point3], &Setup),
    count: usize,
    prepared: &Prepared,
    from: Start,
    counters: &mut Counters,
) -> Result<Relaxed, Failure> {
    let volume = &prepared.volume;
    let rows = &volume.rows;
    let density = vec![DENSITY; setup.laws.len()];
    let mass = lumped_mass(rows, &density, &volume.region, Lumping::for_table(rows))?;
    let mut force = InternalForce::new(body(setup, prepared), LanePath::best())?;
    let loads = nodal_forces(rows, &prepared.loads())?;
    let constrained = led(prepared);
    let surface = prepared.contact();
    let mut pressing = surface.as_ref().map(|surface| {
        let each = setup.tools.iter().zip(&from.closures).zip(from.history);
        let tools = each.map(|((set, &closure), history)| PressingTool {
            tool: &set.tool,
            drive: part_of(set.drive, from.load),
            closure,
            history,
        });
        Pressing::new(surface, tools.collect())
    });
    let mut done =
        Relaxed { steps: Vec::new(), fields: Vec::new(), made: 0, forces: force.info(), failure: None };
    let mut u = from.u;
    for number in 1..=count {
        let load = number as f64 / count as f64;
        if load <= from.load * (1.0 + 1e-12) {
            continue;
        }
        let at = |(&(node, axis), led): (&(u32, u8), &Led)| FixedDof { node, axis, value: led.value * load };
        let fixed: Vec<FixedDof> = constrained.iter().map(at).collect();
        let mut external = |u: &[Vector3], f: &mut [Vector3]| {
            f.iter_mut().zip(&loads).for_each(|(f, full)| *f += full * load);
            prepared.following().iter().for_each(|pressure| pressure.add_force(u, load, f));
        };
        force.contract(&setup.active.iter().map(|full| full * load).collect::<Vec<_>>());
        if let Some(pressing) = &mut pressing {
            pressing.drive(setup.tools.iter().map(|set| part_of(set.drive, load)));
        }
        let found =
            relax_under(&mut force, &mass, &fixed, &mut external, pressing.as_mut(), u.clone(), RELAXATION);
        let Rested { reaction, info, .. } = match found {
            Ok(rested) => {
                u.clone_from(&rested.u);
                rested
            }
            Err(failure) => {
                if let ExplicitError::NotRelaxed { steps, .. } = failure {
                    done.made += steps as u64;
                }
                done.failure = Some(failure);
                break;
            }
        };
        done.made += info.steps as u64;
        done.steps.push(step_at_rest(
            (nodes, setup),
            prepared,
            (load, &u, &reaction),
            &mut force,
            (pressing.as_ref(), &info),
        )?);
        done.fields.push(u.clone());
    }
    counters.relaxation_steps += done.made;
    if let Some(pressing) = &pressing {
        counters.contact_evaluations += pressing.counts().evaluations;
        counters.contact_skips += pressing.counts().skipped;
    }
    Ok(done)
}

/// The record of a load step that came to rest with the displacements `u`, m, and the reactions, N.
fn step_at_rest(
    (nodes, setup): (&[Point3], &Setup),
    prepared: &Prepared,
    (load, u, reaction): (f64, &[Vector3], &[Vector3]),
    force: &mut InternalForce,
    (pressing, info): (Option<&Pressing>, &RelaxationInfo),
) -> Result<LoadStep, Failure> {
    let states = pressing.map_or(&[][..], Pressing::states);
    let tools = states.iter().zip(&setup.tools).map(|(state, set)| ToolStep::of(state, &set.tool));
    Ok(LoadStep {
        load,
        tools: tools.collect(),
        supports: prepared.support_forces(&ConditionForces {
            at: &|i| nodes[i] + u[i],
            nodes: reaction,
            rows: &[],
            weak: &[],
            time: None,
        }),
        means: Vec::new(),
        strain_energy: Some(force.energy(u).map_err(ExplicitError::from)?),
        smallest_j: smallest_j(prepared, u),
        iterations: 0,
        probes: Vec::new(),
        points: Vec::new(),
        against: Vec::new(),
        more: metrics(info),
    })
}

fn part_of(drive: Drive, load: f64) -> Drive {
    match drive {
        Drive::Closure(full) => Drive::Closure(full * load),
        Drive::Force(full) => Drive::Force(full * load),
    }
}

fn metrics(info: &RelaxationInfo) -> Vec<Metric> {
    vec![
        Metric::new(&metric::RELAXATION_STEPS, info.steps as f64),
        Metric::new(&metric::RELAXATION_ERROR, info.error),
        Metric::new(&metric::RELAXATION_RESIDUAL, info.residual),
    ]
}
