//! Detection of tools that jumped over the surface in a step.
//!
//! Contact depends on a state, not on how the state was reached. A tool that travels farther in a step than
//! its own thickness ends beyond the surface, and nothing touches it there. Relative to the tool every point
//! moves on a straight line during a step (during parts of it, if the tool turns), and the distance to a convex shape is convex along that line. Its
//! minimum is found by bisection on the sign of the slope. Of other shapes, parts of the line are halved
//! until the distance, which changes at most as fast as the position, can't be smaller in them.

use shape::{Point3, Vector3};

use crate::error::ContactError;
use crate::surface::ContactSurface;
use crate::tool::Tool;

/// Number of bisections of a path: to a millionth of its length.
const HALVINGS: usize = 20;

/// Smallest part of a path that is searched, if the shape is not convex.
const FINEST: f64 = 1.0 / 256.0;

/// Largest depth along its path, as part of the deepest penetration, of a point if nothing touches at the
/// end.
const UNSEEN: f64 = 0.08;

/// State of a tool and a surface.
#[derive(Clone, Copy, Debug)]
pub struct Stand<'u> {
    /// Displacement of the tool along its direction (closure), m.
    pub closure: f64,
    /// Nodal displacements, or nodal parameters of a meshless basis, m, one vector per node.
    pub u: &'u [Vector3],
}

impl ContactSurface<'_> {
    /// Checks as [`ContactSurface::check_passage`] for a tool that moves between two closures (m) while the
    /// surface stays in the state `u` (m). A travel so short that no point can enter and leave the tool
    /// passes at once.
    pub fn check_travel(
        &self,
        tool: &Tool,
        [from, to]: [f64; 2],
        u: &[Vector3],
        touches: bool,
    ) -> Result<(), ContactError> {
        if (to - from).abs() <= 2.0 * UNSEEN * tool.deepest() {
            return Ok(());
        }
        self.check_passage(tool, Stand { closure: from, u }, Stand { closure: to, u }, touches)
    }

    /// Checks that the step from one state to another did not take the surface through the tool. `touches`
    /// states whether the tool touches any point of the surface at the end.
    ///
    /// A point that goes deeper along its path than [`Tool::deepest`] has been jumped over: points that slide
    /// along a tool cut its corners by less. If nothing touches at the end, the limit is 8 % of
    /// [`Tool::deepest`], and the corners of the outline are checked as well.
    ///
    /// # Errors
    ///
    /// [`ContactError::JumpedOver`] with the deepest point.
    pub fn check_passage(
        &self,
        tool: &Tool,
        from: Stand,
        to: Stand,
        touches: bool,
    ) -> Result<(), ContactError> {
        let limit = tool.deepest() * if touches { 1.0 } else { UNSEEN };
        if limit.is_infinite() {
            return Ok(());
        }
        let mut worst = Passage { depth: limit, at: Point3::origin(), travel: 0.0 };
        for points in self.passed(tool, from, to, limit)? {
            for &q in points {
                let ends = [self.position(q as usize, from.u), self.position(q as usize, to.u)];
                worst.meet(tool, [from.closure, to.closure], ends);
            }
        }
        if let (Some(outline), false) = (self.outline, touches) {
            for k in 0..outline.len() {
                let ends = [outline.position(k, from.u), outline.position(k, to.u)];
                worst.meet(tool, [from.closure, to.closure], ends);
            }
        }
        let Passage { depth, at, travel } = worst;
        if depth > limit { Err(ContactError::JumpedOver { depth, at, travel }) } else { Ok(()) }
    }

    /// Returns the points of each cluster that may come deeper than `limit` (m) into the tool along their
    /// paths; all others cannot.
    fn passed(&self, tool: &Tool, from: Stand, to: Stand, limit: f64) -> Result<Vec<&[u32]>, ContactError> {
        let mut passed = Vec::new();
        for cluster in &self.clusters {
            let ends = [from, to].map(|stand| {
                let boxed = cluster.current_box(&self.nodes, stand.u);
                boxed.map(|(middle, half)| (middle - tool.displacement(stand.closure), half))
            });
            let [(a, half_a), (b, half_b)] = [ends[0].clone()?, ends[1].clone()?];
            // The distance function changes by no more than the distance travelled.
            let least = if tool.turns() {
                let middle = cluster.current_box(&self.nodes, from.u)?.0;
                let moved = (cluster.current_box(&self.nodes, to.u)?.0 - middle).norm();
                let travel = (to.closure - from.closure).abs();
                tool.gap(from.closure, &middle) - half_a.norm().max(half_b.norm()) - moved - travel
            } else {
                let (low, high) = ((a - half_a).inf(&(b - half_b)), (a + half_a).sup(&(b + half_b)));
                let middle = nalgebra::center(&low, &high);
                let half = (high - low) * 0.5;
                tool.shape().foot(&tool.local(0.0, &middle)).0 - half.norm()
            };
            if least < -limit {
                passed.push(&self.order[cluster.points.clone()]);
            }
        }
        Ok(passed)
    }
}

