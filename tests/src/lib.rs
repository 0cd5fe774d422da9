//! Helpers of the tests across crates: bodies with their tables, tools, and measures of error.

pub mod block;
pub mod cuboid;
pub mod model;
pub mod organs;
pub mod tools;
