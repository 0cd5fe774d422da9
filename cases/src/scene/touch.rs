//! Places of tools: at a point, or at first contact with the body.

use catalogue::Problem;
use contact::{ContactLaw, Tool as Rigid, ToolShape};
use geometry::generate::{
    Drawn, ShellExtent, ball_mesh, box_mesh, cylinder_mesh, half_kidney_mesh, kidney_mesh, sphere_shell_mesh,
    ventricle_mesh,
};
use geometry::surface::BoundaryFaces;
use geometry::{CellKind, Mesh, Point3, Surface, Vector3};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::body::Body;
use super::report::Report;
use super::units::{Length, Q};

/// Position of a tool's centre: a point, or first contact with the body
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum AtKeys {
    Point([Q<Length>; 3]),
    Touch(TouchKeys),
}

/// Place at which a tool that comes from a side of the body touches it
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TouchKeys {
    /// Side of the body from which the tool comes, along the axis
    touch: Side,
    /// Position of the tool's centre across its way; the middle of the body's box unless given
    x: Option<Q<Length>>,
    y: Option<Q<Length>>,
    z: Option<Q<Length>>,
    /// Distance along the way that is left between tool and body; none unless given
    gap: Option<Q<Length>>,
}

/// Side of a body
#[derive(Clone, Copy, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum Side {
    XMin,
    XMax,
    YMin,
    YMax,
    ZMin,
    ZMax,
}

impl Side {
    fn axis(self) -> usize {
        match self {
            Side::XMin | Side::XMax => 0,
            Side::YMin | Side::YMax => 1,
            Side::ZMin | Side::ZMax => 2,
        }
    }

    /// Direction from the side into the body.
    fn inwards(self) -> Vector3 {
        let sign = if matches!(self, Side::XMin | Side::YMin | Side::ZMin) { 1.0 } else { -1.0 };
        Vector3::ith(self.axis(), sign)
    }
}

/// Cells across a body of which the surface is taken: its chords then lie within a thousandth of the radius.
const CELLS: usize = 16;
/// Longest distance of the surface's points over the extent of the body. A ball of half this extent then
/// stands within 1e-4 of its radius.
const SPACING: f64 = 0.01;
/// Distance from the body, over its extent, at which a tool touches it.
const TOUCHES: f64 = 1e-7;
/// Most moves of a tool to the body. A tool whose face lies across the way needs one.
const MOST: usize = 1000;

impl AtKeys {
    /// Returns the position of the centre (m) of a tool of this shape, turned by `turned`, that
    /// moves along `moves`.
    pub fn read(
        self,
        (shape, turned, moves): (&ToolShape, Matrix3<f64>, [f64; 3]),
        body: Option<&Body>,
        report: &Report,
    ) -> Option<[f64; 3]> {
        let keys = match self {
            AtKeys::Point(at) => return Some(at.map(|q| q.0)),
            AtKeys::Touch(keys) => keys,
        };
        let gap = keys.gap.as_ref().map_or(0.0, |gap| gap.0);
        report.require(gap >= 0.0, "at.gap", "is negative", "give 0 or more, or leave it out");
        let side = keys.touch;
        let points = match body.map(surface) {
            Some(Ok(surface)) => points(&surface),
            Some(Err(problem)) => {
                let help = "give the position at = [x, y, z]";
                report.add(
                    "at.touch",
                    Problem::new(format!("needs the surface of the body, {problem}")).help(help),
                );
                return None;
            }
            None => return None,
        };
        let (low, high) =
            points.iter().fold((points[0], points[0]), |(low, high), x| (low.inf(x), high.sup(x)));
        let mut at = nalgebra::center(&low, &high);
        for (axis, (name, given)) in
            [("at.x", keys.x), ("at.y", keys.y), ("at.z", keys.z)].into_iter().enumerate()
        {
            let Some(given) = given else { continue };
            let help = "leave it out: the tool moves along this axis until it touches";
            report.require(axis != side.axis(), name, "lies along the way of the tool", help);
            at[axis] = given.0;
        }
        let along = side.inwards();
        let help = "give a direction of motion into the body, or the other side";
        report.require(
            along.dot(&Vector3::from(moves)) > 0.0,
            "at.touch",
            "is the side to which the tool moves away",
            help,
        );
        let extent = (high - low).norm();
        let (tool_low, tool_high) = shape.bounds();
        let reach = if shape.is_endless() { 0.0 } else { (tool_high - tool_low).norm() };
        // The tool starts outside of a ball around the body.
        at -= along * (at - nalgebra::center(&low, &high)).dot(&along);
        let start = at - along * (extent + reach);
        let law = ContactLaw::frictionless(1.0).expect("a positive penalty");
        let tool = match Rigid::new(shape.clone(), start, turned, along, law) {
            Ok(tool) => tool,
            Err(bad) => {
                report.add("", Problem::new(format!("is not a valid tool: {bad}")));
                return None;
            }
        };
        let Some(closure) = first_contact(&tool, &points, 3.0 * (extent + reach), TOUCHES * extent) else {
            let help = "give x, y or z across the way, so that the body lies ahead of the tool";
            report.add("at.touch", Problem::new("passes by the body").help(help));
            return None;
        };
        Some(tool.place(closure - gap).into())
    }
}