/// Deepest passage of a point along its path.
struct Passage {
    /// Depth, m.
    depth: f64,
    /// Final position of the point, m.
    at: Point3,
    /// Path length of the point relative to the tool, m.
    travel: f64,
}

impl Passage {
    /// Follows one point. A point that is as deep before or after the step has not been jumped over.
    fn meet(&mut self, tool: &Tool, closures: [f64; 2], ends: [Point3; 2]) {
        let foot = |p: &Vector3| tool.shape().foot(p).0;
        let count = tool.parts(closures);
        let mut from = tool.local(closures[0], &ends[0]);
        let before = foot(&from);
        let (mut least, mut travel, mut after) = (before, 0.0, before);
        for k in 1..=count {
            let to = if k == count {
                tool.local(closures[1], &ends[1])
            } else {
                let part = k as f64 / count as f64;
                let closure = closures[0] + part * (closures[1] - closures[0]);
                tool.local(closure, &ends[0].lerp(&ends[1], part))
            };
            let last = std::mem::replace(&mut after, foot(&to));
            least = least.min(self.least_between(tool, [from, to], [last, after]));
            travel += (to - from).norm();
            from = to;
        }
        if -least > self.depth && least < before.min(after) {
            *self = Passage { depth: -least, at: ends[1], travel };
        }
    }

    /// Smallest distance (m) on a straight line between two positions (m, in the tool's frame) with the
    /// distances `ends` (m); that of the nearer end if no place between them is a deeper passage.
    fn least_between(&self, tool: &Tool, [a, b]: [Vector3; 2], ends: [f64; 2]) -> f64 {
        let way = b - a;
        let foot = |part: f64| tool.shape().foot(&(a + (b - a) * part));
        let [before, after] = ends;
        let travel = way.norm();
        if 0.5 * (before + after - travel) >= -self.depth {
            return before.min(after);
        }
        if !tool.shape().is_convex() {
            return self.least(before, after, travel, |part| foot(part).0);
        }
        let (mut low, mut high) = (0.0, 1.0);
        let mut least = before.min(after);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let (gap, normal) = foot(middle);
            least = least.min(gap);
            *(if normal.dot(&way) < 0.0 { &mut low } else { &mut high }) = middle;
        }
        least
    }

    /// Smallest distance (m) along a path of the length `travel` (m), to the accuracy that decides whether it
    /// is a deeper passage.
    fn least(&self, before: f64, after: f64, travel: f64, gap: impl Fn(f64) -> f64) -> f64 {
        let mut least = before.min(after);
        let mut open = vec![([0.0, 1.0], [before, after])];
        while let Some(([from, to], [first, last])) = open.pop() {
            let reach = 0.5 * (first + last - (to - from) * travel);
            if reach >= least || reach >= -self.depth || to - from <= FINEST {
                continue;
            }
            let middle = 0.5 * (from + to);
            let between = gap(middle);
            least = least.min(between);
            open.extend([([from, middle], [first, between]), ([middle, to], [between, last])]);
        }
        least
    }
}
