//! Rigid tools in the equations of single nodes.

use contact::{ContactCounts, ContactError, ContactHistory, ContactSurface, Pose, Stand, Tool, ToolState};
use shape::{Matrix3, Point3, Vector3};

use crate::error::ExplicitError;
use crate::lists::Lists;

/// Tool without friction, with a prescribed displacement.
pub struct FrameTool<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Displacement along its path (m) as a function of time (s).
    pub closure: &'a (dyn Fn(f64) -> f64 + Sync),
}

/// Tools on a surface.
pub(super) struct Touch<'a> {
    surface: &'a ContactSurface<'a>,
    tools: Vec<FrameTool<'a>>,
    places: Vec<Place>,
    /// Contact points of each node.
    of_node: Lists,
    /// Empty histories.
    histories: Vec<ContactHistory>,
    counts: ContactCounts,
}

/// Contact of a point, linearised.
pub(super) struct Spring {
    point: u32,
    normal: Vector3,
    /// Force per penetration, N/m.
    stiffness: f64,
}

/// Tool at the end of a time step.
struct Place {
    /// Displacement, m.
    closure: f64,
    pose: Pose,
    /// Corners of a box around the tool, m.
    low: Point3,
    high: Point3,
}

impl Place {
    /// Signed distance of a place (m), below 0 inside, and the unit normal out of the tool; `None` outside of
    /// its box.
    fn foot(&self, tool: &Tool, x: &Point3) -> Option<(f64, Vector3)> {
        if (0..3).any(|a| x[a] < self.low[a] || x[a] > self.high[a]) {
            return None;
        }
        let (gap, normal) = tool.shape().foot(&self.pose.rotation.tr_mul(&(x - self.pose.place)));
        Some((gap, self.pose.rotation * normal))
    }
}

