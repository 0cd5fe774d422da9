//! Point of the mesh surface nearest to a point outside.

use geometry::{Facet, Mesh, Point3, Vector3};

use crate::bounds::{Bounds, facet_bounds};
use crate::face::{Face, into_cell, with_face};
use crate::locate::Place;
use crate::map::Nodes;

/// Boundary facets of a mesh with their boxes.
pub(crate) struct Surface<'a> {
    mesh: &'a Mesh,
    facets: Vec<(Facet, Bounds)>,
}

impl<'a> Surface<'a> {
    pub(crate) fn new(mesh: &'a Mesh) -> Surface<'a> {
        let facets = mesh.boundary().into_iter().map(|f| (f, facet_bounds(mesh, f))).collect();
        Surface { mesh, facets }
    }

    /// Returns the nearest place on the surface and its distance (m). The result is exact for flat facets.
    /// For a curved facet it is the nearest of the stationary points reached from the middle of the facet and
    /// the middles of its edges.
    pub(crate) fn closest(&self, p: &Point3) -> (Place, f64) {
        let mut best = (Place { cell: 0, xi: [0.0; 3] }, f64::INFINITY);
        // The facet with the nearest box comes first: it bounds the distance well and excludes most other
        // facets.
        let first = (0..self.facets.len())
            .min_by(|&a, &b| self.facets[a].1.distance(p).total_cmp(&self.facets[b].1.distance(p)));
        for index in first.into_iter().chain(0..self.facets.len()) {
            let (facet, bounds) = &self.facets[index];
            if bounds.distance(p) < best.1 {
                let (s, distance) = closest_on_facet(self.mesh, *facet, p);
                if distance < best.1 {
                    let cell = facet.cell as usize;
                    let xi = into_cell(self.mesh.kind(cell), facet.face as usize, s);
                    best = (Place { cell, xi }, distance);
                }
            }
        }
        best
    }
}

/// Returns reference coordinates and distance (m) of the point of one facet nearest to `p`.
fn closest_on_facet(mesh: &Mesh, facet: Facet, p: &Point3) -> ([f64; 2], f64) {
    let kind = mesh.facet_kind(facet);
    with_face!(kind, F, N => {
        let mut nodes = [0; N];
        for (slot, node) in nodes.iter_mut().zip(mesh.facet_nodes(facet)) {
            *slot = node;
        }
        let x = Nodes::gather(mesh, &nodes);
        let target = p - x.origin;
        let gap = |s| target - x.offset(&<F as Face<N>>::shape(s));
        let tangents = |s| x.tangents(&<F as Face<N>>::shape_grad(s));
        let corners = &<F as Face<N>>::NODES[..kind.corner_count()];

        let middle = kind.centre();
        let mut best = (middle, gap(middle).norm());
        let inner = descend(middle, &gap, &tangents);
        let inside = if kind.is_triangle() {
            inner[0] >= 0.0 && inner[1] >= 0.0 && inner[0] + inner[1] <= 1.0
        } else {
            inner[0].abs() <= 1.0 && inner[1].abs() <= 1.0
        };
        let on_edges = (0..corners.len())
            .map(|i| descend_edge(corners[i], corners[(i + 1) % corners.len()], &gap, &tangents));
        for s in inside.then_some(inner).into_iter().chain(on_edges) {
            let distance = gap(s).norm();
            if distance < best.1 {
                best = (s, distance);
            }
        }
        best
    })
}

/// Minimises `|gap(s)|^2` by Gauss-Newton with step halving, unconstrained.
fn descend(
    start: [f64; 2],
    gap: &impl Fn([f64; 2]) -> Vector3,
    tangents: &impl Fn([f64; 2]) -> [Vector3; 2],
) -> [f64; 2] {
    let mut s = start;
    let mut g = gap(s);
    for _ in 0..100 {
        let [a, b] = tangents(s);
        let (aa, ab, bb) = (a.dot(&a), a.dot(&b), b.dot(&b));
        let det = aa * bb - ab * ab;
        let step = [(bb * a.dot(&g) - ab * b.dot(&g)) / det, (aa * b.dot(&g) - ab * a.dot(&g)) / det];
        if !step.iter().all(|s| s.is_finite()) {
            return s;
        }
        let mut share = 1.0;
        loop {
            let trial = [s[0] + share * step[0], s[1] + share * step[1]];
            let next = gap(trial);
            if next.norm_squared() < g.norm_squared() {
                (s, g) = (trial, next);
                break;
            }
            share *= 0.5;
            if share * step[0].abs().max(step[1].abs()) < 1e-12 {
                return s;
            }
        }
    }
    s
}

/// Minimises along the edge from corner `a` to corner `b` in the same way, clamped to the edge.
fn descend_edge(
    a: [f64; 2],
    b: [f64; 2],
    gap: &impl Fn([f64; 2]) -> Vector3,
    tangents: &impl Fn([f64; 2]) -> [Vector3; 2],
) -> [f64; 2] {
    let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
    let mut t = 0.5;
    let mut g = gap(at(t));
    for _ in 0..100 {
        let [u, v] = tangents(at(t));
        let along = (b[0] - a[0]) * u + (b[1] - a[1]) * v;
        let step = along.dot(&g) / along.norm_squared();
        if !step.is_finite() {
            return at(t);
        }
        let mut share = 1.0;
        loop {
            let trial = (t + share * step).clamp(0.0, 1.0);
            let next = gap(at(trial));
            if next.norm_squared() < g.norm_squared() {
                (t, g) = (trial, next);
                break;
            }
            share *= 0.5;
            if share * step.abs() < 1e-12 {
                return at(t);
            }
        }
    }
    at(t)
}
