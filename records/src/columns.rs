//! Records as the columns of a data frame, named like their fields.

use polars::prelude::*;
use serde::Serialize;

use crate::record::{Family, Purpose, Record};

/// A type of field, whose values become a column.
trait Field {
    fn column(name: &str, values: &[&Self]) -> Column;

    /// The field, if it holds any text.
    fn text(&mut self) -> Option<&mut String> {
        None
    }
}

impl Field for String {
    fn column(name: &str, values: &[&Self]) -> Column {
        let texts: Vec<&str> = values.iter().map(|text| text.as_str()).collect();
        Column::new(name.into(), texts)
    }

    fn text(&mut self) -> Option<&mut String> {
        Some(self)
    }
}

impl Field for Option<String> {
    fn column(name: &str, values: &[&Self]) -> Column {
        let texts: Vec<Option<&str>> = values.iter().map(|text| text.as_deref()).collect();
        Column::new(name.into(), texts)
    }

    fn text(&mut self) -> Option<&mut String> {
        self.as_mut()
    }
}

/// Fields of numbers and truth values.
macro_rules! plain {
    ($($kind:ty),*) => {$(
        impl Field for $kind {
            fn column(name: &str, values: &[&Self]) -> Column {
                let values: Vec<$kind> = values.iter().map(|value| **value).collect();
                Column::new(name.into(), values)
            }
        }
    )*};
}
plain!(f64, Option<f64>, u64, Option<u64>, u32, Option<bool>);

/// Word of a field in files.
fn word(value: &impl Serialize) -> String {
    let written = serde_json::to_value(value).expect("a word has no keys to be written");
    written.as_str().expect("its variants are words").to_string()
}

/// Fields whose values are words.
macro_rules! words {
    ($($kind:ty),*) => {$(
        impl Field for $kind {
            fn column(name: &str, values: &[&Self]) -> Column {
                let words: Vec<String> = values.iter().map(|value| word(value)).collect();
                Column::new(name.into(), words)
            }
        }
    )*};
}
words!(Family, Purpose);

macro_rules! columns {
    ($($field:ident),* $(,)?) => {
        /// The columns of `records`, one for each field, in the order of the stored table.
        pub(crate) fn of(records: &[Record]) -> Vec<Column> {
            vec![$(Field::column(stringify!($field), &records.iter().map(|r| &r.$field).collect::<Vec<_>>())),*]
        }

        /// All texts of a record.
        pub(crate) fn texts(record: &mut Record) -> impl Iterator<Item = &mut String> {
            [$(record.$field.text()),*].into_iter().flatten()
        }
    };
}
columns!(
    run,
    case,
    purpose,
    published,
    method,
    series,
    family,
    variant,
    basis,
    support_scale,
    neighbours,
    neighbour_factor,
    neighbourhood,
    gamma,
    kernel,
    dilation,
    integration,
    essential,
    refine,
    split,
    law,
    mass,
    from,
    power,
    shape,
    polynomial,
    force_kernel,
    adapter,
    lane_path,
    linear_solver,
    axis,
    at,
    poisson,
    level,
    nodes,
    elements,
    points,
    dofs,
    spacing,
    seed,
    quantity,
    component,
    index,
    unit,
    phase,
    step,
    mode,
    statistic,
    repeat,
    value,
);
