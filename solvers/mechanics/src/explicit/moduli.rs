//! What the fast kernels need of a law.

/// Lame moduli of a neo-Hookean law, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moduli {
    pub mu: f64,
    pub lambda: f64,
}
