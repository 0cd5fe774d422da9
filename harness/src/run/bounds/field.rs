//! Energies of a displacement field and of a stress field for the same causes, and what they enclose.

use super::result::Bracket;

/// A displacement field or a stress field.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    /// Its energy, J.
    pub energy: f64,
    /// Work of the loads on a displacement field, or of a stress field on the prescribed displacements, J.
    pub work: f64,
    /// Rounding of both, with the work on forces out of balance, J.
    pub rounding: f64,
}

/// Bounds of the potential, the energy less the work of the loads, from a compatible field and one in
/// equilibrium.
pub(super) fn enclosed([compatible, balanced]: &[Field; 2]) -> Bracket {
    Bracket {
        lower: balanced.work - balanced.energy - balanced.rounding,
        upper: compatible.energy - compatible.work + compatible.rounding,
    }
}

/// Bounds of the energy. In its norm the exact stress lies on the sphere whose poles are the stresses of both
/// fields (Prager and Synge 1947). These bounds close where both fields are exact, even if those of the
/// separate causes do not.
pub(super) fn on_sphere([compatible, balanced]: &[Field; 2]) -> Bracket {
    let (energies, work) = (compatible.energy + balanced.energy, compatible.work + balanced.work);
    let rounding = 2.0 * (compatible.rounding + balanced.rounding);
    let radius = (((energies - work).max(0.0) + rounding) / 2.0).sqrt();
    let centre = |rounding: f64| ((energies + work) / 2.0 + rounding).max(0.0).sqrt();
    Bracket {
        lower: (centre(-rounding) - radius).max(0.0).powi(2) / 2.0,
        upper: (centre(rounding) + radius).powi(2) / 2.0,
    }
}
