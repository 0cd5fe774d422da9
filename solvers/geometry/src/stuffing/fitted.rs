//! Moves the boundary of a stuffed mesh so that the mesh encloses the volume of its surface.
//!
//! The corners of a stuffed mesh lie on the surface and its faces are chords. Where the surface is convex
//! they cut off a volume, 2 % of a sphere with 400 nodes; where parts are thinner than the cells, far more.
//! Linear meshes spread this error to both sides of the surface: each corner moves along its normal by the
//! mean distance of the faces around it from the surface. A face that cuts off a sharp edge does not count:
//! its corners on flat faces of the body stay there, where a tool may touch them. Quadratic meshes get
//! curved faces instead: the middle nodes move onto the surface. Walls between regions are treated likewise;
//! nodes where a wall meets the surface slide along the surface.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::edges::Edges;
use super::walls::Walls;
use crate::element::{self, CellKind};
use crate::generate::raise_order;
use crate::mesh::{Facet, Mesh};
use crate::surface::Surface;
use crate::{Point3, Vector3, quality};

/// Number of passes in which corners move. More change little.
const PASSES: usize = 5;
/// Largest move of a corner in a pass, over the length of the shortest edge of its faces.
const FARTHEST: f64 = 0.25;
/// Number of halvings of the moves at a cell that would become worse than is allowed, before they are given
/// up.
const HALVINGS: u32 = 4;
/// Angles (degrees) between faces of tetrahedra that moves may not exceed: those proven for the stuffing.
const ANGLES: [f64; 2] = [10.7, 164.8];
/// Smallest ratio of the lowest to the highest Jacobian determinant in a curved cell.
const LEAST_RATIO: f64 = 0.15;
/// Smallest number of faces per parallel task.
const CHUNK: usize = 32;

/// Moves the boundary of linear tetrahedra whose corners there lie on the surface.
pub(super) fn linear(mesh: Mesh, surface: &Surface) -> Mesh {
    balanced(mesh, surface, has_angles)
}

/// Whether the angles of a linear tetrahedron are those proven. A mirrored tetrahedron has the same angles,
/// but no volume.
pub(super) fn has_angles(_: CellKind, points: &[Point3]) -> bool {
    has_angles_beyond(ANGLES, points)
}

fn has_angles_beyond([least, most]: [f64; 2], points: &[Point3]) -> bool {
    let (low, high) = quality::dihedrals(CellKind::Tet4, points);
    let [a, b, c] = [1, 2, 3].map(|k| points[k] - points[0]);
    low >= least && high <= most && a.cross(&b).dot(&c) > 0.0
}

/// Part of the proven angles that is left to tetrahedra whose edges are bisected.
const BISECTED: f64 = 0.4;

/// Moves the boundary of linear tetrahedra that fill a surface and were bisected: first its nodes onto the
/// surface. The cells of the returned mesh are quadratic if asked for.
pub fn fitted(mesh: Mesh, surface: &Surface, quadratic: bool) -> Mesh {
    let sound = |_: CellKind, points: &[Point3]| {
        has_angles_beyond([BISECTED * ANGLES[0], 180.0 - BISECTED * (180.0 - ANGLES[1])], points)
    };
    let mesh = moved(&mesh, onto_surface(&mesh, surface), sound);
    if quadratic { self::quadratic(raise_order(&mesh), surface) } else { balanced(mesh, surface, sound) }
}

/// Moves that bring the nodes of the boundary onto the surface, and those of the walls onto these.
fn onto_surface(mesh: &Mesh, surface: &Surface) -> Vec<Vector3> {
    let mut moves = vec![Vector3::zeros(); mesh.points().len()];
    let nodes = mesh.facet_group_nodes(&mesh.boundary());
    let to_surface = |&node: &u32| {
        let point = mesh.points()[node as usize];
        (node, surface.closest(&point).0 - point)
    };
    let found: Vec<(u32, Vector3)> = nodes.par_iter().with_min_len(CHUNK).map(to_surface).collect();
    found.into_iter().for_each(|(node, by)| moves[node as usize] = by);
    to_walls(mesh, surface, &mut moves);
    moves
}

