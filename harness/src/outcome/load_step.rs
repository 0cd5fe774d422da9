//! State at the end of a load step, or a recorded state of dynamics.

use catalogue::metric;
use contact::{Tool, ToolState};
use geometry::{Point3, Vector3};
use shape::Resultant;

use super::metrics::Metric;

/// Fewest points that have to carry a tool's force. Three points define a plane.
const FEWEST: f64 = 3.0;

/// State of a tool at the end of a load step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolStep {
    /// Travel from the start, m.
    pub closure: f64,
    /// Force on the tool, N.
    pub force: Vector3,
    /// Moment on the tool about the coordinate origin, N m.
    pub moment: Vector3,
    /// Force that the tool exerts along its direction of travel, N.
    pub pushed: f64,
    /// Surface points in contact.
    pub active: u64,
    /// Effective number of points that carry the force: n if n points carry equal forces, 1 if one point
    /// carries all.
    pub carriers: f64,
    /// Undeformed area of the points in contact, m^2.
    pub area: f64,
    /// Deepest penetration, m.
    pub penetration: f64,
}

impl ToolStep {
    /// Converts the solver's state of a tool.
    pub(crate) fn of(state: &ToolState, tool: &Tool) -> ToolStep {
        ToolStep {
            closure: state.closure,
            force: state.force,
            moment: state.moment + tool.place(state.closure).coords.cross(&state.force),
            // The sum yields 0 for a tool without contact, which would otherwise have -0.
            pushed: 0.0 + tool.driving_force(state.closure, &state.force, &state.moment),
            active: state.active as u64,
            carriers: state.carriers,
            area: state.area,
            penetration: state.penetration,
        }
    }

    /// Returns the moment on the tool about a point (m), N m.
    pub(crate) fn moment_about(&self, point: &Point3) -> Vector3 {
        Resultant { force: self.force, moment: self.moment }.about(point)
    }

    /// Whether so few points carry the force that it depends on their positions: the surface is too coarse
    /// for the tool.
    pub fn is_carried_by_few(&self) -> bool {
        self.active > 0 && self.carriers < FEWEST
    }

    /// Initial state of every tool.
    pub const UNTOUCHED: ToolStep = ToolStep {
        closure: 0.0,
        force: Vector3::new(0.0, 0.0, 0.0),
        moment: Vector3::new(0.0, 0.0, 0.0),
        pushed: 0.0,
        active: 0,
        carriers: 0.0,
        area: 0.0,
        penetration: 0.0,
    };
}

/// State at the end of a load step.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadStep {
    /// Fraction of the loading, 0 to 1; in dynamics, fraction of the time.
    pub load: f64,
    /// States of the tools of the scene.
    pub tools: Vec<ToolStep>,
    /// Resultant of each support's forces on the body; empty if unknown.
    pub supports: Vec<Resultant>,
    /// Mean displacement of each face for which the scene requests it, m.
    pub means: Vec<Vector3>,
    /// Strain energy, J.
    pub strain_energy: Option<f64>,
    /// Smallest volume ratio of all quadrature points.
    pub smallest_j: f64,
    /// Solved linear systems.
    pub iterations: u64,
    /// Displacement at the scene's probes, m.
    pub probes: Vec<Vector3>,
    /// Numbers of points and surfaces: displacements, stresses, stretches, volumes.
    pub points: Vec<Metric>,
    /// Errors against the reference at the same step.
    pub against: Vec<Metric>,
    /// Other results of the procedure: time and energies in dynamics.
    pub more: Vec<Metric>,
}

impl LoadStep {
    /// Time in dynamics, s.
    pub fn time(&self) -> Option<f64> {
        self.more.iter().find(|m| *m.of.metric == metric::TIME).map(|m| m.value)
    }

    /// State before any load is applied.
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
            points: Vec::new(),
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
