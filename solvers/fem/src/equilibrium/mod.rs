//! Equilibrium elements: stress fields of degree 1 in the four parts of a tetrahedron, in equilibrium with
//! each other and without body force.
//!
//! Every set of linear tractions on the four faces that is itself in equilibrium belongs to exactly one such
//! field. The unknowns are displacements of degree 1 of the faces, three vectors each. A cell has no
//! zero-energy motion but the rigid ones. Source: Fraeijs de Veubeke (1965); Almeida and Maunder, Equilibrium
//! Finite Element Formulations (2017).

mod faces;
mod reference;
mod tetrahedron;

pub use faces::FaceNumbers;
pub use tetrahedron::{EquilibriumTet, Response, face_moments};
