//! Moves the boundary of a stuffed mesh so that the mesh encloses the volume of its surface.
//!
//! The corners of a stuffed mesh lie on the surface and its faces are chords. Where the surface is convex
//! they cut off a volume, 2 % of a sphere with 400 nodes; where parts are thinner than the cells, far more.
//! Linear meshes spread this error to both sides of the surface: each corner moves along its normal by the
//! mean distance of the faces around it from the surface. A face that cuts off a sharp edge does not count:
//! its corners on flat faces of the body stay there, where a tool may touch them. Quadratic meshes get
//! curved faces instead: the middle nodes move onto the surface.

use rayon::prelude::*;

use super::edges::Edges;
use crate::element::{self, CellKind};
use crate::mesh::{Facet, Mesh};
use crate::surface::Surface;
use crate::{Point3, Vector3, quality};

/// Number of passes in which corners move. More change little.
const PASSES: usize = 5;
/// Largest move of a corner in a pass, over the length of the shortest edge of its faces.
const FARTHEST: f64 = 0.25;
/// Number of halvings of the moves at a cell that would become worse than is allowed, before they are given up.
const HALVINGS: u32 = 4;
/// Angles (degrees) between faces of tetrahedra that moves may not exceed: those proven for the stuffing.
const ANGLES: [f64; 2] = [10.7, 164.8];
/// Smallest ratio of the lowest to the highest Jacobian determinant in a curved cell.
const LEAST_RATIO: f64 = 0.15;
/// Smallest number of faces per parallel task.
const CHUNK: usize = 32;

/// Moves the boundary of linear tetrahedra whose corners there lie on the surface.
pub(super) fn linear(mesh: Mesh, surface: &Surface) -> Mesh {
    balanced(mesh, surface, |_, points| {
        let (low, high) = quality::dihedrals(CellKind::Tet4, points);
        low >= ANGLES[0] && high <= ANGLES[1]
    })
}

/// Moves the boundary of straight quadratic tetrahedra whose corners there lie on the surface: first the middle nodes
/// onto the surface.
pub(super) fn quadratic(mesh: Mesh, surface: &Surface) -> Mesh {
    let sound = |kind: CellKind, points: &[Point3]| {
        let dets = kind.entry().nodes.iter().map(|xi| element::map(kind, points, *xi).1.determinant());
        let (low, high) = dets.fold((f64::INFINITY, 0.0f64), |(low, high), d| (low.min(d), high.max(d)));
        low >= LEAST_RATIO * high
    };
    let mut moves = vec![Vector3::zeros(); mesh.points().len()];
    let nodes = mesh.facet_group_nodes(&mesh.boundary());
    let to_surface = |&node: &u32| {
        let point = mesh.points()[node as usize];
        (node, surface.closest(&point).0 - point)
    };
    let found: Vec<(u32, Vector3)> = nodes.par_iter().with_min_len(CHUNK).map(to_surface).collect();
    found.into_iter().for_each(|(node, by)| moves[node as usize] = by);
    balanced(moved(&mesh, moves, sound), surface, sound)
}

fn balanced(mut mesh: Mesh, surface: &Surface, sound: impl Fn(CellKind, &[Point3]) -> bool + Sync) -> Mesh {
    let (boundary, edges) = (mesh.boundary(), Edges::of(surface));
    for _ in 0..PASSES {
        let moves = moves(&mesh, &boundary, surface, &edges);
        mesh = moved(&mesh, moves, &sound);
    }
    mesh
}

/// A triangle of the boundary, or a quarter of a curved one.
struct Triangle {
    nodes: [u32; 3],
    /// Twice the area times the normal, m^2.
    area: Vector3,
    /// Integral of the distance from the surface with the linear shape function of each node, over twice the area, m.
    lacking: [f64; 3],
    /// Length of the shortest edge, m.
    shortest: f64,
}

