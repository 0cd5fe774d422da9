//! What a step may have done without any force: tools that jumped over the surface, or stand in it between its points.
//!
//! Contact sees a state, not how it was reached. A tool that travels farther in a step than it is thick ends beyond the
//! surface, where nothing touches. Seen from the tool every point goes a straight way during a step, and the distance to a
//! convex shape is convex along it: its least value is found by halving the way at the sign of its slope.

use shape::{Point3, PointRows, Vector3};

use super::{ContactError, ContactSurface, Tool};

/// Halvings of a way: to a millionth of it.
const HALVINGS: usize = 20;
/// Part of the way to the nearest point of the surface that a corner of it may stand in a tool which touches no point: below
/// it, the points are on their way to it; a tool that comes on along the corner's normal is two thirds of it deep.
const RESOLVED: f64 = 0.5;

/// Where a tool and a surface stand.
#[derive(Clone, Copy, Debug)]
pub struct Stand<'u> {
    /// Closure, m.
    pub closure: f64,
    /// Nodal parameters, m.
    pub u: &'u [Vector3],
}

/// Position `X + sum_I N_I u_I` of a corner of the surface's faces, where it has no points, m. Corners carry no force, but tell
/// where the body is.
fn corner(corners: &PointRows, corner: usize, u: &[Vector3]) -> Point3 {
    let (nodes, values) = corners.rows().row(corner);
    let moved: Vector3 = nodes.iter().zip(values).map(|(&node, value)| u[node as usize] * *value).sum();
    corners.points()[corner] + moved
}

impl ContactSurface<'_> {
    /// Fails where a step from one state to another took the surface through the tool, and where a tool that touches no point
    /// of it at the end (`touches`) stands in the body all the same.
    ///
    /// A point that goes deeper on its way than [`Tool::deepest`], and half of that where nothing touches in the end, has been
    /// jumped over: points that slide along a tool cut its corners by less.
    pub fn check_step(&self, tool: &Tool, from: Stand, to: Stand, touches: bool) -> Result<(), ContactError> {
        self.check_passage(tool, from, to, touches)?;
        if touches { Ok(()) } else { self.check_overlap(tool, to) }
    }

    /// Fails where a tool that travels while the surface stays jumps over it; `touches` at the end or not. Less than
    /// [`Tool::deepest`] takes no point in and out again.
    pub fn check_travel(
        &self,
        tool: &Tool,
        [from, to]: [f64; 2],
        u: &[Vector3],
        touches: bool,
    ) -> Result<(), ContactError> {
        if (to - from).abs() <= tool.deepest() {
            return Ok(());
        }
        self.check_passage(tool, Stand { closure: from, u }, Stand { closure: to, u }, touches)
    }

    fn check_passage(&self, tool: &Tool, from: Stand, to: Stand, touches: bool) -> Result<(), ContactError> {
        let limit = tool.deepest() * if touches { 1.0 } else { 0.5 };
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
        if let (Some(corners), false) = (self.corners, touches) {
            for c in 0..corners.points().len() {
                let ends = [corner(corners, c, from.u), corner(corners, c, to.u)];
                worst.meet(tool, [from.closure, to.closure], ends);
            }
        }
        let Passage { depth, at, travel } = worst;
        if depth > limit { Err(ContactError::JumpedOver { depth, at, travel }) } else { Ok(()) }
    }

    /// Fails where a corner of the surface stands in a tool that touches no point deeper than its points can tell.
    pub fn check_overlap(&self, tool: &Tool, stand: Stand) -> Result<(), ContactError> {
        let Some(corners) = self.corners else { return Ok(()) };
        let mut worst: Option<(f64, usize, f64)> = None;
        for c in 0..corners.points().len() {
            let depth = -tool.shape().foot(&tool.local(stand.closure, &corner(corners, c, stand.u))).0;
            if !(depth > worst.map_or(0.0, |(most, ..)| most)) {
                continue;
            }
            let points = self.rows().points().iter().map(|p| (p - corners.points()[c]).norm_squared());
            let apart = points.fold(f64::INFINITY, f64::min).sqrt();
            if depth > (RESOLVED * apart).min(tool.deepest()) {
                worst = Some((depth, c, apart));
            }
        }
        match worst {
            Some((depth, c, apart)) => {
                Err(ContactError::Overlap { depth, at: corner(corners, c, stand.u), apart })
            }
            None => Ok(()),
        }
    }

    /// Points of each cluster that may come deeper than `limit` (m) into the tool on the way; all others cannot.
    fn passed(&self, tool: &Tool, from: Stand, to: Stand, limit: f64) -> Result<Vec<&[u32]>, ContactError> {
        let mut passed = Vec::new();
        for cluster in &self.clusters {
            let ends = [from, to].map(|stand| {
                let boxed = cluster.current_box(&self.nodes, stand.u);
                boxed.map(|(middle, half)| (middle - tool.along() * stand.closure, half))
            });
            let [(a, half_a), (b, half_b)] = [ends[0].clone()?, ends[1].clone()?];
            let (low, high) = ((a - half_a).inf(&(b - half_b)), (a + half_a).sup(&(b + half_b)));
            let (middle, half) = (nalgebra::center(&low, &high), (high - low) * 0.5);
            // The distance changes by no more than the way gone.
            if tool.shape().foot(&tool.local(0.0, &middle)).0 - half.norm() < -limit {
                passed.push(&self.order[cluster.points.clone()]);
            }
        }
        Ok(passed)
    }
}

/// The deepest that a point has come on its way.
struct Passage {
    /// m.
    depth: f64,
    /// Where the point stands in the end, m.
    at: Point3,
    /// Way of the point as seen from the tool, m.
    travel: f64,
}

impl Passage {
    /// Follows one point. One that was as deep before the step, or is after it, has not been passed by.
    fn meet(&mut self, tool: &Tool, closures: [f64; 2], ends: [Point3; 2]) {
        let [a, b] = [tool.local(closures[0], &ends[0]), tool.local(closures[1], &ends[1])];
        let (way, foot) = (b - a, |part: f64| tool.shape().foot(&(a + (b - a) * part)));
        let (before, after, travel) = (foot(0.0).0, foot(1.0).0, way.norm());
        if 0.5 * (before + after - travel) >= -self.depth {
            return;
        }
        let (mut low, mut high) = (0.0, 1.0);
        let mut least = before.min(after);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let (gap, normal) = foot(middle);
            least = least.min(gap);
            *(if normal.dot(&way) < 0.0 { &mut low } else { &mut high }) = middle;
        }
        if -least > self.depth && least < before.min(after) {
            *self = Passage { depth: -least, at: ends[1], travel };
        }
    }
}
