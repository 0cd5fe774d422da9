//! Detection of rigid motions that neither supports nor tools prevent.

use algebra::Connectivity;

use super::Newton;
use super::state::State;
use crate::nonlinear::error::StaticError;
use crate::nonlinear::problem::LinearSystems;
use crate::rigid::{add_normals, add_prescribed, add_surface, check_rows};

impl Newton<'_> {
    /// Refuses a state in which a rigid motion meets no support and no tool. Tools without friction prevent
    /// only motions against their surface; tools with friction prevent every motion of the points they touch.
    /// Modes are those of bodies that were constrained.
    pub fn check_rigid(&mut self, state: &State) -> Result<(), StaticError> {
        let problem = self.equations.problem;
        if matches!(problem.systems, LinearSystems::Modal(_)) {
            return Ok(());
        }
        let touching = match problem.tools {
            [] => Vec::new(),
            _ => self.equations.balance(state, state.time)?.contacts,
        };
        let rows = problem.solid.volume.at().rows();
        let points = Connectivity { offsets: rows.offsets(), nodes: rows.nodes(), seen_by: &[] };
        check_rows(problem.nodes, points, &[], |add| {
            add_prescribed(&self.equations.prescribed, add);
            for penalty in problem.penalties.iter().filter(|penalty| penalty.beta > 0.0) {
                let rows = penalty.surface.rows();
                match penalty.along_normal {
                    true => add_normals(rows, penalty.surface.normals(), add),
                    false => add_surface(rows, penalty.axes, add),
                }
            }
            let Some(surface) = problem.contact else { return };
            let table = surface.rows().rows();
            for (driven, contacts) in problem.tools.iter().zip(&touching) {
                let Some(contacts) = contacts else { continue };
                let sticks = driven.tool.law().friction() > 0.0;
                for (&q, traction) in contacts.points().iter().zip(contacts.tractions()) {
                    let (nodes, values) = table.row(q as usize);
                    let terms = || nodes.iter().zip(values).map(|(&node, &value)| (node as usize, value));
                    if sticks {
                        (0..3).for_each(|axis| add(&mut terms().map(|(node, value)| (node, axis, value))));
                    } else if let Some(normal) = traction.try_normalize(0.0) {
                        let along =
                            |(node, value)| (0..3).map(move |axis| (node, axis, value * normal[axis]));
                        add(&mut terms().flat_map(along));
                    }
                }
            }
        })?;
        Ok(())
    }
}
