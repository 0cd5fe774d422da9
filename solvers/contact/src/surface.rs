//! Broad phase of contact: a surface quadrature in clusters of neighbouring points, each with a box.

use std::ops::Range;

use shape::{Point3, SurfaceRows, Vector3};

use crate::error::ContactError;
use crate::outline::Outline;
use crate::tool::Tool;

/// Largest number of points in a cluster.
pub(super) const CLUSTER: usize = 32;

/// Product of two unit normals above which the points are on the same side of an edge.
const ALIKE: f64 = 0.7;
/// Distance, relative to the size of the surface, below which two points coincide.
const SAME: f64 = 1e-9;

/// Surface prepared for contact: made once per surface, for any number of tools and states.
#[derive(Clone, Debug)]
pub struct ContactSurface<'a> {
    rows: &'a SurfaceRows,
    /// Points, with neighbours next to each other.
    pub(super) order: Vec<u32>,
    pub(super) clusters: Vec<Cluster>,
    /// Nodes of the clusters, one cluster after another.
    pub(super) nodes: Vec<u32>,
    /// Surface between the points, if given.
    pub(super) outline: Option<Outline<'a>>,
    /// Two neighbours of each point, counter-clockwise seen from outside; the point itself if it has none.
    pub(super) beside: Vec<[u32; 2]>,
}

/// Cluster of points with a bounding box.
///
/// The current position of a point is `x = X + sum_I N_I u_I`. With `m` the middle and `h` the half range of
/// `u` over the cluster's nodes, `|x - X - m| <= max(sum |N_I|) h + max|sum N_I - 1| |m|` per axis. This
/// bounds all points of the cluster from the nodes alone, for any basis.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    pub(super) points: Range<usize>,
    nodes: Range<usize>,
    /// Middle of the box of reference positions, m.
    middle: Point3,
    /// Half extents of this box, m.
    half: Vector3,
    /// Largest `sum |N_I|`.
    lebesgue: f64,
    /// Largest `|sum N_I - 1|`.
    excess: f64,
}

impl<'a> ContactSurface<'a> {
    /// Sorts the points of a surface quadrature into clusters.
    pub fn new(rows: &'a SurfaceRows) -> ContactSurface<'a> {
        let mut order: Vec<u32> = (0..rows.points().len() as u32).collect();
        let mut ranges = Vec::new();
        if !order.is_empty() {
            split(&mut order, 0, rows.points(), &mut ranges);
        }
        let mut nodes = Vec::new();
        let clusters: Vec<Cluster> =
            ranges.into_iter().map(|points| Cluster::new(rows, &order, points, &mut nodes)).collect();
        let bent = bent(rows);
        let mut beside: Vec<[u32; 2]> = (0..order.len() as u32).map(|q| [q; 2]).collect();
        for cluster in &clusters {
            let near = &order[cluster.points.clone()];
            let flat = near.iter().filter(|&&q| !bent[q as usize]);
            flat.for_each(|&q| beside[q as usize] = two_beside(rows, q, near));
        }
        ContactSurface { rows, order, clusters, nodes, beside, outline: None }
    }

    /// Adds the surface between the points, to find tools that overlap the body there.
    pub fn with_outline(mut self, outline: Outline<'a>) -> ContactSurface<'a> {
        self.outline = Some(outline);
        self
    }

    /// The surface quadrature.
    pub fn rows(&self) -> &'a SurfaceRows {
        self.rows
    }

    /// Number of clusters.
    pub fn clusters(&self) -> usize {
        self.clusters.len()
    }

    /// Returns the largest `sum |N_I|` of all points.
    pub(super) fn lebesgue(&self) -> f64 {
        self.clusters.iter().map(|cluster| cluster.lebesgue).fold(0.0, f64::max)
    }

    /// Returns the smallest signed distance (m) of any point to the tool in the state `u`; infinite without
    /// points.
    pub fn gap(&self, tool: &Tool, closure: f64, u: &[Vector3]) -> f64 {
        let pose = tool.pose(closure);
        (0..self.rows.points().len())
            .map(|q| tool.shape().foot(&pose.local(&self.position(q, u))).0)
            .fold(f64::INFINITY, f64::min)
    }

    /// Returns the points that lie within the tool in the state `u` (m): positions and signed distances (m,
    /// below 0).
    pub fn within(&self, tool: &Tool, closure: f64, u: &[Vector3]) -> Vec<(Point3, f64)> {
        let places = (0..self.rows.points().len()).map(|q| self.position(q, u));
        places.map(|x| (x, tool.gap(closure, &x))).filter(|(_, gap)| *gap < 0.0).collect()
    }

    /// Returns the points of each cluster that may come within `reach` (m) of the tool; all others cannot.
    pub(super) fn near(
        &self,
        tool: &Tool,
        closure: f64,
        reach: f64,
        u: &[Vector3],
    ) -> Result<Vec<&[u32]>, ContactError> {
        let (low, high) = tool.bounds(closure);
        let (low, high) = (low.map(|c| c - reach), high.map(|c| c + reach));
        let pose = tool.pose(closure);
        let mut near = Vec::new();
        for cluster in &self.clusters {
            let (middle, half) = cluster.current_box(&self.nodes, u)?;
            let apart = (0..3).any(|a| middle[a] + half[a] < low[a] || middle[a] - half[a] > high[a]);
            // The distance function changes by no more than the distance travelled.
            if apart || tool.shape().foot(&pose.local(&middle)).0 > half.norm() + reach {
                continue;
            }
            near.push(&self.order[cluster.points.clone()]);
        }
        Ok(near)
    }

    /// Current position `X + sum_I N_I u_I` of a point, m.
    #[inline]
    pub fn position(&self, point: usize, u: &[Vector3]) -> Point3 {
        let (nodes, values) = self.rows.rows().row(point);
        let mut x = self.rows.points()[point];
        for (&node, value) in nodes.iter().zip(values) {
            x += u[node as usize] * *value;
        }
        x
    }
}

impl Cluster {
    fn new(rows: &SurfaceRows, order: &[u32], points: Range<usize>, nodes: &mut Vec<u32>) -> Cluster {
        let first = nodes.len();
        let (mut lebesgue, mut excess) = (0.0f64, 0.0f64);
        for &q in &order[points.clone()] {
            let (of_row, values) = rows.rows().row(q as usize);
            nodes.extend_from_slice(of_row);
            lebesgue = lebesgue.max(values.iter().map(|v| v.abs()).sum());
            excess = excess.max((values.iter().sum::<f64>() - 1.0).abs());
        }
        nodes[first..].sort_unstable();
        let mut kept = first;
        for k in first..nodes.len() {
            if kept == first || nodes[kept - 1] != nodes[k] {
                nodes[kept] = nodes[k];
                kept += 1;
            }
        }
        nodes.truncate(kept);
        let (low, high) = range(order[points.clone()].iter().map(|&q| rows.points()[q as usize].coords));
        let middle = Point3::from((low + high) * 0.5);
        let half = (high - low) * 0.5;
        Cluster { points, nodes: first..kept, middle, half, lebesgue, excess }
    }

