//! Views of tables and stability maps, in columns.

use records::text::short;
use records::{Axis, Trial};
use serde::Serialize;

use crate::quantity::label_of_name;
use crate::table::{Column, Table};

#[derive(Serialize)]
pub(super) struct TableView<'a> {
    name: &'a str,
    title: &'a str,
    caption: &'a str,
    note: &'a str,
    columns: Vec<ColumnView<'a>>,
}

#[derive(Serialize)]
struct ColumnView<'a> {
    head: &'a str,
    number: bool,
    /// Distinct texts.
    words: Vec<&'a str>,
    /// Index of the text in each row.
    rows: Vec<usize>,
    /// Sort keys of a column of numbers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    values: Vec<Option<f64>>,
}

impl<'a> TableView<'a> {
    pub(super) fn new(table: &'a Table) -> TableView<'a> {
        let (shown, exact) = (table.shown(), table.exact());
        let column = |(k, (head, kind)): (usize, &'a (String, Column))| {
            let number = *kind != Column::Words;
            let mut words: Vec<&str> = Vec::new();
            let mut at = std::collections::HashMap::new();
            let rows = shown.iter().map(|row| {
                *at.entry(row[k]).or_insert_with(|| {
                    words.push(row[k]);
                    words.len() - 1
                })
            });
            let rows = rows.collect();
            let values = exact.iter().filter(|_| number).map(|row| row[k].parse().ok()).collect();
            ColumnView { head, number, words, rows, values }
        };
        TableView {
            name: table.name,
            title: &table.title,
            caption: &table.caption,
            note: table.note(),
            columns: table.header().iter().enumerate().map(column).collect(),
        }
    }
}

/// `(method, value, verdict, error, reason, class)`; method, value and class are indices.
type Cell = (usize, usize, &'static str, Option<f64>, String, usize);

/// View of a stability map along an axis.
#[derive(Serialize)]
pub(super) struct MapView<'a> {
    case: &'a str,
    name: &'a str,
    unit: &'a str,
    judge: String,
    base: String,
    wrong: f64,
    values: Vec<String>,
    methods: Vec<&'a str>,
    /// Names of the colours' classes.
    classes: Vec<String>,
    cells: Vec<Cell>,
}

impl<'a> MapView<'a> {
    pub(super) fn new(axis: &'a Axis) -> MapView<'a> {
        let methods = axis.methods();
        let cell = |trial: &Trial| {
            let row = methods.iter().position(|m| *m == trial.method)?;
            let column = axis.values.iter().position(|v| *v == trial.value)?;
            let why = if trial.reason.is_empty() { trial.warnings.join(", ") } else { trial.reason.clone() };
            let error = trial.error.filter(|e| e.is_finite());
            Some((row, column, axis.verdict(trial).name(), error, why, axis.class(trial)))
        };
        MapView {
            case: &axis.case,
            name: &axis.name,
            unit: &axis.unit,
            judge: label_of_name(&axis.judge),
            base: short(axis.base),
            wrong: axis.wrong,
            classes: axis.classes(),
            values: axis.values.iter().map(|v| short(*v)).collect(),
            cells: axis.trials.iter().filter_map(cell).collect(),
            methods,
        }
    }
}
