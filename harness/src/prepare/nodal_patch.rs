//! Nodal patches of a constrained surface, and the constraint rows of a cloud built from them.
//!
//! Rows at points admit test functions that vanish at the points but not between them. The traction on the
//! constrained surface does work on these functions, and a patch test fails by this work. Rows of means over
//! patches that cover the surface do no such work under a constant traction, for any surface quadrature that
//! is also the quadrature of the energy.

use geometry::{Facet, Mesh, Point3, Vector3, closest_on_triangle};
use shape::SurfaceRows;
use statics::ConstraintRow;

/// Smallest scalar product of unit normals on the same side of an edge: 37 degrees. Each side has its own
/// traction.
const SAME_SIDE: f64 = 0.8;

/// The surface points assigned to one node, on one side of every edge.
pub struct NodalPatch {
    node: usize,
    normal: Vector3,
    points: Vec<usize>,
}

/// Returns the patches by ascending node; every surface point belongs to one of them. A node on an edge owns
/// points on the side with more points nearest to the node. Points on the other side go to the nearest node
/// of that side. With a patch on each side, a cube of 6 x 6 x 6 nodes constrained on all sides would have
/// more rows than nodes.
pub fn nodal_patches(nodes: &[Point3], surface: &SurfaceRows) -> Vec<NodalPatch> {
    // The nodes of a row are the neighbours of its point. They contain the nearest node, or the point's
    // values are poor.
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
    // The first among equals: points are ordered by facet.
    let most =
        |patches: &Vec<NodalPatch>| patches.iter().rev().max_by_key(|s| s.points.len()).map(|s| s.normal);
    let side: Vec<Option<Vector3>> = sides.iter().map(most).collect();
    let mut sides: Vec<Vec<NodalPatch>> = nodes.iter().map(|_| Vec::new()).collect();
    for q in points {
        let own = |n: usize| side[n].is_some_and(|side| side.dot(&surface.normals()[q]) > SAME_SIDE);
        // A side so narrow that no node owns it goes to the nearest node of another side.
        let node = nearest(q, &own).or_else(|| nearest(q, &|_| true));
        node.into_iter().for_each(|node| put(&mut sides, node, q));
    }
    sides.into_iter().flatten().collect()
}

/// Returns constraint rows for the mean displacement over each patch, along each constrained axis. The mean
/// equals that of `values` (m, one per surface point).
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

/// Returns, for each node with a patch, the nearest point on the facets (triangles).
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
