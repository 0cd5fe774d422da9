//! Which run a scenario is.

use cases::scene::{self, Family, ProcedureKind};

use super::Scenario;
use crate::outcome::Identity;

impl Scenario<'_> {
    /// Which run this is.
    pub fn identity(&self) -> Identity {
        let mut pairs: Vec<(&str, String)> = Vec::new();
        let (family, variant, seed) = match &self.method.family {
            Family::Fem(fem) => {
                pairs.push(("dilation", fem.dilation.name().into()));
                if fem.reduced {
                    pairs.push(("points", "2x2x2".into()));
                }
                ("fem", fem.element.name().to_string(), fem.jitter.map_or(0, |j| j.seed))
            }
            Family::Efg(efg) => {
                pairs.push(("dilation", efg.dilation.name().into()));
                pairs.push(("basis", efg.functions.basis().into()));
                let variant = match efg.functions {
                    scene::Functions::MovingLeastSquares { kernel, support, shape, .. } => {
                        match support {
                            scene::SupportRule::Dilatation(d) => pairs.push(("dilatation", d.to_string())),
                            scene::SupportRule::Neighbours { k, factor } => {
                                pairs.push(("neighbours", k.to_string()));
                                pairs.push(("factor", factor.to_string()));
                            }
                        }
                        if shape == scene::SupportShape::Adapted {
                            pairs.push(("support", shape.name().into()));
                        }
                        kernel.name.name()
                    }
                    scene::Functions::MaximumEntropy { gamma } => {
                        pairs.push(("gamma", gamma.to_string()));
                        efg.functions.basis()
                    }
                };
                if let scene::Cloud::Refined { refine, .. } = efg.cloud {
                    pairs.push(("refine", format!("gradient-error-{}-ratio-{}", refine.steps, refine.ratio)));
                }
                pairs.push((
                    "integration",
                    match efg.integration {
                        scene::Integration::Gauss { points } => format!("gauss-{points}"),
                        scene::Integration::Grid { points, .. } => format!("grid-{points}"),
                        scene::Integration::CellSmoothed { order: 1, face_points } => {
                            format!("cell-smoothed-{face_points}")
                        }
                        scene::Integration::CellSmoothed { order, face_points } => {
                            format!("cell-smoothed-{face_points}-order-{order}")
                        }
                        scene::Integration::NodeSmoothed { stabilisation, face_points } => {
                            format!("node-smoothed-{face_points}-stabilisation-{stabilisation}")
                        }
                    },
                ));
                let with = |name: &str, factor: Option<f64>| {
                    factor.map_or_else(|| name.to_string(), |factor| format!("{name}-{factor}"))
                };
                pairs.push((
                    "essential",
                    match efg.essential {
                        scene::Essential::Nitsche { factor } => with("nitsche", factor),
                        scene::Essential::Penalty { factor } => with("penalty", factor),
                        scene::Essential::Multipliers => "multipliers".into(),
                        scene::Essential::Coupling => "coupling".into(),
                        scene::Essential::Elimination { rows } => format!("elimination-{}", rows.name()),
                    },
                ));
                let seed = match &efg.cloud {
                    scene::Cloud::Mesh { jitter, .. } => jitter.map_or(0, |j| j.seed),
                    scene::Cloud::File { .. } => 0,
                    scene::Cloud::Uniform { seed, .. }
                    | scene::Cloud::Graded { seed, .. }
                    | scene::Cloud::Refined { seed, .. } => *seed,
                };
                ("efg", variant.to_string(), seed)
            }
        };
        let law = self.scene.material.name();
        if !matches!(self.scene.procedure.kind, ProcedureKind::Linear | ProcedureKind::Modes) {
            pairs.push(("law", law.into()));
        }
        if let Some(mass) = self.method.mass {
            pairs.push(("mass", mass.name().into()));
        }
        pairs.sort();
        Identity {
            case: self.case.clone(),
            method: self.method.id.clone(),
            family,
            variant,
            parameters: pairs.iter().map(|(k, v)| format!("{k}={v}")).collect::<Vec<_>>().join(";"),
            // From the moduli of a law it comes back as 0.49500000000000005: twelve digits are those of the scene.
            poisson: self.laws().map_or(0.0, |(_, materials)| (materials[0].poisson() * 1e12).round() / 1e12),
            level: self.level,
            seed,
        }
    }
}
