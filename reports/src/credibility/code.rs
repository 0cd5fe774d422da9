//! Evidence of code verification: exact solutions, observed orders, and parts of the program that none of
//! them exercised.

use std::collections::{BTreeMap, BTreeSet};

use catalogue::metric::{self, Kind, Needs};
use records::text::plural;
use records::{Check, Purpose, RunSet, Status};

use super::document::{Block, Evidence};
use super::factors;
use crate::order::observed;
use crate::select::{Run, series};
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// Law of a run at small strain, whose records name none.
const LINEAR: &str = "linear elasticity";

/// Errors with an observed order.
const ERRORS: [&metric::Metric; 3] = [&metric::L2, &metric::ENERGY, &metric::PRESSURE];

/// Whether a check compares a run with its exact solution: a bound on an error or on an order.
fn compares(check: &Check) -> bool {
    let Some(of) = metric::find(&check.metric).map(|of| of.metric) else { return false };
    let against = matches!(
        of.needs,
        Needs::Reference
            | Needs::ToolReference
            | Needs::StepsReference
            | Needs::ProbesReference
            | Needs::Probes
            | Needs::Exact
            | Needs::ExactContact
            | Needs::ModesReference
    );
    let is_error = of.kind == Kind::Error || *of == metric::TOOL_FORCE_ERROR;
    matches!(of.kind, Kind::Order(_)) || against && is_error
}

/// Whether the bound of a check that holds shows that a run is right: an error that is at least something is
/// known to be wrong.
fn confirms(check: &Check) -> bool {
    check.capped || metric::find(&check.metric).is_some_and(|of| matches!(of.metric.kind, Kind::Order(_)))
}

/// Results of a study, by the reference of each case.
pub(super) struct Verified<'a> {
    set: &'a RunSet,
    /// Name of the exact solution of each case that has one.
    exact: BTreeMap<&'a str, &'a str>,
    /// Indices of the checks that compare a run with its reference, by the id of the run.
    checks: BTreeMap<&'a str, Vec<usize>>,
    runs: &'a [Run<'a>],
}

impl<'a> Verified<'a> {
    /// `runs` are those of solvers.
    pub(super) fn new(set: &'a RunSet, runs: &'a [Run<'a>]) -> Verified<'a> {
        let exact = set.references.iter().filter(|of| of.nodes == 0);
        let mut checks: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, check) in set.checks.iter().enumerate().filter(|(_, check)| compares(check)) {
            check.runs.iter().for_each(|run| checks.entry(run).or_default().push(index));
        }
        Verified { set, exact: exact.map(|of| (&*of.case, &*of.method)).collect(), checks, runs }
    }

    /// Exact solution of a run.
    pub(super) fn exact(&self, run: &Run) -> Option<&'a str> {
        self.exact.get(run.is.case.as_str()).copied()
    }

    /// Indices of the checks that compare some runs with their exact solution.
    fn checks_of(&self, runs: &[Run]) -> BTreeSet<usize> {
        let of = |run: &Run| self.checks.get(run.is.run.as_str()).into_iter().flatten().copied();
        runs.iter().flat_map(of).collect()
    }

    /// Numbers of some checks that passed, failed, are known not to pass, and did not run.
    fn outcomes(&self, checks: &BTreeSet<usize>) -> [usize; 4] {
        let all = || checks.iter().map(|&check| &self.set.checks[check]);
        let shown = |check: &&Check| check.status != Status::Pass || confirms(check);
        let count = |status| all().filter(shown).filter(|check| check.status == status).count();
        [Status::Pass, Status::Fail, Status::KnownFailure, Status::NotRun].map(count)
    }

    /// Whether an exact solution confirms a run: a check of an error or of an order holds, and none is
    /// missed.
    fn is_confirmed(&self, run: &Run) -> bool {
        let [passed, failed, known, _] = self.outcomes(&self.checks_of(std::slice::from_ref(run)));
        self.exact(run).is_some() && passed > 0 && failed + known == 0
    }

