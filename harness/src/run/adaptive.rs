//! Meshes refined until a number is accurate: each run's error is traced to its cells, which are bisected
//! where it comes from, and the next mesh is solved from the start.

use catalogue::{metric, warning};
use geometry::generate::bisect;
use geometry::{Mesh, Point3};

use super::contributions::Contributions;
use super::pass::{Pass, pass};
use crate::discretise::{Adapt, Discretisation};
use crate::error::Failure;
use crate::measure::{Request, Solved, number};
use crate::outcome::timing::{Meters, Timings};
use crate::outcome::{Counters, Outcome, Plan, SATURATED, Warning, corrected, push};
use crate::scenario::setup::Setup;

/// Power of the cell size with which the contribution of all cells of a region is taken to fall, and that of
/// one cell.
const RATE: f64 = 2.0;
const RATE_OF_CELL: f64 = RATE + 3.0;
/// Smallest ratio of a new cell to the cell that contains it, and smallest and largest ratio of the error to
/// that on the mesh before. Sizes for less are guessed too badly; a mesh with more shows nothing new.
const SMALLEST: f64 = 0.25;
const LEFT: [f64; 2] = [0.12, 0.5];
/// Part of the wanted error at which the sizes aim.
const AIM: f64 = 0.7;
/// Most cells of a mesh.
const MOST_CELLS: f64 = 1e6;

/// The refinement of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct Adapted {
    /// Number of solved meshes.
    meshes: usize,
    /// Number on the last traced mesh, and its prediction.
    before: Option<[f64; 2]>,
    /// The last prediction, corrected by the one before; `None` with a single one, which may share most of
    /// the error of its mesh.
    predicted: Option<f64>,
    /// Saturation of the last prediction, if known.
    saturation: Option<f64>,
    /// Relative error of the last mesh against the last prediction.
    error: f64,
    /// Reason why the refinement ended before the error was reached.
    ended: Option<String>,
}

impl Adapted {
    /// Adds the metrics, and warnings if the error was not reached, and if it is uncertain.
    pub(super) fn report(&self, outcome: &mut Outcome) {
        push(&mut outcome.metrics, &metric::MESHES, self.meshes as f64);
        push(&mut outcome.metrics, &metric::REMAINING_ERROR, self.error);
        if let Some(why) = &self.ended {
            let message = format!("the error is still {:.2} %: {why}", 100.0 * self.error);
            outcome.warnings.push(Warning::new(&warning::NOT_ACCURATE, self.error, "method.refine", message));
        }
        if let Some(saturation) = self.saturation.filter(|saturation| *saturation > SATURATED) {
            let message = format!(
                "the remaining error may be far larger: between the last two traced meshes the prediction changed by \
                 {saturation:.2} of the change of the number; start from a finer mesh"
            );
            outcome.warnings.push(Warning::new(
                &warning::LEVELS_DISAGREE,
                saturation,
                "method.refine",
                message,
            ));
        }
    }
}

/// Solves on finer and finer meshes. The times before the last solution are those of the phase "refine".
pub(super) fn adapted(
    method: &Discretisation,
    adapt: &Adapt,
    setup: &Setup,
    plan: &Plan,
    request: &Request,
    meters: &mut Meters,
) -> Result<(Pass, Adapted), Failure> {
    let Meters { timings, counters, .. } = meters;
    timings.time_rest("refine", |timings| rounds(method, adapt, (setup, plan), request, (timings, counters)))
}

fn rounds(
    method: &Discretisation,
    adapt: &Adapt,
    (setup, plan): (&Setup, &Plan),
    request: &Request,
    (timings, counters): (&mut Timings, &mut Counters),
) -> Result<(Pass, Adapted), Failure> {
    let mut current = method.clone();
    let mut adapted = Adapted::default();
    loop {
        let mut own = Meters::default();
        let pass = pass(&current, setup, plan, request, &mut own)?;
        adapted.meshes += 1;
        let run = Solved { method: &current, setup, prepared: &pass.prepared, solution: &pass.solution };
        let Some(mesh) = refined(&run, adapt, request.probes, counters, &mut adapted)? else {
            counters.refinements = adapted.meshes as u64 - 1;
            *timings = own.timings;
            *counters += own.counters;
            return Ok((Pass { refined: Some(current), ..pass }, adapted));
        };
        current = (adapt.on)(mesh)?;
    }
}

