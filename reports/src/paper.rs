//! The published kidney-grasper comparison, number by number with its place, so that ours can stand beside it.
//!
//! Finite elements: Abaqus/Explicit, C3D4, 1330 nodes. Element-free Galerkin: Matlab, 83 nodes. Where a number's section isn't known
//! for certain its place is just "text".

/// One published number.
pub(crate) struct Published {
    /// The quantity here: `max-x`, `rms-y`, `rms-least`, `elements`, or the phases of a time joined by `+`.
    pub(crate) quantity: &'static str,
    /// Whose: `fem` or `efg` (`rms-*` compares EFG with FE).
    pub(crate) family: &'static str,
    /// SI value.
    pub(crate) value: f64,
    /// Digits it was given with.
    pub(crate) digits: usize,
    /// What it is.
    pub(crate) what: &'static str,
    /// Where it stands.
    pub(crate) place: &'static str,
}

const fn published(
    quantity: &'static str,
    family: &'static str,
    value: f64,
    digits: usize,
    what: &'static str,
    place: &'static str,
) -> Published {
    Published { quantity, family, value, digits, what, place }
}

const TEXT: &str = "text";
const COMPARED: &str = "text, section 3.3";
const ABSTRACT: &str = "abstract";

/// All of them, in the order of the table. Two numbers of elements, and two accounts of the RMS, contradict each other in print.
pub(crate) const PUBLISHED: [Published; 17] = [
    published("elements", "fem", 6195.0, 4, "elements of the FE mesh", TEXT),
    published("elements", "fem", 2621.0, 4, "elements of the FE mesh, in another passage", TEXT),
    published("max-x", "fem", 5.32e-3, 3, "largest displacement in x", TEXT),
    published("max-y", "fem", 2.26e-3, 3, "largest displacement in y", TEXT),
    published("max-z", "fem", 9.79e-3, 3, "largest displacement in z", TEXT),
    published("max-x", "efg", 0.40e-3, 2, "largest displacement in x", TEXT),
    published("max-y", "efg", 1.55e-3, 3, "largest displacement in y", TEXT),
    published("max-z", "efg", 6.35e-3, 3, "largest displacement in z", TEXT),
    published("rms-x", "efg", 1.6e-3, 2, "RMS difference of EFG from FE in x", COMPARED),
    published("rms-y", "efg", 1.0e-3, 2, "RMS difference of EFG from FE in y", COMPARED),
    published("rms-z", "efg", 2.8e-3, 2, "RMS difference of EFG from FE in z", COMPARED),
    published("rms-least", "efg", 0.8e-3, 1, "least of the three RMS differences", ABSTRACT),
    published("rms-most", "efg", 2.3e-3, 2, "largest of the three RMS differences", ABSTRACT),
    published("total", "fem", 7200.0, 2, "the whole FE run (about 2 h)", TEXT),
    published("prepare", "efg", 23.0, 2, "preparing EFG", TEXT),
    published("assemble+factor+solve", "efg", 10.0, 2, "solving EFG", TEXT),
    published("transfer", "efg", 0.07, 1, "interpolating to the FE nodes", TEXT),
];

/// Whether a case is a reading of the published one: the kidney under other loads is not.
pub(crate) fn is_paper(case: &str) -> bool {
    case.contains("kidney") && case.contains("paper")
}

/// Nodes of the published finite-element mesh.
pub(crate) const FE_NODES: u64 = 1330;
/// Nodes of the published EFG cloud.
pub(crate) const EFG_NODES: u64 = 83;
