//! From records to tables, figures and one page.
//!
//! The harness hands over a [`RunSet`]; [`write_run`] puts it into a folder, [`render`] turns the folder into CSV, Markdown and
//! LaTeX tables, SVG and PNG figures and a self-contained HTML report. Rendering only reads: nothing is solved, or timed, again.

mod clouds;
mod error;
mod figures;
mod findings;
mod frame;
mod fronts;
mod history;
mod order;
mod paper;
mod record;
mod render;
mod select;
mod store;
mod table;
mod tables;
mod text;

pub use error::ReportError;
pub use order::{Order, observed as observed_order};
pub use record::{
    Check, Failure, PlanEntry, Provenance, Record, RunSet, SceneHash, Section, SectionCell, Status,
    SurfaceField, ToolHull,
};
pub use render::{Rendered, render};
pub use store::{read_run, write_run};