/// The next mesh; `None` at the end.
fn refined(
    run: &Solved,
    adapt: &Adapt,
    probes: &[Point3],
    counters: &mut Counters,
    adapted: &mut Adapted,
) -> Result<Option<Mesh>, Failure> {
    if !run.solution.is_whole() {
        adapted.ended = Some("the load path ended early".into());
        return Ok(None);
    }
    if let Some(predicted) = adapted.predicted {
        let number = number(run, &adapt.by, probes)?;
        adapted.error = relative(number, predicted);
        if adapted.error <= adapt.error {
            return Ok(None);
        }
    }
    let found = match Contributions::new(run, &adapt.by, probes, counters) {
        Ok(found) => found,
        Err(failure) if adapted.meshes > 1 => {
            adapted.ended = Some(format!("the error of the last mesh can't be traced: {failure}"));
            return Ok(None);
        }
        Err(failure) => return Err(failure),
    };
    let now = [found.number, found.predicted];
    if !(found.predicted.abs() > 0.0) {
        return Err(Failure::Run(format!(
            "{} is {} in a richer method, so it has no relative error",
            adapt.by, found.predicted
        )));
    }
    if let Some(before) = adapted.before.replace(now) {
        let (predicted, saturation) = corrected(now, before);
        (adapted.predicted, adapted.saturation) = (Some(predicted), saturation);
    }
    adapted.error = relative(found.number, adapted.predicted.unwrap_or(found.predicted));
    if adapted.error <= adapt.error && adapted.predicted.is_some() {
        return Ok(None);
    }
    if adapted.meshes == adapt.rounds {
        adapted.ended = Some(format!("{} meshes were solved, as many as allowed", adapted.meshes));
        return Ok(None);
    }
    let mesh = run.method.mesh();
    let left = (AIM * adapt.error / adapted.error).clamp(LEFT[0], LEFT[1]);
    let ratios = ratios(&found.of_cell, left);
    let longest =
        (0..mesh.cell_count()).map(|cell| ratios[cell] * longest_edge(mesh, cell)).collect::<Vec<_>>();
    let cells: f64 = ratios.iter().map(|ratio| ratio.powi(-3)).sum();
    if cells > MOST_CELLS {
        adapted.ended = Some(format!("the next mesh would have {cells:.1e} cells"));
        return Ok(None);
    }
    Ok(Some(bisect(mesh, &longest)))
}

/// Ratio of the new to the present size of each cell, so that a part `left` of the sum of all contributions
/// is left with the fewest cells: ratios are proportional to contributions to the power of `-1 /
/// RATE_OF_CELL`.
fn ratios(contributions: &[f64], left: f64) -> Vec<f64> {
    let total: f64 = contributions.iter().map(|c| c.abs()).sum();
    let ratio =
        |level: f64, c: f64| (level / (c.abs() / total)).powf(1.0 / RATE_OF_CELL).clamp(SMALLEST, 1.0);
    let remains = |level: f64| -> f64 {
        contributions.iter().map(|&c| c.abs() / total * ratio(level, c).powf(RATE)).sum()
    };
    // The level is a contribution that stays as it is, over the total; 60 halvings exhaust a double.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if remains(middle) > left { high = middle } else { low = middle }
    }
    contributions.iter().map(|&c| if c == 0.0 { 1.0 } else { ratio(low, c) }).collect()
}

fn relative(number: f64, predicted: f64) -> f64 {
    ((number - predicted) / predicted).abs()
}

fn longest_edge(mesh: &Mesh, cell: usize) -> f64 {
    let (kind, nodes) = (mesh.kind(cell), mesh.cell(cell));
    let length = |ends: &[usize; 2]| {
        let [a, b] = ends.map(|k| mesh.points()[nodes[k] as usize]);
        nalgebra::distance(&a, &b)
    };
    kind.edges().iter().map(length).fold(0.0, f64::max)
}
