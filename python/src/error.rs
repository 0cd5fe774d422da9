//! Errors as exceptions, with their location in the file.

use cases::scene::{ErrorKind, SceneError};
use harness::Failure;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyList, PyType};

/// Builds an exception of a class in `tissuebench._errors`, with the known part of its location.
fn exception(py: Python<'_>, class: &str, message: String, error: Option<&SceneError>) -> PyErr {
    static INPUT: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    static RUN: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let cell = if class == "SceneError" { &INPUT } else { &RUN };
    let made = || -> PyResult<Bound<'_, PyAny>> {
        let about = PyDict::new(py);
        if let Some(error) = error {
            let number = |n: usize| (n > 0).then_some(n);
            about.set_item("file", &error.file)?;
            about.set_item("line", number(error.line))?;
            about.set_item("column", number(error.column))?;
            about.set_item("key", (!error.key.is_empty()).then_some(&error.key))?;
            about.set_item("found", &error.found)?;
            about.set_item("problem", &error.problem)?;
            about.set_item("help", &error.help)?;
        }
        cell.import(py, "tissuebench._errors", class)?.call((message,), Some(&about))
    };
    made().map_or_else(|bad| bad, PyErr::from_value)
}

/// Builds an exception for invalid input.
pub(crate) fn input(py: Python<'_>, problem: &str) -> PyErr {
    exception(py, "SceneError", problem.into(), None)
}

/// Builds an exception for a failure to run, read or write.
pub(crate) fn not_run(py: Python<'_>, problem: impl ToString) -> PyErr {
    exception(py, "RunError", problem.to_string(), None)
}

/// Builds an exception for all errors of a file. It belongs to the first error and has the text of all; each
/// error is in its `errors`.
pub(crate) fn of_scene(py: Python<'_>, errors: &[SceneError]) -> PyErr {
    let class = |invalid: bool| if invalid { "SceneError" } else { "RunError" };
    let is_invalid = |error: &SceneError| error.kind == ErrorKind::Invalid;
    let text = errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    let all = exception(py, class(errors.iter().any(is_invalid)), text, errors.first());
    let each = |error: &SceneError| exception(py, class(is_invalid(error)), error.to_string(), Some(error));
    let list = PyList::new(py, errors.iter().map(|error| each(error).into_value(py)));
    match list.and_then(|list| all.value(py).setattr("_errors", list)) {
        Ok(()) => all,
        Err(bad) => bad,
    }
}

/// Builds an exception for a failed run.
pub(crate) fn of_failure(py: Python<'_>, failure: &Failure) -> PyErr {
    let class = if failure.exit_code() == 2 { "SceneError" } else { "RunError" };
    let error = match failure {
        Failure::Scene(error) => Some(&**error),
        _ => None,
    };
    exception(py, class, failure.to_string(), error)
}
