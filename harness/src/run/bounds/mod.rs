//! Strict two-sided bounds in linear elasticity, by dual analysis: a compatible displacement field and a
//! stress field in equilibrium enclose the potential of the solution (Fraeijs de Veubeke 1965).
//!
//! The solution is a sum over causes: the motion of the supports, the loads, and unit loads for requested
//! means. The stresses of the first two do no work on each other, so that their energies add up and each has
//! its own bounds. Residuals and rounding are subtracted.

mod anchors;
mod body;
mod conforming;
mod enclose;
mod equilibrated;
mod exact;
mod field;
mod on_faces;
mod report;
mod result;

pub(crate) use body::cell_count;
pub(crate) use enclose::{MOST_CELLS, bounds};
pub(crate) use exact::exact_energy;
pub(super) use report::add_bounds;
pub(crate) use result::{Bounded, Bounds, Bracket};
