//! Where tools may touch: contact points so close together that no tool fits between them, and the corners of the faces.

use cases::scene::ErrorKind;
use contact::{ContactSurface, Outline, Tool};
use geometry::quadrature::Parts;
use geometry::{Facet, Mesh, Point3, Vector3};
use shape::{PointRows, RowSource, SurfaceRows};

use super::sharp;
use crate::Failure;
use crate::error::Key;
use crate::scenario::PlacedTool;

/// Part of a tool's half breadth that its way may be off the nearest point at most: just so much that it cannot pass all points,
/// nor go through the surface in one step unseen. Tools of that size keep the method's own points.
const FREE: f64 = 0.95;
/// The same where faces are divided.
const AIM: f64 = 0.5;
/// Points that dividing faces may add: as many as a large mesh has.
const MOST: usize = 500_000;

/// Parts along each edge of a face that has contact points at its corners and on its edges.
const AT_CORNERS: usize = 4;

/// Points on a part of a face, about.
const POINTS: usize = 4;

/// Tables of the surface.
pub(super) struct Touch {
    /// Contact points.
    pub(super) surface: SurfaceRows,
    /// Vertices and middles of the faces that tools pass; they carry no force.
    outline: PointRows,
    triangles: Vec<[u32; 3]>,
}

impl Touch {
    /// The method's own contact points, and more where a tool passes faces that are too large for it.
    pub(super) fn new(source: &dyn RowSource, tools: &[PlacedTool]) -> Result<Touch, Failure> {
        let mesh = source.mesh();
        let facets = mesh.boundary();
        let mut surface = source.contact_surface(&[])?;
        let passed =
            facets.iter().copied().filter(|&facet| tools.iter().any(|t| passes(mesh, facet, &t.tool)));
        let passed: Vec<Facet> = passed.collect();
        let (outline, triangles) = (source.outline(&passed)?, triangles(mesh, &passed));
        let (mut parts, mut added) = (vec![1; facets.len()], 0usize);
        let mut sharp = vec![false; facets.len()];
        for (index, set) in tools.iter().enumerate() {
            outside(&surface, index, &set.tool)?;
            let half = set.tool.half_breadth();
            sharp::mark(mesh, &facets, |facet| passes(mesh, facet, &set.tool), &set.tool, &mut sharp);
            for (k, &facet) in facets.iter().enumerate().filter(|(_, facet)| passes(mesh, **facet, &set.tool))
            {
                // Points go by facets: those of this one are near there.
                let near = k * surface.points().len() / facets.len();
                let free = free(mesh, facet, &surface, near, FREE * half);
                if free > FREE * half {
                    parts[k] = parts[k].max((free / (AIM * half)).ceil() as usize);
                    added += POINTS * parts[k] * parts[k];
                    affordable(index, half, free, added)?;
                }
            }
        }
        let points = parts.into_iter().zip(sharp).map(|(parts, sharp)| match sharp {
            true => Parts::Corners(parts.max(AT_CORNERS)),
            false => Parts::Inside(parts),
        });
        let points: Vec<Parts> = points.collect();
        if points.iter().any(|parts| *parts != Parts::WHOLE) {
            surface = source.contact_surface(&points)?;
        }
        Ok(Touch { surface, outline, triangles })
    }

    /// As the solver takes it.
    pub(super) fn contact(&self) -> ContactSurface<'_> {
        let outline = Outline::new(&self.outline, &self.triangles).expect("triangles of its own points");
        ContactSurface::new(&self.surface).with_outline(outline)
    }
}

/// Part of the solid angle `4 pi` from which on a place is taken to lie within a surface: 1 inside, 0 outside, but near points
/// that are far apart 1/2 on both sides.
const WITHIN: f64 = 0.75;