    /// Series of runs with an exact solution.
    fn of_exact(&self) -> Vec<Run<'a>> {
        self.runs.iter().filter(|run| self.exact(run).is_some()).cloned().collect()
    }

    /// Evidence of the quality of the software: the build and its tests.
    pub(super) fn quality(&self) -> Evidence {
        let program = &self.set.provenance.program;
        let count = |status| self.set.checks.iter().filter(|check| check.status == status).count();
        let mut blocks = vec![Block::Table(build(self.set))];
        if program.dirty {
            let text =
                "The source was changed since this commit, so the commit does not reproduce the build.";
            blocks.push(Block::Text(text.into()));
        }
        blocks.push(Block::Text(format!(
            "Checks of this folder: {} passed, {} failed, {} known not to pass, {} not run. The program's own tests \
             (cargo test --workspace: unit, property, patch, reproducibility and snapshot tests; cargo xtask mutants: \
             faults that the tests must find) are not part of this folder.",
            count(Status::Pass),
            count(Status::Fail),
            count(Status::KnownFailure),
            count(Status::NotRun)
        )));
        let summary = format!("version {}, commit {}", program.version, program.revision());
        Evidence { factor: &factors::QUALITY, summary, blocks }
    }

    /// Evidence of numerical code verification.
    pub(super) fn code(&self, figures: Vec<String>) -> Evidence {
        let (solutions, [passed, failed]) = self.solutions();
        let idle = self.not_exercised();
        let summary = match solutions.is_empty() {
            true => String::new(),
            false => format!(
                "checks of exact solutions: {passed} passed, {failed} failed; {} part{} not exercised",
                idle.len(),
                plural(idle.len())
            ),
        };
        let mut blocks = Vec::new();
        if solutions.is_empty() {
            blocks.push(Block::Text("No scene of this folder has an exact solution.".into()));
        }
        let (open, orders) = (self.open_checks(), self.orders());
        blocks.extend([solutions, open, orders].into_iter().filter(|of| !of.is_empty()).map(Block::Table));
        blocks.extend(figures.into_iter().map(Block::Figure));
        if !idle.is_empty() {
            blocks.push(Block::Table(idle.table()));
        } else if !self.runs.is_empty() {
            let text =
                "An exact solution exercises every law, setting and stage of these runs, each by itself.";
            blocks.push(Block::Text(text.into()));
        }
        Evidence { factor: &factors::CODE, summary, blocks }
    }

    /// Table of the exact solutions by method and law, failed ones first, and the numbers of passed and
    /// failed checks.
    fn solutions(&self) -> (Table, [usize; 2]) {
        let mut table = Table::new(
            "exact-solutions",
            "Exact solutions",
            "Every method on every scene with an exact solution, and the outcomes of the checks of its errors and orders. Patch: \
             a test of exactness. Fail: a check failed. Known: a check is known not to pass, for the stated reason. Not checked: \
             no error and no order was checked",
            &[
                ("result", Words),
                ("scene", Words),
                ("exact solution", Words),
                ("law", Words),
                ("method", Words),
                ("passed", Number),
                ("failed", Number),
                ("known", Number),
                ("not run", Number),
                ("runs", Words),
            ],
        );
        let of_exact = self.of_exact();
        let mut rows = Vec::new();
        let mut all = BTreeSet::new();
        for series in series(&of_exact) {
            let is = series.is();
            let checks = self.checks_of(&series.runs);
            let counts = self.outcomes(&checks);
            all.extend(checks);
            let (rank, result) = match counts {
                [_, failed, ..] if failed > 0 => (0, "fail"),
                [_, _, known, _] if known > 0 => (1, "known"),
                [0, ..] => (2, "not checked"),
                _ => (3, "pass"),
            };
            let purpose = if is.purpose == Purpose::Patch { ", patch" } else { "" };
            let solution = format!("{}{purpose}", self.exact(&series.runs[0]).unwrap_or_default());
            let law = is.law.clone().unwrap_or_else(|| LINEAR.into());
            rows.push((rank, (result, is, solution, law, counts, ids(&series.runs))));
        }
        rows.sort_by_key(|(rank, _)| *rank);
        for (_, (result, is, solution, law, counts, runs)) in &rows {
            let [passed, failed, known, not_run] = counts.map(|count| Cell::Count(count as u64));
            table.row(&[
                Cell::Text(result),
                Cell::Text(&is.case),
                Cell::Text(solution),
                Cell::Text(law),
                Cell::Text(&is.series),
                passed,
                failed,
                known,
                not_run,
                Cell::Text(runs),
            ]);
        }
        let [passed, failed, ..] = self.outcomes(&all);
        (table, [passed, failed])
    }

    /// Table of all checks that did not pass, with or without an exact solution.
    fn open_checks(&self) -> Table {
        let mut table = Table::new(
            "open-checks",
            "Checks that did not pass",
            "Failed checks, checks that are known not to pass for the stated reason, and checks that did not run, of \
             all scenes",
            &[
                ("result", Words),
                ("scene", Words),
                ("method", Words),
                ("number", Words),
                ("value", Number),
                ("bound", Words),
                ("reason", Words),
                ("runs", Words),
            ],
        );
        for status in [Status::Fail, Status::KnownFailure, Status::NotRun] {
            for check in self.set.checks.iter().filter(|check| check.status == status) {
                table.row(&[
                    Cell::Text(status.name()),
                    Cell::Text(&check.case),
                    Cell::Text(&check.method),
                    Cell::Text(&check.metric),
                    Cell::Digits(check.value, 4),
                    Cell::Text(&check.bound),
                    Cell::Text(&check.reason),
                    Cell::Text(&check.runs.join(" ")),
                ]);
            }
        }
        table
    }

    /// Table of observed orders of convergence with the expected ones.
    fn orders(&self) -> Table {
        let mut table = Table::new(
            "orders-of-exact-solutions",
            "Observed and expected orders",
            "Slope of the logarithm of the error over that of the spacing by least squares, with the order that theory \
             gives for a smooth solution. Asymptotic: the last two pairs of levels agree within 0.15",
            &[
                ("scene", Words),
                ("method", Words),
                ("error", Words),
                ("expected", Number),
                ("observed", Number),
                ("95 % ±", Number),
                ("verdict", Words),
                ("runs", Words),
            ],
        );
        let of_exact = self.of_exact();
        for series in series(&of_exact) {
            for error in ERRORS {
                let Some(order) = observed(&series.points(error)) else { continue };
                table.row(&[
                    Cell::Text(&series.is().case),
                    Cell::Text(&series.is().series),
                    Cell::Text(error.label),
                    Cell::Digits(series.theory(error), 1),
                    Cell::Digits(Some(order.fit), 3),
                    Cell::Digits(order.band, 2),
                    Cell::Text(order.verdict.map_or("two levels only", |verdict| verdict.name())),
                    Cell::Text(&ids(&series.runs)),
                ]);
            }
        }
        table
    }

    /// Parts of the program that runs use and that no confirmed run with an exact solution uses.
    fn not_exercised(&self) -> Idle {
        let mut stages: BTreeMap<(&str, &str), BTreeSet<&str>> = BTreeMap::new();
        for plan in self.set.plans.iter().filter(|plan| plan.ran) {
            stages.entry((&plan.case, &plan.method)).or_default().insert(&plan.stage);
        }
        let parts = |run: &Run| -> BTreeSet<Part> {
            let stages = stages.get(&(run.is.case.as_str(), run.is.method.as_str()));
            let stages = stages.into_iter().flatten().map(|stage| ("stage", stage.to_string()));
            settings(run).chain(stages).collect()
        };
        let exercised: BTreeSet<Part> =
            self.runs.iter().filter(|run| self.is_confirmed(run)).flat_map(parts).collect();
        let mut idle: BTreeMap<Part, BTreeMap<String, String>> = BTreeMap::new();
        for run in self.runs {
            for part in parts(run).difference(&exercised) {
                // One run of each scene is enough to find the part again.
                let scenes = idle.entry(part.clone()).or_default();
                scenes.entry(run.is.case.clone()).or_insert_with(|| run.is.run.clone());
            }
        }
        Idle(idle)
    }
}

