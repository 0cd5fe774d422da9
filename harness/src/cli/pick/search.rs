//! The search: runs every approach from coarse to fine, the cheapest next size first, until it is accurate or
//! more expensive than another accurate run.

use cases::scene::{Method, Scene};
use records::{Machine, Reference, RunSet};
use reports::{Seconds, Took};
use serde::Serialize;

use super::ladder::Ladder;
use super::quantity::Quantity;
use crate::error::Failure;
use crate::outcome::Outcome;
use crate::outcome::timing::Timed;
use crate::run::{Group, RunOptions};
use crate::study::{compared_with, failed, stalled};

/// Requirements on the result.
pub(super) struct Demand {
    pub quantity: Quantity,
    pub error: f64,
    /// Additional quantities with their error bounds.
    pub also: Vec<(Quantity, f64)>,
    /// Longest estimated time of a run, s.
    pub at_most: f64,
}

impl Demand {
    /// Returns the quantity for which the reference's own error exceeds the bound, with the bound and that
    /// error.
    pub fn beyond(&self, reference: &Reference) -> Option<(&Quantity, f64, f64)> {
        let all =
            std::iter::once((&self.quantity, self.error)).chain(self.also.iter().map(|(q, most)| (q, *most)));
        let known = all.filter_map(|(quantity, most)| Some((quantity, most, quantity.band(reference)?)));
        known.into_iter().find(|(_, most, own)| own > most)
    }
}

/// Result of one run.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Tried {
    pub method: String,
    pub nodes: u64,
    pub dofs: u64,
    /// Error of the quantity; absent if the run ended early or has none.
    pub error: Option<f64>,
    /// Errors of the other quantities, by name.
    pub errors: Vec<(String, f64)>,
    /// Time used in comparisons, s.
    pub seconds: f64,
    /// Wall-clock time, CPU time of all processors, and shortest wall-clock time of the repeats, s.
    #[serde(skip)]
    pub timed: Timed,
    pub status: &'static str,
    /// Whether all requirements are met.
    pub within: bool,
    /// Whether the run is on the Pareto front of time and error.
    pub front: bool,
}

/// Result of the search.
#[derive(Default)]
pub(super) struct Found {
    pub tried: Vec<Tried>,
    pub set: RunSet,
    /// Methods whose next size was estimated to take too long, with the estimate, s.
    pub too_long: Vec<(String, f64)>,
    /// Clock used to compare runs.
    pub by: Seconds,
    /// Exit code of failed runs.
    pub code: u8,
}

impl Found {
    /// Returns the fastest run that meets all requirements.
    pub fn cheapest(&self) -> Option<&Tried> {
        self.tried.iter().filter(|run| run.within).min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }
}

/// Runs the ladders.
///
/// # Errors
/// Returns an error if the first run shows that no run of this scene has the required quantity.
pub(super) fn search(
    scene: &Scene,
    group: &Group,
    mut ladders: Vec<Ladder>,
    demand: &Demand,
    machine: &Machine,
    options: RunOptions,
) -> Result<Found, String> {
    let mut found = Found::default();
    loop {
        let foreseen = ladders.iter().enumerate().filter_map(|(at, l)| Some((at, l.foreseen(scene)?)));
        let Some((at, seconds)) = foreseen.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        let ladder = &mut ladders[at];
        let Some(method) = ladder.next() else { break };
        if seconds > demand.at_most {
            found.too_long.push((method.id.clone(), seconds));
            ladders.remove(at);
            continue;
        }
        let scenario = group.scenario(method.clone(), 0);
        // Sizes chosen here may repeat the previous mesh, and the usual methods may not suit the body.
        if ladder.ours {
            match group.plan(&scenario) {
                Ok((_, size)) if ladder.last.is_none_or(|(nodes, _)| nodes < size.nodes) => {}
                Ok(_) => continue,
                Err(failure) => {
                    found.fail(scene, &method, &failure);
                    ladders.remove(at);
                    continue;
                }
            }
        }
        match group.run(&scenario, options) {
            Ok(outcome) => {
                let tried = tried(&outcome, demand);
                if tried.error.is_none() && outcome.status == "ok" {
                    return Err(format!(
                        "runs of this scene have no error of {}; `tissuebench list metrics` explains the metrics",
                        demand.quantity.name
                    ));
                }
                ladder.last = Some((tried.nodes, tried.seconds));
                let least = found.cheapest().map(|run| run.seconds);
                let done = tried.within || least.is_some_and(|least| tried.seconds >= least);
                found.keep(outcome, tried);
                if done {
                    ladders.remove(at);
                }
            }
            Err(unfinished) => {
                found.fail(scene, &method, &unfinished.failure);
                if ladder.ours {
                    ladders.remove(at);
                }
            }
        }
    }
    found.by = Seconds::of(machine, found.tried.iter().map(|run| run.timed.took()));
    found.tried.iter_mut().for_each(|run| run.seconds = run.timed.by(found.by));
    let band = group.reference().and_then(|reference| demand.quantity.band(&reference));
    mark_front(&mut found.tried, band.unwrap_or(0.0));
    Ok(found)
}

