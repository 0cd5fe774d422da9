//! A run: prepare, assemble, factor and solve (timed separately and repeated), then errors, probes and
//! transfers.

mod accurate;
mod adaptive;
pub(crate) mod bounds;
mod contributions;
mod estimate;
mod export;
mod external_problem;
mod group;
mod levels;
mod memory;
mod pass;
mod real_time;
mod repeated;
mod richer;
pub(crate) mod stored_reference;
pub(crate) mod symmetry;
mod witness;

use std::time::Instant;

use cases::scene::Procedure;
use catalogue::warning;
use geometry::{Point3, Vector3};
use records::{Record, SurfaceField};

use crate::discretise::Discretisation;
use crate::error::Failure;
use crate::measure::{
    self, Field, OwnError, Recovered, Reference, Request, check_points, check_probes, displacement, energies,
    free_norm, measure, of_tables, over_time, picture, places, points, probe_errors, probe_history, probes,
    report_modes, report_steps, states, surface, transfers, warnings,
};
use crate::outcome::timing::{Meters, Timed, Timings};
use crate::outcome::{Counters, Estimates, Identity, Outcome, Plan, Size, StageName, Warning};
use crate::prepare::{Prepared, check_means};
use crate::procedure::{conclude, refined};
use crate::process;
use crate::scenario::setup::Setup;
use adaptive::{Adapted, adapted};
use bounds::add_bounds;
use contributions::add_trace;
use estimate::{estimate, estimate_modes};
use memory::Baseline;
use pass::{Pass, pass};
use real_time::real_time;
use repeated::repeated;

pub use crate::measure::Repeats;
pub use external_problem::{Found, Posed, PosedTool};
pub use group::{Group, RunOptions, case_name};
pub use memory::{Baseline as MemoryBaseline, keep_freed_memory};
pub use stored_reference::Stored;

/// Finished run with its nodal parameters.
pub(crate) struct FinishedRun {
    /// Identity, metrics and times.
    pub(crate) outcome: Outcome,
    prepared: Prepared,
    /// Nodal parameters, m.
    u: Vec<Vector3>,
}

/// Runs one method according to its plan.
///
/// The whole run executes on a thread of the Rayon pool. From an outside thread every parallel region would
/// have to be handed over and waited for, which takes 0.03 to 0.1 ms each time: as long as the forces of 6000
/// elements.
pub(crate) fn run(
    identity: Identity,
    plan: Plan,
    method: &Discretisation,
    setup: &Setup,
    request: &Request,
) -> Result<FinishedRun, Failure> {
    check_probes(method.mesh(), request.probes)?;
    check_means(method.mesh(), &setup.output.means)?;
    check_points(method.mesh(), setup)?;
    rayon::scope(|_| on_pool(identity, plan, method, setup, request))
}

fn on_pool(
    identity: Identity,
    plan: Plan,
    method: &Discretisation,
    setup: &Setup,
    request: &Request,
) -> Result<FinishedRun, Failure> {
    let baseline = Baseline::new();
    process::forget_most_memory();
    let mut meters = Meters::default();
    let (Pass { refined, prepared, solution }, adapted) = passes(method, setup, &plan, request, &mut meters)?;
    let memory = baseline.peak();
    let method = refined.as_ref().unwrap_or(method);
    let run = measure::Solved { method, setup, prepared: &prepared, solution: &solution };
    let mut outcome = Outcome::new(identity, size(method, &prepared, solution.dofs), plan);
    outcome.process_memory = process::most_memory().filter(|_| solution.program.is_none());
    outcome.memory = solution.program.as_ref().map_or(memory, |program| program.memory);
    outcome.identity.linear_solver = solution.solver().map(Into::into);
    outcome.first_use = meters.first_use;
    let Meters { timings, counters, .. } = &mut meters;
    timings.time_rest("measure", |timings| {
        if request.states {
            outcome.states = Some(states(&run, usize::MAX)?);
        }
        if solution.u.is_empty() {
            unloaded(&mut outcome, &run, timings)?;
        } else {
            loaded(&mut outcome, &run, request, timings, counters)?;
        }
        if let Some(states) = &mut outcome.states {
            states.error_source.clone_from(&outcome.error_source);
        }
        if let Some(adapted) = &adapted {
            adapted.report(&mut outcome);
        }
        readable(&outcome)
    })?;
    outcome.phases = phases(&meters, &run);
    outcome.counters = meters.counters;
    Ok(FinishedRun { outcome, prepared, u: solution.u })
}

