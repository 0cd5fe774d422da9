//! Simple bodies in closed form: volume, inside test, level function, closest surface point.

mod kidney;
pub use kidney::Kidney;
