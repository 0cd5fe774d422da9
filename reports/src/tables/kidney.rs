//! Our kidney numbers beside the published ones.

use crate::paper::{EFG_NODES, FE_NODES, PUBLISHED, Published};
use crate::select::Run;
use crate::table::Column::{Number, Words};
use crate::table::{Cell, Table};

/// A published number and ours.
pub(crate) struct Pair<'a, 'r> {
    pub(crate) paper: &'static Published,
    pub(crate) run: &'a Run<'r>,
    /// SI.
    pub(crate) ours: Option<f64>,
}

impl Pair<'_, '_> {
    /// Whether the number is a time.
    pub(crate) fn is_time(&self) -> bool {
        !["max-", "rms-", "elements"].iter().any(|start| self.paper.quantity.starts_with(start))
    }

    /// How many times faster, for times.
    pub(crate) fn speed_up(&self) -> Option<f64> {
        self.ours.filter(|v| self.is_time() && *v > 0.0).map(|v| self.paper.value / v)
    }
}

/// Published numbers beside every run that matches the published discretisation best: finite elements near 1330 nodes of each element,
/// EFG at 83 nodes (the cubic spline first).
pub(crate) fn pairs<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<Pair<'a, 'r>> {
    let paper_case = |r: &&Run| r.is.case.contains("kidney") && r.is.case.contains("paper");
    let mut kidney: Vec<&Run> = runs.iter().filter(paper_case).collect();
    if kidney.is_empty() {
        kidney = runs.iter().filter(|r| r.is.case.contains("kidney")).collect();
    }
    let near = |r: &Run, nodes: u64| r.is.nodes.abs_diff(nodes) * 50 <= nodes;
    let mut fe: Vec<&Run> = Vec::new();
    for run in kidney.iter().filter(|r| r.is.family == "fem" && near(r, FE_NODES)) {
        if fe.iter().all(|f| f.is.method != run.is.method) {
            fe.push(run);
        }
    }
    let clouds: Vec<&Run> =
        kidney.iter().filter(|r| r.is.family == "efg" && near(r, EFG_NODES)).copied().collect();
    let efg = clouds.iter().find(|r| r.is.variant == "cubic-spline").or(clouds.first());
    let mut out = Vec::new();
    for paper in &PUBLISHED {
        let matching: Vec<&Run> =
            if paper.family == "fem" { fe.clone() } else { efg.iter().map(|r| **r).collect() };
        out.extend(matching.into_iter().map(|run| Pair { paper, run, ours: ours(run, paper.quantity) }));
    }
    out
}

fn ours(run: &Run, quantity: &str) -> Option<f64> {
    let directions =
        || ["rms-x", "rms-y", "rms-z"].map(|q| run.value(q)).into_iter().collect::<Option<Vec<f64>>>();
    match quantity {
        "total" => run.total(),
        "elements" => Some(run.is.elements as f64).filter(|n| *n > 0.0),
        "rms-least" => directions().map(|d| d.into_iter().fold(f64::MAX, f64::min)),
        "rms-most" => directions().map(|d| d.into_iter().fold(0.0, f64::max)),
        q if q.starts_with("max-") || q.starts_with("rms-") => run.value(q),
        phases => phases.split('+').map(|phase| run.time(phase, "median")).sum(),
    }
}

/// The table: value, place, ours, and how many times faster.
pub(super) fn beside_the_paper(runs: &[Run]) -> Table {
    let caption = "Published numbers with the place where they stand, and ours for the matching discretisation. The published RMS compares EFG with its own FE, \
                   ours compares with the case's reference. Ours is linear elastic, and geometry and supports are a reading of the publication, not an identification";
    let mut table = Table::new(
        "kidney",
        "Kidney and grasper beside the publication",
        caption,
        &[
            ("number", Words),
            ("unit", Words),
            ("published", Number),
            ("place", Words),
            ("our method", Words),
            ("nodes", Number),
            ("ours", Number),
            ("times faster [1]", Number),
        ],
    );
    for pair in pairs(runs) {
        let (unit, scale) = match pair.paper.quantity {
            "elements" => ("1", 1.0),
            _ if pair.is_time() => ("s", 1.0),
            _ => ("mm", 1e3),
        };
        let ours = match pair.paper.quantity {
            "elements" => pair.ours.map_or(Cell::Digits(None, 1), |n| Cell::Count(n as u64)),
            _ => Cell::Digits(pair.ours.map(|v| v * scale), 3),
        };
        table.row(&[
            Cell::Text(pair.paper.what),
            Cell::Text(unit),
            Cell::Digits(Some(pair.paper.value * scale), pair.paper.digits),
            Cell::Text(pair.paper.place),
            Cell::Text(&pair.run.is.method),
            Cell::Count(pair.run.is.nodes),
            ours,
            Cell::Digits(pair.speed_up(), 2),
        ]);
    }
    table
}
