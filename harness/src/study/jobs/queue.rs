//! The executor of a study with its jobs, shared with the handler of interrupts.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::error::Failure;
use crate::executor::{Executor, Job, Site, State, open};

/// Executor with the ids of the jobs that have not ended.
#[derive(Clone)]
pub(crate) struct Jobs(Arc<Mutex<Shared>>);

struct Shared {
    executor: Box<dyn Executor>,
    active: Vec<String>,
}

impl Jobs {
    /// Executor of a site, without jobs.
    pub(crate) fn open(site: &Site) -> Result<Jobs, Failure> {
        let shared = Shared { executor: open(site)?, active: Vec::new() };
        Ok(Jobs(Arc::new(Mutex::new(shared))))
    }

    fn shared(&self) -> MutexGuard<'_, Shared> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn submit(&self, job: &Job) -> Result<String, String> {
        let mut shared = self.shared();
        let id = shared.executor.submit(job)?;
        shared.active.push(id.clone());
        Ok(id)
    }

    pub(super) fn poll(&self, ids: &[String]) -> Result<Vec<State>, String> {
        self.shared().executor.poll(ids)
    }

    /// Sets the jobs that have not ended.
    pub(super) fn set_active(&self, ids: Vec<String>) {
        self.shared().active = ids;
    }

    /// Cancels the jobs that have not ended, and returns their number.
    pub(super) fn cancel_active(&self) -> usize {
        cancelled(&mut self.shared())
    }

    /// Cancels all jobs just before the program exits, and returns their number. No job is handed over any
    /// more: every further call waits.
    pub(crate) fn cancel_at_exit(&self) -> usize {
        let mut shared = self.shared();
        let count = cancelled(&mut shared);
        std::mem::forget(shared);
        count
    }
}

fn cancelled(shared: &mut Shared) -> usize {
    let ids = std::mem::take(&mut shared.active);
    if let Err(bad) = shared.executor.cancel(&ids) {
        eprintln!("tissuebench: jobs {} could not be cancelled: {bad}", ids.join(", "));
    }
    ids.len()
}
