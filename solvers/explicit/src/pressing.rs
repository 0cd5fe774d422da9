//! Rigid tools in a dynamic relaxation: displacement control, or force control with the displacement as one
//! more unknown.

use contact::{ContactCounts, ContactError, ContactHistory, ContactSearch, ContactSurface};
use contact::{Drive, Stand, Tool, ToolState};
use shape::Vector3;

use crate::critical_step::Springs;

/// Tool under a constant drive, with its initial state.
#[derive(Clone, Debug)]
pub struct PressingTool<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Displacement (m) or force along its direction (N), constant during the relaxation.
    pub drive: Drive,
    /// Displacement of the tool at the start, m. Under displacement control the tool has the displacement of
    /// its drive from the first step on.
    pub closure: f64,
    /// Friction history of the contact at the start.
    pub history: ContactHistory,
}

/// Tools on a surface during a relaxation.
///
/// The displacement of a force-driven tool follows the update rule of the nodes, with a mass of its own. This
/// is the mass at which the penalty of the whole surface has twice the time step as its critical step,
/// `m = k_n A dt^2`, so that contact is stable whichever points touch. Slip is committed after every step of
/// the relaxation, as in dynamics.
pub struct Pressing<'a> {
    surface: &'a ContactSurface<'a>,
    search: ContactSearch<'a>,
    tools: Vec<PressingTool<'a>>,
    /// Displacements of the tools at the last step, m.
    before: Vec<f64>,
    /// Last increment of every displacement, m.
    moves: Vec<f64>,
    /// Force of each tool along its direction at this step and at the last, N.
    pushed: Vec<[f64; 2]>,
    states: Vec<ToolState>,
    area: f64,
    counts: ContactCounts,
}

impl<'a> Pressing<'a> {
    /// Places the tools at their initial displacements.
    pub fn new(surface: &'a ContactSurface<'a>, mut tools: Vec<PressingTool<'a>>) -> Pressing<'a> {
        let before = tools.iter().map(|tool| tool.closure).collect();
        for tool in &mut tools {
            if let Drive::Closure(closure) = tool.drive {
                tool.closure = closure;
            }
        }
        let still = |tool: &PressingTool| ToolState::new(tool.closure, None);
        Pressing {
            surface,
            search: ContactSearch::new(surface, tools.len()),
            before,
            moves: vec![0.0; tools.len()],
            pushed: vec![[0.0; 2]; tools.len()],
            states: tools.iter().map(still).collect(),
            area: surface.rows().weights().iter().sum(),
            counts: ContactCounts::default(),
            tools,
        }
    }

    /// Continues under other drives, in the order of the tools.
    pub fn drive(&mut self, drives: impl Iterator<Item = Drive>) {
        for (tool, drive) in self.tools.iter_mut().zip(drives) {
            tool.drive = drive;
            if let Drive::Closure(closure) = drive {
                tool.closure = closure;
            }
        }
        self.moves.fill(0.0);
    }

    /// State of every tool at the last step.
    pub fn states(&self) -> &[ToolState] {
        &self.states
    }

    /// Counters of the contact search.
    pub fn counts(&self) -> ContactCounts {
        self.counts
    }

    /// Returns the surface with the largest penalty or stick slope, Pa/m.
    pub(super) fn springs(&self) -> Option<Springs<'a>> {
        let stiffest = |tool: &PressingTool| tool.tool.law().penalty().max(tool.tool.law().stick());
        let modulus = self.tools.iter().map(stiffest).reduce(f64::max)?;
        Some(Springs { surface: self.surface.rows(), modulus, damping: 0.0 })
    }

    /// Adds the contact forces (N) in the state `u` (m) to `force` and commits the contact. An error has the
    /// index of its tool.
    pub(super) fn touch(
        &mut self,
        u: &[Vector3],
        force: &mut [Vector3],
    ) -> Result<(), (usize, ContactError)> {
        let mut search = self.search.at(u);
        for (k, tool) in self.tools.iter_mut().enumerate() {
            let lost = |cause| (k, cause);
            let contacts = search
                .tractions(k, tool.tool, tool.closure, &tool.history, &mut self.counts)
                .map_err(lost)?;
            tool.history.commit(contacts.as_ref());
            let touches = contacts.as_ref().is_some_and(|c| !c.points().is_empty());
            let travel = [std::mem::replace(&mut self.before[k], tool.closure), tool.closure];
            self.surface.check_travel(tool.tool, travel, u, touches).map_err(lost)?;
            if let Some(contacts) = &contacts {
                contacts.add_force(self.surface.rows(), force);
            }
            let state = ToolState::new(tool.closure, contacts.as_ref());
            let pushed = tool.tool.driving_force(tool.closure, &state.force, &state.moment);
            self.pushed[k] = [pushed, self.pushed[k][0]];
            self.states[k] = state;
        }
        Ok(())
    }

    /// Checks the final state `u` (m): no tool may push from within the body, or overlap the body without
    /// contact. During the relaxation both may happen. An error has the index of its tool.
    pub(super) fn check_sides(&mut self, u: &[Vector3]) -> Result<(), (usize, ContactError)> {
        for (k, tool) in self.tools.iter().enumerate() {
            let lost = |cause| (k, cause);
            let contacts = (self.surface)
                .tractions(tool.tool, tool.closure, u, &tool.history, &mut self.counts)
                .map_err(lost)?;
            match contacts.filter(|c| !c.points().is_empty()) {
                Some(contacts) => self.surface.check_side(&contacts, u),
                None => self.surface.check_end(tool.tool, Stand { closure: tool.closure, u }),
            }
            .map_err(lost)?;
        }
        Ok(())
    }

    fn mass(&self, tool: &PressingTool, dt: f64) -> f64 {
        tool.tool.law().penalty() * self.area * dt * dt
    }

    /// Returns `(dd . dQ, dd . m dd)` of the last increments of displacement: their part in the Rayleigh
    /// quotient.
    pub(super) fn quotient(&self, dt: f64) -> (f64, f64) {
        let each = self.tools.iter().zip(&self.moves).zip(&self.pushed);
        each.fold((0.0, 0.0), |(stiff, inert), ((tool, d), [now, before])| {
            (stiff + d * (now - before), inert + self.mass(tool, dt) * d * d)
        })
    }

    /// Advances the displacements of force-driven tools, `d <- r^2 d + s^2 (F - Q) / m`. Returns the largest
    /// increment (m) and the largest force imbalance (N).
    pub(super) fn advance(&mut self, dt: f64, r: f64, s: f64) -> (f64, f64) {
        let (mut moved, mut lacking) = (0.0f64, 0.0f64);
        for k in 0..self.tools.len() {
            let Drive::Force(full) = self.tools[k].drive else { continue };
            let out = full - self.pushed[k][0];
            self.moves[k] = r * r * self.moves[k] + s * s / self.mass(&self.tools[k], dt) * out;
            self.tools[k].closure += self.moves[k];
            moved = moved.max(self.moves[k].abs());
            lacking = lacking.max(out.abs());
        }
        (moved, lacking)
    }
}