/// Moves the boundary of straight quadratic tetrahedra whose corners there lie on the surface: first the
/// middle nodes onto the surface.
pub(super) fn quadratic(mesh: Mesh, surface: &Surface) -> Mesh {
    let sound = |kind: CellKind, points: &[Point3]| {
        let dets = kind.entry().nodes.iter().map(|xi| element::map(kind, points, *xi).1.determinant());
        let (low, high) = dets.fold((f64::INFINITY, 0.0f64), |(low, high), d| (low.min(d), high.max(d)));
        low >= LEAST_RATIO * high
    };
    balanced(moved(&mesh, onto_surface(&mesh, surface), sound), surface, sound)
}

/// Extends the moves of straight quadratic tetrahedra by those of middle nodes to the walls. On the
/// surface, a node moves to both.
fn to_walls(mesh: &Mesh, surface: &Surface, moves: &mut [Vector3]) {
    let walls = Walls(surface.regions());
    for Facets { between: [first, second], facets } in facets_between(mesh) {
        for node in mesh.facet_group_nodes(&facets).into_iter().map(|node| node as usize) {
            let on_surface = moves[node] != Vector3::zeros();
            let from = mesh.points()[node];
            let mut to = walls.closest(first, second, &(from + moves[node]));
            if on_surface {
                to = surface.closest(&to).0;
            }
            moves[node] = to - from;
        }
    }
}

fn balanced(mut mesh: Mesh, surface: &Surface, sound: impl Fn(CellKind, &[Point3]) -> bool + Sync) -> Mesh {
    let (boundary, edges) = (mesh.boundary(), Edges::of(surface));
    let walls = Walls(surface.regions());
    let between = facets_between(&mesh);
    let of_regions: Vec<Edges> = walls.0.iter().map(|region| Edges::of(&region.surface)).collect();
    for _ in 0..PASSES {
        let outer = Sheet {
            facets: &boundary,
            distance: |p: &Point3| surface.signed_distance(p),
            cuts_an_edge: |nodes: &[Vector3]| edges.are_cut(surface, nodes),
        };
        let mut sheets = vec![outer.moves(&mesh)];
        for Facets { between: [first, second], facets } in &between {
            let region = &walls.0[*first].surface;
            let sheet = Sheet {
                facets,
                distance: |p: &Point3| walls.between(*first, *second, p),
                cuts_an_edge: |nodes: &[Vector3]| {
                    let is_rim =
                        |p: &Vector3| surface.signed_distance(&Point3::from(*p)).abs() < RIM * extent(nodes);
                    !nodes.iter().any(is_rim) && of_regions[*first].are_cut(region, nodes)
                },
            };
            sheets.push(sheet.moves(&mesh));
        }
        mesh = moved(&mesh, combined(&sheets), &sound);
    }
    mesh
}

/// Distance from the outer surface, over the extent of a face, below which a node of a wall lies on it.
const RIM: f64 = 0.1;

/// Largest distance of two nodes, m.
fn extent(nodes: &[Vector3]) -> f64 {
    nodes.iter().flat_map(|a| nodes.iter().map(move |b| (a - b).norm())).fold(0.0, f64::max)
}

/// Moves along the normals of several sheets: in each the unit normal of every node and the distance along
/// it, m. A node keeps its distance from earlier sheets.
fn combined(sheets: &[Vec<(Vector3, f64)>]) -> Vec<Vector3> {
    let of_node = |node: usize| {
        let mut moved = Vector3::zeros();
        let mut kept: Vec<Vector3> = Vec::new();
        for (normal, by) in sheets.iter().map(|sheet| sheet[node]).filter(|(normal, _)| normal.norm() > 0.0) {
            let along = kept.iter().fold(normal, |along, other| along - other * along.dot(other));
            if along.norm() > 0.5 {
                kept.push(along.normalize());
                moved += along * (by / along.norm_squared());
            }
        }
        moved
    };
    let combined = |node: usize| match sheets {
        [only] => only[node].0 * only[node].1,
        _ => of_node(node),
    };
    (0..sheets[0].len()).map(combined).collect()
}

/// Faces between two regions, of the cells of the first.
pub(super) struct Facets {
    pub between: [usize; 2],
    pub facets: Vec<Facet>,
}

