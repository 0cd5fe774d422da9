//! Execution of a study from its file to its folder of results, for programs that use this crate as a
//! library.

use std::path::Path;
use std::sync::Arc;

use super::args::VerifyArgs;
use super::events::Events;
use super::folder::{self, Folder};
use super::merge;
use super::plan::StudyPlan;
use super::results::FinishedStudy;
use super::store::clean;
use crate::error::Failure;
use crate::outcome::Watch;

impl StudyPlan {
    /// Sets the watch of the runs.
    pub fn watched_by(&mut self, watch: Arc<Watch>) {
        self.watch = Some(watch);
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.watch.as_ref().is_some_and(|watch| watch.is_stopped())
    }

    /// Runs the study in the file `study` and writes its results and report to the folder of the arguments.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be locked or written, if the runs exceed the limits on memory or
    /// time, and if the study was stopped. The folder keeps the finished runs.
    pub fn execute_in_folder(
        &self,
        args: &VerifyArgs,
        study: &Path,
        events: Option<&Events>,
    ) -> Result<FinishedStudy, Failure> {
        if let (false, Some(refused)) = (args.force, self.too_large(args).into_iter().next()) {
            return Err(Failure::Scene(Box::new(refused)));
        }
        let folder = folder::take(study, &args.out)?;
        clean(&args.out);
        let finished = self.execute_taken(args, study, events, &folder);
        folder.close(|| clean(&args.out));
        finished
    }

    fn execute_taken(
        &self,
        args: &VerifyArgs,
        study: &Path,
        events: Option<&Events>,
        folder: &Folder,
    ) -> Result<FinishedStudy, Failure> {
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