impl<'a> Touch<'a> {
    pub fn new(
        surface: &'a ContactSurface<'a>,
        tools: Vec<FrameTool<'a>>,
    ) -> Result<Touch<'a>, ExplicitError> {
        if let Some(tool) = tools.iter().position(|tool| tool.tool.law().friction() > 0.0) {
            return Err(ExplicitError::Friction { tool });
        }
        let rows = surface.rows().rows();
        let pairs = (0..rows.len()).flat_map(|q| rows.row(q).0.iter().map(move |&node| (node, q as u32)));
        let of_node = Lists::new(rows.node_count(), pairs);
        let mut touch = Touch {
            places: Vec::new(),
            of_node,
            histories: tools.iter().map(|tool| ContactHistory::new(tool.tool, rows.len())).collect(),
            counts: ContactCounts::default(),
            surface,
            tools,
        };
        touch.drive(0.0);
        Ok(touch)
    }

    /// Moves the tools to their displacements at a time (s).
    pub fn drive(&mut self, time: f64) {
        let place = |of: &FrameTool| {
            let closure = (of.closure)(time);
            let (low, high) = of.tool.bounds(closure);
            Place { closure, pose: of.tool.pose(closure), low, high }
        };
        self.places = self.tools.iter().map(place).collect();
    }

    /// Number of pairs of a point and a tool.
    pub fn pairs(&self) -> usize {
        self.surface.rows().points().len() * self.tools.len()
    }

    /// Force per penetration of a point in a tool, N/m.
    fn stiffness(&self, point: u32, tool: &Tool) -> f64 {
        tool.law().penalty() * self.surface.rows().weights()[point as usize]
    }

    /// Force on a node (N), and its stiffness (N/m) without the curvature of the tools, which keeps it
    /// positive.
    pub fn on_node(&self, node: usize, u: &[Vector3]) -> (Vector3, Matrix3) {
        let (mut force, mut stiffness) = (Vector3::zeros(), Matrix3::zeros());
        for &point in self.of_node.of(node) {
            let (nodes, values) = self.surface.rows().rows().row(point as usize);
            let at = nodes.iter().position(|&other| other as usize == node);
            let value = at.map_or(0.0, |at| values[at]);
            let x = self.surface.position(point as usize, u);
            for (of, place) in self.tools.iter().zip(&self.places) {
                let Some((gap, normal)) = place.foot(of.tool, &x).filter(|(gap, _)| *gap < 0.0) else {
                    continue;
                };
                let k = self.stiffness(point, of.tool);
                force -= normal * (k * gap * value);
                stiffness += normal * normal.transpose() * (k * value * value);
            }
        }
        (force, stiffness)
    }

    /// Relaxes the constraints of all points in turn, each with the compliance of its penalty. `yields` is
    /// the displacement of a node per force along each axis (m/N), and each pair has a multiplier (N).
    pub fn relax(&self, yields: &dyn Fn(usize) -> Vector3, u: &mut [Vector3], multipliers: &mut [f64]) {
        let rows = self.surface.rows();
        let count = self.tools.len();
        for point in 0..rows.points().len() {
            for (k, (of, place)) in self.tools.iter().zip(&self.places).enumerate() {
                let x = self.surface.position(point, u);
                let multiplier = &mut multipliers[point * count + k];
                let Some((gap, normal)) = place.foot(of.tool, &x) else { continue };
                if gap >= 0.0 && *multiplier == 0.0 {
                    continue;
                }
                let (nodes, values) = rows.rows().row(point);
                let square = normal.component_mul(&normal);
                let each = nodes.iter().zip(values);
                let soft: f64 = each.map(|(&node, n)| n * n * square.dot(&yields(node as usize))).sum();
                let compliance = 1.0 / self.stiffness(point as u32, of.tool);
                let change = (-gap - compliance * *multiplier) / (soft + compliance);
                let change = change.max(-*multiplier);
                *multiplier += change;
                for (&node, value) in nodes.iter().zip(values) {
                    u[node as usize] += normal.component_mul(&yields(node as usize)) * (change * value);
                }
            }
        }
    }

    /// Adds the contact forces (N) at displacements `u` (m) to `force`, and returns the springs of the points
    /// in contact.
    pub fn springs(&self, u: &[Vector3], force: &mut [Vector3]) -> Vec<Spring> {
        let rows = self.surface.rows();
        let mut springs = Vec::new();
        for point in 0..rows.points().len() {
            let x = self.surface.position(point, u);
            for (of, place) in self.tools.iter().zip(&self.places) {
                let Some((gap, normal)) = place.foot(of.tool, &x).filter(|(gap, _)| *gap < 0.0) else {
                    continue;
                };
                let stiffness = self.stiffness(point as u32, of.tool);
                let (nodes, values) = rows.rows().row(point);
                for (&node, value) in nodes.iter().zip(values) {
                    force[node as usize] -= normal * (stiffness * gap * value);
                }
                springs.push(Spring { point: point as u32, normal, stiffness });
            }
        }
        springs
    }

    /// Adds the forces of springs (N) that resist displacements `p` (m) to `f`.
    pub fn add_springs(&self, springs: &[Spring], p: &[Vector3], f: &mut [Vector3]) {
        for spring in springs {
            let (nodes, values) = self.surface.rows().rows().row(spring.point as usize);
            let each = nodes.iter().zip(values);
            let moved: f64 = each.map(|(&node, value)| value * spring.normal.dot(&p[node as usize])).sum();
            for (&node, value) in nodes.iter().zip(values) {
                f[node as usize] += spring.normal * (spring.stiffness * moved * value);
            }
        }
    }

    /// Adds the contact forces (N) at displacements `u` (m) to `force`, and returns the state of each tool.
    /// The state is checked: no tool may push from within the body, or overlap it without contact.
    pub fn settle(
        &mut self,
        u: &[Vector3],
        force: &mut [Vector3],
    ) -> Result<Vec<ToolState>, (usize, ContactError)> {
        let mut states = Vec::with_capacity(self.tools.len());
        for (k, (of, place)) in self.tools.iter().zip(&self.places).enumerate() {
            let closure = place.closure;
            let lost = |cause| (k, cause);
            let found = self.surface.tractions(of.tool, closure, u, &self.histories[k], &mut self.counts);
            let contacts = found.map_err(lost)?;
            match contacts.as_ref().filter(|contacts| !contacts.points().is_empty()) {
                Some(contacts) => {
                    self.surface.check_side(contacts, u).map_err(lost)?;
                    contacts.add_force(self.surface.rows(), force);
                }
                None => self.surface.check_overlap(of.tool, Stand { closure, u }).map_err(lost)?,
            }
            states.push(ToolState::new(closure, contacts.as_ref()));
        }
        Ok(states)
    }

    /// Counters of the contact search.
    pub fn counts(&self) -> ContactCounts {
        self.counts
    }
}
