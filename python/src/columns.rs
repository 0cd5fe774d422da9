//! Records as Arrow columns, in the order of `records.csv`.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringViewArray, UInt32Array, UInt64Array};
use arrow_schema::ArrowError;
use records::Record;
use serde_json::Value;

/// Returns the word for a value in files.
fn word(value: impl serde::Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(Value::String(word)) => word,
        _ => String::new(),
    }
}

/// Builds a column of each kind: text, words of a list, optional text, numbers.
macro_rules! column {
    ($records:ident, text $name:ident) => {
        Arc::new(StringViewArray::from_iter_values($records.iter().map(|r| r.$name.as_str()))) as ArrayRef
    };
    ($records:ident, word $name:ident) => {
        Arc::new(StringViewArray::from_iter_values($records.iter().map(|r| word(r.$name)))) as ArrayRef
    };
    ($records:ident, some_text $name:ident) => {
        Arc::new(StringViewArray::from_iter($records.iter().map(|r| r.$name.as_deref()))) as ArrayRef
    };
    ($records:ident, flag $name:ident) => {
        Arc::new(arrow_array::BooleanArray::from_iter($records.iter().map(|r| r.$name))) as ArrayRef
    };
    ($records:ident, real $name:ident) => {
        Arc::new(Float64Array::from_iter_values($records.iter().map(|r| r.$name))) as ArrayRef
    };
    ($records:ident, some_real $name:ident) => {
        Arc::new(Float64Array::from_iter($records.iter().map(|r| r.$name))) as ArrayRef
    };
    ($records:ident, count $name:ident) => {
        Arc::new(UInt64Array::from_iter_values($records.iter().map(|r| r.$name))) as ArrayRef
    };
    ($records:ident, some_count $name:ident) => {
        Arc::new(UInt64Array::from_iter($records.iter().map(|r| r.$name))) as ArrayRef
    };
    ($records:ident, small $name:ident) => {
        Arc::new(UInt32Array::from_iter_values($records.iter().map(|r| r.$name))) as ArrayRef
    };
}

macro_rules! columns {
    ($records:ident: $($kind:ident $name:ident),* $(,)?) => {
        [$((stringify!($name), column!($records, $kind $name))),*]
    };
}

/// Returns all records as one batch. Texts are views, as in polars, so nothing is copied there.
pub(crate) fn batch(records: &[Record]) -> Result<RecordBatch, ArrowError> {
    RecordBatch::try_from_iter(columns! { records:
        text run, text case, word purpose, text published, text method, text series, word family, text variant,
        some_text basis, some_real support_scale, some_count neighbours, some_real neighbour_factor,
        some_text neighbourhood, some_real gamma, some_text kernel, some_text dilation, some_text integration,
        some_text essential, some_text refine, some_text split, some_text law, some_text mass, some_text from,
        some_real power, some_real shape, flag polynomial, some_text force_kernel, some_text adapter,
        some_text lane_path, some_text linear_solver, text axis, some_real at, real poisson, small level, count nodes,
        count elements, count points, count dofs, real spacing, count seed, text quantity, text component,
        some_count index, text unit, text phase,
        some_count step, some_count mode, text statistic, some_count repeat, real value,
    })
}
