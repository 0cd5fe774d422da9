//! Energy balance of a moving body.

/// Energy balance at the end of a step, J: the energies at this time and the work since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy `v . M v / 2`.
    pub kinetic: f64,
    /// Strain energy. With relaxation: work of the internal forces since the start, stored and dissipated.
    pub internal: f64,
    /// Work of loads, supports and tools on the body since the start, by the trapezoidal rule from step to
    /// step.
    pub external: f64,
    /// Energy dissipated by the damping since the start.
    pub damped: f64,
    /// Kinetic plus strain energy at time 0.
    pub start: f64,
}

impl Energy {
    /// Energy dissipated by the scheme, J: `start + external - kinetic - internal - damped`. A negative value
    /// is generated energy.
    pub fn lost(&self) -> f64 {
        self.start + self.external - self.kinetic - self.internal - self.damped
    }
}
