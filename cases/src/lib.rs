//! Cases: exact solutions, and the scene and study files that name them.

pub mod exact;
mod names;
pub mod scene;
