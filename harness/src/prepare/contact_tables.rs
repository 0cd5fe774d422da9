//! Contact tables: contact points so dense that no tool fits between them, and points at sharp corners and
//! edges.

use cases::scene::ErrorKind;
use contact::{ContactSurface, Motion, Outline, Tool};
use geometry::quadrature::Parts;
use geometry::{Facet, Mesh, Point3, Vector3};
use shape::{PointRows, RowSource, SurfaceRows, length, position_alone};

use super::sharp;
use crate::error::{Failure, Key};
use crate::scenario::PlacedTool;

/// Largest distance from a location on a facet to the nearest contact point, over the tool's half breadth.
/// Within this distance a tool can neither slip between the points nor pass the surface in one step. The
/// method's own points are then kept.
const FREE: f64 = 0.95;
/// Target of the same ratio if faces are subdivided.
const AIM: f64 = 0.5;
/// Most points that subdivision may add: as many as in a large mesh.
const MOST: usize = 500_000;

/// Divisions along each edge of a face with contact points at its corners and edges.
const AT_CORNERS: usize = 4;

/// Approximate number of points on one part of a face.
const POINTS: usize = 4;

/// Tables of the contact surface.
pub(super) struct Touch {
    /// Contact points.
    pub(super) surface: SurfaceRows,
    /// Vertices and centres of the faces that tools pass; no force acts on them.
    outline: PointRows,
    triangles: Vec<[u32; 3]>,
}

impl Touch {
    /// Builds the method's own contact points, and more of them on faces that are too large for a tool
    /// passing them.
    pub(super) fn new(source: &dyn RowSource, tools: &[PlacedTool]) -> Result<Touch, Failure> {
        let mesh = source.mesh();
        let facets = mesh.boundary();
        let mut surface = source.contact_surface(&[])?;
        let passed =
            facets.iter().copied().filter(|&facet| tools.iter().any(|t| passes(mesh, facet, &t.tool)));
        let passed: Vec<Facet> = passed.collect();
        let outline = source.outline(&passed)?;
        let triangles = triangles(mesh, &passed);
        let mut parts = vec![1; facets.len()];
        let mut added = 0usize;
        let mut sharp = vec![false; facets.len()];
        for (index, set) in tools.iter().enumerate() {
            outside(&surface, index, &set.tool)?;
            let half = set.tool.half_breadth();
            let on_its_way = |facet| passes(mesh, facet, &set.tool);
            sharp::mark(mesh, &facets, on_its_way, surface.points(), set, &mut sharp);
            for (k, &facet) in facets.iter().enumerate().filter(|(_, facet)| passes(mesh, **facet, &set.tool))
            {
                // Points are ordered by facet, so that those of this facet are near this index.
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

    /// Returns the contact surface for the solver.
    pub(super) fn contact(&self) -> ContactSurface<'_> {
        let outline = Outline::new(&self.outline, &self.triangles).expect("triangles of its own points");
        ContactSurface::new(&self.surface).with_outline(outline)
    }
}

/// Fraction of the solid angle `4 pi` above which a point counts as inside a surface. The exact fraction is 1
/// inside and 0 outside. Close to a surface with sparse points the sum is near 1/2 on both sides.
const WITHIN: f64 = 0.75;

/// Refuses a tool that starts inside the body, because it would never meet the surface from outside. The test
/// is the solid angle `sum w n . r / |r|^3` of the surface as seen from the tool.
fn outside(surface: &SurfaceRows, index: usize, tool: &Tool) -> Result<(), Failure> {
    let place = tool.place(0.0);
    let angle: f64 = (surface.points().iter().zip(surface.normals()).zip(surface.weights()))
        .map(|((x, n), w)| w * n.dot(&(x - place)) / (x - place).norm().powi(3))
        .sum();
    // The place of a plate is any point of its face, and that of a surface may lie outside of it, such as
    // between the branches of a clamp. The condition is negated so that NaN passes: the place may coincide
    // with a point.
    let is_within_tool = !tool.shape().is_endless() && tool.gap(0.0, &place) < 0.0;
    if !is_within_tool || !(angle > WITHIN * 4.0 * std::f64::consts::PI) {
        return Ok(());
    }
    let problem = format!("{} lies within the body", position_alone(&place));
    Err(Failure::input(
        Key::Scene(format!("tool[{index}].at")),
        problem,
        "a tool has to start outside the body",
    ))
}

/// Splits facets into triangles around their centres. Indices refer to the rows of [`RowSource::outline`]:
/// nodes in ascending order, then centres.
fn triangles(mesh: &Mesh, facets: &[Facet]) -> Vec<[u32; 3]> {
    let nodes = mesh.facet_group_nodes(facets);
    let mut triangles = Vec::new();
    for (k, &facet) in facets.iter().enumerate() {
        let row = |node: u32| nodes.binary_search(&node).expect("a node of the facets") as u32;
        let of_facet: Vec<u32> = mesh.facet_nodes(facet).map(row).collect();
        // Edge nodes, if any, follow the corners. Each lies after the corner of the same index.
        let (corners, between) = of_facet.split_at(mesh.facet_kind(facet).corner_count());
        let around: Vec<u32> =
            (0..corners.len()).flat_map(|i| [Some(corners[i]), between.get(i).copied()]).flatten().collect();
        let middle = (nodes.len() + k) as u32;
        triangles.extend((0..around.len()).map(|i| [around[i], around[(i + 1) % around.len()], middle]));
    }
    triangles
}

/// Refuses a subdivision of faces that takes too many points.
fn affordable(index: usize, half: f64, free: f64, points: usize) -> Result<(), Failure> {
    if points <= MOST {
        return Ok(());
    }
    let problem = format!(
        "leaves {} between contact points, and tool[{index}] is {} wide and would slip through; \
         subdividing the faces would take more than {MOST} points",
        length(2.0 * free),
        length(2.0 * half)
    );
    Err(Failure::at(ErrorKind::NotRun, Key::Size(""), problem, "take a finer mesh near the tool"))
}

/// Whether a tool passes a facet or a margin around it. The margin is the diagonal of the tool's bounding
/// box, because the tissue deforms.
fn passes(mesh: &Mesh, facet: Facet, tool: &Tool) -> bool {
    let nodes = || mesh.facet_nodes(facet).map(|node| mesh.points()[node as usize]);
    let middle = Point3::from(nodes().map(|x| x.coords).sum::<Vector3>() / nodes().len() as f64);
    let radius = nodes().map(|x| (x - middle).norm()).fold(0.0, f64::max);
    let (low, high) = tool.bounds(0.0);
    let margin = radius + (high - low).norm();
    tool.legs().any(|(start, leg)| match leg.motion() {
        Motion::Along(along) => {
            let off = middle - start.place;
            let across = off - along * off.dot(along);
            across.norm() <= margin
        }
        // The tool sweeps a ring.
        Motion::About(turn) => {
            let [of_tool, of_facet] = [start.place, middle].map(|x| {
                let off = x - turn.pin;
                (off.dot(&turn.axis), turn.axis.cross(&off).norm())
            });
            (of_tool.0 - of_facet.0).abs() <= margin && (of_tool.1 - of_facet.1).abs() <= margin
        }
    })
}

/// Returns the largest distance (m) from a sampled location on a facet to its nearest contact point; 0 if
/// none exceeds `allowed` (m). Samples are the nodes, the centre and the midpoints between them. The search
/// starts at point `near`.
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
