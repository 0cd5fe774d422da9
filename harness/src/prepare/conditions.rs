//! The essential conditions of each support.

/// Counts of nodal conditions, constraint rows and weakly constrained surfaces.
#[derive(Clone, Copy, Default)]
pub(super) struct Conditions {
    pub(super) fixed: usize,
    pub(super) rows: usize,
    pub(super) weak: usize,
}

/// The conditions of one support.
pub(super) struct Held {
    pub(super) axes: [bool; 3],
    /// Start and end of the part of the loading in which it acts; `None` for all of it.
    pub(super) during: Option<[f64; 2]>,
    /// Counts before the support and after it.
    pub(super) from: Conditions,
    pub(super) to: Conditions,
}