/// Finds the faces between regions.
pub(super) fn facets_between(mesh: &Mesh) -> Vec<Facets> {
    if mesh.region_names().len() < 2 {
        return Vec::new();
    }
    let mut faces: Vec<([u32; 3], Facet)> = Vec::new();
    for cell in 0..mesh.cell_count() {
        for face in 0..mesh.kind(cell).faces().len() {
            let facet = Facet { cell: cell as u32, face: face as u8 };
            let mut corners = mesh.facet_corners(facet);
            let mut corners: [u32; 3] = std::array::from_fn(|_| corners.next().unwrap_or(u32::MAX));
            corners.sort_unstable();
            faces.push((corners, facet));
        }
    }
    faces.sort_unstable();
    let region = |facet: &Facet| usize::from(mesh.region(facet.cell as usize));
    let mut between: BTreeMap<[usize; 2], Vec<Facet>> = BTreeMap::new();
    for two in faces.chunk_by(|a, b| a.0 == b.0) {
        let mut facets: Vec<Facet> = two.iter().map(|(_, facet)| *facet).collect();
        facets.sort_by_key(region);
        if let [first, second] = facets[..]
            && region(&first) != region(&second)
        {
            between.entry([region(&first), region(&second)]).or_default().push(first);
        }
    }
    between.into_iter().map(|(between, facets)| Facets { between, facets }).collect()
}

/// A triangle of the boundary, or a quarter of a curved one.
struct Triangle {
    nodes: [u32; 3],
    /// Twice the area times the normal, m^2.
    area: Vector3,
    /// Integral of the distance from the surface with the linear shape function of each node, over twice the
    /// area, m.
    lacking: [f64; 3],
    /// Length of the shortest edge, m.
    shortest: f64,
}

/// Nodes of the quarters of a triangle with six nodes, and barycentric coordinates of these nodes.
const QUARTERS: [[usize; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
const BARYCENTRIC: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];

/// Faces that lie on a surface.
struct Sheet<'a, D, C> {
    facets: &'a [Facet],
    /// Signed distance of a point from the surface, m; negative where the cells are.
    distance: D,
    /// Whether a face with these nodes cuts off a sharp edge of the surface.
    cuts_an_edge: C,
}

/// Returns the triangles of a face of three or six nodes.
fn triangles(
    mesh: &Mesh,
    facet: Facet,
    distance: impl Fn(&Point3) -> f64,
    cuts_an_edge: impl Fn(&[Vector3]) -> bool,
) -> Vec<Triangle> {
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
    let cuts_an_edge = cuts_an_edge(&points);
    let triangle = |corners: &[usize; 3]| {
        let [a, b, c] = corners.map(|k| points[k]);
        // The middles of the edges integrate quadratic functions exactly.
        let middles = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
            let [i, j] = [corners[i], corners[j]].map(|k| BARYCENTRIC[k]);
            place(std::array::from_fn(|k| 0.5 * (i[k] + j[k])))
        });
        let [ab, bc, ca] = match cuts_an_edge {
            true => [0.0; 3],
            false => middles.map(|point| -distance(&point) / 12.0),
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

impl<D: Fn(&Point3) -> f64 + Sync, C: Fn(&[Vector3]) -> bool + Sync> Sheet<'_, D, C> {
    /// Returns the unit normal of every node, and the distance (m) by which it moves along it: the mean
    /// distance `int N d dA / int N dA` of the surface from the triangles around it.
    fn moves(&self, mesh: &Mesh) -> Vec<(Vector3, f64)> {
        let of_face = |facet: &Facet| triangles(mesh, *facet, &self.distance, &self.cuts_an_edge);
        let faces: Vec<Vec<Triangle>> = self.facets.par_iter().with_min_len(CHUNK).map(of_face).collect();
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
            normal.try_normalize(0.0).map_or((Vector3::zeros(), 0.0), |normal| (normal, by))
        })
        .collect()
    }
}

/// Moves the nodes. Moves at cells that would not be `sound` are halved, and given up at last: every cell
/// that is sound stays so.
pub(super) fn moved(
    mesh: &Mesh,
    mut moves: Vec<Vector3>,
    sound: impl Fn(CellKind, &[Point3]) -> bool + Sync,
) -> Mesh {
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