/// Returns the distance (m) at which a tool on its way is within `near` of the first of some points; `None` if it
/// passes by. No move overshoots, because a distance changes by no more than the tool's travel.
fn first_contact(tool: &Rigid, points: &[Point3], farthest: f64, near: f64) -> Option<f64> {
    let mut closure = 0.0;
    for _ in 0..MOST {
        let gap = points.iter().map(|x| tool.gap(closure, x)).fold(f64::INFINITY, f64::min);
        if gap <= near {
            return Some(closure);
        }
        closure += gap;
        if closure > farthest {
            return None;
        }
    }
    None
}

/// Returns the corners of a surface, and points on its triangles.
fn points(surface: &Surface) -> Vec<Point3> {
    let [low, high] = surface.bounds();
    let longest = SPACING * (high - low).norm();
    let mut points = surface.points().to_vec();
    for triangle in 0..surface.triangles().len() {
        let [a, b, c] = surface.corners(triangle);
        let edge = (b - a).norm().max((c - a).norm()).max((c - b).norm());
        let parts = (edge / longest).ceil().max(1.0) as usize;
        for i in 0..=parts {
            for j in 0..=parts - i {
                let part = |k: usize| k as f64 / parts as f64;
                points.push(a + (b - a) * part(i) + (c - a) * part(j));
            }
        }
    }
    points
}

/// Returns the surface of a body, or why it is unknown.
fn surface(body: &Body) -> Result<Surface, String> {
    let of_mesh =
        |mesh: &Mesh| BoundaryFaces::new(mesh).map(|faces| faces.surface).map_err(|bad| bad.to_string());
    let kind = CellKind::Hex8;
    let mesh = match *body {
        Body::Box { min, max } => box_mesh(kind, min.into(), max.into(), [1; 3], [1.0; 3], None),
        Body::Cylinder { radius, height } => cylinder_mesh(kind, radius, height, [CELLS, 1], 1.0),
        Body::Ball { radius } => ball_mesh(kind, radius, CELLS),
        Body::SphereShell { inner, outer, octant } => {
            let extent = if octant { ShellExtent::Octant } else { ShellExtent::Whole };
            sphere_shell_mesh(kind, inner, outer, [CELLS, 1], 1.0, extent)
        }
        Body::Ventricle(ref wall) => ventricle_mesh(kind, wall, [2 * CELLS, 2]),
        Body::Kidney { half: false, .. } => kidney_mesh(kind, CELLS),
        Body::Kidney { half: true, .. } => half_kidney_mesh(kind, CELLS, Drawn::Mildly),
        Body::File(ref file) => {
            if mesh_files::is_surface(&file.path) {
                return mesh_files::read_together(&file.paths(), file.unit, file.treatment)
                    .map(|treated| treated.surface)
                    .map_err(|bad| format!("which can't be read: {bad}"));
            }
            let mesh = mesh_files::read(&file.path, file.unit)
                .map_err(|bad| format!("which can't be read: {bad}"))?;
            return of_mesh(&mesh);
        }
    };
    of_mesh(&mesh.map_err(|bad| bad.to_string())?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::{Plate, Sphere};

    fn stands(shape: ToolShape, side: Side, across: [f64; 3], body: &Body) -> Option<Point3> {
        let points = points(&surface(body).unwrap());
        let along = side.inwards();
        let start = Point3::from(across) - along;
        let turned = Rigid::turned_to(&along);
        let tool = Rigid::new(shape, start, turned, along, ContactLaw::frictionless(1.0).unwrap()).unwrap();
        first_contact(&tool, &points, 3.0, 1e-9).map(|closure| tool.place(closure))
    }

    #[test]
    fn tools_stand_where_they_touch() {
        let ball = Body::Ball { radius: 0.02 };
        let plate = stands(Plate.into(), Side::ZMax, [0.0; 3], &ball).unwrap();
        assert!((plate.z - 0.02).abs() < 1e-8, "{plate}");
        // Two balls whose centres are 6 mm apart across the way: sqrt(30^2 - 6^2) mm along it.
        let sphere = stands(Sphere { radius: 0.01 }.into(), Side::XMin, [0.0, 6e-3, 0.0], &ball).unwrap();
        assert!((sphere.x + (0.03f64.powi(2) - 6e-3f64.powi(2)).sqrt()).abs() < 4e-5, "{sphere}");
        let cuboid = Body::Box { min: [0.0; 3], max: [0.04, 0.02, 0.01] };
        let sphere =
            stands(Sphere { radius: 0.01 }.into(), Side::YMax, [0.021, 0.0, 0.0047], &cuboid).unwrap();
        assert!((sphere.y - 0.03).abs() < 4e-6, "{sphere}");
        assert!(stands(Sphere { radius: 0.01 }.into(), Side::YMax, [0.021, 0.0, 0.0247], &cuboid).is_none());
    }
}