/// Refuses a run whose records contain an invalid number. Only this run fails, not the study whose tables
/// would contain the number.
fn readable(outcome: &Outcome) -> Result<(), Failure> {
    let numbers = outcome.records().iter().try_for_each(Record::check);
    let all = numbers.and_then(|()| outcome.field.iter().try_for_each(SurfaceField::check));
    all.map_err(|bad| Failure::Run(bad.to_string()))
}

/// Fraction of a pass's CPU time spent in the operating-system kernel above which the pass is taken to have
/// touched its memory for the first time.
const FIRST_USE: f64 = 0.25;
/// Smallest kernel time that counts, s. Kernel times have a resolution of a hundredth of a second.
const LEAST_FIRST_USE: f64 = 0.03;

/// Runs the timed part as often as it is repeated. The counters are those of the last pass.
///
/// If the first pass touches its memory for the first time, it is discarded and run again. The host of a
/// virtual machine reclaims unused memory: there the first use took 1.5 to 2 s per GB and the second 0.05 to
/// 0.3 s, and the rows of a cloud of 97,336 nodes took 1.7 s instead of 0.47 s.
fn passes(
    method: &Discretisation,
    setup: &Setup,
    plan: &Plan,
    request: &Request,
    meters: &mut Meters,
) -> Result<(Pass, Option<Adapted>), Failure> {
    let before = process::system_seconds();
    let mut start = Instant::now();
    let mut pass = once(method, setup, plan, request, meters)?;
    let repeats = request.repeats.most > 1 && method.outside.is_none();
    if repeats && is_first_use(before, process::system_seconds(), &meters.timings.total().cpu) {
        drop(pass);
        meters.first_use = Some(std::mem::take(&mut meters.timings).wall());
        start = Instant::now();
        pass = once(method, setup, plan, request, meters)?;
    }
    for _ in 1..request.repeats.most {
        if start.elapsed().as_secs_f64() > request.repeats.seconds {
            break;
        }
        // Keeping both passes would take twice the memory.
        drop(pass);
        pass = once(method, setup, plan, request, meters)?;
    }
    Ok(pass)
}

/// Whether a pass was the first to use its memory, from the kernel's CPU seconds before and after the pass
/// and the CPU seconds that the pass took.
fn is_first_use(before: Option<f64>, after: Option<f64>, spent: &[f64]) -> bool {
    let system = after.zip(before).map_or(0.0, |(after, before)| after - before);
    system >= LEAST_FIRST_USE && system > FIRST_USE * spent.iter().sum::<f64>()
}

fn once(
    method: &Discretisation,
    setup: &Setup,
    plan: &Plan,
    request: &Request,
    meters: &mut Meters,
) -> Result<(Pass, Option<Adapted>), Failure> {
    meters.counters = Counters::default();
    if let Some(adapt) = &method.adapt {
        let (pass, adapted) = adapted(method, adapt, setup, plan, request, meters)?;
        return Ok((pass, Some(adapted)));
    }
    let Meters { timings, counters, .. } = meters;
    let refined = if plan.runs(StageName::Refinement) {
        timings.time("refine", || refined(method, setup, plan, counters))?
    } else {
        None
    };
    let solved = pass(refined.as_ref().unwrap_or(method), setup, plan, request, meters)?;
    Ok((Pass { refined, ..solved }, None))
}

/// Keeps the estimates of a run, or warns that there are none.
fn estimated(outcome: &mut Outcome, found: Result<Estimates, Failure>) {
    match found {
        Ok(estimates) => outcome.estimates = Some(estimates),
        Err(failure) => {
            let message = format!("the error can't be estimated: {failure}");
            outcome.warnings.push(Warning::new(&warning::NO_ESTIMATE, 0.0, "output.estimate", message));
        }
    }
}

