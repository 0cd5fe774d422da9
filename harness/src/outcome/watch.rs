//! Observer of a run, which may stop the run.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};

use super::load_step::LoadStep;

/// Observer that is called with every step: a converged step of Newton's method, or a recorded state of
/// explicit dynamics. It may end the run at a step.
pub struct Watch {
    each: Box<dyn Fn(&LoadStep) + Send + Sync>,
    stopped: AtomicBool,
}

/// Payload with which a stopped run unwinds. A stopped run has no result.
#[derive(Clone, Copy, Debug)]
pub struct Stopped;

impl Watch {
    /// Creates a watch that calls `each` with every step.
    pub fn new(each: impl Fn(&LoadStep) + Send + Sync + 'static) -> Watch {
        Watch { each: Box::new(each), stopped: AtomicBool::new(false) }
    }

    /// Requests the end of a run at its next step, or of a study before its next run.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Whether the run is to end.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Reports a step. If the run is to end, it unwinds from here with [`Stopped`], which is not a panic. No
    /// solver on the stack has state to preserve.
    pub(crate) fn step(&self, step: &LoadStep) {
        (self.each)(step);
        if self.is_stopped() {
            resume_unwind(Box::new(Stopped));
        }
    }
}
