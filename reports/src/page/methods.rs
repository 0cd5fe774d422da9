//! Methods and runs that occur in the page, without duplicates.

use std::collections::{BTreeMap, HashMap};

use catalogue::metric::{
    ENERGY, L2, Metric, PEAK_ERROR, PENETRATION, PRESSURE, RELATIVE_RMS, TOOL_FORCE_ERROR,
};
use plotters::style::RGBColor;
use records::Family;
use serde::Serialize;

use crate::appearance::{Look, MARKERS, distinct};
use crate::quantity::{scale, unit};
use crate::select::{Run, by_material, labels};

/// Appearance of a label.
#[derive(Serialize)]
pub(super) struct LookView {
    colour: String,
    marker: &'static str,
    dash: &'static [f64],
    open: bool,
    family: Family,
}

impl LookView {
    fn new(look: Look, family: Family) -> LookView {
        let RGBColor(red, green, blue) = look.colour;
        LookView {
            colour: format!("#{red:02x}{green:02x}{blue:02x}"),
            marker: MARKERS[look.marker],
            dash: look.dash,
            open: look.open,
            family,
        }
    }
}

/// Data of the runs, one column per property.
#[derive(Default, Serialize)]
pub(super) struct RunColumns {
    id: Vec<String>,
    case: Vec<String>,
    method: Vec<String>,
    label: Vec<usize>,
    poisson: Vec<f64>,
    nodes: Vec<u64>,
    elements: Vec<u64>,
    dofs: Vec<u64>,
    settings: Vec<String>,
    solver: Vec<String>,
    seconds: Vec<Option<f32>>,
    first_use: Vec<Option<f32>>,
    memory: Vec<Option<f64>>,
    errors: BTreeMap<&'static str, ErrorColumn>,
}

/// Values of a metric, one per run, in the unit in which they are shown; `1` for relative errors.
#[derive(Serialize)]
struct ErrorColumn {
    unit: &'static str,
    values: Vec<Option<f32>>,
}

/// Errors in the description of a run.
const ERRORS: [&Metric; 7] =
    [&L2, &RELATIVE_RMS, &ENERGY, &PRESSURE, &TOOL_FORCE_ERROR, &PEAK_ERROR, &PENETRATION];

/// Collector of labels and runs.
pub(super) struct Methods {
    labels: Vec<(String, Family)>,
    runs: RunColumns,
    index: HashMap<String, usize>,
}

impl Methods {
    /// Creates a collector with the runs that may occur.
    pub(super) fn new(runs: &[Run]) -> Methods {
        let mut all = Methods { labels: Vec::new(), runs: RunColumns::default(), index: HashMap::new() };
        for group in by_material(runs) {
            for (run, label) in group.iter().zip(labels(group.iter().map(|r| r.is))) {
                all.push(run, &label);
            }
        }
        all.runs.errors.retain(|_, error| error.values.iter().any(Option::is_some));
        all
    }

    fn push(&mut self, run: &Run, label: &str) {
        let (is, at) = (run.is, self.runs.id.len());
        self.index.insert(is.run.clone(), at);
        let label = self.label(label, is.family);
        let settings: Vec<String> =
            is.settings().into_iter().map(|(name, value)| format!("{name} {value}")).collect();
        let runs = &mut self.runs;
        runs.id.push(is.run.clone());
        runs.case.push(is.case.clone());
        runs.method.push(is.method.clone());
        runs.label.push(label);
        runs.poisson.push(is.poisson);
        runs.nodes.push(is.nodes);
        runs.elements.push(is.elements);
        runs.dofs.push(is.dofs);
        runs.settings.push(settings.join(", "));
        runs.solver.push(is.linear_solver.clone().unwrap_or_default());
        runs.seconds.push(run.total().map(|t| t as f32));
        runs.first_use.push(run.first_use().map(|t| t as f32));
        runs.memory.push(run.memory());
        for error in ERRORS {
            let of = error.whole();
            let column = || ErrorColumn { unit: unit(of), values: Vec::new() };
            let value = run.value(of).map(|v| (scale(of) * v) as f32);
            runs.errors.entry(error.name).or_insert_with(column).values.push(value);
        }
    }

    /// Index of a label, added if it is new.
    pub(super) fn label(&mut self, label: &str, family: Family) -> usize {
        self.labels.iter().position(|l| l.0 == label).unwrap_or_else(|| {
            self.labels.push((label.into(), family));
            self.labels.len() - 1
        })
    }

    /// Index of a run.
    pub(super) fn run(&self, id: &str) -> Option<usize> {
        self.index.get(id).copied()
    }

    /// Returns looks, labels and runs. Labels that occur in one of the `figures` have distinct looks.
    pub(super) fn into_parts(
        self,
        figures: &[Vec<usize>],
    ) -> (BTreeMap<String, LookView>, Vec<String>, RunColumns) {
        let together = |i: usize, j: usize| figures.iter().any(|f| f.contains(&i) && f.contains(&j));
        let looks = distinct(&self.labels, together);
        let view = |((label, family), look): (&(String, Family), Look)| {
            (label.clone(), LookView::new(look, *family))
        };
        let looks = self.labels.iter().zip(looks).map(view).collect();
        (looks, self.labels.into_iter().map(|l| l.0).collect(), self.runs)
    }
}
