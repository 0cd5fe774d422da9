//! Rigid tools in explicit dynamics: driven by displacement or force, in contact by penalty with friction.

use contact::{
    ContactCounts, ContactError, ContactHistory, ContactSearch, ContactSurface, Contacts, Drive, Stand, Tool,
    ToolState,
};
use shape::{Curve, Point3, Vector3};

use crate::critical_step::Springs;
use crate::error::ExplicitError;

/// Tool with its drive and its ramp.
///
/// At t = 0 every tool is placed at its first contact with the body, with zero gap. A ramp over seconds would
/// otherwise spend part of its time on the approach. From there a displacement grows in proportion to time,
/// from that of first contact to the requested value, and a force grows from zero. A tool that would not
/// touch the body before it reaches its requested displacement, or a force-driven tool that would pass by,
/// starts from displacement 0 instead.
///
/// A force needs a mass to act on: `m d'' = F - F_contact - alpha m d'` along the direction, by central
/// differences with the body's time step. The mass is a free parameter if a case gives none. It adds its
/// inertia `m d''` to the force on the tissue and oscillates on the tissue at `sqrt(k / m)`. It should be
/// light compared with the body (a tenth), and heavy enough for the time step (see
/// [`ExplicitError::LightTool`]).
#[derive(Clone, Copy, Debug)]
pub struct MovingTool<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Displacement (m) or force (N) along the tool's direction at the end of the ramp.
    pub drive: Drive,
    /// Length of the ramp, s; the drive is constant afterwards.
    pub over: f64,
    /// Curve of the drive over time (s) in place of the ramp. The tool then starts where it stands, not at
    /// first contact.
    pub curve: Option<&'a Curve>,
    /// Mass of a force-driven tool, kg.
    pub mass: f64,
    /// Mass-proportional damping of a force-driven tool, 1/s.
    pub damping: f64,
}

/// Tool at a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolMotion {
    /// Displacement, force and contact of the tool.
    pub state: ToolState,
    /// Speed along its direction over the previous step, m/s.
    pub speed: f64,
}

/// Energies of all tools, J. Work and losses are sums since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToolEnergies {
    /// Work of the drives: of the drive force along the tool's path, or, for a displacement-driven tool, the
    /// work against its contact force.
    pub work: f64,
    /// Kinetic energy of the force-driven tools at the last step.
    pub kinetic: f64,
    /// Energy stored in the contact at the last step, `sum_q w (p^2 / (2 k_n) + k_t |e|^2 / 2)`, with the
    /// pressure `p` and the elastic slip `e` of each point.
    pub stored: f64,
    /// Energy lost to friction.
    pub friction: f64,
    /// Energy lost to the damping of force-driven tools.
    pub damping: f64,
}

/// Moving tools with their contact, as a part of [`super::Dynamics`].
pub struct Tools<'a> {
    surface: &'a ContactSurface<'a>,
    search: ContactSearch<'a>,
    each: Vec<Moving<'a>>,
    forces: Vec<Vector3>,
    /// Nodes with a contact force, each once.
    loaded: Vec<u32>,
    /// Whether each node has a contact force.
    is_loaded: Vec<bool>,
    counts: ContactCounts,
}

struct Moving<'a> {
    of: MovingTool<'a>,
    history: ContactHistory,
    /// Displacement at first contact, m.
    touch: f64,
    /// Displacement at the next step, m.
    closure: f64,
    /// Displacement at the previous step, m.
    before: f64,
    /// Speed at `n - 1/2`, m/s.
    speed: f64,
    motion: ToolMotion,
    /// Drive force or contact force at the previous step, for its work, N.
    worked: f64,
    energies: ToolEnergies,
    /// Half of this step's damping work, which belongs to the next step, J.
    pending: f64,
}

