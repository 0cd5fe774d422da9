//! A study: many scenes and methods, run in a fixed order, checked and written to files.

mod args;
mod busy;
pub mod check;
mod curve;
mod events;
mod execute;
mod execution;
mod files;
mod filters;
mod fit;
pub(crate) mod folder;
mod foreseen;
pub(crate) mod isolated;
pub(crate) mod jobs;
mod listing;
pub(crate) mod make_reference;
pub(crate) mod merge;
mod plan;
mod progress;
#[cfg(test)]
mod project;
mod results;
mod samples;
mod shards;
mod store;
mod summary;
mod task;
mod tasks;
mod trials;

pub use args::{Loudness, VerifyArgs};
pub use busy::warn_if_busy;
pub use events::Events;
pub(crate) use events::{Event, Line};
pub(crate) use files::note_inputs;
pub use filters::Filters;
pub(crate) use filters::like;
pub use isolated::ExperimentArgs;
pub use listing::Planned;
pub use merge::MergeArgs;
pub use plan::StudyPlan;
pub use results::{FinishedStudy, compared_with, reference_records};
pub(crate) use samples::numerical;
pub use store::has_stored;
pub(crate) use store::{clean, sweep};
pub use summary::RunSummary;
pub use task::{failed, stalled};
