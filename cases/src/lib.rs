//! Cases: exact solutions, and the scene and study files that name them.

pub mod exact;
pub mod scene;