    /// Returns middle and half extents of a box that contains the cluster's points in the state `u`.
    pub(super) fn current_box(
        &self,
        nodes: &[u32],
        u: &[Vector3],
    ) -> Result<(Point3, Vector3), ContactError> {
        let nodes = &nodes[self.nodes.clone()];
        let mut finite = true;
        let (low, high) = range(nodes.iter().map(|&node| {
            let u = u[node as usize];
            finite &= (u.x + u.y + u.z).is_finite();
            u
        }));
        if !finite {
            let bad = nodes.iter().find(|&&node| !u[node as usize].iter().all(|c| c.is_finite()));
            return Err(ContactError::NotFinite { node: *bad.unwrap_or(&nodes[0]) as usize });
        }
        let middle = (low + high) * 0.5;
        Ok((
            self.middle + middle,
            self.half + (high - low) * (0.5 * self.lebesgue) + middle.abs() * self.excess,
        ))
    }
}

/// Whether each point coincides with a point of a face that has another normal.
fn bent(rows: &SurfaceRows) -> Vec<bool> {
    let (points, normals) = (rows.points(), rows.normals());
    // Sorted along a direction in which few points of a regular mesh have the same coordinate.
    let along: Vec<f64> = points.iter().map(|p| p.x + 0.7549 * p.y + 0.5698 * p.z).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| along[a].total_cmp(&along[b]));
    let size = order.first().zip(order.last()).map_or(0.0, |(&a, &b)| along[b] - along[a]);
    let mut bent = vec![false; points.len()];
    for (k, &a) in order.iter().enumerate() {
        for &b in order[k + 1..].iter().take_while(|&&b| along[b] - along[a] <= SAME * size) {
            if (points[a] - points[b]).norm() <= SAME * size && normals[a].dot(&normals[b]) <= ALIKE {
                (bent[a], bent[b]) = (true, true);
            }
        }
    }
    bent
}

/// Returns the two points that span the surface around `q` best: close to `q`, and in clearly different
/// directions.
fn two_beside(rows: &SurfaceRows, q: u32, near: &[u32]) -> [u32; 2] {
    let normal = rows.normals()[q as usize];
    let way = |other: u32| rows.points()[other as usize] - rows.points()[q as usize];
    // Points beyond an edge are excluded, because the normal differs there.
    let alike = |p: u32| normal.dot(&rows.normals()[p as usize]) > ALIKE;
    let mut flat: Vec<u32> = near.iter().copied().filter(|&p| p != q && alike(p)).collect();
    flat.sort_by(|&a, &b| way(a).norm().total_cmp(&way(b).norm()));
    for (k, &b) in flat.iter().enumerate() {
        for &a in &flat[..k] {
            let turn = way(a).cross(&way(b)).dot(&normal) / (way(a).norm() * way(b).norm());
            if turn.abs() > 0.5 {
                return if turn > 0.0 { [a, b] } else { [b, a] };
            }
        }
    }
    [q; 2]
}

fn range(vectors: impl Iterator<Item = Vector3>) -> (Vector3, Vector3) {
    vectors.fold((Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)), |(low, high), v| {
        (low.inf(&v), high.sup(&v))
    })
}

/// Bisects the points at the median of their longest extent until at most [`CLUSTER`] are left; ties are
/// broken by index.
fn split(order: &mut [u32], start: usize, points: &[Point3], ranges: &mut Vec<Range<usize>>) {
    if order.len() <= CLUSTER {
        ranges.push(start..start + order.len());
        return;
    }
    let (low, high) = range(order.iter().map(|&q| points[q as usize].coords));
    let axis = (high - low).imax();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| {
        points[a as usize][axis].total_cmp(&points[b as usize][axis]).then(a.cmp(&b))
    });
    let (lower, upper) = order.split_at_mut(half);
    split(lower, start, points, ranges);
    split(upper, start + half, points, ranges);
}
