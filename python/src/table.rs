//! An Arrow table that polars, pyarrow, pandas and duckdb use without a copy.

use std::path::PathBuf;

use arrow_array::cast::AsArray;
use arrow_array::ffi::FFI_ArrowSchema;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, UInt32Type, UInt64Type};
use arrow_array::{Array, RecordBatch, RecordBatchIterator};
use arrow_schema::DataType;
use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use records::Record;

use crate::columns::batch;
use crate::error::not_run;
use crate::worker::wait;

/// Records: one number per row.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Table {
    batch: RecordBatch,
}

impl Table {
    pub(crate) fn of(py: Python<'_>, records: &[Record]) -> PyResult<Table> {
        Ok(Table { batch: batch(records).map_err(|bad| not_run(py, bad))? })
    }
}

#[pymethods]
impl Table {
    /// Exports the table through Arrow's C stream interface. It has one batch; `requested_schema` is ignored.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        // Only references to the columns are cloned.
        let batches = RecordBatchIterator::new([Ok(self.batch.clone())], self.batch.schema());
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(batches)), c"arrow_array_stream")
    }

    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema =
            FFI_ArrowSchema::try_from(self.batch.schema().as_ref()).map_err(|bad| not_run(py, bad))?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    fn __len__(&self) -> usize {
        self.batch.num_rows()
    }

    #[getter]
    fn columns(&self) -> Vec<String> {
        self.batch.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    /// Returns a column: numbers as an array with nan for missing values, texts as a list.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let column = self.batch.column_by_name(name).ok_or_else(|| PyKeyError::new_err(name.to_string()))?;
        match column.data_type() {
            DataType::Float64 => {
                let column = column.as_primitive::<Float64Type>();
                Ok(PyArray1::from_iter(py, column.iter().map(|v| v.unwrap_or(f64::NAN))).into_any())
            }
            DataType::UInt32 => {
                Ok(PyArray1::from_iter(py, column.as_primitive::<UInt32Type>().values().iter().copied())
                    .into_any())
            }
            DataType::UInt64 if column.null_count() == 0 => {
                Ok(PyArray1::from_iter(py, column.as_primitive::<UInt64Type>().values().iter().copied())
                    .into_any())
            }
            DataType::UInt64 => {
                let column = column.as_primitive::<UInt64Type>();
                Ok(PyArray1::from_iter(py, column.iter().map(|v| v.map_or(f64::NAN, |n| n as f64)))
                    .into_any())
            }
            DataType::Boolean => {
                Ok(PyList::new(py, column.as_boolean().iter().collect::<Vec<_>>())?.into_any())
            }
            _ => Ok(PyList::new(py, column.as_string_view().iter().collect::<Vec<_>>())?.into_any()),
        }
    }

    fn __repr__(&self) -> String {
        format!("<tissuebench.Table: {} records>", self.batch.num_rows())
    }
}

/// Reads the records in a folder of results.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, results: PathBuf) -> PyResult<Table> {
    let set = wait(py, None, move |_, _| records::read_run(&results))?.map_err(|bad| not_run(py, bad))?;
    Table::of(py, &set.records)
}
