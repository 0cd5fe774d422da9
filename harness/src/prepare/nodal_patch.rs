//! What of a constrained surface belongs to which node of a cloud, and the constraint rows made of it.
//!
//! Rows at points let test functions through that vanish there and not between: the traction on the constrained surface does
//! work on them, and a patch test misses by it. Rows of means over shares that cover the surface do no such work under a
//! constant traction, by whatever rule the surface is integrated, if it is the rule of the energy.

use geometry::{Facet, Mesh, Point3, Vector3, closest_on_triangle};
use shape::SurfaceRows;
use statics::ConstraintRow;

/// Normals that differ by more than this belong to two sides of an edge, each with a traction of its own: 37 degrees.
const SAME_SIDE: f64 = 0.8;

/// The points of a surface that one node answers for, on one side of every edge.
pub struct NodalPatch {
    node: usize,
    normal: Vector3,
    points: Vec<usize>,
}

/// Shares by ascending node; every point of the surface is in one of them. A node on an edge answers for the side on which
/// more points are nearest to it, and those of the other go to the nearest node there: with a share on each side, a cube
/// of 6 x 6 x 6 nodes constrained on all sides would have more rows than nodes.
pub fn nodal_patches(nodes: &[Point3], surface: &SurfaceRows) -> Vec<NodalPatch> {
    // The row's nodes are those near the point: the nearest of all is among them, or the point's values are poor.
    let nearest = |q: usize, of: &dyn Fn(usize) -> bool| {
        let distance = |n: &usize| (nodes[*n] - surface.points()[q]).norm_squared();
        let near = surface.rows().row(q).0.iter().map(|&n| n as usize).filter(|&n| of(n));
        near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let points = 0..surface.weights().len();
    let mut sides: Vec<Vec<NodalPatch>> = nodes.iter().map(|_| Vec::new()).collect();
    let put = |sides: &mut Vec<Vec<NodalPatch>>, node: usize, q: usize| {
        let normal = surface.normals()[q];
        match sides[node].iter_mut().find(|s| s.normal.dot(&normal) > SAME_SIDE) {
            Some(patch) => patch.points.push(q),
            None => sides[node].push(NodalPatch { node, normal, points: vec![q] }),
        }
    };
    for q in points.clone() {
        nearest(q, &|_| true).into_iter().for_each(|node| put(&mut sides, node, q));
    }
    // The first of equals: the order of points is that of the facets.
    let most =
        |patches: &Vec<NodalPatch>| patches.iter().rev().max_by_key(|s| s.points.len()).map(|s| s.normal);
    let side: Vec<Option<Vector3>> = sides.iter().map(most).collect();
    let mut sides: Vec<Vec<NodalPatch>> = nodes.iter().map(|_| Vec::new()).collect();
    for q in points {
        let own = |n: usize| side[n].is_some_and(|side| side.dot(&surface.normals()[q]) > SAME_SIDE);
        // A side so narrow that no node is its own takes the nearest of another.
        let node = nearest(q, &own).or_else(|| nearest(q, &|_| true));
        node.into_iter().for_each(|node| put(&mut sides, node, q));
    }
    sides.into_iter().flatten().collect()
}

/// The mean displacement over each share is that of `values` (m, one per point of the surface), along each constrained axis.
pub fn mean_rows(
    surface: &SurfaceRows,
    patches: &[NodalPatch],
    axes: [bool; 3],
    values: &[Vector3],
) -> Vec<ConstraintRow> {
    let mut out = Vec::new();
    for NodalPatch { points, .. } in patches {
        let area: f64 = points.iter().map(|&q| surface.weights()[q]).sum();
        let part = |q: usize| surface.weights()[q] / area;
        for axis in (0..3).filter(|&a| axes[a]) {
            let terms = points.iter().flat_map(|&q| {
                let (nodes, phi) = surface.rows().row(q);
                nodes.iter().zip(phi).map(move |(&n, v)| (n, axis as u8, part(q) * v))
            });
            let value = points.iter().map(|&q| part(q) * values[q][axis]).sum();
            out.push(ConstraintRow { terms: terms.collect(), value });
        }
    }
    out
}

/// The points of the facets (triangles) nearest to the nodes that have a share.
pub fn on_facets(nodes: &[Point3], patches: &[NodalPatch], mesh: &Mesh, facets: &[Facet]) -> Vec<Point3> {
    let triangles: Vec<[Point3; 3]> = (facets.iter())
        .map(|&facet| {
            let mut corners = mesh.facet_nodes(facet).map(|n| mesh.points()[n as usize]);
            [(); 3].map(|()| corners.next().expect("a tetrahedron's face has three corners"))
        })
        .collect();
    let mut owners: Vec<usize> = patches.iter().map(|s| s.node).collect();
    owners.dedup();
    let nearest = |x: &Point3| {
        let points = triangles.iter().map(|t| closest_on_triangle(x, t));
        points.min_by(|a, b| (a - x).norm_squared().total_cmp(&(b - x).norm_squared()))
    };
    owners.into_iter().filter_map(|n| nearest(&nodes[n])).collect()
}