/// Completes a run without a displacement: a run that ends before the solution, or a modal analysis. Adds the
/// modes and the properties of the tables.
fn unloaded(outcome: &mut Outcome, run: &measure::Solved, timings: &mut Timings) -> Result<(), Failure> {
    if let Some(vibration) = &run.solution.vibration {
        let found = report_modes(run, vibration)?;
        (outcome.metrics, outcome.modes, outcome.size.dofs) = (found.metrics, found.modes, found.dofs as u64);
        outcome.warnings = found.warnings;
        if outcome.plan.runs(StageName::Estimate) {
            let found = timings.time("estimate", || estimate_modes(run, vibration));
            estimated(outcome, found);
        }
    }
    of_tables(&mut outcome.metrics, run.prepared);
    Ok(())
}

/// Completes a run with a displacement: all comparisons, probes, warnings and pictures.
fn loaded(
    outcome: &mut Outcome,
    run: &measure::Solved,
    request: &Request,
    timings: &mut Timings,
    counters: &mut Counters,
) -> Result<(), Failure> {
    let measure::Solved { setup, solution, .. } = *run;
    let displaced = displacement(run, &outcome.plan, request, timings, counters)?;
    if let Some(forces) = solution.forces {
        outcome.identity.force_kernel = Some(forces.name());
        outcome.identity.lane_path = forces.path.map(|path| path.name().into());
    }
    conclude(&mut outcome.plan, solution, counters);
    let recovered = Recovered::new(run, &solution.u, &solution.pressure, solution.time());
    compare(outcome, run, &displaced, recovered.as_ref(), request)?;
    outcome.tools = setup.tools.iter().map(|t| t.name.clone()).collect();
    places(outcome, run)?;
    let over_time = over_time(run, &outcome.plan, request, &outcome.steps)?;
    outcome.metrics.extend(over_time);
    outcome.probes = probes(run, recovered.as_ref(), request.probes)?;
    points(outcome, run, request.probes)?;
    energies(outcome, run)?;
    outcome.free_norm = Some(free_norm(run));
    if let Some(exact) = &setup.exact {
        probe_errors(&mut outcome.metrics, &outcome.probes, exact.as_ref(), &solution.u);
    }
    // A load path that ended early is compared with the reference at its steps, not at its end, and has no
    // simulator's loop.
    let whole = solution.is_whole();
    let mut bridging = None;
    if outcome.plan.runs(StageName::Schemes) {
        (outcome.transfers, bridging) = transfers(run, &request.at_end(whole), counters)?;
    }
    outcome.warnings =
        warnings(run, recovered.as_ref(), &outcome.metrics, &outcome.probes, outcome.last.as_ref())?;
    outcome.warnings.extend(bridging);
    if outcome.plan.runs(StageName::Estimate) {
        let found = match &solution.forces {
            None => timings.time("estimate", || estimate(outcome, run, &displaced, request, counters)),
            Some(_) => Err(Failure::Run("the run ended by relaxation".into())),
        };
        estimated(outcome, found);
    }
    if let Some(goal) = &setup.output.error_of
        && outcome.plan.runs(StageName::Trace)
    {
        timings.time("trace", || add_trace(outcome, run, goal, request.probes, counters));
    }
    if outcome.plan.runs(StageName::Bounds) {
        timings.time("bounds", || add_bounds(outcome, run, counters))?;
    }
    if whole && run.method.outside.is_none() && (request.repeated.is_some() || request.real_time.is_some()) {
        timings.time("loop", || loops(outcome, run, request))?;
    }
    if request.picture {
        let mut field = picture(&outcome.identity, run, outcome.last.as_ref())?;
        field.body = Some(surface(run, &displaced, &request.at_end(whole), &outcome.error_source)?);
        outcome.field = Some(field);
    }
    Ok(())
}

