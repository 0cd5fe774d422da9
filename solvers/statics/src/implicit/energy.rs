//! Where the energy of a moving body is.

/// Energies since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic, `v . M v / 2`.
    pub kinetic: f64,
    /// Strain energy. With relaxation the work of the internal forces, both what is stored and what is dissipated.
    pub internal: f64,
    /// Work of loads, supports and tools on the body, by the trapezoidal rule from step to step.
    pub external: f64,
    /// What the damping took.
    pub damped: f64,
    /// Kinetic and strain energy at the start.
    pub start: f64,
}

impl Energy {
    /// `start + external - kinetic - internal - damped`: what the scheme dissipated (negative: made).
    pub fn lost(&self) -> f64 {
        self.start + self.external - self.kinetic - self.internal - self.damped
    }
}
