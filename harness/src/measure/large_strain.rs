//! Where a law of small strain is strained beyond what it is for.

use geometry::Point3;
use material::Material as _;

use super::Solved;

/// Principal strain from which on it is: the stretches of linear and true strain then differ by a twentieth of the strain.
pub(super) const LARGE: f64 = 0.1;

/// Of an eigenvalue and of the norm.
const ROUNDING: f64 = 1e-12;

/// The largest principal strain of laws of small strain.
pub(super) struct LargestStrain {
    /// In stretch or compression, a number above 0.
    pub strain: f64,
    /// The integration point, m.
    pub at: Point3,
    /// Share of the volume where it is above [`LARGE`].
    pub share: f64,
}

/// Over all integration points; `None` where no law is one of small strain. An exact solution of the linear equations states
/// the small strain itself: against that the numbers are right at any strain.
pub(super) fn largest(run: &Solved) -> Option<LargestStrain> {
    let Solved { setup, prepared, solution, .. } = *run;
    let small = |q: usize| {
        let region = prepared.volume.region.get(q).map_or(0, |&region| usize::from(region));
        setup.is_linear() || setup.laws[region].is_small_strain()
    };
    if setup.exact.is_some() || setup.contact.is_some() {
        return None;
    }
    let rows = &prepared.volume.rows;
    let (mut found, mut beyond): (Option<(f64, usize)>, f64) = (None, 0.0);
    for (q, h) in rows.at().displacement_gradients(&solution.u).iter().enumerate().filter(|(q, _)| small(*q))
    {
        let tensor = (h + h.transpose()) * 0.5;
        let most = found.map_or(-1.0, |(most, _)| most);
        // No principal strain is larger than the norm, which is a tenth of the work: few points need more.
        if tensor.norm() * (1.0 + ROUNDING) < most.min(LARGE) {
            continue;
        }
        let strain = tensor.symmetric_eigenvalues().amax();
        if strain > most {
            found = Some((strain, q));
        }
        beyond += if strain > LARGE { rows.weights()[q] } else { 0.0 };
    }
    let share = beyond / rows.weights().iter().sum::<f64>();
    found.map(|(strain, q)| LargestStrain { strain, at: rows.points()[q], share })
}
