//! A study from its file to its folder of results, for programs that have this one as a library.

use std::path::Path;
use std::sync::Arc;

use super::events::Events;
use super::folder::{self, Folder};
use super::{Finished, Plan, VerifyArgs, clean, merge};
use crate::Failure;
use crate::outcome::Watch;

impl Plan {
    /// Someone waits for the runs.
    pub fn watched_by(&mut self, watch: Arc<Watch>) {
        self.watch = Some(watch);
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.watch.as_ref().is_some_and(|watch| watch.is_stopped())
    }

    /// Runs everything and writes the results of the study in the file `study`, and the report, to the folder of the arguments.
    ///
    /// # Errors
    /// A folder that can't be taken or written, runs that take more than anyone means to spend, and a study that was stopped:
    /// the folder keeps what is finished.
    pub fn execute_in_folder(
        &self,
        args: &VerifyArgs,
        study: &Path,
        events: Option<&Events>,
    ) -> Result<Finished, Failure> {
        if let (false, Some(refused)) = (args.force, self.too_large(args).into_iter().next()) {
            return Err(Failure::Scene(Box::new(refused)));
        }
        let folder = folder::take(study, &args.out)?;
        clean(args);
        let finished = self.execute_taken(args, study, events, &folder);
        folder.close(|| clean(args));
        finished
    }

    fn execute_taken(
        &self,
        args: &VerifyArgs,
        study: &Path,
        events: Option<&Events>,
        folder: &Folder,
    ) -> Result<Finished, Failure> {
        folder.begin(study)?;
        merge::note(args, study)?;
        let mut finished = self.execute_watched(args, events);
        if self.is_stopped() {
            let out = args.out.display();
            return Err(Failure::Run(format!("stopped; {out} is incomplete and keeps the finished runs")));
        }
        finished.set.provenance.source = folder::source(study);
        let written = reports::write_with_report(&args.out, &finished.set, None);
        written.map_err(|bad| Failure::Run(bad.to_string()))?;
        Ok(finished)
    }
}
