//! Scene to plan to run to records; studies and their checks; the command line.
//!
//! Data flows one way: a scene (TOML, checked) becomes a [`scenario::Scenario`], that a [`setup::Setup`] and a
//! [`discretise::Discretisation`], these the tables of [`prepare::prepare`], and the solution of [`run::run`] an
//! [`outcome::Outcome`] of records. Nothing here draws; nothing in `reports` solves.

mod baseline;
pub mod body;
pub mod check;
pub mod cli;
mod cloud_file;
pub mod command;
mod course;
pub mod discretise;
pub mod error;
pub mod explicit;
mod folder;
mod grading;
pub mod group;
pub mod in_time;
pub mod json;
pub mod law;
pub mod list;
mod locate;
pub mod mean_pressure;
mod measure;
mod memory;
pub mod mesh_files;
pub mod modes;
mod motion;
pub mod norms;
pub mod outcome;
pub mod picture;
pub mod place;
pub mod plan;
pub mod prepare;
mod progress;
pub mod provenance;
pub mod reach;
pub mod refine;
mod relaxation;
pub mod repeated;
pub mod run;
pub mod scenario;
pub mod setup;
mod share;
pub mod statics;
pub mod stored;
pub mod study;
pub mod task;
pub mod timing;
pub mod tools;
pub mod transfer;
mod way;
pub mod work;

pub use error::Failure;
