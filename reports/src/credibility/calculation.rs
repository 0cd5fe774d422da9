//! Evidence of calculation verification: errors of discretisation and of solvers, and warnings.

use catalogue::metric::{self, Address, Kind, Metric};
use records::text::{percent, plural, significant};
use records::{Purpose, RunSet};

use super::code::ids;
use super::document::{Block, Evidence};
use super::factors;
use crate::order;
use crate::quantity;
use crate::select::{Run, series};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// A result with the metrics of its error.
struct Quantity {
    value: &'static Metric,
    /// Relative errors against a reference; the first that a run has counts.
    errors: &'static [&'static Metric],
    /// Estimate of the relative error without a reference, and its saturation.
    estimate: Option<(&'static Metric, &'static Metric)>,
}

/// Results of a run, in the order of the table.
const QUANTITIES: [Quantity; 6] = [
    Quantity {
        value: &metric::MAX,
        errors: &[&metric::L2, &metric::RELATIVE_RMS],
        estimate: Some((&metric::DISPLACEMENT_ESTIMATE, &metric::DISPLACEMENT_SATURATION)),
    },
    Quantity {
        value: &metric::TOOL_FORCE,
        errors: &[&metric::TOOL_FORCE_ERROR],
        estimate: Some((&metric::TOOL_FORCE_ESTIMATE, &metric::TOOL_FORCE_SATURATION)),
    },
    Quantity {
        value: &metric::REACTION,
        errors: &[],
        estimate: Some((&metric::REACTION_ESTIMATE, &metric::REACTION_SATURATION)),
    },
    Quantity {
        value: &metric::PROBE,
        errors: &[],
        estimate: Some((&metric::PROBE_ESTIMATE, &metric::PROBE_SATURATION)),
    },
    Quantity {
        value: &metric::STRAIN_ENERGY,
        errors: &[&metric::STRAIN_ENERGY_ERROR, &metric::ENERGY],
        estimate: Some((&metric::STRAIN_ENERGY_ESTIMATE, &metric::STRAIN_ENERGY_SATURATION)),
    },
    Quantity {
        value: &metric::FREQUENCY,
        errors: &[&metric::FREQUENCY_ERROR],
        estimate: Some((&metric::FREQUENCY_ESTIMATE, &metric::FREQUENCY_SATURATION)),
    },
];

impl Quantity {
    /// Addresses of the numbers of a run: one, or that of each tool, support, point or mode.
    fn addresses(&self, run: &Run) -> Vec<Address> {
        if !matches!(self.value.kind, Kind::Tool | Kind::Place) {
            return vec![self.value.whole()];
        }
        (0..).map(|at| self.value.at(at)).take_while(|of| size(run, *of).is_some()).collect()
    }

    /// Estimate, its saturation, error against the reference and own error of the reference.
    fn known(&self, run: &Run, of: Address) -> [Option<f64>; 4] {
        let alike = |metric: &'static Metric| match metric.is_numbered() {
            true => Address { index: of.index, ..metric.whole() },
            false => metric.whole(),
        };
        let estimated = self.estimate.map_or([None, None], |(error, saturation)| {
            [error, saturation].map(|metric| run.value(alike(metric)))
        });
        let error = self.errors.iter().find(|error| run.value(alike(error)).is_some());
        let [error, band] =
            error.map_or([None, None], |error| [run.value(alike(error)), run.band(alike(error))]);
        [estimated[0], estimated[1], error, band]
    }
}

/// Value of a number, or the length of a vector of which only the components are recorded.
fn size(run: &Run, of: Address) -> Option<f64> {
    let part = |component| run.value(Address { component, ..of });
    run.value(of).or_else(|| Some(part("x")?.hypot(part("y")?).hypot(part("z")?)))
}

/// Evidence about the error of discretisation.
pub(super) fn discretisation(set: &RunSet, runs: &[Run]) -> Evidence {
    // A test of exactness has no error to speak of, unless it is a test of the estimate.
    let judged = |run: &&Run| run.is.purpose != Purpose::Patch || run.has(&metric::DISPLACEMENT_ESTIMATE);
    let judged: Vec<Run> = runs.iter().filter(judged).cloned().collect();
    let (errors, [known, none]) = errors(&judged);
    let summary = match known + none {
        0 => String::new(),
        all => format!("{known} of {all} results with an error or an estimate; {none} without"),
    };
    let tables = [errors, references(set), bounds(runs), indices(&judged)];
    let blocks = tables.into_iter().filter(|of| !of.is_empty()).map(Block::Table).collect();
    Evidence { factor: &factors::DISCRETISATION, summary, blocks }
}

