//! Stiffness-proportional damping in explicit dynamics.

use shape::Vector3;

/// Damping forces `beta K v` with the tangent `K` of the internal forces in the current state: `beta` times the
/// change of the internal forces over the last step, divided by its length. They lag by half a step.
///
/// Source: Belytschko, Liu, Moran and Elkhodary, Nonlinear Finite Elements for Continua and Structures (2014),
/// ch. 6.2, for the stable step; Rayleigh damping itself: Bathe, Finite Element Procedures (2014), ch. 9.3.
pub(super) struct StiffnessDamping {
    /// Factor `beta`, s.
    beta: f64,
    /// Internal forces at the previous step, N; empty before the first.
    before: Vec<Vector3>,
    /// Damping forces at the previous step, N.
    forces: Vec<Vector3>,
    /// Energy lost since the start in free and in prescribed degrees of freedom, J.
    pub lost: [f64; 2],
}

impl StiffnessDamping {
    /// Starts the damping of a body with a number of nodes.
    pub fn new(beta: f64, nodes: usize) -> StiffnessDamping {
        StiffnessDamping { beta, before: Vec::new(), forces: vec![Vector3::zeros(); nodes], lost: [0.0; 2] }
    }

    /// Factor `beta`, s.
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// Takes the damping forces at a step with the internal forces `internal` (N) from the external ones. `dt` (s)
    /// is the length of the step before, and `v` (m/s) holds its velocities.
    pub fn act(
        &mut self,
        internal: &[Vector3],
        dt: f64,
        v: &[Vector3],
        constrained: &[bool],
        external: &mut [Vector3],
    ) {
        if self.before.is_empty() {
            self.before.extend_from_slice(internal);
            return;
        }
        let rate = self.beta / dt;
        for (i, (now, before)) in internal.iter().zip(&mut self.before).enumerate() {
            let force = (now - *before) * rate;
            let work = (force + self.forces[i]).component_mul(&v[i]) * (0.5 * dt);
            for axis in 0..3 {
                self.lost[usize::from(constrained[3 * i + axis])] += work[axis];
            }
            external[i] -= force;
            (self.forces[i], *before) = (force, *now);
        }
    }
}
