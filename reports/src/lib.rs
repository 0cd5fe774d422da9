//! Turns records into tables, figures and a page.
//!
//! The harness writes a [`records::RunSet`] to a folder. [`render`] turns the folder into CSV, Markdown and
//! LaTeX tables, SVG, PNG and PDF figures and a self-contained HTML report. Rendering only reads: nothing is
//! solved or timed again.
//!
//! ```
//! use records::{Family, Record, RunSet, read_run, write_run};
//! use tissuebench_reports::render;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A record is one number of one run: its case and method, then its quantity, unit and value.
//! let run = Record { case: "block".into(), method: "tet4".into(), family: Family::Fem, ..Record::default() };
//! let error = Record { quantity: "l2".into(), unit: "1".into(), statistic: "value".into(), value: 0.02, ..run };
//! let set = RunSet { records: vec![error], ..RunSet::default() };
//! let folder = std::env::temp_dir().join(format!("tissuebench-{}", std::process::id()));
//! write_run(&folder, &set)?;
//! assert_eq!(read_run(&folder)?.records[0].value, 0.02);
//! let rendered = render(&folder, &folder.join("report"))?;
//! assert!(rendered.files.iter().any(|file| file.ends_with("report.html")));
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok(())
//! # }
//! ```

mod appearance;
pub mod baseline;
mod busy;
mod cheapest;
mod claims;
mod clouds;
pub mod commits;
pub mod compare;
mod credibility;
mod error;
mod figures;
mod findings;
mod fitted;
mod fronts;
mod history;
mod order;
mod page;
mod plot;
mod quantity;
mod questions;
mod render;
mod seconds;
mod select;
mod table;
mod tables;
mod uncertain;

#[cfg(test)]
mod blank;

pub use busy::Busy;
pub use claims::{Claim, ClaimVerdict, Judged, own_claims, read_claims};
pub use credibility::{Statements, read_statements};
pub use error::ReportError;
pub use figures::svg_over_commits;
pub use fitted::fitted_text;
pub use order::{Order, observed as observed_order};
pub use render::{Rendered, render, render_with, write_with_report};
pub use seconds::{Seconds, Took};
pub use uncertain::{FINE_ENOUGH, Uncertain, uncertain};
