//! The end of a load step or a recorded state of a motion.

use catalogue::metric;
use contact::{Tool, ToolState};
use geometry::Vector3;

use super::Metric;

/// Points that have to carry a tool's force: three hold a plane.
const FEWEST: f64 = 3.0;

/// A tool at the end of a load step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolStep {
    /// Way from its start, m.
    pub closure: f64,
    /// Force on the tool, N.
    pub force: Vector3,
    /// Force that it exerts along its way, N.
    pub pushed: f64,
    /// Surface points in contact.
    pub active: u64,
    /// How many of them carry the force: n where n points have the same, 1 where one has it all.
    pub carriers: f64,
    /// Their undeformed area, m^2.
    pub area: f64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

impl ToolStep {
    /// Of the solver's state of a tool.
    pub(crate) fn of(state: &ToolState, tool: &Tool) -> ToolStep {
        ToolStep {
            closure: state.closure,
            force: state.force,
            // Of a tool that touches nothing 0, which a sign in front makes -0.
            pushed: 0.0 - state.force.dot(&tool.along()),
            active: state.active as u64,
            carriers: state.carriers,
            area: state.area,
            penetration: state.penetration,
        }
    }

    /// Whether so few points carry the force that it depends on where they happen to be: the surface is too coarse for the tool.
    pub fn is_carried_by_few(&self) -> bool {
        self.active > 0 && self.carriers < FEWEST
    }

    /// Where every tool starts.
    pub const UNTOUCHED: ToolStep = ToolStep {
        closure: 0.0,
        force: Vector3::new(0.0, 0.0, 0.0),
        pushed: 0.0,
        active: 0,
        carriers: 0.0,
        area: 0.0,
        penetration: 0.0,
    };
}

/// The end of a load step.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadStep {
    /// Part of the loading, 0 to 1; of the time in dynamics.
    pub load: f64,
    /// One per tool of the scene.
    pub tools: Vec<ToolStep>,
    /// Force of each support on the body, N; none where it is not known.
    pub supports: Vec<Vector3>,
    /// Mean displacement of each face whose mean is asked for, m.
    pub means: Vec<Vector3>,
    /// Strain energy, J.
    pub strain_energy: Option<f64>,
    /// Smallest volume ratio of all quadrature points.
    pub smallest_j: f64,
    /// Linear systems solved.
    pub iterations: u64,
    /// Displacement at the scene's probes, m.
    pub probes: Vec<Vector3>,
    /// Errors against the reference at the same step.
    pub against: Vec<Metric>,
    /// What else the procedure reports: time and energies in dynamics.
    pub more: Vec<Metric>,
}

impl LoadStep {
    /// Time in dynamics, s.
    pub fn time(&self) -> Option<f64> {
        self.more.iter().find(|m| *m.entry == metric::TIME).map(|m| m.value)
    }

    /// Before anything acts.
    pub(crate) fn at_start(tools: usize) -> LoadStep {
        LoadStep {
            load: 0.0,
            tools: vec![ToolStep::UNTOUCHED; tools],
            supports: Vec::new(),
            means: Vec::new(),
            strain_energy: Some(0.0),
            smallest_j: 1.0,
            iterations: 0,
            probes: Vec::new(),
            against: Vec::new(),
            more: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_points_are_enough_and_none_is_no_contact() {
        let tool = |active, carriers| ToolStep { active, carriers, ..ToolStep::UNTOUCHED };
        assert!(tool(1, 1.0).is_carried_by_few() && tool(40, 2.9).is_carried_by_few());
        assert!(!tool(3, 3.0).is_carried_by_few() && !tool(0, 0.0).is_carried_by_few());
    }
}