/// Table of results with their errors, and the numbers of those with and without one.
fn errors(runs: &[Run]) -> (Table, [usize; 2]) {
    let mut table = Table::new(
        "result-errors",
        "Errors of results",
        "Every run, without patch tests. None: results of the run without an error. The errors of max are those of the displacement field. Estimate: relative error that the run estimates without a \
         reference; saturation: ratio by which the estimate of a coarser mesh corrects it (near 1 is good). Error: \
         relative error against the reference of the scene, and the own error of this reference",
        &[
            ("evidence", Words),
            ("scene", Words),
            ("method", Words),
            ("nodes", Number),
            ("result", Words),
            ("value", Number),
            ("estimate", Number),
            ("saturation", Number),
            ("error", Number),
            ("of the reference", Number),
            ("run", Words),
        ],
    );
    let mut counts = [0, 0];
    let text = |value: Option<f64>| value.map_or("—".into(), percent);
    for run in runs {
        let mut row = |evidence: &str,
                       result: &str,
                       value: &str,
                       [estimate, saturation, error, band]: [Option<f64>; 4]| {
            table.row(&[
                Cell::Text(evidence),
                Cell::Text(&run.is.case),
                Cell::Text(&run.is.method),
                Cell::Count(run.is.nodes),
                Cell::Text(result),
                Cell::Text(value),
                Cell::Text(&text(estimate)),
                Cell::Digits(saturation, 3),
                Cell::Text(&text(error)),
                Cell::Text(&text(band)),
                Cell::Text(&run.is.run),
            ]);
        };
        let mut without = Vec::new();
        for (quantity, of) in
            QUANTITIES.iter().flat_map(|of| of.addresses(run).into_iter().map(move |at| (of, at)))
        {
            let Some(value) = size(run, of) else { continue };
            let known @ [estimate, _, error, _] = quantity.known(run, of);
            let evidence = match (estimate, error) {
                (Some(_), Some(_)) => "both",
                (Some(_), None) => "estimate",
                (None, Some(_)) => "reference",
                (None, None) => {
                    without.push(of.to_string());
                    continue;
                }
            };
            counts[0] += 1;
            let value = format!("{} {}", significant(value * quantity::scale(of), 4), quantity::unit(of));
            row(evidence, &of.to_string(), &value, known);
        }
        counts[1] += without.len();
        if !without.is_empty() {
            row("none", &without.join(", "), "", [None; 4]);
        }
    }
    (table, counts)
}

/// Table of the references, with their own errors and warnings.
fn references(set: &RunSet) -> Table {
    let mut table = Table::new(
        "references",
        "References",
        "References of the scenes with their own errors; a smaller error of a run is not significant",
        &[("scene", Words), ("reference", Words), ("warnings", Words)],
    );
    for reference in set.references.iter().filter(|of| of.nodes > 0) {
        table.row_once(&[
            Cell::Text(&reference.case),
            Cell::Text(&reference.sentence()),
            Cell::Text(&reference.warnings.join("; ")),
        ]);
    }
    table
}

/// Table of strict bounds of the strain energy.
fn bounds(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "strict-bounds",
        "Strict bounds",
        "Two-sided bounds of the exact strain energy in linear elasticity, and the energy of the run. Outside: relative \
         distance from the nearer bound",
        &[
            ("scene", Words),
            ("method", Words),
            ("lower [J]", Number),
            ("energy [J]", Number),
            ("upper [J]", Number),
            ("half-width", Number),
            ("outside", Number),
            ("run", Words),
        ],
    );
    for run in runs {
        let Some(lower) = run.value(&metric::STRAIN_ENERGY_LOWER) else { continue };
        let share = |metric| run.value(metric).map_or(String::new(), percent);
        table.row(&[
            Cell::Text(&run.is.case),
            Cell::Text(&run.is.method),
            Cell::Digits(Some(lower), 5),
            Cell::Digits(run.value(&metric::STRAIN_ENERGY), 5),
            Cell::Digits(run.value(&metric::STRAIN_ENERGY_UPPER), 5),
            Cell::Text(&share(&metric::BOUNDS_HALF_WIDTH)),
            Cell::Text(&share(&metric::BOUNDS_EXCESS)),
            Cell::Text(&run.is.run),
        ]);
    }
    table
}

