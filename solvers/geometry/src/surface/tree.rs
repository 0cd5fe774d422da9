//! Bounding-box tree of triangles, for closest points and for triangles that touch a box.

use crate::triangle::{Feature, closest_on};
use crate::{Point3, Vector3};

/// Largest number of triangles in a leaf.
const FEW: usize = 4;

/// Hierarchy of boxes; a leaf contains triangles.
pub(crate) struct Tree {
    pub(super) nodes: Vec<Node>,
    /// Triangles in the order of the boxes.
    order: Vec<u32>,
    /// Corners of the triangles in this order.
    pub(super) corners: Vec<[Point3; 3]>,
}

pub(super) struct Node {
    pub(super) low: Point3,
    pub(super) high: Point3,
    /// First triangle of a leaf, or first of the two children.
    pub(super) start: u32,
    /// Number of triangles; 0 for a box with children.
    pub(super) count: u32,
}

/// The closest point of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub triangle: u32,
    pub feature: Feature,
    pub at: Point3,
    /// Squared distance, m^2.
    pub square: f64,
}

impl Tree {
    pub(crate) fn new(points: &[Point3], triangles: &[[u32; 3]]) -> Tree {
        let of = |t: u32| triangles[t as usize].map(|p| points[p as usize]);
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let middles: Vec<Point3> = order
            .iter()
            .map(|&t| Point3::from(of(t).iter().map(|p| p.coords).sum::<Vector3>() / 3.0))
            .collect();
        let mut nodes = vec![Node { low: Point3::origin(), high: Point3::origin(), start: 0, count: 0 }];
        let mut open = vec![(0, 0, order.len())];
        while let Some((node, start, end)) = open.pop() {
            let (low, high) = bounds(order[start..end].iter().flat_map(|&t| of(t)));
            let count = end - start;
            if count <= FEW {
                nodes[node] = Node { low, high, start: start as u32, count: count as u32 };
                continue;
            }
            let (from, to) = bounds(order[start..end].iter().map(|&t| middles[t as usize]));
            let axis = (to - from).imax();
            let along = |t: &u32| (middles[*t as usize][axis], *t);
            order[start..end].select_nth_unstable_by(count / 2, |a, b| {
                let (a, b) = (along(a), along(b));
                a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
            });
            let child = nodes.len();
            nodes[node] = Node { low, high, start: child as u32, count: 0 };
            for _ in 0..2 {
                nodes.push(Node { low, high, start: 0, count: 0 });
            }
            open.push((child, start, start + count / 2));
            open.push((child + 1, start + count / 2, end));
        }
        let corners = order.iter().map(|&t| of(t)).collect();
        Tree { nodes, order, corners }
    }

    /// Lowest and highest corner of the box around all triangles.
    pub(super) fn bounds(&self) -> [Point3; 2] {
        [self.nodes[0].low, self.nodes[0].high]
    }

    /// The closest point of all triangles; `None` if none is closer than `within`.
    pub(crate) fn closest(&self, p: &Point3, within: f64) -> Option<Closest> {
        let mut best: Option<Closest> = None;
        let mut least = within * within;
        let mut open = vec![(0u32, self.nodes[0].square(p))];
        while let Some((at, square)) = open.pop() {
            if square >= least {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count == 0 {
                let near =
                    [node.start, node.start + 1].map(|child| (child, self.nodes[child as usize].square(p)));
                let [first, second] = if near[0].1 <= near[1].1 { near } else { [near[1], near[0]] };
                open.push(second);
                open.push(first);
                continue;
            }
            for slot in node.start as usize..(node.start + node.count) as usize {
                let (feature, at) = closest_on(p, &self.corners[slot]);
                let square = (p - at).norm_squared();
                if square < least {
                    least = square;
                    best = Some(Closest { triangle: self.order[slot], feature, at, square });
                }
            }
        }
        best
    }

    /// Calls `found` with every triangle whose box may touch the given box.
    pub(super) fn touching(&self, low: &Point3, high: &Point3, mut found: impl FnMut(u32)) {
        let mut open = vec![0u32];
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            if (0..3).any(|a| node.low[a] > high[a] || node.high[a] < low[a]) {
                continue;
            }
            if node.count == 0 {
                open.extend([node.start + 1, node.start]);
            } else {
                let slots = node.start as usize..(node.start + node.count) as usize;
                self.order[slots].iter().for_each(|&t| found(t));
            }
        }
    }
}

impl Tree {
    /// Calls `found` with every intersection of the line `from + t * line`, `0 < t < longest`, and a
    /// triangle, as t. Rounding may lose or double intersections at the edges of triangles.
    pub(super) fn pierced(&self, from: &Point3, line: &Vector3, longest: f64, mut found: impl FnMut(f64)) {
        let mut open = vec![0u32];
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            if !node.is_passed(from, line, longest) {
                continue;
            }
            if node.count == 0 {
                open.extend([node.start + 1, node.start]);
                continue;
            }
            for [a, b, c] in &self.corners[node.start as usize..(node.start + node.count) as usize] {
                // Moeller and Trumbore 1997.
                let (ab, ac, off) = (b - a, c - a, from - a);
                let (normal, turned) = (line.cross(&ac), off.cross(&ab));
                let det = ab.dot(&normal);
                let [u, v, t] = [off.dot(&normal), line.dot(&turned), ac.dot(&turned)].map(|x| x / det);
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < longest {
                    found(t);
                }
            }
        }
    }
}

impl Node {
    /// Whether a line meets the box.
    fn is_passed(&self, from: &Point3, line: &Vector3, longest: f64) -> bool {
        let (mut first, mut last) = (0.0f64, longest);
        for axis in 0..3 {
            if line[axis] == 0.0 {
                if from[axis] < self.low[axis] || from[axis] > self.high[axis] {
                    return false;
                }
                continue;
            }
            let [a, b] = [self.low, self.high].map(|end| (end[axis] - from[axis]) / line[axis]);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
        first <= last
    }

    /// Squared distance of a point from the box.
    fn square(&self, p: &Point3) -> f64 {
        (0..3).map(|a| (self.low[a] - p[a]).max(p[a] - self.high[a]).max(0.0).powi(2)).sum()
    }
}

/// Bounding box of at least one point.
pub(super) fn bounds(points: impl Iterator<Item = Point3>) -> (Point3, Point3) {
    let none = (Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3]));
    points.fold(none, |(low, high), p| (low.inf(&p), high.sup(&p)))
}
