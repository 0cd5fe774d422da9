//! Detours of paths through the body.

use shape::Vector3;

/// Detour from a node to a point, relative to the extent of the node's support, and its gradient (1/m). The
/// detour is added to the relative straight distance.
#[derive(Clone, Copy, Default)]
pub(crate) struct Detour {
    pub(crate) longer: f64,
    pub(crate) slope: Vector3,
}
