//! From records to tables, figures and one page.
//!
//! The harness hands over a [`RunSet`]; [`write_run`] puts it into a folder, [`render`] turns the folder into CSV, Markdown and
//! LaTeX tables, SVG and PNG figures and a self-contained HTML report. Rendering only reads: nothing is solved, or timed, again.

pub mod baseline;
mod clouds;
mod error;
mod figures;
mod findings;
mod frame;
mod fronts;
mod history;
mod order;
mod provenance;
mod published;
mod record;
mod render;
mod run_set;
mod select;
mod store;
mod table;
mod tables;
mod text;

pub use error::ReportError;
pub use order::{Order, observed as observed_order};
pub use provenance::{Machine, Program, Provenance, SceneHash};
pub use published::is_known_publication;
pub use record::{Family, Purpose, Record};
pub use render::{Rendered, render};
pub use run_set::{Check, Failure, PlanEntry, RunSet, Section, SectionCell, Status, SurfaceField, ToolHull};
pub use store::{read_run, source_of, write_run};