impl<'a> Tools<'a> {
    /// Places the tools at their first contact with the body in the state `u` (m).
    ///
    /// # Errors
    ///
    /// [`ExplicitError::BadParameter`] or [`ExplicitError::Length`] for invalid input.
    pub fn new(
        surface: &'a ContactSurface<'a>,
        tools: &[MovingTool<'a>],
        u: &[Vector3],
    ) -> Result<Tools<'a>, ExplicitError> {
        let bad = |what, value, allowed| Err(ExplicitError::BadParameter { what, value, allowed });
        for tool in tools {
            if !(tool.over >= 0.0 && tool.over.is_finite()) {
                return bad("ramp of a tool", tool.over, "finite and not negative");
            }
            if !(tool.damping >= 0.0 && tool.damping.is_finite()) {
                return bad("damping of a tool", tool.damping, "finite and not negative");
            }
            if matches!(tool.drive, Drive::Force(_)) && !(tool.mass > 0.0 && tool.mass.is_finite()) {
                return bad("mass of a tool driven by force", tool.mass, "positive and finite");
            }
        }
        let found = surface.rows().rows().node_count();
        if u.len() != found {
            return Err(ExplicitError::Length { what: "displacements", found: u.len(), expected: found });
        }
        let each = tools.iter().map(|&of| Moving::new(of, surface, u)).collect();
        let forces = vec![Vector3::zeros(); u.len()];
        let search = ContactSearch::new(surface, tools.len());
        let loaded = Vec::new();
        let is_loaded = vec![false; u.len()];
        Ok(Tools { surface, search, each, forces, loaded, is_loaded, counts: ContactCounts::default() })
    }

    /// Iterates over the motions of all tools at the last step.
    pub fn motions(&self) -> impl Iterator<Item = ToolMotion> {
        self.each.iter().map(|tool| tool.motion)
    }

    /// Returns the energies at the last step.
    pub fn energies(&self) -> ToolEnergies {
        self.each.iter().fold(ToolEnergies::default(), |a, tool| {
            let b = &tool.energies;
            ToolEnergies {
                work: a.work + b.work,
                kinetic: a.kinetic + b.kinetic,
                stored: a.stored + b.stored,
                friction: a.friction + b.friction,
                damping: a.damping + b.damping,
            }
        })
    }

    /// Checks that no tool without contact overlaps the body at `step`, with the displacements `u` (m) of
    /// that step.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::ContactAt`] with the first such tool.
    pub fn check_overlap(&self, step: usize, time: f64, u: &[Vector3]) -> Result<(), ExplicitError> {
        self.check(step, time, u, |surface, tool, stand| surface.check_overlap(tool, stand))
    }

    /// Checks as [`Tools::check_overlap`] at the end of the motion, when no further contact can follow.
    ///
    /// # Errors
    ///
    /// [`ExplicitError::ContactAt`] with the first such tool.
    pub fn check_end(&self, step: usize, time: f64, u: &[Vector3]) -> Result<(), ExplicitError> {
        self.check(step, time, u, |surface, tool, stand| surface.check_end(tool, stand))
    }

    fn check(
        &self,
        step: usize,
        time: f64,
        u: &[Vector3],
        check: impl Fn(&ContactSurface, &Tool, Stand) -> Result<(), ContactError>,
    ) -> Result<(), ExplicitError> {
        for (tool, moving) in self.each.iter().enumerate().filter(|(_, m)| m.motion.state.active == 0) {
            let stand = Stand { closure: moving.motion.state.closure, u };
            check(self.surface, moving.of.tool, stand).map_err(|cause| ExplicitError::ContactAt {
                step,
                time,
                tool,
                cause,
            })?;
        }
        Ok(())
    }

    /// Counters of the contact search.
    pub fn counts(&self) -> ContactCounts {
        self.counts
    }