impl Found {
    fn fail(&mut self, scene: &Scene, method: &Method, failure: &Failure) {
        eprintln!("{failure} (method '{}')", method.id);
        self.set.failures.push(failed(&crate::run::case_name(scene), method, failure));
        self.code = self.code.max(failure.exit_code());
    }

    fn keep(&mut self, outcome: Outcome, tried: Tried) {
        if let Some(failure) = &outcome.stalled {
            eprintln!("{}: {failure} (method '{}', {} nodes)", outcome.status, tried.method, tried.nodes);
            self.set.failures.push(stalled(&outcome, failure));
        }
        self.set.records.extend(outcome.records());
        self.set.plans.extend(outcome.plan_entries());
        self.set.warnings.extend(outcome.warning_rows());
        compared_with(&mut self.set, outcome.reference.as_ref());
        self.set.fields.extend(outcome.field.clone());
        self.tried.push(tried);
    }
}

/// Returns the result of a run. A run that ended early has no error. The reference has none either, since its
/// difference from itself is zero.
fn tried(outcome: &Outcome, demand: &Demand) -> Tried {
    let whole = outcome.stalled.is_none();
    let of = |quantity: &Quantity| quantity.error(outcome).filter(|_| whole);
    let error = of(&demand.quantity);
    let others = demand.also.iter().map(|(quantity, _)| quantity.clone()).chain(Quantity::shown());
    let mut errors: Vec<(String, f64)> = Vec::new();
    for quantity in others.filter(|quantity| quantity.name != demand.quantity.name) {
        if let Some(error) = of(&quantity)
            && errors.iter().all(|(name, _)| *name != quantity.name)
        {
            errors.push((quantity.name, error));
        }
    }
    let keeps = |quantity: &Quantity, most: f64| of(quantity).is_some_and(|error| error <= most);
    let within = keeps(&demand.quantity, demand.error)
        && demand.also.iter().all(|(quantity, most)| keeps(quantity, *most))
        && !outcome.is_reference();
    let total = outcome.total().cloned().unwrap_or_default();
    Tried {
        method: outcome.identity.method.clone(),
        nodes: outcome.size.nodes,
        dofs: outcome.size.dofs,
        error,
        errors,
        seconds: undisturbed(&total),
        timed: total,
        status: if outcome.is_reference() { "reference" } else { outcome.status },
        within,
        front: false,
    }
}

/// Returns the time, s, of a run without other load on the processors, as far as both clocks show.
fn undisturbed(total: &Timed) -> f64 {
    let Took { wall, cpu } = total.took();
    cpu.map_or(wall, |cpu| cpu.min(wall))
}

/// Marks the Pareto front of time and error, and sorts all runs by time. Errors below `band`, the error of
/// the reference, count as `band`.
fn mark_front(tried: &mut [Tried], band: f64) {
    tried.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let mut least = f64::INFINITY;
    for run in tried.iter_mut().filter(|run| run.status != "reference") {
        if let Some(error) = run.error.map(|error| error.max(band)).filter(|error| *error < least) {
            (run.front, least) = (true, error);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_falls_in_error_as_it_rises_in_time() {
        let run = |seconds: f64, error: Option<f64>, status: &'static str| Tried {
            method: "m".into(),
            nodes: 8,
            dofs: 24,
            error,
            errors: Vec::new(),
            seconds,
            timed: Timed::default(),
            status,
            within: false,
            front: false,
        };
        let mut all = [
            run(3.0, Some(0.1), "ok"),
            run(1.0, Some(0.5), "ok"),
            run(2.0, Some(0.6), "ok"),
            run(0.5, Some(0.0), "reference"),
            run(0.1, None, "stalled"),
        ];
        mark_front(&mut all, 0.0);
        assert_eq!(
            all.each_ref().map(|r| (r.seconds, r.front)),
            [(0.1, false), (0.5, false), (1.0, true), (2.0, false), (3.0, true)]
        );
        // A reference with an error of one half cannot separate these runs.
        all.iter_mut().for_each(|run| run.front = false);
        mark_front(&mut all, 0.5);
        assert_eq!(all.iter().filter(|run| run.front).map(|run| run.seconds).collect::<Vec<_>>(), [1.0]);
    }
}
