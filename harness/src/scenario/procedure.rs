//! How a scenario is solved: the parameters of its procedure.

use cases::scene::ProcedureKind;
use material::Prony;
use statics::{NewtonParams, StaticParams, TimeParams};

use super::Scenario;
use crate::Failure;
use crate::error::Key;
use crate::explicit::ExplicitParams;
use crate::in_time::InTimeParams;
use crate::modes::ModesParams;

/// Part of a load step below which cutting it back is given up: six halvings.
const SMALLEST: f64 = 1.0 / 64.0;

impl Scenario<'_> {
    pub(super) fn statics(&self) -> Option<StaticParams> {
        let procedure = self.scene.procedure;
        let newton = procedure.newton;
        (procedure.kind == ProcedureKind::Static).then_some(StaticParams {
            steps: procedure.steps,
            smallest: SMALLEST,
            newton: NewtonParams { tolerance: newton.tolerance, iterations: newton.iterations, chords: true },
            augmentations: newton.augmentations,
            limit_within: procedure.limit_within,
        })
    }

    pub(super) fn explicit(&self) -> Option<ExplicitParams> {
        let procedure = self.scene.procedure;
        let asked = procedure.explicit;
        let duration = procedure.duration.filter(|_| procedure.kind == ProcedureKind::Explicit)?;
        Some(ExplicitParams {
            duration,
            ramp: procedure.over.unwrap_or(duration),
            states: procedure.steps,
            damping: procedure.damping,
            safety: asked.safety,
            step: asked.step,
            tool_mass: asked.tool_mass,
            density: self.density(),
            over: self.scene.tools.iter().map(|t| t.over.unwrap_or(duration)).collect(),
        })
    }

    pub(super) fn modes(&self) -> Option<ModesParams> {
        let procedure = self.scene.procedure;
        let mass = self.method.mass.filter(|_| procedure.kind == ProcedureKind::Modes)?;
        Some(ModesParams { mass, count: procedure.modes, density: self.density() })
    }

    /// Densities by region; a scene whose procedure needs one it lacks is refused before.
    fn density(&self) -> Vec<f64> {
        self.scene.materials().map(|(_, material)| material.density.unwrap_or(f64::NAN)).collect()
    }

    pub(super) fn in_time(&self) -> Result<Option<InTimeParams>, Failure> {
        let procedure = self.scene.procedure;
        let asked = procedure.implicit;
        let Some(end) = procedure.duration.filter(|_| procedure.kind == ProcedureKind::ImplicitDynamic)
        else {
            return Ok(None);
        };
        let relaxation = self.scene.materials().map(|(key, material)| {
            let terms: Vec<(f64, f64)> = material.prony.iter().map(|t| (t.g, t.tau)).collect();
            let wrong = |bad: material::MaterialError| {
                Failure::input(Key::Scene(format!("{key}.prony")), bad.to_string(), "")
            };
            if terms.is_empty() { Ok(None) } else { Prony::new(&terms).map(Some).map_err(wrong) }
        });
        Ok(Some(InTimeParams {
            time: TimeParams {
                end,
                steps: procedure.steps,
                // An accuracy asks for steps as short as it takes.
                smallest: if asked.accuracy.is_some() { 1e-6 } else { SMALLEST },
                accuracy: asked.accuracy,
                rho_inf: asked.spectral_radius,
                newton: NewtonParams {
                    tolerance: procedure.newton.tolerance,
                    iterations: procedure.newton.iterations,
                    chords: true,
                },
                augmentations: procedure.newton.augmentations,
            },
            density: asked.inertia.then(|| self.density()),
            damping: procedure.damping,
            ramp: procedure.over.unwrap_or(end),
            over: self.scene.tools.first().and_then(|t| t.over).unwrap_or(end),
            relaxation: relaxation.collect::<Result<_, _>>()?,
        }))
    }
}
