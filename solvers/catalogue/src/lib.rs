//! Catalogue of everything that a user can name, with explanations.
//!
//! A law, a kernel, an exact solution or a metric is an [`Entry`]: a name, a meaning, a source, its
//! [`Parameter`]s with dimension, default and range, and a constructor from checked SI values. Entries are
//! defined next to their implementations. This crate defines their types and the units of their parameters,
//! and finds the nearest known name of a mistyped name. Scene files, their schema, messages, lists and
//! property tests all use the same slices of entries.
//!
//! The [metrics](metric), [warnings](warning) and names of [elements](element) are defined here, because
//! solvers record them and reports draw them.
//!
//! ```
//! use tissuebench_catalogue::{Build, Dimension, Entry, Parameter, Problem, Value, Values, find, metric};
//! // A spring that a scene could name: `{ spring = "linear", stiffness = ... }`.
//! type Spring = Entry<Build<f64>>;
//! static SPRINGS: [Spring; 1] = [Entry {
//!     name: "linear",
//!     meaning: "force in proportion to the length",
//!     source: "Hooke (1678)",
//!     parameters: &[Parameter::required("stiffness", Dimension::None, "force per length")],
//!     build: |values: &Values| -> Result<_, Problem> { values.number("stiffness") },
//! }];
//! let spring = find(&SPRINGS, "linear")?;
//! let mut values = Values::new(spring.parameters);
//! values.give("stiffness", Value::Number(2.5))?;
//! assert_eq!((spring.build)(&values)?, 2.5);
//! // A mistyped name gets the nearest one, and every number has a unit and a meaning.
//! assert!(find(&SPRINGS, "linaer").unwrap_err().to_string().contains("linear"));
//! assert_eq!(metric::TOOL_FORCE.unit(), "N");
//! # Ok::<(), Problem>(())
//! ```

mod dimension;
pub mod element;
mod entry;
pub mod metric;
mod names;
mod parameter;
mod problem;
mod quantity;
mod values;
pub mod warning;

pub use dimension::Dimension;
pub use entry::{Build, Entry, find, names};
pub use names::{nearest, suggest};
pub use parameter::{Kind, Parameter, Range, Value, short};
pub use problem::{Problem, clip};
pub use quantity::{Exponents, Quantity, UnitWord, units};
pub use values::Values;
