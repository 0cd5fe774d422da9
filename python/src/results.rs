//! Results of several methods of a scene, and their folder of results.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use cases::scene;
use harness::outcome::{Outcome, Unfinished, provenance};
use harness::run::case_name;
use harness::study::{check, compared_with, failed, reference_records, stalled, warn_if_busy};
use pyo3::prelude::*;
use records::{Failure as FailedRun, Machine, Record, RunSet};

use crate::error::{input, not_run, of_failure};
use crate::run::Run;
use crate::table::Table;
use crate::worker::unforked;

/// Result of a method.
pub(crate) type Ended = Result<Outcome, Unfinished>;

/// Runs of one scene.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Results {
    scene: Arc<scene::Scene>,
    machine: Machine,
    finished: Mutex<Vec<Arc<Outcome>>>,
    failed: Vec<(String, harness::Failure, FailedRun)>,
}

impl Results {
    pub(crate) fn new(
        scene: Arc<scene::Scene>,
        machine: Machine,
        ended: Vec<(scene::Method, Ended)>,
    ) -> Results {
        let case = case_name(&scene);
        let (mut finished, mut without) = (Vec::new(), Vec::new());
        for (method, one) in ended {
            match one {
                Ok(outcome) => finished.push(Arc::new(outcome)),
                Err(bad) => {
                    let row = failed(&case, &method, &bad.failure);
                    without.push((method.id, bad.failure, row));
                }
            }
        }
        Results { scene, machine, finished: Mutex::new(finished), failed: without }
    }

    fn finished(&self) -> Vec<Arc<Outcome>> {
        self.finished.lock().expect("no thread panicked").clone()
    }

    /// Returns a method's run, or its failure.
    pub(crate) fn run(&self, py: Python<'_>, method: &str) -> PyResult<Run> {
        if let Some(outcome) = self.finished().iter().find(|outcome| outcome.identity.method == method) {
            return Ok(Run { scene: self.scene.clone(), outcome: outcome.clone() });
        }
        match self.failed.iter().find(|(id, ..)| id == method) {
            Some((_, failure, _)) => Err(of_failure(py, failure)),
            None => Err(pyo3::exceptions::PyKeyError::new_err(method.to_string())),
        }
    }

    /// Returns all records, including those of a stored reference.
    fn all_records(&self) -> Vec<Record> {
        let mut records: Vec<Record> = self.finished().iter().flat_map(|outcome| outcome.records()).collect();
        records.extend(reference_records(&self.scene));
        records
    }

    /// Returns the complete content of a folder of results.
    fn set(&self, case: String) -> RunSet {
        let mut set = RunSet { records: self.all_records(), ..RunSet::default() };
        for outcome in self.finished() {
            let method = &outcome.identity.method;
            let records = outcome.records();
            let own = |c: &&scene::Check| c.methods.is_empty() || c.methods.contains(method);
            for check in self.scene.checks.iter().filter(own).filter(|c| !check::is_of_many(c)) {
                let of = check.address;
                let value = check::value(of, &records);
                let band = check::band(of, &records);
                set.checks.push(check::judge(check, &case, method, value, band));
            }
            set.plans.extend(outcome.plan_entries());
            set.warnings.extend(outcome.warning_rows());
            compared_with(&mut set, outcome.reference.as_ref());
            set.fields.extend(outcome.field.clone());
            set.failures.extend(outcome.stalled.as_ref().map(|failure| stalled(&outcome, failure)));
        }
        set.failures.extend(self.failed.iter().map(|(_, _, row)| row.clone()));
        set.provenance =
            provenance::provenance(self.machine.clone(), &[(case, self.scene.text().to_string())]);
        let name = Path::new(self.scene.file()).file_name();
        set.provenance.source = name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        warn_if_busy(&mut set);
        set
    }
}

/// Returns the columns of a record that identify its run.
fn id(outcome: &Outcome) -> Option<String> {
    outcome.records().first().map(|record| record.run.clone())
}

#[pymethods]
impl Results {
    #[getter]
    fn runs(&self) -> Vec<Run> {
        self.finished().into_iter().map(|outcome| Run { scene: self.scene.clone(), outcome }).collect()
    }

    /// Methods without results, with their errors.
    #[getter]
    fn failures<'py>(&self, py: Python<'py>) -> Vec<(String, Bound<'py, PyAny>)> {
        let one = |failure| of_failure(py, failure).into_value(py).into_bound(py).into_any();
        self.failed.iter().map(|(id, failure, _)| (id.clone(), one(failure))).collect()
    }

    fn __getitem__(&self, py: Python<'_>, method: &str) -> PyResult<Run> {
        self.run(py, method)
    }

    fn __len__(&self) -> usize {
        self.finished().len()
    }

    #[getter]
    fn records(&self, py: Python<'_>) -> PyResult<Table> {
        Table::of(py, &self.all_records())
    }

    /// Adds a run of the same scene, for example the result of the user's own solver.
    fn add(&self, py: Python<'_>, run: &Run) -> PyResult<()> {
        let (case, other) = (case_name(&self.scene), &run.outcome.identity.case);
        if case != *other {
            return Err(input(py, &format!("the run belongs to {other}, but the results belong to {case}")));
        }
        if run.scene.text() != self.scene.text() {
            let (a, b) = (run.scene.file(), self.scene.file());
            return Err(input(
                py,
                &format!("the run belongs to another scene with the name {case} ({a}, {b})"),
            ));
        }
        let mut finished = self.finished.lock().expect("no thread panicked");
        if finished.iter().any(|known| id(known) == id(&run.outcome)) {
            let problem =
                format!("the results already have a run of {}; give the solver another name", run.label());
            return Err(input(py, &problem));
        }
        finished.push(run.outcome.clone());
        Ok(())
    }

    /// Writes a folder of results with its report.
    fn write(&self, py: Python<'_>, out: PathBuf) -> PyResult<()> {
        unforked(py)?;
        let written = py
            .detach(|| reports::write_with_report(&out, &self.set(case_name(&self.scene)), None).map(|_| ()));
        written.map_err(|bad| not_run(py, bad))
    }
}
