//! From a scene through a plan to records; studies and their checks; the command line.
//!
//! The modules form layers in one order. A module uses only modules to its right (`tests/rooms` checks
//! this):
//!
//! `cli` > `study` > `run` > `measure` > `procedure` > `prepare` > `scenario` > `discretise` > `adapter` >
//! `outcome` > `executor` > `process` > `error`
//!
//! Data flows in the opposite direction. A checked TOML scene becomes a `scenario::Scenario`. The scenario
//! becomes a `scenario::setup::Setup` and a `discretise::Discretisation`, and `prepare::prepare` builds the
//! tables from both. A procedure solves the problem, `measure` compares the solution with its references, and
//! `run::run` returns an [`outcome::Outcome`] of records. Nothing here draws; nothing in `reports` solves.
//!
//! ```
//! use cases::scene;
//! use tissuebench_harness::run::{Group, Repeats, RunOptions};
//! // A cube between frictionless walls under a pressure p: at nu = 0 its top moves down by p h / E.
//! let text = r#"
//! title = "A cube between walls"
//! body = { shape = "box", size = ["10 mm", "10 mm", "10 mm"] }
//! material = { law = "linear", young = "20 kPa", poisson = 0.0 }
//! support = [
//!   { on = "z-min", fix = "z" },
//!   { on = ["x-min", "x-max"], fix = "x" },
//!   { on = ["y-min", "y-max"], fix = "y" },
//! ]
//! load = [{ on = "z-max", pressure = "1 kPa" }]
//! method = [{ id = "hex8", family = "fem", element = "hex8", size = { cells = [2, 2, 2] } }]
//! "#;
//! let scene = scene::parse(text, "cube.toml").expect("sound");
//! let group = Group::new(&scene, None, Repeats::ONCE)?;
//! let outcome =
//!     group.run(&group.scenario(scene.methods[0].clone(), 0), RunOptions::default()).expect("runs");
//! let down = outcome.metric("max-z").expect("recorded");
//! assert!((down - 1e3 / 20e3 * 0.01).abs() < 1e-12);
//! # Ok::<(), tissuebench_harness::Failure>(())
//! ```

#[macro_use]
mod print;

mod adapter;
pub mod cli;
mod discretise;
mod error;
pub mod executor;
mod measure;
pub mod outcome;
mod prepare;
mod procedure;
mod process;
pub mod run;
mod scenario;
pub mod study;

pub use adapter::try_readers;
pub use error::{Failure, Foreign, ForeignStatus};
