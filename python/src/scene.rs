//! Scenes: reading, running, and export as problems for other solvers.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use cases::scene::{self, Family};
use harness::outcome::{Watch, provenance};
use harness::run;
use harness::run::{Group, Repeats, RunOptions};
use pyo3::prelude::*;
use serde_json::json;

use crate::error::{input, not_run, of_failure, of_scene};
use crate::problem::Problem;
use crate::reference::Referenced;
use crate::results::{Ended, Results};
use crate::run::Run;
use crate::worker::{Reporter, wait};

/// Number of repeats of a timing, as in `tissuebench run`.
const REPEATS: Repeats = Repeats { most: 5, seconds: 1.0 };

/// A checked scene.
#[pyclass(frozen, module = "tissuebench")]
pub(crate) struct Scene {
    scene: Arc<scene::Scene>,
    reference: Arc<Referenced>,
}

/// Options shared by all runs of a call.
#[derive(Clone, Copy)]
struct Asked {
    repeats: Repeats,
    options: RunOptions,
}

impl Scene {
    fn of(py: Python<'_>, read: Result<scene::Scene, Vec<scene::SceneError>>) -> PyResult<Scene> {
        let scene = read.map_err(|errors| of_scene(py, &errors))?;
        let ahead = scene.unavailable();
        if !ahead.is_empty() {
            return Err(of_scene(py, &ahead));
        }
        let scene = Arc::new(scene);
        Ok(Scene { reference: Referenced::new(scene.clone()), scene })
    }

    /// Returns a method that this process can run.
    fn method(&self, py: Python<'_>, id: &str) -> PyResult<scene::Method> {
        let Some(method) = self.scene.method(id) else {
            let known = self.methods().join(", ");
            return Err(input(
                py,
                &format!("{}: no method '{id}'; known methods are {known}", self.scene.file()),
            ));
        };
        if matches!(method.family, Family::External(_)) {
            let problem =
                format!("method '{id}' uses an adapter: run the method with the command tissuebench");
            return Err(not_run(py, problem));
        }
        Ok(method.clone())
    }

    fn ran(
        &self,
        py: Python<'_>,
        methods: Vec<scene::Method>,
        asked: Asked,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Results> {
        let machine = provenance::machine();
        let reference = self.reference.clone();
        let case = run::case_name(&self.scene);
        let ended = wait(py, progress, move |watch, reporter| {
            reporter.send(json!({ "event": "begin", "case": case, "runs": methods.len() }));
            reference.with(asked.repeats, watch, |group| all(group, &case, methods, asked, watch, reporter))
        })?;
        let ended = ended.map_err(|failure| of_failure(py, &failure))?;
        Ok(Results::new(self.scene.clone(), machine, ended))
    }
}

/// Runs methods one after the other.
fn all(
    group: &Group,
    case: &str,
    methods: Vec<scene::Method>,
    asked: Asked,
    watch: &Arc<Watch>,
    reporter: &Reporter,
) -> Vec<(scene::Method, Ended)> {
    let mut ended = Vec::new();
    for method in methods {
        if watch.is_stopped() {
            break;
        }
        reporter.send(json!({ "event": "start", "case": case, "method": method.id, "run": ended.len() }));
        let one = group.run(&group.scenario(method.clone(), 0), asked.options);
        reporter.send(match &one {
            Ok(_) => json!({ "event": "done", "case": case, "method": method.id, "run": ended.len() }),
            Err(bad) => json!({ "event": "failed", "case": case, "method": method.id, "run": ended.len(), "reason": bad.failure.to_string() }),
        });
        ended.push((method, one));
    }
    ended
}

fn asked(once: bool, states: bool, frames: bool) -> Asked {
    let options = RunOptions { picture: true, states, frames, split: None };
    Asked { repeats: if once { Repeats::ONCE } else { REPEATS }, options }
}

#[pymethods]
impl Scene {
    #[getter]
    fn file(&self) -> &str {
        self.scene.file()
    }

    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    #[getter]
    fn methods(&self) -> Vec<String> {
        self.scene.methods.iter().map(|method| method.id.clone()).collect()
    }

    /// Runs one method; a failure raises an exception.
    #[pyo3(signature = (method, *, once = true, states = false, frames = false, progress = None))]
    fn run(
        &self,
        py: Python<'_>,
        method: &str,
        once: bool,
        states: bool,
        frames: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Run> {
        let results = self.ran(py, vec![self.method(py, method)?], asked(once, states, frames), progress)?;
        results.run(py, method)
    }

    /// Runs some or all methods; the failure of a method is stored among the results.
    #[pyo3(signature = (methods = None, *, once = false, states = false, frames = true, progress = None))]
    fn run_all(
        &self,
        py: Python<'_>,
        methods: Option<Vec<String>>,
        once: bool,
        states: bool,
        frames: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Results> {
        let own = || {
            let foreign = |m: &&scene::Method| !matches!(m.family, Family::External(_));
            self.scene.methods.iter().filter(foreign).map(|m| m.id.clone()).collect()
        };
        let ids: Vec<String> = methods.unwrap_or_else(own);
        let methods = ids.iter().map(|id| self.method(py, id)).collect::<PyResult<_>>()?;
        self.ran(py, methods, asked(once, states, frames), progress)
    }

    /// Returns a method's problem with its tables, for the user's own solver.
    fn problem(&self, py: Python<'_>, method: &str) -> PyResult<Problem> {
        Problem::new(py, self.scene.clone(), self.reference.clone(), self.method(py, method)?)
    }

    fn __repr__(&self) -> String {
        format!("<tissuebench.Scene: {}, {} methods>", self.scene.title, self.scene.methods.len())
    }
}

/// Reads the scene in a file.
#[pyfunction]
pub(crate) fn load(py: Python<'_>, path: PathBuf) -> PyResult<Scene> {
    Scene::of(py, scene::load(&path))
}

/// Reads a scene from text; `file` is its name in messages, and paths in the scene are relative to the folder
/// of `file`.
#[pyfunction]
#[pyo3(signature = (text, file = PathBuf::from("scene.toml")), text_signature = "(text, file='scene.toml')")]
pub(crate) fn parse(py: Python<'_>, text: &str, file: PathBuf) -> PyResult<Scene> {
    Scene::of(py, scene::parse(text, &Path::new(&file).display().to_string()))
}
