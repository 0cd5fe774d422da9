//! Places of supports and loads on one mesh: nodes, whole facets, or facets cut by the region's planes.

use cases::scene::{Comparison, Region, Relation};
use geometry::{Facet, Mesh, Point3, Vector3};

use crate::error::{Failure, Key};

pub use cases::scene::Place;

/// The part of a boundary on which a support or load acts.
pub struct Patch {
    /// Facets entirely in the region. The discretisation integrates over them with its own rule.
    pub whole: Vec<Facet>,
    /// Flat triangles left of the facets that the region cuts.
    pub cut: Vec<CutTriangle>,
}

/// One flat triangle left of a facet after clipping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutTriangle {
    /// Corners, m, counter-clockwise from outside.
    pub corners: [Point3; 3],
}

impl CutTriangle {
    /// Returns the area (m^2) times the outward unit normal.
    pub fn area_vector(&self) -> Vector3 {
        let [a, b, c] = self.corners;
        (b - a).cross(&(c - a)) / 2.0
    }
}

/// Returns the tolerance of regions, m: the diagonal of the mesh's bounding box times the relative tolerance.
pub fn tolerance(mesh: &Mesh) -> f64 {
    Region::TOLERANCE * size(mesh)
}

/// Returns the diagonal of the mesh's bounding box, m.
pub fn size(mesh: &Mesh) -> f64 {
    let (low, high) = bounds(mesh);
    (high - low).norm()
}

