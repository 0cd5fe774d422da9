//! Studies: many checked runs with their folder of results.

use std::io::{self, Write};
use std::path::PathBuf;

use cases::scene;
use harness::study::{Events, Filters, FinishedStudy, StudyPlan, VerifyArgs};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use records::Status;

use crate::error::{input, of_failure, of_scene};
use crate::table::Table;
use crate::worker::{Reporter, wait};

/// A finished study.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Study {
    finished: FinishedStudy,
}

/// Events as lines of text, passed on to the waiting thread.
struct Lines {
    reporter: Reporter,
    line: Vec<u8>,
}

impl Write for Lines {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.line.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if let Ok(event) = serde_json::from_slice(&self.line) {
            self.reporter.send(event);
        }
        self.line.clear();
        Ok(())
    }
}

#[pymethods]
impl Study {
    #[getter]
    fn records(&self, py: Python<'_>) -> PyResult<Table> {
        Table::of(py, &self.finished.set.records)
    }

    /// Whether every check passed that is expected to pass, and every run has results.
    #[getter]
    fn ok(&self) -> bool {
        let held = |status| matches!(status, Status::Pass | Status::KnownFailure);
        self.finished.failed.is_empty() && self.finished.set.checks.iter().all(|check| held(check.status))
    }

    #[getter]
    fn checks<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let one = |check: &records::Check| {
            let row = PyDict::new(py);
            row.set_item("case", &check.case)?;
            row.set_item("method", &check.method)?;
            row.set_item("metric", &check.metric)?;
            row.set_item("value", check.value)?;
            row.set_item("bound", &check.bound)?;
            row.set_item("status", check.status.name())?;
            row.set_item("reason", &check.reason)?;
            Ok(row)
        };
        self.finished.set.checks.iter().map(one).collect()
    }

    /// Runs that failed or ended early: `(case, method, reason)`.
    #[getter]
    fn failures(&self) -> Vec<(String, String, String)> {
        let all = self.finished.set.failures.iter();
        all.map(|run| (run.case.clone(), run.method.clone(), run.reason.clone())).collect()
    }

    fn __len__(&self) -> usize {
        self.finished.ran
    }
}

/// Runs a study, and writes its results and the report to a folder.
#[pyfunction]
#[pyo3(signature = (study, *, out = PathBuf::from("results"), quick = false, cases = vec![], methods = vec![], tags = vec![],
    leave_out = vec![], resume = false, jobs = 1, force = false, progress = None),
    text_signature = "(study, *, out='results', quick=False, cases=(), methods=(), tags=(), leave_out=(), resume=False, jobs=1, \
                      force=False, progress=None)")]
pub(crate) fn verify(
    py: Python<'_>,
    study: PathBuf,
    out: PathBuf,
    quick: bool,
    cases: Vec<String>,
    methods: Vec<String>,
    tags: Vec<String>,
    leave_out: Vec<String>,
    resume: bool,
    jobs: u16,
    force: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Study> {
    if !(1..=1024).contains(&jobs) {
        return Err(input(py, &format!("jobs: {jobs}; give 1 to 1024")));
    }
    let filters = Filters { cases, methods, tags, not: leave_out };
    let args = VerifyArgs { out, quick, filters, resume, jobs, force, quiet: true, ..VerifyArgs::of(&study) };
    let read = scene::load_study(&study).and_then(StudyPlan::new);
    let mut plan = read.map_err(|errors| of_scene(py, &errors))?;
    plan.select(&args);
    if plan.is_empty() {
        return Err(input(py, &format!("{}: no run matches the selection", study.display())));
    }
    let finished = wait(py, progress, move |watch, reporter| {
        plan.watched_by(watch.clone());
        let events = Events::new(Box::new(Lines { reporter: reporter.clone(), line: Vec::new() }));
        plan.execute_in_folder(&args, &study, Some(&events))
    })?;
    finished.map(|finished| Study { finished }).map_err(|failure| of_failure(py, &failure))
}
