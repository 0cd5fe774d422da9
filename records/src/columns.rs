//! Records as columns of a data frame, and back. The names of the columns are those of the fields.

use polars::prelude::*;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::Error as WordError;

use crate::record::{Family, Purpose, Record};

/// A type of field: how its values become a column and are read from one.
trait Field: Sized {
    fn column(name: &str, values: &[&Self]) -> Column;
    fn read(column: &Column) -> PolarsResult<Vec<Self>>;
}

/// An error that names the first row without a value in a column that has no empty cells.
fn empty(column: &Column) -> PolarsError {
    PolarsError::ComputeError(format!("column {} has an empty cell", column.name()).into())
}

fn whole<T>(column: &Column, values: impl Iterator<Item = Option<T>>) -> PolarsResult<Vec<T>> {
    values.map(|value| value.ok_or_else(|| empty(column))).collect()
}

impl Field for String {
    fn column(name: &str, values: &[&Self]) -> Column {
        let texts: Vec<&str> = values.iter().map(|text| text.as_str()).collect();
        Column::new(name.into(), texts)
    }
    fn read(column: &Column) -> PolarsResult<Vec<Self>> {
        whole(column, column.str()?.iter().map(|text| text.map(String::from)))
    }
}

impl Field for Option<String> {
    fn column(name: &str, values: &[&Self]) -> Column {
        let texts: Vec<Option<&str>> = values.iter().map(|text| text.as_deref()).collect();
        Column::new(name.into(), texts)
    }
    fn read(column: &Column) -> PolarsResult<Vec<Self>> {
        Ok(column.str()?.iter().map(|text| text.map(String::from)).collect())
    }
}

/// Fields of numbers and truth values, with the method that gives a column of theirs.
macro_rules! plain {
    ($($kind:ty, $of:ident);*) => {$(
        impl Field for $kind {
            fn column(name: &str, values: &[&Self]) -> Column {
                let values: Vec<$kind> = values.iter().map(|value| **value).collect();
                Column::new(name.into(), values)
            }
            fn read(column: &Column) -> PolarsResult<Vec<Self>> {
                whole(column, column.$of()?.iter())
            }
        }
        impl Field for Option<$kind> {
            fn column(name: &str, values: &[&Self]) -> Column {
                let values: Vec<Option<$kind>> = values.iter().map(|value| **value).collect();
                Column::new(name.into(), values)
            }
            fn read(column: &Column) -> PolarsResult<Vec<Self>> {
                Ok(column.$of()?.iter().collect())
            }
        }
    )*};
}
plain!(f64, f64; u64, u64; u32, u32; bool, bool);

/// Fields that are one of several words.
macro_rules! words {
    ($($kind:ty),*) => {$(
        impl Field for $kind {
            fn column(name: &str, values: &[&Self]) -> Column {
                let words: Vec<&str> = values.iter().map(|value| value.name()).collect();
                Column::new(name.into(), words)
            }
            fn read(column: &Column) -> PolarsResult<Vec<Self>> {
                let read = |word: Option<&str>| {
                    let word: &str = word.ok_or_else(|| empty(column))?;
                    let unknown = |bad: WordError| PolarsError::ComputeError(bad.to_string().into());
                    Self::deserialize(word.into_deserializer()).map_err(unknown)
                };
                column.str()?.iter().map(read).collect()
            }
        }
    )*};
}
words!(Family, Purpose);

/// Both ways for all fields of a record, in the order of the stored table.
macro_rules! columns {
    ($($field:ident),* $(,)?) => {
        /// The columns of `records`, one for each field.
        pub(crate) fn of(records: &[Record]) -> Vec<Column> {
            vec![$(Field::column(stringify!($field), &records.iter().map(|r| &r.$field).collect::<Vec<_>>())),*]
        }

        /// The records in a frame; columns that are no field of a record are left out.
        ///
        /// # Errors
        /// A column that is missing or of another type, an empty cell where a value belongs, an unknown word.
        pub(crate) fn records(frame: &DataFrame) -> PolarsResult<Vec<Record>> {
            $(let mut $field = Field::read(frame.column(stringify!($field))?)?.into_iter();)*
            let mut records = Vec::with_capacity(frame.height());
            // All columns of a frame have its height.
            while let ($(Some($field),)*) = ($($field.next(),)*) {
                records.push(Record { $($field),* });
            }
            Ok(records)
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
    unit,
    phase,
    step,
    mode,
    statistic,
    repeat,
    value,
);
