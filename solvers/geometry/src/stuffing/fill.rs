//! Fills a surface with tetrahedra: lattice, cuts, regions, mesh.

use std::collections::HashMap;

use rayon::prelude::*;

use super::cuts::{Cells, Cuts};
use super::edges::Edges;
use super::fitted::{Facets, facets_between};
use super::lattice::Lattice;
use super::names::named;
use super::octree::{Frame, Octree};
use super::sharp::sharpened;
use super::stencil::{Side, Tet};
use super::walls::{Clipped, Divided, divided};
use super::{LARGEST, MEAN_EDGE, Stuffed, Stuffing, StuffingError, expected_nodes, fitted, parts};
use crate::element::CellKind;
use crate::generate::raise_order;
use crate::mesh::{Facet, Mesh};
use crate::surface::Surface;
use crate::{Point3, Vector3};

/// Smallest number of points per parallel task.
const CHUNK: usize = 64;
/// Largest estimated number of nodes.
const MOST: f64 = 2e7;

/// Fills a surface with linear tetrahedra, which enclose about the volume of the surface.
///
/// # Errors
/// A spacing that is not positive and finite, or too fine or too coarse for the surface.
pub fn stuff(surface: &Surface, how: Stuffing) -> Result<Stuffed, StuffingError> {
    Ok(fill(surface, how)?.linear(surface))
}

/// Fills a surface with quadratic tetrahedra, whose nodes on the boundary lie on the surface. `how.spacing`
/// is that of the corners.
///
/// # Errors
/// As for [`stuff`].
pub fn stuff_quadratic(surface: &Surface, how: Stuffing) -> Result<Stuffed, StuffingError> {
    Ok(fill(surface, how)?.quadratic(surface))
}

impl Stuffed {
    pub(super) fn linear(self, surface: &Surface) -> Stuffed {
        Stuffed { mesh: fitted::linear(self.mesh, surface), ..self }
    }

    pub(super) fn quadratic(self, surface: &Surface) -> Stuffed {
        Stuffed { mesh: fitted::quadratic(raise_order(&self.mesh), surface), ..self }
    }
}

/// Fills a surface with linear tetrahedra, whose corners on the boundary lie on the surface.
pub(super) fn fill(surface: &Surface, how: Stuffing) -> Result<Stuffed, StuffingError> {
    let Stuffing { spacing, doublings } = how;
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(StuffingError::Spacing { spacing });
    }
    let coarsest = doublings.min(LARGEST);
    let nodes = if coarsest == 0 { surface.volume() } else { surface.volume() / 8.0 };
    let nodes = expected_nodes(nodes, surface.area(), spacing);
    if nodes > MOST {
        return Err(StuffingError::TooFine { spacing, nodes });
    }
    let clipped = clipped(surface, 0.5 * spacing / MEAN_EDGE, coarsest as usize);
    let sides = clipped.sides.clone();
    let divided = divided(surface, clipped);
    let parts = parts::connected(&divided.tets, &sides);
    if parts.tets.is_empty() {
        return Err(StuffingError::TooCoarse { spacing });
    }
    let regions = surface.regions();
    let is_empty = |region: usize| !parts.tets.iter().any(|&tet| usize::from(divided.regions[tet]) == region);
    if let Some(region) = (0..regions.len()).find(|&region| is_empty(region)) {
        return Err(StuffingError::RegionTooSmall { region: regions[region].name.clone(), spacing });
    }
    let mesh = mesh(&divided, &parts, surface);
    Ok(Stuffed { mesh: named(surface, mesh), left_out: parts.left_out })
}

