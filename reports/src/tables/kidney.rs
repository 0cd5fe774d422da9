//! Our kidney numbers beside the published ones.

use crate::paper::{ABSTRACT_RMS, EFG_NODES, FE_NODES, PUBLISHED, Published};
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
        !self.paper.quantity.starts_with("max") && !self.paper.quantity.starts_with("rms")
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
    if quantity == "total" {
        return run.total();
    }
    if quantity.starts_with("max") || quantity.starts_with("rms") {
        return run.value(quantity);
    }
    quantity.split('+').map(|phase| run.time(phase, "median")).sum()
}

/// The table: value, place, ours, and how many times faster.
pub(super) fn beside_the_paper(runs: &[Run]) -> Table {
    let (low, high) = ABSTRACT_RMS;
    let caption = format!(
        "Published numbers with their place, and ours for the matching discretisation. The published abstract gives an RMS range of {} to {} mm, its text \
         other values. Our RMS is against the case's reference. Ours is linear elastic and the geometry and supports are a reading of the publication, not an identification",
        low * 1e3,
        high * 1e3
    );
    let mut table = Table::new(
        "kidney",
        "Kidney and grasper beside the publication",
        &caption,
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
        let (unit, scale) = if pair.is_time() { ("s", 1.0) } else { ("mm", 1e3) };
        table.row(&[
            Cell::Text(pair.paper.what),
            Cell::Text(unit),
            Cell::Digits(Some(pair.paper.value * scale), 3),
            Cell::Text(pair.paper.place),
            Cell::Text(&pair.run.is.method),
            Cell::Count(pair.run.is.nodes),
            Cell::Digits(pair.ours.map(|v| v * scale), 3),
            Cell::Digits(pair.speed_up(), 2),
        ]);
    }
    table
}