/// Nodes of the quarters of a triangle with six nodes, and barycentric coordinates of these nodes.
const QUARTERS: [[usize; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
const BARYCENTRIC: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];

/// Returns the triangles of a face of three or six nodes.
fn triangles(mesh: &Mesh, facet: Facet, surface: &Surface, edges: &Edges) -> Vec<Triangle> {
    let nodes: Vec<u32> = mesh.facet_nodes(facet).collect();
    let points: Vec<Vector3> = nodes.iter().map(|&node| mesh.points()[node as usize].coords).collect();
    let place = |[a, b, c]: [f64; 3]| -> Point3 {
        let weights = match nodes.len() {
            3 => vec![a, b, c],
            _ => vec![
                a * (2.0 * a - 1.0),
                b * (2.0 * b - 1.0),
                c * (2.0 * c - 1.0),
                4.0 * a * b,
                4.0 * b * c,
                4.0 * c * a,
            ],
        };
        points.iter().zip(weights).map(|(point, weight)| point * weight).sum::<Vector3>().into()
    };
    let cuts_an_edge = edges.are_cut(surface, &points);
    let triangle = |corners: &[usize; 3]| {
        let [a, b, c] = corners.map(|k| points[k]);
        // The middles of the edges integrate quadratic functions exactly.
        let middles = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
            let [i, j] = [corners[i], corners[j]].map(|k| BARYCENTRIC[k]);
            place(std::array::from_fn(|k| 0.5 * (i[k] + j[k])))
        });
        let [ab, bc, ca] = match cuts_an_edge {
            true => [0.0; 3],
            false => middles.map(|point| -surface.signed_distance(&point) / 12.0),
        };
        Triangle {
            nodes: corners.map(|k| nodes[k]),
            area: (b - a).cross(&(c - a)),
            lacking: [ab + ca, ab + bc, bc + ca],
            shortest: (b - a).norm().min((c - b).norm()).min((a - c).norm()),
        }
    };
    if nodes.len() == 3 { vec![triangle(&[0, 1, 2])] } else { QUARTERS.iter().map(triangle).collect() }
}

/// Returns the move of every node: along its normal, by the mean distance `int N d dA / int N dA` of the surface from
/// the triangles around it.
fn moves(mesh: &Mesh, boundary: &[Facet], surface: &Surface, edges: &Edges) -> Vec<Vector3> {
    let of_face = |facet: &Facet| triangles(mesh, *facet, surface, edges);
    let faces: Vec<Vec<Triangle>> = boundary.par_iter().with_min_len(CHUNK).map(of_face).collect();
    let count = mesh.points().len();
    let (mut normal, mut sum) = (vec![Vector3::zeros(); count], vec![[0.0; 2]; count]);
    let mut shortest = vec![f64::INFINITY; count];
    for Triangle { nodes, area, lacking, shortest: length } in faces.into_iter().flatten() {
        for (node, lacking) in nodes.into_iter().zip(lacking) {
            let node = node as usize;
            normal[node] += area;
            sum[node][0] += lacking * area.norm();
            sum[node][1] += area.norm() / 6.0;
            shortest[node] = shortest[node].min(length);
        }
    }
    let each = normal.iter().zip(&sum).zip(&shortest);
    each.map(|((normal, [lacking, area]), shortest)| {
        let longest = FARTHEST * shortest;
        let by = (lacking / area).clamp(-longest, longest);
        normal.try_normalize(0.0).map_or(Vector3::zeros(), |normal| normal * by)
    })
    .collect()
}

/// Moves the nodes. Moves at cells that would not be `sound` are halved, and given up at last: every cell that is
/// sound stays so.
fn moved(mesh: &Mesh, mut moves: Vec<Vector3>, sound: impl Fn(CellKind, &[Point3]) -> bool + Sync) -> Mesh {
    let zero = Vector3::zeros();
    let mut halved = vec![0; moves.len()];
    loop {
        let points: Vec<Point3> = mesh.points().iter().zip(&moves).map(|(point, by)| point + by).collect();
        let is_bad = |&cell: &usize| {
            let nodes = mesh.cell(cell);
            let touched = nodes.iter().any(|&node| moves[node as usize] != zero);
            let corners: Vec<Point3> = nodes.iter().map(|&node| points[node as usize]).collect();
            touched && !sound(mesh.kind(cell), &corners)
        };
        let bad: Vec<usize> =
            (0..mesh.cell_count()).into_par_iter().with_min_len(CHUNK).filter(is_bad).collect();
        if bad.is_empty() {
            return mesh.at(points);
        }
        let mut nodes: Vec<u32> = bad.iter().flat_map(|&cell| mesh.cell(cell).iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        for node in nodes {
            let node = node as usize;
            halved[node] += 1;
            moves[node] = if halved[node] > HALVINGS { zero } else { moves[node] * 0.5 };
        }
    }
}