/// Refuses a tool that starts within the body: it would never meet the surface from outside. What is inside is seen from the solid
/// angle `sum w n . r / |r|^3` of the surface.
fn outside(surface: &SurfaceRows, index: usize, tool: &Tool) -> Result<(), Failure> {
    let place = tool.place(0.0);
    let angle: f64 = (surface.points().iter().zip(surface.normals()).zip(surface.weights()))
        .map(|((x, n), w)| w * n.dot(&(x - place)) / (x - place).norm().powi(3))
        .sum();
    // A plate's place is any point of its face. Written so that a NaN, of a place on a point, passes.
    if tool.shape().is_endless() || !(angle > WITHIN * 4.0 * std::f64::consts::PI) {
        return Ok(());
    }
    let at = place.coords.map(|c| 1e3 * c);
    let problem = format!("({:.4}, {:.4}, {:.4}) mm lies within the body", at.x, at.y, at.z);
    Err(Failure::input(
        Key::Scene(format!("tool[{index}].at")),
        problem,
        "a tool starts outside, and closes from there",
    ))
}

/// Facets in triangles around their middles, between the rows of [`RowSource::outline`]: nodes in ascending order, then middles.
fn triangles(mesh: &Mesh, facets: &[Facet]) -> Vec<[u32; 3]> {
    let nodes = mesh.facet_group_nodes(facets);
    let mut triangles = Vec::new();
    for (k, &facet) in facets.iter().enumerate() {
        let row = |node: u32| nodes.binary_search(&node).expect("a node of the facets") as u32;
        let of_facet: Vec<u32> = mesh.facet_nodes(facet).map(row).collect();
        let corners = mesh.kind(facet.cell as usize).face_kind().corner_count();
        // Nodes on the edges, if there are any, follow the corners, each after the corner of the same place.
        let (corners, between) = of_facet.split_at(corners);
        let around: Vec<u32> =
            (0..corners.len()).flat_map(|i| [Some(corners[i]), between.get(i).copied()]).flatten().collect();
        let middle = (nodes.len() + k) as u32;
        triangles.extend((0..around.len()).map(|i| [around[i], around[(i + 1) % around.len()], middle]));
    }
    triangles
}

/// Refuses faces that would take too many points.
fn affordable(index: usize, half: f64, free: f64, points: usize) -> Result<(), Failure> {
    if points <= MOST {
        return Ok(());
    }
    let problem = format!(
        "leaves {:.3} mm free between contact points, where tool[{index}] is {:.3} mm broad and would slip through; to divide the \
         faces takes more than {MOST} points",
        2e3 * free,
        2e3 * half
    );
    Err(Failure::at(ErrorKind::NotRun, Key::Size(""), problem, "a finer mesh where the tool touches"))
}

/// Whether a tool passes a facet, or twice its own size beside it: the tissue gives way.
fn passes(mesh: &Mesh, facet: Facet, tool: &Tool) -> bool {
    let nodes = || mesh.facet_nodes(facet).map(|node| mesh.points()[node as usize]);
    let middle = Point3::from(nodes().map(|x| x.coords).sum::<Vector3>() / nodes().len() as f64);
    let radius = nodes().map(|x| (x - middle).norm()).fold(0.0, f64::max);
    let (low, high) = tool.bounds(0.0);
    let off = middle - tool.place(0.0);
    let across = off - tool.along() * off.dot(&tool.along());
    across.norm() <= radius + (high - low).norm()
}

/// Distance (m) from the place on a facet that is farthest from all contact points: its nodes, its middle and the places between
/// them; 0 where none is farther than `allowed` (m). Points from `near` on are looked at first.
fn free(mesh: &Mesh, facet: Facet, surface: &SurfaceRows, near: usize, allowed: f64) -> f64 {
    let nodes: Vec<Vector3> =
        mesh.facet_nodes(facet).map(|node| mesh.points()[node as usize].coords).collect();
    let middle = nodes.iter().sum::<Vector3>() / nodes.len() as f64;
    let between = nodes.iter().zip(nodes.iter().cycle().skip(1)).map(|(a, b)| 0.5 * (a + b));
    let places =
        nodes.iter().copied().chain([middle]).chain(nodes.iter().map(|x| 0.5 * (x + middle))).chain(between);
    let (before, after) = surface.points().split_at(near);
    let nearest = |x: Vector3| {
        let squares = || after.iter().chain(before).map(|p| (p.coords - x).norm_squared());
        if squares().any(|square| square <= allowed * allowed) {
            return 0.0;
        }
        squares().fold(f64::INFINITY, f64::min).sqrt()
    };
    places.map(nearest).fold(0.0, f64::max)
}
