//! Curves of the prepared conditions.

use std::sync::Arc;

use shape::Curve;

/// The curve of a condition; `None` for the common growth.
pub(super) type Timed = Option<Arc<Curve>>;

/// Curves of each prepared condition, in the order of the lists of `Prepared`; empty lists in a scene without
/// curves.
#[derive(Default)]
pub(super) struct OwnCurves {
    pub(super) surfaces: Vec<Timed>,
    pub(super) body_force: Vec<Timed>,
    pub(super) nodal: Vec<Timed>,
    pub(super) following: Vec<Timed>,
    pub(super) fixed: Vec<Timed>,
    pub(super) weak: Vec<Timed>,
    /// Start and end of the time in which each of the fixed and of the weak conditions acts.
    pub(super) fixed_during: Vec<Option<[f64; 2]>>,
    pub(super) weak_during: Vec<Option<[f64; 2]>>,
    /// Those of surfaces, body forces and nodal forces, one after another.
    pub(super) loads: Vec<Timed>,
    pub(super) active: Vec<Timed>,
    pub(super) tools: Vec<Timed>,
    /// End of the loading: 1 in statics, s in dynamics.
    pub(super) end: f64,
}

impl OwnCurves {
    /// Returns the factor at the end of the loading of the condition `index` of a list.
    pub(super) fn at_end(&self, list: &[Timed], index: usize) -> f64 {
        list.get(index).and_then(Option::as_ref).map_or(1.0, |curve| curve.value(self.end))
    }
}