/// Table of grid convergence indices.
fn indices(runs: &[Run]) -> Table {
    let mut table = Table::new(
        "grid-convergence-indices",
        "Grid convergence indices",
        "Results on three levels: apparent order and index of the finest level (safety factor 1.25; Celik et al. 2008)",
        &[
            ("scene", Words),
            ("method", Words),
            ("result", Words),
            ("order", Number),
            ("index", Number),
            ("verdict", Words),
            ("runs", Words),
        ],
    );
    for series in series(runs) {
        for outcome in [&metric::MAX, &metric::STRAIN_ENERGY] {
            let point = |run: &Run| run.value(outcome).map(|value| (run.is.spacing, value));
            let points: Vec<(f64, f64)> =
                series.runs.iter().filter_map(point).filter(|(h, _)| *h > 0.0).collect();
            let Some(found) = order::grid_convergence(&points) else { continue };
            table.row(&[
                Cell::Text(&series.is().case),
                Cell::Text(&series.is().series),
                Cell::Text(outcome.name),
                Cell::Digits(found.index.as_ref().map(|gci| gci.order), 3),
                Cell::Text(&found.index.as_ref().map_or(String::new(), |gci| percent(gci.fine))),
                Cell::Text(found.verdict.name()),
                Cell::Text(&ids(&series.runs)),
            ]);
        }
    }
    table
}

/// Numbers about the solution of the equations, and about the steps of loads and time.
const SOLVER: [&Metric; 16] = [
    &metric::RESIDUAL,
    &metric::LINEAR_ITERATIONS,
    &metric::NEWTON_ITERATIONS,
    &metric::LOAD_STEPS,
    &metric::CUT_BACKS,
    &metric::LOAD_CARRIED,
    &metric::RELAXATION_STEPS,
    &metric::RELAXATION_ERROR,
    &metric::RELAXATION_RESIDUAL,
    &metric::TIME_STEPS,
    &metric::CRITICAL_STEP,
    &metric::TIME_REACHED,
    &metric::STEP_ERROR,
    &metric::ENERGY_DRIFT,
    &metric::FORCE_ROUNDING,
    &metric::HOURGLASS_ENERGY,
];

/// Evidence about the error of solvers.
pub(super) fn solver(runs: &[Run]) -> Evidence {
    let mut table = Table::new(
        "solver-facts",
        "Solution of the equations",
        "Linear solver, residual, iterations, steps and balance of energy of every run, with the names of \
         tissuebench list metrics, SI units. Tolerances are in the scene, whose hash is in provenance.json",
        &[("scene", Words), ("method", Words), ("linear solver", Words), ("numbers", Words), ("run", Words)],
    );
    for run in runs {
        let fact = |metric: &&'static Metric| {
            let unit = if metric.unit() == "1" { String::new() } else { format!(" {}", metric.unit()) };
            Some(format!("{} {}{unit}", metric.name, short(run.value(*metric)?)))
        };
        let facts: Vec<String> = SOLVER.iter().filter_map(fact).collect();
        table.row(&[
            Cell::Text(&run.is.case),
            Cell::Text(&run.is.method),
            Cell::Text(run.is.linear_solver.as_deref().unwrap_or("not recorded")),
            Cell::Text(&facts.join("; ")),
            Cell::Text(&run.is.run),
        ]);
    }
    let summary = if runs.is_empty() { String::new() } else { format!("facts of {} runs", runs.len()) };
    Evidence { factor: &factors::SOLVER, summary, blocks: vec![Block::Table(table)] }
}

/// A whole number as such, any other with three digits.
fn short(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e9 { value.to_string() } else { significant(value, 3) }
}

/// Evidence about use errors: warnings, and runs that ended early.
pub(super) fn usage(set: &RunSet) -> Evidence {
    let mut warnings = Table::new(
        "run-warnings",
        "Warnings",
        "Warnings of the program about the numbers of runs; tissuebench list warnings explains the codes",
        &[("warning", Words), ("scene", Words), ("method", Words), ("message", Words), ("run", Words)],
    );
    for warning in &set.warnings {
        let place = if warning.place.is_empty() { String::new() } else { format!("{}: ", warning.place) };
        warnings.row(&[
            Cell::Text(&warning.code),
            Cell::Text(&warning.case),
            Cell::Text(&warning.method),
            Cell::Text(&format!("{place}{}", warning.message)),
            Cell::Text(&warning.run),
        ]);
    }
    let mut ended = Table::new(
        "ended-early",
        "Runs that ended early",
        "Runs without numbers, or with those of a part of the load",
        &[("scene", Words), ("method", Words), ("load reached", Number), ("reason", Words)],
    );
    for failure in &set.failures {
        ended.row(&[
            Cell::Text(&failure.case),
            Cell::Text(&failure.method),
            Cell::Digits(failure.carried, 3),
            Cell::Text(&failure.reason),
        ]);
    }
    let text = "The program checks every scene before it runs: keys, units, ranges, contradictions between the parts \
                of the scene. It reports doubts about results as warnings.";
    let tables = [warnings, ended].into_iter().filter(|of| !of.is_empty()).map(Block::Table);
    let (count, early) = (set.warnings.len(), set.failures.len());
    let summary = format!("{count} warning{}; {early} run{} ended early", plural(count), plural(early));
    Evidence {
        factor: &factors::USE,
        summary,
        blocks: [Block::Text(text.into())].into_iter().chain(tables).collect(),
    }
}
