//! The long table of benchmark numbers.
//!
//! A [`Record`] is one number of one run, and a [`RunSet`] holds all results of a study. A folder is the
//! stored form of a run set ([`write_run`], [`read_run`]). Two sets of numbers are compared by a paired
//! [`difference()`].

mod axis;
mod body;
pub mod cell;
mod columns;
mod difference;
mod error;
mod fit;
mod frame;
mod provenance;
mod record;
mod reference;
pub mod ro_crate;
mod run_set;
mod samples;
pub mod store;
pub mod text;

pub use axis::{Axis, Ended, Trial, Verdict as AxisVerdict};
pub use body::{BodyState, Faces, Inside, InsideState, RecordedBody, Skin, pack};
pub use difference::{Difference, Numbers, Pair, Paired, difference, numbers};
pub use error::RecordError;
pub use fit::{Fit, FitConstant, FitPoint};
pub use provenance::{FORMAT, Machine, Program, Provenance, SceneHash};
pub use record::{Family, Key, Purpose, Record};
pub use reference::Reference;
pub use run_set::{
    Check, Failure, PlanEntry, RunSet, Section, SectionCell, Status, SurfaceField, ToolHull, Warning,
};
pub use samples::{Input, Output, Sample, SampleResults, Samples};
pub use store::{
    begin, end, is_incomplete, provenance_of, read_numbers, read_run, source_of, write_run, write_text,
};
