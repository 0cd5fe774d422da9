//! Scene to plan to run to records; studies and their checks; the command line.
//!
//! The modules are rooms in one order, and a room uses only those to its right (`tests/rooms.rs` checks it):
//!
//! `cli` > `study` > `run` > `measure` > `procedure` > `prepare` > `scenario` > `discretise` > `outcome` > `error`
//!
//! Data flows the other way round: a scene (TOML, checked) becomes a [`scenario::Scenario`], that a
//! [`scenario::setup::Setup`] and a [`discretise::Discretisation`], these the tables of [`prepare::prepare`]. A procedure
//! solves them, `measure` compares the solution, and [`run::run`] makes an [`outcome::Outcome`] of records. Nothing here
//! draws; nothing in `reports` solves.

pub mod cli;
mod discretise;
mod error;
mod measure;
pub mod outcome;
mod prepare;
mod procedure;
pub mod run;
mod scenario;
pub mod study;

pub use error::Failure;
