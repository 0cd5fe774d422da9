//! Energy of hourglass control, which should be small: its stiffness is not that of the material.

use catalogue::warning;
use geometry::Vector3;

use super::solved::Solved;
use crate::discretise::Volume;
use crate::outcome::Warning;
use crate::scenario::setup::Setup;

/// Fraction of the strain energy above which the warning is given: the usual limit, such as that of the
/// support pages of LS-DYNA (dynasupport.com, Hourglass: "<10% as a rule-of-thumb" of the peak energy).
const LARGE: f64 = 0.1;

/// Returns the energy of hourglass control (J) at nodal parameters `u` (m), zero without hourglass control.
pub(super) fn energy(setup: &Setup, volume: &Volume, u: &[Vector3]) -> f64 {
    let moduli = |q: usize| {
        let law = &setup.materials[volume.region(q)];
        [law.lambda(), law.mu()]
    };
    volume.rows.hourglass_energy(moduli, u)
}

/// Returns the largest energy of hourglass control divided by the largest strain energy of all load steps or
/// recorded states; `energy` (J) is the strain energy at the end. `None` without hourglass control or energy.
pub(super) fn part(run: &Solved, energy: f64) -> Option<f64> {
    let Solved { setup, prepared, solution, .. } = *run;
    let volume = &prepared.volume;
    volume.rows.hourglass()?;
    let at_end = self::energy(setup, volume, &solution.u);
    let steps = solution.history.iter().flat_map(|history| history.steps.iter().zip(&history.fields));
    let (control, strain) = steps.fold((at_end, energy), |(control, strain), (step, u)| {
        (control.max(self::energy(setup, volume, u)), strain.max(step.strain_energy.unwrap_or(0.0)))
    });
    (strain > 0.0).then_some(control / strain)
}

/// Warns if the energy of hourglass control is a large part of the strain energy.
pub(super) fn warning(part: f64) -> Option<Warning> {
    (part > LARGE).then(|| {
        let message = format!(
            "{:.0} % of the strain energy is that of hourglass control, at most {:.0} % are usual: bending of single cells \
             is resisted by an artificial stiffness instead of the material. Take smaller cells, another \
             hourglass.coefficient or hourglass.modulus, or reduced = false",
            100.0 * part,
            100.0 * LARGE
        );
        Warning::new(&warning::HOURGLASS_CONTROL, part, "method.hourglass", message)
    })
}
