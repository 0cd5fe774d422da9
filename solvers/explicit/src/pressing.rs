//! Rigid tools in a dynamic relaxation: a closure that is led, or one more unknown that a force moves.

use contact::{ContactCounts, ContactError, ContactHistory, ContactSearch, ContactSurface};
use contact::{Drive, Stand, Tool, ToolState};
use shape::Vector3;

/// A tool under a constant drive, in the state that it starts from.
#[derive(Clone, Debug)]
pub struct PressingTool<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Closure (m) or force along its way (N), constant through the relaxation.
    pub drive: Drive,
    /// Closure at the start, m; that of the drive from the first step on if it is led.
    pub closure: f64,
    /// What its contact remembers.
    pub history: ContactHistory,
}

/// Tools on a surface through a relaxation.
///
/// The closure of a tool that a force drives follows the rule of the nodes, with a mass of its own: that on which the penalty
/// of the whole surface swings with twice the time step as its critical one, `m = k_n A dt^2`, so that contact is stable
/// whatever touches. Slip is kept after every step of the relaxation, as in dynamics.
pub struct Pressing<'a> {
    surface: &'a ContactSurface<'a>,
    search: ContactSearch<'a>,
    tools: Vec<PressingTool<'a>>,
    /// Closures at the last step, m.
    before: Vec<f64>,
    /// Last move of every closure, m.
    moves: Vec<f64>,
    /// Force that each exerts along its way at this and at the last step, N.
    pushed: Vec<[f64; 2]>,
    states: Vec<ToolState>,
    area: f64,
    counts: ContactCounts,
}

impl<'a> Pressing<'a> {
    /// Tools as they stand.
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

    /// Goes on under other drives, in the tools' order.
    pub fn drive(&mut self, drives: impl Iterator<Item = Drive>) {
        for (tool, drive) in self.tools.iter_mut().zip(drives) {
            tool.drive = drive;
            if let Drive::Closure(closure) = drive {
                tool.closure = closure;
            }
        }
        self.moves.fill(0.0);
    }

    /// Every tool as of the last step.
    pub fn states(&self) -> &[ToolState] {
        &self.states
    }

    /// What the contact search did and skipped.
    pub fn counts(&self) -> ContactCounts {
        self.counts
    }

    /// The surface with the largest penalty or stick slope, Pa/m.
    pub(super) fn springs(&self) -> Option<super::Springs<'a>> {
        let stiffest = |tool: &PressingTool| tool.tool.law().penalty().max(tool.tool.law().stick());
        let modulus = self.tools.iter().map(stiffest).reduce(f64::max)?;
        Some(super::Springs { surface: self.surface.rows(), modulus })
    }

    /// Contact forces (N) in the state `u` (m), added to `force`, and committed; fails with the index of a tool.
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
            self.states[k] = ToolState::new(tool.closure, contacts.as_ref());
            self.pushed[k] = [-self.states[k].force.dot(&tool.tool.along()), self.pushed[k][0]];
        }
        Ok(())
    }

    /// Fails where a tool pushes from within the body, or stands in it and touches nothing, in the state `u` (m) at the end: on
    /// the way there it may.
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

    /// `(dd . dQ, dd . m dd)` of the closures' last moves: their share in the Rayleigh quotient.
    pub(super) fn quotient(&self, dt: f64) -> (f64, f64) {
        let each = self.tools.iter().zip(&self.moves).zip(&self.pushed);
        each.fold((0.0, 0.0), |(stiff, inert), ((tool, d), [now, before])| {
            (stiff + d * (now - before), inert + self.mass(tool, dt) * d * d)
        })
    }

    /// Moves the closures that a force drives, `d <- r^2 d + s^2 (F - Q) / m`; the largest move (m) and the largest force that
    /// is lacking (N).
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
