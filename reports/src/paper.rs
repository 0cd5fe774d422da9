//! The published kidney-grasper comparison, number by number with its place, so that ours can stand beside it.
//!
//! Finite elements: Abaqus/Explicit, C3D4, 1330 nodes, 6195 elements (2621 in another passage). Element-free Galerkin: Matlab, 83 nodes.

/// One published number.
pub(crate) struct Published {
    /// The quantity here: `max-x`, `rms-y`, or the phases of a time joined by `+`.
    pub(crate) quantity: &'static str,
    /// Whose: `fem` or `efg` (`rms-*` compares EFG with FE).
    pub(crate) family: &'static str,
    /// SI value.
    pub(crate) value: f64,
    /// What it is.
    pub(crate) what: &'static str,
    /// Where it stands.
    pub(crate) place: &'static str,
}

const fn published(
    quantity: &'static str,
    family: &'static str,
    value: f64,
    what: &'static str,
    place: &'static str,
) -> Published {
    Published { quantity, family, value, what, place }
}

const RESULTS: &str = "results";
const RMS: &str = "results, section 3.3";

/// All of them, in the order of the table.
pub(crate) const PUBLISHED: [Published; 13] = [
    published("max-x", "fem", 5.32e-3, "largest displacement in x", RESULTS),
    published("max-y", "fem", 2.26e-3, "largest displacement in y", RESULTS),
    published("max-z", "fem", 9.79e-3, "largest displacement in z", RESULTS),
    published("max-x", "efg", 0.40e-3, "largest displacement in x", RESULTS),
    published("max-y", "efg", 1.55e-3, "largest displacement in y", RESULTS),
    published("max-z", "efg", 6.35e-3, "largest displacement in z", RESULTS),
    published("rms-x", "efg", 1.6e-3, "RMS difference from FE in x", RMS),
    published("rms-y", "efg", 1.0e-3, "RMS difference from FE in y", RMS),
    published("rms-z", "efg", 2.8e-3, "RMS difference from FE in z", RMS),
    published("total", "fem", 7200.0, "time of the whole FE run, about 2 h", RESULTS),
    published("prepare", "efg", 23.0, "time to prepare EFG", RESULTS),
    published("assemble+factor+solve", "efg", 10.0, "time to solve EFG", RESULTS),
    published("transfer", "efg", 0.07, "time to interpolate to the FE nodes", RESULTS),
];

/// The RMS range of the abstract, which its own text contradicts, metres.
pub(crate) const ABSTRACT_RMS: (f64, f64) = (0.8e-3, 2.3e-3);
/// Nodes of the published finite-element mesh.
pub(crate) const FE_NODES: u64 = 1330;
/// Nodes of the published EFG cloud.
pub(crate) const EFG_NODES: u64 = 83;