    /// Returns the largest possible contact stiffness: the largest penalty or stick slope on the whole
    /// surface. A point is assumed to touch one tool at a time.
    pub(super) fn springs(&self) -> Option<Springs<'a>> {
        let stiffest = |tool: &Moving| tool.of.tool.law().penalty().max(tool.of.tool.law().stick());
        let modulus = self.each.iter().map(stiffest).reduce(f64::max)?;
        Some(Springs { surface: self.surface.rows(), modulus, damping: 0.0 })
    }

    /// Iterates over the nodes with a contact force on the tissue at the last step, each once, with that
    /// force, N.
    pub(super) fn forces(&self) -> impl Iterator<Item = (usize, &Vector3)> {
        self.loaded.iter().map(|&node| (node as usize, &self.forces[node as usize]))
    }

    /// Computes and commits contact at step `n` in the state `u`. Then computes the tools' speeds at
    /// `n + 1/2` and displacements at `n + 1`.
    pub(super) fn step(
        &mut self,
        step: usize,
        time: f64,
        dt: [f64; 2],
        u: &[Vector3],
    ) -> Result<(), ExplicitError> {
        // A few dozen nodes have a force: clearing and visiting all nodes took a fortieth of a step.
        for node in self.loaded.drain(..) {
            self.forces[node as usize] = Vector3::zeros();
            self.is_loaded[node as usize] = false;
        }
        let mut search = self.search.at(u);
        for (index, tool) in self.each.iter_mut().enumerate() {
            let lost = |cause| ExplicitError::ContactAt { step, time, tool: index, cause };
            let contacts = search
                .tractions(index, tool.of.tool, tool.closure, &tool.history, &mut self.counts)
                .map_err(lost)?;
            tool.history.commit(contacts.as_ref());
            if let Some(contacts) = &contacts {
                let rows = self.surface.rows();
                contacts.add_force(rows, &mut self.forces);
                for &node in contacts.points().iter().flat_map(|&q| rows.rows().row(q as usize).0) {
                    if !std::mem::replace(&mut self.is_loaded[node as usize], true) {
                        self.loaded.push(node);
                    }
                }
            }
            tool.settle(contacts.as_ref(), self.surface);
            tool.check(index, step, time, dt, contacts.as_ref(), self.surface)?;
            let travel = [std::mem::replace(&mut tool.before, tool.closure), tool.closure];
            let touches = tool.motion.state.active > 0;
            (self.surface.check_travel(tool.of.tool, travel, u, touches)).map_err(lost)?;
            let within = contacts.iter().try_for_each(|c| self.surface.check_side(c, u));
            within.map_err(lost)?;
            tool.advance(step == 0, time, dt);
        }
        Ok(())
    }
}

