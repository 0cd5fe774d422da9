//! Parameters of a time integration, prescribed motions and loads, and its energy balance.

use shape::Vector3;

use super::critical_step::{CriticalStep, LanczosParams};
use crate::error::ExplicitError;
use crate::tools::ToolEnergies;

/// Parameters of a time integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicsParams {
    /// Time step, s.
    pub dt: f64,
    /// Mass-proportional damping `alpha` of `C = alpha M`, 1/s.
    pub damping: f64,
    /// Parameters of the estimate of the critical step, which `dt` must not exceed.
    pub critical: LanczosParams,
    /// Number of steps between two checks of the critical step as the body deforms; 0: before the first step
    /// only.
    pub recheck: usize,
    /// Critical step at the start, if known, including the springs of possible contact.
    pub known: Option<CriticalStep>,
}

/// Degree of freedom with a prescribed displacement.
pub struct Prescribed<'a> {
    /// Index of the node.
    pub node: u32,
    /// Axis, 0 to 2.
    pub axis: u8,
    /// Displacement (m) as a function of time (s).
    pub motion: &'a (dyn Fn(f64) -> f64 + Sync),
}

/// External forces, as a function `(t, u, v, f)` that adds nodal forces (N) to `f`, which starts from zero.
/// Time `t` (s) and displacements `u` (m) are those of step n, and the velocities `v` (m/s) lag by half a
/// step: `v_(n-1/2)`.
pub type External<'a> = dyn FnMut(f64, &[Vector3], &[Vector3], &mut [Vector3]) + 'a;

/// Energy balance at one step, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// Number of the step.
    pub step: usize,
    /// Time, s.
    pub time: f64,
    /// Kinetic energy `v_(n-1/2) . M v_(n+1/2) / 2` at a whole step. Its sum with the strain energy is
    /// constant to rounding in a linear undamped motion.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Work of the external forces since the start, and of the activation of muscle: its change of the strain
    /// energy. The work of the tools' drives is in `tools.work`.
    pub external: f64,
    /// Work of the prescribed displacements since the start.
    pub support: f64,
    /// Energy lost to damping since the start.
    pub damping: f64,
    /// Energies of the tools; zero without tools.
    pub tools: ToolEnergies,
    /// Relative energy error: the change of the sum below since the first recorded step, over the largest of
    /// its terms so far (without `tools.kinetic` and `tools.damping`).
    ///
    /// The sum is
    /// `kinetic + strain + damping + tools.kinetic + tools.stored + tools.friction + tools.damping` less
    /// `external + support + tools.work`.
    pub drift: f64,
}

/// Marks the (node, axis) pairs of a list among all degrees of freedom; each pair may occur once.
pub(super) fn constrained(
    nodes: usize,
    list: impl Iterator<Item = (u32, u8)>,
) -> Result<Vec<bool>, ExplicitError> {
    let mut constrained = vec![false; 3 * nodes];
    for (node, axis) in list {
        let bad = |why| Err(ExplicitError::BadDof { node: node as usize, axis, why });
        if node as usize >= nodes || axis > 2 {
            return bad("there is no such node or axis");
        }
        if std::mem::replace(&mut constrained[3 * node as usize + axis as usize], true) {
            return bad("the displacement is prescribed twice");
        }
    }
    Ok(constrained)
}
