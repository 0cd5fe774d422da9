//! What a person can name, and how it is explained.
//!
//! A law, a kernel, an exact solution or a metric is an [`Entry`]: a name, a meaning, a source, its [`Parameter`]s with
//! dimension, default and range, and a constructor from checked SI values. Entries stand beside their implementations;
//! this crate has their types, the units of their parameters and the nearest known name of a mistyped one. Scene files,
//! their schema, messages, lists and property tests all walk the same slices of entries.
//!
//! The [metrics](metric) are here themselves, because solvers record them and reports draw them.

mod dimension;
mod entry;
pub mod metric;
mod names;
mod parameter;
mod problem;
mod quantity;
mod values;

pub use dimension::Dimension;
pub use entry::{Entry, find, names};
pub use names::{nearest, suggest};
pub use parameter::{Kind, Parameter, Range};
pub use problem::{Problem, clip};
pub use quantity::{Exponents, Quantity, UnitWord, units};
pub use values::{Value, Values};