/// Cuts the lattice along the surface. `half` is half the edge of its smallest cubes, m.
fn clipped(surface: &Surface, half: f64, coarsest: usize) -> Clipped {
    let [low, high] = surface.bounds();
    let frame = Frame { origin: nalgebra::center(&low, &high), half };
    let lattice = Lattice::new(&Octree::new(surface, frame, coarsest));
    let mut points: Vec<Point3> = lattice.points.iter().map(|&key| frame.place(key)).collect();
    let distances: Vec<f64> =
        points.par_iter().with_min_len(CHUNK).map(|p| surface.signed_distance(p)).collect();
    let cells = Cells { regular: lattice.regular, others: Vec::new() };
    let long = 2.0 * half;
    let Cuts { sides, moved, nodes, added } =
        Cuts::new(&cells, &points, &distances, long, |[inside, outside]| {
            let end = |p: u32| (&points[p as usize], distances[p as usize]);
            surface.cut(end(inside), end(outside))
        });
    moved.into_iter().for_each(|(point, to)| points[point as usize] = to);
    points.extend(added);
    let (mut tets, mut is_whole) = (Vec::new(), Vec::new());
    let apart = |a: u32, b: u32| nalgebra::distance(&points[a as usize], &points[b as usize]);
    for corners in cells.regular {
        let tet = Tet { corners, sides: corners.map(|p| sides[p as usize]) };
        tet.inside(|a, b| nodes[&[a, b]], apart, |part| tets.push(part));
        is_whole.resize(tets.len(), tet.sides == [Side::Inside; 4]);
    }
    // No other tetrahedron has a corner on the surface, since they touch only larger cubes.
    let all_inside = |tet: &[u32; 4]| tet.iter().all(|&p| sides[p as usize] == Side::Inside);
    tets.extend(lattice.coarse.into_iter().filter(all_inside));
    is_whole.resize(tets.len(), false);
    Clipped { points, tets, is_whole, sides, long }
}

/// Builds the mesh of the parts. Nodes are numbered in the order in which cells use them, and corners are
/// ordered for a positive volume.
fn mesh(divided: &Divided, parts: &parts::Parts, surface: &Surface) -> Mesh {
    let Divided { points, tets, regions, moves } = divided;
    let mut index = HashMap::new();
    let (mut kept, mut nodes) = (Vec::new(), Vec::with_capacity(4 * parts.tets.len()));
    let mut moves_of_kept = Vec::new();
    for (&tet, &part) in parts.tets.iter().zip(&parts.part) {
        let tet = tets[tet];
        let [a, b, c, d] = tet.map(|p| points[p as usize]);
        let turned = (b - a).cross(&(c - a)).dot(&(d - a)) < 0.0;
        let order = if turned { [0, 2, 1, 3] } else { [0, 1, 2, 3] };
        for corner in order {
            // Nodes are separate for each part. Otherwise, parts that touch only at a node or an edge would
            // form a hinge.
            nodes.push(*index.entry((part, tet[corner])).or_insert_with(|| {
                kept.push(points[tet[corner] as usize]);
                moves_of_kept.push(moves.get(&tet[corner]).copied().unwrap_or_else(Vector3::zeros));
                kept.len() as u32 - 1
            }));
        }
    }
    let kinds = vec![CellKind::Tet4; parts.tets.len()];
    let mut mesh = Mesh::from_flat(kept, kinds, nodes).expect("tetrahedra of four nodes each");
    if !surface.regions().is_empty() {
        let names = surface.regions().iter().map(|region| region.name.clone()).collect();
        mesh = mesh.with_regions(parts.tets.iter().map(|&tet| regions[tet]).collect(), names);
        mesh = fitted::moved(&mesh, moves_of_kept, fitted::has_angles);
    }
    let boundary: Vec<Facet> = mesh.boundary();
    let mut mesh = sharpened(mesh, &boundary, surface, &Edges::of(surface));
    for Facets { between: [region, _], facets } in facets_between(&mesh) {
        let region = &surface.regions()[region].surface;
        mesh = sharpened(mesh, &facets, region, &Edges::of(region).inside(surface));
    }
    mesh.with_group("surface", boundary).expect("faces of the mesh itself")
}