/// Runs the loops that are requested.
fn loops(outcome: &mut Outcome, run: &measure::Solved, request: &Request) -> Result<(), Failure> {
    if let Some(ask) = request.repeated {
        outcome.latencies = repeated(ask, run, &outcome.plan, request.probes, &mut outcome.metrics)?;
    }
    match request.real_time {
        Some(ask) => real_time(outcome, run, ask, request),
        None => Ok(()),
    }
}

/// Adds the errors at the end and at every step, and the status of the run.
fn compare(
    outcome: &mut Outcome,
    run: &measure::Solved,
    field: &Field,
    recovered: Option<&Recovered>,
    request: &Request,
) -> Result<(), Failure> {
    let solution = run.solution;
    measure(&mut outcome.metrics, run, field, recovered, &request.at_end(solution.is_whole()))?;
    if let Some(history) = &solution.history {
        let steps = report_steps(&mut outcome.metrics, run, history, request)?;
        if let (None, Some(ramp)) = (&history.failure, run.setup.procedure.ramp()) {
            let exact = run.setup.exact.as_deref();
            outcome.metrics.extend(probe_history(&steps, exact, request.probes, ramp.damps()));
        }
        (outcome.steps, outcome.last) = (steps, Some(history.last.clone()));
        outcome.stalled = history.failure.clone();
    }
    outcome.relaxed = solution.relaxed.clone();
    outcome.status = match (&outcome.stalled, &outcome.relaxed) {
        (Some(failure), _) => failure.early_status(),
        (None, Some(_)) => "relaxed",
        (None, None) => "ok",
    };
    Ok(())
}

/// Times per phase with their total; for explicit dynamics also the time per element and step.
fn phases(meters: &Meters, run: &measure::Solved) -> Vec<Timed> {
    let mut phases = meters.timings.phases().to_vec();
    phases.push(meters.timings.total());
    let steps = meters.counters.time_steps;
    if let (Procedure::Explicit(_), true, Some(solve)) =
        (&run.setup.procedure, steps > 0, phases.iter().find(|timed| timed.phase == "solve"))
    {
        let each = 1.0 / (steps as f64 * run.method.mesh().cell_count() as f64);
        phases.push(solve.part("element-step", each));
    }
    phases
}

fn size(method: &Discretisation, prepared: &Prepared, dofs: usize) -> Size {
    Size {
        nodes: method.nodes().len() as u64,
        elements: method.mesh().cell_count() as u64,
        points: prepared.volume.rows.weights().len() as u64,
        dofs: dofs as u64,
        spacing: prepared.spacing,
    }
}

/// Converts a finished run to a reference, which keeps the tables and can evaluate the displacement anywhere
/// later.
pub(crate) fn reference(finished: FinishedRun, targets: &[Point3]) -> Result<Reference, Failure> {
    let FinishedRun { outcome, prepared, u } = finished;
    let at = move |points: &[Point3]| -> Result<Vec<Vector3>, Failure> {
        Ok(prepared.source.at_points(points)?.0.rows().apply(&u))
    };
    let points = if targets.is_empty() { Vec::new() } else { at(targets)? };
    let nodes = outcome.size.nodes as usize;
    let Outcome { identity, steps, stalled, warnings, .. } = outcome;
    let method = identity.method;
    let finished = stalled.is_none();
    let own = OwnError::default();
    Ok(Reference { method, nodes, targets: points, steps, finished, warnings, own, at: Some(Box::new(at)) })
}

#[cfg(test)]
mod tests {
    use super::is_first_use;

    #[test]
    fn a_first_use_of_memory_takes_a_quarter_of_the_time_and_is_long_enough_to_be_known() {
        let first = |system: f64, spent: f64| is_first_use(Some(7.0), Some(7.0 + system), &[spent]);
        assert!(first(1.2, 1.7) && first(0.04, 0.1));
        assert!(!first(0.1, 0.47) && !first(0.02, 0.02));
        assert!(!is_first_use(None, Some(1.0), &[1.0]) && !is_first_use(Some(1.0), None, &[1.0]));
    }
}