impl<'a> Moving<'a> {
    fn new(of: MovingTool<'a>, surface: &ContactSurface, u: &[Vector3]) -> Moving<'a> {
        let full = if let Drive::Closure(full) = of.drive { full } else { f64::INFINITY };
        let touch = touch(of.tool, full, surface, u);
        let mut moving = Moving {
            of,
            history: ContactHistory::new(of.tool, surface.rows().points().len()),
            touch,
            closure: 0.0,
            before: 0.0,
            speed: 0.0,
            motion: ToolMotion { state: ToolState::new(0.0, None), speed: 0.0 },
            worked: 0.0,
            energies: ToolEnergies::default(),
            pending: 0.0,
        };
        moving.closure = match of.drive {
            Drive::Closure(_) => moving.led(0.0),
            // A force on a tool that never touches moves the tool from its initial position.
            Drive::Force(_) if of.curve.is_none() && touch.is_finite() => touch,
            Drive::Force(_) => 0.0,
        };
        moving.before = moving.closure;
        moving.motion.state.closure = moving.closure;
        moving
    }

    fn ramp(&self, time: f64) -> f64 {
        if let Some(curve) = self.of.curve {
            return curve.value(time);
        }
        if self.of.over > 0.0 { (time / self.of.over).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// Returns the displacement of a displacement-driven tool, m.
    fn led(&self, time: f64) -> f64 {
        let Drive::Closure(full) = self.of.drive else { return self.closure };
        let start = if self.touch < full && self.of.curve.is_none() { self.touch } else { 0.0 };
        start + (full - start) * self.ramp(time)
    }

    /// Stores force, penetration and stored energy of the contacts found.
    fn settle(&mut self, contacts: Option<&Contacts>, surface: &ContactSurface) {
        self.motion = ToolMotion { state: ToolState::new(self.closure, contacts), speed: self.speed };
        let law = self.of.tool.law();
        self.energies.stored = contacts.map_or(0.0, |c| {
            let each = c.points().iter().zip(c.pressures()).zip(c.slip());
            each.map(|((&q, p), slip)| {
                let stick = 0.5 * law.stick() * slip.stretch().norm_squared();
                surface.rows().weights()[q as usize] * (0.5 * p * p / law.penalty() + stick)
            })
            .sum()
        });
        self.energies.friction += contacts.map_or(0.0, Contacts::dissipated);
    }

    /// Checks that the tool's own critical step in contact is at least twice the time step.
    fn check(
        &self,
        index: usize,
        step: usize,
        time: f64,
        dt: [f64; 2],
        contacts: Option<&Contacts>,
        surface: &ContactSurface,
    ) -> Result<(), ExplicitError> {
        let (Drive::Force(_), Some(contacts)) = (self.of.drive, contacts) else { return Ok(()) };
        let area: f64 = contacts.points().iter().map(|&q| surface.rows().weights()[q as usize]).sum();
        let critical = 2.0 * (self.of.mass / (self.of.tool.law().penalty() * area)).sqrt();
        if critical < 2.0 * dt[1] {
            let mass = self.of.mass;
            return Err(ExplicitError::LightTool { step, time, tool: index, mass, dt: dt[1], critical });
        }
        Ok(())
    }

    fn advance(&mut self, first: bool, time: f64, [before_dt, after_dt]: [f64; 2]) {
        let state = &self.motion.state;
        let pushed = self.of.tool.driving_force(self.closure, &state.force, &state.moment);
        match self.of.drive {
            Drive::Closure(_) => {
                if !first {
                    self.energies.work += 0.5 * before_dt * self.speed * (self.worked + pushed);
                }
                let next = self.led(time + after_dt);
                self.speed = (next - self.closure) / after_dt;
                self.closure = next;
                self.worked = pushed;
            }
            Drive::Force(full) => {
                let (m, dt) = (self.of.mass, 0.5 * (before_dt + after_dt));
                let c = 0.5 * self.of.damping * dt;
                let drive = full * self.ramp(time);
                if first {
                    // From rest at t = 0, like the body.
                    self.speed = -(drive - pushed) * (0.5 * dt / m);
                }
                let before = self.speed;
                let after = ((1.0 - c) * before + dt * (drive - pushed) / m) / (1.0 + c);
                let mean = 0.5 * (before + after);
                let half = 0.5 * self.of.damping * dt * m;
                if !first {
                    self.energies.work += 0.5 * before_dt * before * (self.worked + drive);
                    self.energies.damping += half * before * mean + self.pending;
                }
                self.pending = half * after * mean;
                self.energies.kinetic = 0.5 * m * before * after;
                self.speed = after;
                self.closure += after * after_dt;
                self.worked = drive;
            }
        }
    }
}

/// Returns the displacement (m) of first contact, to 1e-9 m or a millionth of the distance to the body's far
/// side; infinite if the tool passes by. A tool that turns travels up to `full` (m). The distance to a point changes by no more than the tool's travel,
/// so advancing by the gap never overshoots.
fn touch(tool: &Tool, full: f64, surface: &ContactSurface, u: &[Vector3]) -> f64 {
    let points = surface.rows().points();
    if points.is_empty() {
        return f64::INFINITY;
    }
    // Beyond the body's far side, when the tool's origin has passed every point, nothing is left to touch.
    let ahead = |x: &Point3| (x - tool.place(0.0)).dot(&tool.along());
    let positions = (0..points.len()).map(|q| surface.position(q, u));
    let far = positions.clone().map(|x| ahead(&x)).fold(0.0, f64::max);
    // A turn has no far side.
    let farthest = if tool.turns() { full } else { 2.0 * far.abs() + 1.0 };
    let near = 1e-9f64.min(1e-6 * if tool.turns() { full } else { far });
    let rate = tool.rate(positions, 0.0);
    let mut closure = 0.0;
    for _ in 0..10_000 {
        let gap = surface.gap(tool, closure, u);
        if gap <= near {
            return closure;
        }
        closure += gap / rate;
        if closure > farthest {
            break;
        }
    }
    f64::INFINITY
}