/// Kind and name of a part of the program.
type Part = (&'static str, String);

/// Parts of the program that no exact solution exercised, with a run of each scene that uses them.
struct Idle(BTreeMap<Part, BTreeMap<String, String>>);

impl Idle {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn table(&self) -> Table {
        let mut table = Table::new(
            "not-exercised",
            "Not exercised by an exact solution",
            "Laws, methods and stages (contact, friction, time steps, ...) that runs of this folder use and that no run \
             with an exact solution and a passed check of its error uses. Each part is judged alone: a combination of \
             parts may be new although each of them is exercised",
            &[("kind", Words), ("part", Words), ("scenes", Words), ("runs", Words)],
        );
        for ((kind, name), scenes) in &self.0 {
            let joined = |texts: Vec<&str>| texts.join(" ");
            table.row(&[
                Cell::Text(kind),
                Cell::Text(name),
                Cell::Text(&joined(scenes.keys().map(String::as_str).collect())),
                Cell::Text(&joined(scenes.values().map(String::as_str).collect())),
            ]);
        }
        table
    }
}

/// Parts of the program that the settings of a run choose.
fn settings(run: &Run) -> impl Iterator<Item = Part> {
    let is = run.is;
    let law = is.law.clone().unwrap_or_else(|| LINEAR.into());
    let chosen = [
        ("basis", is.basis.clone()),
        ("dilation", is.dilation.clone()),
        ("essential conditions", is.essential.clone()),
        ("external solver", is.adapter.clone()),
        ("force kernel", is.force_kernel.clone()),
        ("integration", is.integration.clone()),
        ("linear solver", is.linear_solver.clone()),
        ("mass", is.mass.clone()),
    ];
    let chosen = chosen.into_iter().filter_map(|(kind, name)| Some((kind, name?)));
    [("law", law), ("element or kernel", is.variant.clone())].into_iter().chain(chosen)
}

/// Ids of runs, as they are in the records.
pub(super) fn ids(runs: &[Run]) -> String {
    runs.iter().map(|run| run.is.run.as_str()).collect::<Vec<_>>().join(" ")
}

/// Table of the build and the machine.
fn build(set: &RunSet) -> Table {
    let (program, machine) = (&set.provenance.program, &set.provenance.machine);
    let mut table = Table::new(
        "build",
        "Program and machine",
        "The build that computed the numbers, as in provenance.json",
        &[("part", Words), ("value", Words)],
    );
    let threads = machine.threads.to_string();
    let (commit, processor) = (program.revision(), machine.processor());
    let altered = set.provenance.set.join(", ");
    for (part, value) in [
        ("program", "tissuebench"),
        ("version", &program.version),
        ("commit (+: changed since)", &commit),
        ("compiler", &program.rustc),
        ("target", &program.target),
        ("build profile", &program.profile),
        ("processor", &processor),
        ("threads", &threads),
        ("study or scene", &set.provenance.source),
        ("keys set from outside", if altered.is_empty() { "none" } else { &altered }),
    ] {
        table.row(&[Cell::Text(part), Cell::Text(value)]);
    }
    table
}
