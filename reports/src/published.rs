//! Published comparisons, number by number with their place, so that they can be set against computed ones.

use records::{Family, Purpose, Record};

use crate::select::Run;

/// A published comparison of finite elements with clouds.
pub(crate) struct Publication {
    /// Name in scenes.
    name: &'static str,
    /// Published numbers, in the order of the table.
    pub(crate) numbers: &'static [Published],
    /// Number of nodes of the finite-element mesh.
    pub(crate) fe_nodes: u64,
    /// Number of nodes of the cloud.
    pub(crate) efg_nodes: u64,
    /// Kernel of the cloud.
    pub(crate) kernel: &'static str,
    /// Scheme that transfers the cloud's displacement to the mesh.
    pub(crate) scheme: &'static str,
    /// Limits of the reproduction of the case.
    pub(crate) caveat: &'static str,
}

impl Publication {
    /// The published number of a quantity, SI.
    pub(crate) fn number(&self, family: Family, quantity: &str) -> Option<f64> {
        self.numbers.iter().find(|p| p.family == family && p.quantity == quantity).map(|p| p.value)
    }
}

impl Published {
    /// Whether a run computes the same thing as the published number.
    ///
    /// The published solution times are for contact with jaws, and those of finite elements for explicit
    /// dynamics. A linear scene with given loads has no comparable time.
    pub(crate) fn is_of(&self, run: &Run) -> bool {
        let solves = self.quantity == "total" || self.quantity.contains("solve");
        !solves || (run.has_contact() && (self.family != Family::Fem || run.value("time-steps").is_some()))
    }
}

/// Publication whose claim on time and error a case tests.
pub(crate) fn tested(record: &Record) -> Option<&'static Publication> {
    PUBLICATIONS.iter().find(|p| p.name == record.published)
}

/// Publication that a case reproduces, so that its numbers may be compared.
pub(crate) fn read_as(record: &Record) -> Option<&'static Publication> {
    tested(record).filter(|_| record.purpose == Purpose::Published)
}

/// Whether the numbers of a publication are available here.
pub fn is_known_publication(name: &str) -> bool {
    PUBLICATIONS.iter().any(|p| p.name == name)
}

/// All publications.
const PUBLICATIONS: [Publication; 1] = [Publication {
    name: "saghaei-2016",
    numbers: &SAGHAEI_2016,
    fe_nodes: 1330,
    efg_nodes: 83,
    kernel: "cubic-spline",
    scheme: "inverse-distance",
    caveat: "Geometry, supports and the position of the jaws are estimated from the publication's pictures, so only \
             times and orders of magnitude can be compared.",
}];

/// One published number.
pub(crate) struct Published {
    /// Name of the quantity: `max-x`, `rms-y`, `rms-least`, `elements`, or the phases of a time joined by
    /// `+`.
    pub(crate) quantity: &'static str,
    /// Family of methods (`rms-*` compares EFG with FE).
    pub(crate) family: Family,
    /// Value in SI units.
    pub(crate) value: f64,
    /// Number of published digits.
    pub(crate) digits: usize,
    /// Description of the number.
    pub(crate) what: &'static str,
    /// Place in the publication.
    pub(crate) place: &'static str,
}

const fn published(
    quantity: &'static str,
    family: Family,
    value: f64,
    digits: usize,
    what: &'static str,
    place: &'static str,
) -> Published {
    Published { quantity, family, value, digits, what, place }
}

const FEM: Family = Family::Fem;
const EFG: Family = Family::Efg;
const TEXT: &str = "text";
const COMPARED: &str = "text, section 3.3";
const ABSTRACT: &str = "abstract";

/// Saghaei Nooshabadi et al., Scientia Iranica B 23(1) (2016) 295-300: a kidney in a grasper. Finite
/// elements: Abaqus/Explicit, C3D4, 1330 nodes. Element-free Galerkin: Matlab, 83 nodes. The place of a
/// number whose section is uncertain is "text". Two numbers of elements, and two accounts of the RMS,
/// contradict each other in print.
const SAGHAEI_2016: [Published; 17] = [
    published("elements", FEM, 6195.0, 4, "elements of the FE mesh", TEXT),
    published("elements", FEM, 2621.0, 4, "elements of the FE mesh, in another passage", TEXT),
    published("max-x", FEM, 5.32e-3, 3, "largest displacement in x", TEXT),
    published("max-y", FEM, 2.26e-3, 3, "largest displacement in y", TEXT),
    published("max-z", FEM, 9.79e-3, 3, "largest displacement in z", TEXT),
    published("max-x", EFG, 0.40e-3, 2, "largest displacement in x", TEXT),
    published("max-y", EFG, 1.55e-3, 3, "largest displacement in y", TEXT),
    published("max-z", EFG, 6.35e-3, 3, "largest displacement in z", TEXT),
    published("rms-x", EFG, 1.6e-3, 2, "RMS difference of EFG from FE in x", COMPARED),
    published("rms-y", EFG, 1.0e-3, 2, "RMS difference of EFG from FE in y", COMPARED),
    published("rms-z", EFG, 2.8e-3, 2, "RMS difference of EFG from FE in z", COMPARED),
    published("rms-least", EFG, 0.8e-3, 1, "least of the three RMS differences", ABSTRACT),
    published("rms-most", EFG, 2.3e-3, 2, "largest of the three RMS differences", ABSTRACT),
    published("total", FEM, 7200.0, 2, "the whole FE run (about 2 h)", TEXT),
    published("prepare", EFG, 23.0, 2, "preparing EFG", TEXT),
    published("assemble+factor+solve", EFG, 10.0, 2, "solving EFG", TEXT),
    published("transfer", EFG, 0.07, 1, "interpolating to the FE nodes", TEXT),
];
