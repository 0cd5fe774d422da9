//! Long work on a separate thread, while the interpreter's own thread waits, reports progress and handles
//! Ctrl-C.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use harness::outcome::{LoadStep, Watch};
use pyo3::prelude::*;
use serde_json::{Value, json};

use crate::error::not_run;

/// Time between two checks for a signal.
const LOOK: Duration = Duration::from_millis(50);

/// Message of the working thread.
enum Note {
    /// An event: an object with an `event`.
    Event(Value),
    /// End of the work.
    End,
}

/// Sender of progress events.
#[derive(Clone)]
pub(crate) struct Reporter(Sender<Note>);

impl Reporter {
    /// Reports an event; it is dropped if no thread waits any more.
    pub(crate) fn send(&self, event: Value) {
        let _ = self.0.send(Note::Event(event));
    }
}

/// Refuses work in a process that was forked after its parent had worked: the threads of the pool belong to
/// the parent, and waiting for them would never end.
///
/// # Errors
/// A `RunError` in such a process.
pub(crate) fn unforked(py: Python<'_>) -> PyResult<()> {
    static FIRST: OnceLock<u32> = OnceLock::new();
    let id = std::process::id();
    if *FIRST.get_or_init(|| id) == id {
        return Ok(());
    }
    let problem = "this process was forked after its parent had used tissuebench, and lacks the threads of \
                   tissuebench; start the process with multiprocessing.get_context(\"spawn\")";
    Err(not_run(py, problem))
}

/// Runs long work on another thread. `progress` is called on this thread with a dictionary for every event. A
/// signal, or an exception of `progress`, ends the wait at once and the work at its next step.
///
/// # Errors
/// The exception, or a panic of the work.
pub(crate) fn wait<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Arc<Watch>, &Reporter) -> T + Send + 'static,
) -> PyResult<T> {
    unforked(py)?;
    let (send, notes) = channel();
    let reporter = Reporter(send);
    let steps = reporter.clone();
    let watch = Arc::new(Watch::new(move |step| steps.send(step_event(step))));
    let watched = watch.clone();
    let thread = std::thread::spawn(move || {
        let done = catch_unwind(AssertUnwindSafe(|| work(&watched, &reporter)));
        let _ = reporter.0.send(Note::End);
        done
    });
    let notes = Mutex::new(notes);
    let followed = (|| {
        loop {
            let note = py.detach(|| notes.lock().expect("one thread waits").recv_timeout(LOOK));
            match note {
                Ok(Note::Event(event)) => {
                    if let Some(progress) = progress {
                        progress.call1((object(py, &event)?,))?;
                    }
                }
                Ok(Note::End) | Err(RecvTimeoutError::Disconnected) => return Ok(()),
                Err(RecvTimeoutError::Timeout) => {}
            }
            py.check_signals()?;
        }
    })();
    if let Err(stopped) = followed {
        watch.stop();
        return Err(stopped);
    }
    let done = py.detach(|| thread.join().unwrap_or_else(Err));
    done.map_err(|panic| not_run(py, format!("panicked: {}", words(&*panic))))
}

fn words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message")
}

fn step_event(step: &LoadStep) -> Value {
    let forces: Vec<f64> = step.tools.iter().map(|tool| tool.pushed).collect();
    json!({ "event": "step", "load": step.load, "iterations": step.iterations, "tool-forces": forces })
}

/// Converts a JSON value to a Python object.
fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    static LOADS: pyo3::sync::PyOnceLock<Py<PyAny>> = pyo3::sync::PyOnceLock::new();
    LOADS.import(py, "json", "loads")?.call1((value.to_string(),))
}
