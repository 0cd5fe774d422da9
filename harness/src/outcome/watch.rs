//! Whoever waits for a run.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};

use super::LoadStep;

/// Called with every step: a converged one of Newton's method, a recorded state of explicit dynamics. It may end the run there.
pub struct Watch {
    each: Box<dyn Fn(&LoadStep) + Send + Sync>,
    stopped: AtomicBool,
}

/// What a stopped run unwinds with: it has no result, and nobody waits for one.
#[derive(Clone, Copy, Debug)]
pub struct Stopped;

impl Watch {
    /// Calls `each` with every step.
    pub fn new(each: impl Fn(&LoadStep) + Send + Sync + 'static) -> Watch {
        Watch { each: Box::new(each), stopped: AtomicBool::new(false) }
    }

    /// Ends what is watched: a run at its next step, a study before its next run.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Whether it is to end.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Reports a step. Where the run is to end it unwinds from here with [`Stopped`], by no panic: no solver between has
    /// anything to keep.
    pub(crate) fn step(&self, step: &LoadStep) {
        (self.each)(step);
        if self.is_stopped() {
            resume_unwind(Box::new(Stopped));
        }
    }
}