/// Returns the lowest and highest corner of the mesh's bounding box, m.
pub fn bounds(mesh: &Mesh) -> (Point3, Point3) {
    let first = mesh.points()[0];
    mesh.points().iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Whether `x` lies in the place's region, within `tolerance`, m; true for a named place.
pub fn holds(place: &Place, x: &Point3, tolerance: f64) -> bool {
    match place {
        Place::Where(region) => region.contains([x.x, x.y, x.z], tolerance),
        Place::On(_) | Place::Everywhere => true,
        Place::Edge(_) | Place::At(_) => false,
    }
}

/// Returns the scene key of the place. `key` is that of its support or load.
pub fn key(place: &Place, key: &str) -> Key {
    Key::Scene(match place {
        Place::On(_) => format!("{key}.on"),
        Place::Where(_) => format!("{key}.where"),
        Place::Edge(_) => format!("{key}.edge"),
        Place::At(_) => format!("{key}.at"),
        Place::Everywhere => key.into(),
    })
}

/// Returns the place as written in the scene.
pub fn words(place: &Place) -> String {
    match place {
        Place::On(names) => names.join(", "),
        Place::Where(region) => region.text.clone(),
        Place::Edge(names) => names.join(" and "),
        Place::At(points) => {
            let each = points.iter().map(|x| {
                let [x, y, z] = x.map(millimetres);
                format!("({x}, {y}, {z})")
            });
            format!("{} mm", each.collect::<Vec<_>>().join(", "))
        }
        Place::Everywhere => "everywhere".into(),
    }
}

/// Returns a length in mm, rounded to a nanometre: 0.04 m times 1000 differs from 40 in the last digit.
fn millimetres(metres: f64) -> f64 {
    (metres * 1e9).round() / 1e6
}

/// Describes the extent of the mesh in mm, the most common unit of scenes.
pub fn extent(mesh: &Mesh) -> String {
    let (low, high) = bounds(mesh);
    let along =
        |a: usize| format!("{} = {} to {}", ["x", "y", "z"][a], millimetres(low[a]), millimetres(high[a]));
    format!("the mesh spans {} mm", (0..3).map(along).collect::<Vec<_>>().join(", "))
}

/// Returns the error of a support or load at `key` whose place contains nothing of the body.
pub fn empty(key: &str, place: &Place, mesh: &Mesh) -> Failure {
    let tolerance = tolerance(mesh);
    let inside = matches!(place, Place::Where(_)) && mesh.points().iter().any(|x| holds(place, x, tolerance));
    if inside {
        let problem = "touches no outer face of the body: the nodes there lie inside the body";
        return Failure::input(self::key(place, key), problem, "give a place on the surface");
    }
    let help = format!("{}; check the signs and the unit", extent(mesh));
    Failure::input(self::key(place, key), "touches no part of the body", &help)
}

/// Refuses interior faces for a support or load at `key` that acts along the outward normal: a wall inside
/// the body has two sides.
///
/// # Errors
/// Returns an error if any of the faces lies between two cells.
pub fn outer(key: &str, place: &Place, mesh: &Mesh, faces: &[Facet]) -> Result<(), Failure> {
    let Place::On(names) = place else { return Ok(()) };
    let boundary = mesh.boundary();
    let inside = faces.iter().filter(|facet| boundary.binary_search(facet).is_err()).count();
    if inside == 0 {
        return Ok(());
    }
    let problem = format!(
        "acts along the outward normal, but {inside} of the {} faces of {} lie between two cells, where no direction is outward",
        faces.len(),
        names.join(", ")
    );
    Err(Failure::input(
        self::key(place, key),
        problem,
        "give a traction, which states its direction, or outer faces",
    ))
}

/// Returns the facets named by the place of the support or load at `key`. The name `surface` is the whole
/// boundary of any mesh. A place given by comparisons returns the whole boundary. Edges, points and sets of nodes
/// have no facets.
///
/// # Errors
/// Returns an error that lists the known names if the mesh lacks a named surface.
pub fn facets(key: &str, place: &Place, mesh: &Mesh) -> Result<Vec<Facet>, Failure> {
    let names = match place {
        Place::On(names) => names,
        Place::Where(_) | Place::Everywhere => return Ok(mesh.boundary()),
        Place::Edge(_) | Place::At(_) => return Ok(Vec::new()),
    };
    let mut all = Vec::new();
    for name in names {
        match mesh.group(name) {
            Some(group) => all.extend_from_slice(group),
            None if name == "surface" => all.extend(mesh.boundary()),
            None if mesh.node_group(name).is_some() => {}
            None => return Err(unknown(self::key(place, key), name, mesh)),
        }
    }
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

/// Returns the error of a name that is neither a surface nor a set of nodes of the mesh.
pub(crate) fn unknown(key: Key, name: &str, mesh: &Mesh) -> Failure {
    let known: Vec<&str> = mesh.group_names().filter(|name| *name != "surface").collect();
    let mut help = format!("the mesh has {}", [&["surface"], &known[..]].concat().join(", "));
    let sets: Vec<&str> = mesh.node_groups().map(|(name, _)| name).collect();
    if !sets.is_empty() {
        help += &format!(" and the sets of nodes {}", sets.join(", "));
    }
    Failure::input(key, format!("names '{name}', a surface that the mesh does not have"), &help)
}

/// Returns the part of the boundary in the place. A facet counts as whole if all its corners and its centroid
/// are in the region. A facet that the region cuts is clipped by the region's planes, so that the loaded area
/// is that of the region and not of the facets near it. On a 1331-node kidney, facets are half as wide as the
/// jaw.
///
/// # Errors
/// Returns an error if the mesh lacks a named surface.
pub fn patch(key: &str, place: &Place, mesh: &Mesh) -> Result<Patch, Failure> {
    let tolerance = tolerance(mesh);
    let mut patch = Patch { whole: Vec::new(), cut: Vec::new() };
    for facet in facets(key, place, mesh)? {
        let corners = corners(mesh, facet);
        let sum = corners.iter().fold(Vector3::zeros(), |sum, p| sum + p.coords);
        let centre = Point3::from(sum / corners.len() as f64);
        if holds(place, &centre, tolerance) && corners.iter().all(|p| holds(place, p, tolerance)) {
            patch.whole.push(facet);
        } else if let Place::Where(region) = place {
            for k in 1..corners.len() - 1 {
                clip(&[corners[0], corners[k], corners[k + 1]], region, tolerance, &mut patch.cut);
            }
        }
    }
    Ok(patch)
}

/// Refuses a planar place that cuts facets, because finite elements constrain whole facets. A place with a
/// volume constrains the vertices in it.
///
/// # Errors
/// Returns an error if a planar place cuts facets, or if the mesh lacks a named surface.
pub fn whole(key: &str, place: &Place, mesh: &Mesh) -> Result<(), Failure> {
    let Place::Where(region) = place else { return Ok(()) };
    if region.comparisons.iter().all(|c| c.relation != Relation::Equal) {
        return Ok(());
    }
    let Patch { whole, cut } = patch(key, place, mesh)?;
    if cut.is_empty() {
        return Ok(());
    }
    let problem = format!(
        "cuts faces of the background mesh: {} faces lie wholly in the region, and {} triangles are parts of other faces",
        whole.len(),
        cut.len()
    );
    let help = "essential = \"coupling\" constrains whole faces: end the region at edges of the background mesh, or \
                take \"nitsche\"";
    Err(Failure::input(self::key(place, key), problem, help))
}

/// Returns the three or four corners of a facet, m.
pub fn corners(mesh: &Mesh, facet: Facet) -> Vec<Point3> {
    mesh.facet_corners(facet).map(|node| mesh.points()[node as usize]).collect()
}

/// Returns the distance, m, of `x` from the plane of a comparison, positive on the kept side. For an equality
/// the distance is positive above the value.
fn ahead(comparison: &Comparison, x: &Point3) -> f64 {
    let above = x[comparison.axis] - comparison.value;
    match comparison.relation {
        Relation::Less | Relation::LessEqual => -above,
        Relation::Equal | Relation::Greater | Relation::GreaterEqual => above,
    }
}

/// Clips a triangle by each plane of the region in turn (Sutherland and Hodgman 1974) and splits the
/// remaining polygon into triangles. An equality keeps only facets in its plane.
fn clip(triangle: &[Point3; 3], region: &Region, tolerance: f64, out: &mut Vec<CutTriangle>) {
    let beyond = |c: &Comparison| c.relation != Relation::Equal && triangle.iter().all(|p| ahead(c, p) < 0.0);
    if region.comparisons.iter().any(beyond) {
        return;
    }
    let mut polygon = triangle.to_vec();
    for comparison in &region.comparisons {
        if comparison.relation == Relation::Equal {
            if polygon.iter().any(|p| ahead(comparison, p).abs() > tolerance) {
                return;
            }
            continue;
        }
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, p) in polygon.iter().enumerate() {
            let next = &polygon[(k + 1) % polygon.len()];
            let (a, b) = (ahead(comparison, p), ahead(comparison, next));
            if a >= 0.0 {
                kept.push(*p);
            }
            if (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0) {
                kept.push(p + (next - p) * (a / (a - b)));
            }
        }
        polygon = kept;
        if polygon.len() < 3 {
            return;
        }
    }
    for k in 1..polygon.len() - 1 {
        let triangle = CutTriangle { corners: [polygon[0], polygon[k], polygon[k + 1]] };
        if triangle.area_vector().norm() > tolerance * tolerance {
            out.push(triangle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(comparisons: &[(usize, Relation, f64)]) -> Region {
        Region {
            text: String::new(),
            comparisons: comparisons
                .iter()
                .map(|&(axis, relation, value)| Comparison { axis, relation, value })
                .collect(),
        }
    }

    #[test]
    fn a_clipped_triangle_keeps_exactly_the_area_inside() {
        let triangle = [Point3::origin(), Point3::new(2.0, 0.0, 0.0), Point3::new(0.0, 2.0, 0.0)];
        let window = region(&[(0, Relation::GreaterEqual, 0.5), (1, Relation::LessEqual, 1.0)]);
        let mut out = Vec::new();
        clip(&triangle, &window, 1e-12, &mut out);
        // x >= 1/2, y <= 1 under x + y <= 2: the trapezoid 1/2..1 x 0..1 and the triangle beyond, 1/2 + 1/2.
        let area: f64 = out.iter().map(|t| t.area_vector().z).sum();
        assert!((area - 1.0).abs() < 1e-14, "{area}");
    }

    #[test]
    fn a_surface_that_ends_within_faces_is_refused_and_a_volume_is_not() {
        let corner = Point3::new(4e-3, 4e-3, 4e-3);
        let tet4 = geometry::CellKind::Tet4;
        let mesh = geometry::generate::box_mesh(tet4, Point3::origin(), corner, [4; 3], [1.0; 3], None);
        let mesh = mesh.unwrap();
        let side = (0, Relation::Equal, 0.0);
        let held = |comparisons: &[_]| whole("support[0]", &Place::Where(region(comparisons)), &mesh);
        assert!(held(&[side]).is_ok() && held(&[side, (1, Relation::LessEqual, 2e-3)]).is_ok());
        assert!(held(&[(1, Relation::LessEqual, 2.5e-3)]).is_ok());
        let Err(Failure::At(bad)) = held(&[side, (1, Relation::LessEqual, 2.5e-3)]) else {
            panic!("refused")
        };
        assert_eq!(bad.key, Key::Scene("support[0].where".into()));
        assert!(bad.problem.contains("16 faces lie wholly in the region"), "{}", bad.problem);
    }

    #[test]
    fn a_triangle_across_a_plane_equality_keeps_nothing() {
        let triangle = [Point3::origin(), Point3::new(2.0, 0.0, 0.0), Point3::new(0.0, 2.0, 1.0)];
        let mut out = Vec::new();
        clip(&triangle, &region(&[(2, Relation::Equal, 0.0)]), 1e-12, &mut out);
        assert!(out.is_empty());
    }
}
