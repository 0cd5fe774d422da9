//! Equations of one time step of implicit Euler.

use shape::Vector3;

use super::touch::Touch;

/// Equations of a time step: `w (u - y) + f_int(u) = f_ext + f_contact`, where `w = m (1 + alpha h) / h^2`
/// and `y = u_n + h v_n / (1 + alpha h)`.
pub(super) struct Equations<'a> {
    /// Weight `w` of each node, N/m; 0 without inertia.
    pub weights: &'a [f64],
    /// Displacement `y` of each node without forces, m.
    pub inertial: &'a [Vector3],
    /// Displacement `u_n` of each node at the start of the time step, m.
    pub before: &'a [Vector3],
    /// External forces, N.
    pub load: &'a [Vector3],
    /// Whether each axis of each node has a prescribed displacement.
    pub constrained: &'a [[bool; 3]],
    /// Tools.
    pub touch: Option<&'a Touch<'a>>,
}

impl Equations<'_> {
    /// Displacement of a node per force along each axis against its weight, m/N; 0 along prescribed axes.
    pub fn yields(&self, node: usize) -> Vector3 {
        let per_force = 1.0 / self.weights[node];
        Vector3::from_fn(|axis, _| if self.constrained[node][axis] { 0.0 } else { per_force })
    }
}

/// Solver of the equations of a time step with a fixed budget of work.
pub(super) trait Sweeper: Send {
    /// Changes the displacements `u` (m) towards the solution. Prescribed displacements have their values.
    fn solve(&mut self, equations: &Equations, u: &mut [Vector3]);
}
