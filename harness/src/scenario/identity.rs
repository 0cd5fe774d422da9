//! Identity of a scenario's run in records.

use cases::scene::{self, Family, ProcedureKind};
use records::Purpose;

use super::Scenario;
use crate::adapter;
use crate::outcome::Identity;

impl Scenario<'_> {
    /// Returns the identity of this run.
    pub fn identity(&self) -> Identity {
        let large = !matches!(self.scene.procedure.kind(), ProcedureKind::Linear | ProcedureKind::Modes);
        Identity {
            case: self.case.clone(),
            purpose: purpose(self.scene.purpose),
            published: self.scene.published.map_or("", |p| p.name()).into(),
            law: large.then(|| self.scene.material.name().into()),
            // Computed from a law's moduli, the value would be 0.49500000000000005. Twelve digits restore the
            // scene's value.
            poisson: self.laws().map_or(0.0, |(_, materials)| (materials[0].poisson() * 1e12).round() / 1e12),
            level: self.level,
            axis: self.scene.varied.as_ref().map_or(String::new(), |(name, _)| name.clone()),
            at: self.scene.varied.as_ref().map(|(_, value)| *value),
            ..method_identity(&self.method)
        }
    }
}

/// Returns what a scene says of a method, without the size.
pub(crate) fn method_identity(method: &scene::Method) -> Identity {
    let identity = Identity {
        method: method.id.clone(),
        series: method.series.clone(),
        mass: method.mass.map(|mass| mass.name().into()),
        ..Identity::default()
    };
    match &method.family {
        Family::Fem(fem) => of_elements(fem, identity),
        Family::Efg(efg) => of_cloud(efg, identity),
        Family::External(external) => Identity {
            family: records::Family::External,
            adapter: Some(adapter::label(&external.adapter, &external.settings)),
            variant: external.elements.element.name().into(),
            seed: external.elements.jitter.map_or(0, |j| j.seed),
            ..identity
        },
    }
}

fn of_elements(fem: &scene::Fem, identity: Identity) -> Identity {
    Identity {
        family: records::Family::Fem,
        variant: fem.element.name().into(),
        dilation: Some(fem.dilation.name().into()),
        integration: integration(fem),
        refine: adapt(fem),
        seed: fem.jitter.map_or(0, |j| j.seed),
        ..identity
    }
}

/// Names the reduced integration of elements in records, with its hourglass control.
fn integration(fem: &scene::Fem) -> Option<String> {
    let points = fem.element.reduced().filter(|_| fem.reduced)?;
    Some(match fem.hourglass {
        Some(control) => format!("{points}-hourglass-{}-{}", control.coefficient, control.modulus.name()),
        None => points.into(),
    })
}

/// Names the refinement of a mesh in records.
fn adapt(fem: &scene::Fem) -> Option<String> {
    fem.adapt.map(|scene::Adapt { by, error, rounds }| format!("{by}-{error}-rounds-{rounds}"))
}

fn of_cloud(efg: &scene::Efg, identity: Identity) -> Identity {
    let mut identity = Identity {
        family: records::Family::Efg,
        basis: Some(efg.functions.basis().into()),
        dilation: Some(efg.dilation.name().into()),
        integration: Some(rule(efg.integration)),
        essential: Some(essential(efg.essential)),
        seed: match &efg.cloud {
            scene::Cloud::Mesh { jitter, .. } => jitter.map_or(0, |j| j.seed),
            scene::Cloud::File { .. } => 0,
            scene::Cloud::Uniform { seed, .. }
            | scene::Cloud::Graded { seed, .. }
            | scene::Cloud::Refined { seed, .. } => *seed,
        },
        ..identity
    };
    match efg.functions {
        scene::Functions::MovingLeastSquares { kernel, support, shape, .. } => {
            match support {
                scene::SupportRule::Scale(d) => identity.support_scale = Some(d),
                scene::SupportRule::Neighbours { k, factor } => {
                    (identity.neighbours, identity.neighbour_factor) = (Some(k as u64), Some(factor));
                }
            }
            identity.neighbourhood = (shape == scene::SupportShape::Ellipsoid).then(|| shape.name().into());
            identity.variant = kernel.name().into();
            identity.kernel = Some(kernel.name().into());
        }
        scene::Functions::MaximumEntropy { gamma } => {
            identity.variant = efg.functions.basis().into();
            identity.gamma = Some(gamma);
        }
    }
    if let scene::Cloud::Refined { refine, .. } = efg.cloud {
        identity.refine = Some(format!("gradient-error-{}-ratio-{}", refine.steps, refine.ratio));
    }
    identity
}

/// Names an integration rule in records.
pub(crate) fn rule(integration: scene::Integration) -> String {
    match integration {
        scene::Integration::Gauss { points } => format!("gauss-{points}"),
        scene::Integration::Grid { points, .. } => format!("grid-{points}"),
        scene::Integration::CellSmoothed { order: 1, face_points } => format!("cell-smoothed-{face_points}"),
        scene::Integration::CellSmoothed { order, face_points } => {
            format!("cell-smoothed-{face_points}-order-{order}")
        }
        scene::Integration::NodeSmoothed { stabilisation, face_points } => {
            format!("node-smoothed-{face_points}-stabilisation-{stabilisation}")
        }
    }
}

fn essential(essential: scene::Essential) -> String {
    let name = essential.kind().name();
    match essential {
        scene::Essential::Nitsche { factor: Some(factor) }
        | scene::Essential::Penalty { factor: Some(factor) } => {
            format!("{name}-{factor}")
        }
        scene::Essential::Elimination { rows } => format!("{name}-{}", rows.name()),
        _ => name.into(),
    }
}

/// Converts the purpose of a scene to that of records.
pub(crate) fn purpose(of: scene::Purpose) -> Purpose {
    match of {
        scene::Purpose::Patch => Purpose::Patch,
        scene::Purpose::Smooth => Purpose::Smooth,
        scene::Purpose::Rough => Purpose::Rough,
        scene::Purpose::Published => Purpose::Published,
    }
}

#[cfg(test)]
mod tests {
    use cases::scene::Publication;

    #[test]
    fn the_report_has_the_claim_of_every_publication() {
        for publication in Publication::ALL {
            let claim = |claim: &reports::Claim| claim.id == publication.name();
            assert!(reports::own_claims().iter().any(claim), "{}", publication.name());
        }
    }
}
