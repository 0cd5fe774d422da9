//! Energy balance of a moving body.

/// Energies since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy `v . M v / 2` at the present time.
    pub kinetic: f64,
    /// Strain energy at the present time. With relaxation: work of the internal forces, stored and
    /// dissipated.
    pub internal: f64,
    /// Work of loads, supports and tools on the body, by the trapezoidal rule from step to step.
    pub external: f64,
    /// Energy dissipated by the damping.
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
