//! cases

pub mod exact;
