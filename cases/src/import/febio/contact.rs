//! Contact with rigid surfaces, as tools: a rigid wall, and a surface pair of which one side belongs to a
//! rigid body and is flat or a part of a sphere. (FEBio User Manual 4, 3.12; `FERigidWallInterface.cpp`,
//! `FESlidingInterface.cpp`.)

use std::collections::HashSet;

use nalgebra::{Matrix4, Vector3, Vector4};
use roxmltree::Node;

use super::conditions::Conditions;
use super::curves::Course;
use super::fields::{Fields, Scaled, numbers};
use super::rigid::Body;
use crate::import::document::{Part, list, quoted};
use crate::import::units::number;

/// Distance of nodes from a plane or a sphere that is rounding, relative to the size of the surface.
const ROUNDING: f64 = 1e-6;

/// Distance of the middle of a facet from the sphere through its corners, relative to the radius, up to
/// which a surface is taken for the sphere. That of a cube is 0.4.
const FACETS: f64 = 0.02;

/// Factor of the penalty in place of multipliers, which leave next to no penetration.
const STIFFER: f64 = 100.0;

/// Parts of a contact that steer the search, the tangent and the augmentation.
const STEERING: [&str; 13] = [
    "tolerance",
    "gaptol",
    "minaug",
    "maxaug",
    "search_tol",
    "search_radius",
    "symmetric_stiffness",
    "ktmult",
    "knmult",
    "seg_up",
    "smooth_aug",
    "shell_bottom_primary",
    "shell_bottom_secondary",
];

/// Surface of a tool, in units of the model.
enum Surface {
    /// A point, and the normal out of the tool.
    Plane(Vector3<f64>, Vector3<f64>),
    /// Centre and radius.
    Sphere(Vector3<f64>, f64),
}

/// Motion of a tool: the displacement at a factor of 1.
struct Motion {
    by: Vector3<f64>,
    curve: Option<String>,
}

/// Reads a `<constraint>`; others than rigid walls are refused.
pub(super) fn wall<'a>(node: Node<'a, 'a>, conditions: &mut Conditions<'a, '_>) {
    let source = conditions.source;
    let kind = node.attribute("type").unwrap_or_default();
    if kind != "rigid_wall" {
        let what = format!("<constraint> '{kind}' of <Constraints> can't be expressed");
        return source.refuse(node, what, "rigid walls are read");
    }
    let fields = Fields::of(node, source);
    let plane = fields.take("plane").and_then(|plane| numbers(plane, source, 4));
    let offset = fields.scaled("offset");
    let penalty = penalty(&fields);
    fields.pass(&STEERING);
    fields.finish();
    let (Some(plane), Some(penalty)) = (plane, penalty) else { return };
    let normal = Vector3::new(plane[0], plane[1], plane[2]);
    // The source projects along the vector as given.
    if (normal.norm() - 1.0).abs() > ROUNDING {
        let help = "give a plane a, b, c, d with a^2 + b^2 + c^2 = 1";
        return source.refuse(node, "the normal of <plane> is no unit vector", help);
    }
    let still = Motion { by: Vector3::zeros(), curve: None };
    let motion = match offset {
        None => Some(still),
        Some(offset) => conditions
            .controllers
            .course(offset)
            .map(|Course { factor, curve }| Motion { by: normal * offset.value * factor, curve }),
    };
    if let Some(motion) = motion {
        tool(node, &Surface::Plane(normal * plane[3], normal), &motion, &penalty, conditions);
    }
}

/// Reads a `<contact>` between a solid and a rigid body.
pub(super) fn pair<'a>(node: Node<'a, 'a>, bodies: &[Body<'a>], conditions: &mut Conditions<'a, '_>) {
    let (source, mesh) = (conditions.source, conditions.mesh);
    let kind = node.attribute("type").unwrap_or_default();
    if !["sliding-node-on-facet", "sliding-facet-on-facet", "sliding-elastic"].contains(&kind) {
        let what = format!("<contact> '{kind}' of <Contact> can't be expressed");
        return source.refuse(node, what, "sliding contact with a rigid body is read");
    }
    let fields = Fields::of(node, source);
    let penalty = penalty(&fields);
    for tag in ["tension", "offset", "node_reloc", "update_penalty", "flip_primary", "flip_secondary"] {
        if let Some(found) = fields.number(tag).filter(|found| *found != 0.0) {
            source.refuse(node, format!("<{tag}> is {found}"), "0 is read");
        }
    }
    if fields.flag("two_pass") {
        let what = "the second pass of a contact, with the penalty at the corners of the rigid body too";
        source.findings.leave_out(source.line(node), what);
    }
    fields.pass(&STEERING);
    fields.finish();
    let Some(sides) = mesh.pair_of(node, source) else { return };
    let nodes = sides.map(|side| mesh.facets(side).into_iter().flatten().collect::<HashSet<u64>>());
    let owner = |side: &HashSet<u64>| {
        bodies.iter().position(|body| body.parts.iter().any(|part| mesh.has_nodes(part, side)))
    };
    let (side, body) = match (owner(&nodes[0]), owner(&nodes[1])) {
        (Some(body), None) => (sides[0], &bodies[body]),
        (None, Some(body)) => (sides[1], &bodies[body]),
        (None, None) => {
            let what = format!("<contact> '{kind}' of two deformable surfaces can't be expressed");
            return source.refuse(node, what, "contact with a rigid body is read");
        }
        (Some(_), Some(_)) => return source.refuse(node, "contact of two rigid bodies", ""),
    };
    let facets: Option<Vec<Vec<Vector3<f64>>>> = mesh
        .facets(side)
        .into_iter()
        .map(|facet| facet.into_iter().map(|number| mesh.place(number, source).map(Vector3::from)).collect())
        .collect();
    let Some(surface) = facets.as_deref().and_then(surface) else {
        let what =
            format!("the surface '{side}' of a rigid body is neither flat nor the outside of a sphere");
        return source.refuse(node, what, "");
    };
    let (Some(motion), Some(penalty)) = (motion(body, conditions), penalty) else { return };
    tool(node, &surface, &motion, &penalty, conditions);
}

/// Penalty of a contact, N/m^3 or the model's unit, with its friction and a comment.
struct Penalty {
    normal: f64,
    /// Coefficient, and traction per slip.
    friction: Option<(f64, f64)>,
    note: String,
}

fn penalty(fields: &Fields) -> Option<Penalty> {
    let source = fields.source;
    let multipliers = !matches!(fields.text("laugon"), None | Some("PENALTY" | "0"));
    let automatic = fields.flag("auto_penalty");
    let coefficient = fields.number("fric_coeff").unwrap_or(0.0);
    let slope = fields.number("fric_penalty");
    let given = fields.needed("penalty")?;
    if given <= 0.0 {
        source.refuse(fields.node, format!("<penalty> is {given}"), "give a pressure per length above 0");
        return None;
    }
    if automatic && !multipliers {
        let help = "give <auto_penalty>0</auto_penalty> and a penalty in pressure per length";
        source.refuse(fields.node, "the penalty is scaled by the stiffness of each element", help);
        return None;
    }
    let normal = if multipliers { STIFFER * given } else { given };
    // Nodes on facets slide freely without a penalty of their own, and facets on facets in any case.
    let slope = match fields.node.attribute("type") {
        Some("sliding-node-on-facet") => slope.unwrap_or(0.0),
        Some("sliding-facet-on-facet") => 0.0,
        _ => given,
    };
    if coefficient > 0.0 && slope <= 0.0 {
        fields
            .source
            .findings
            .leave_out(source.line(fields.node), "<fric_coeff>, without effect in this contact");
    }
    let note = match multipliers {
        true => format!("The source has multipliers in place of a penetration: {STIFFER} times its penalty."),
        false => "Pressure per penetration, at points of the faces.".into(),
    };
    Some(Penalty {
        normal,
        friction: (coefficient > 0.0 && slope > 0.0).then(|| (coefficient, normal * slope / given)),
        note,
    })
}

/// Displacement of a rigid body that does not rotate and follows one curve.
fn motion<'a>(body: &Body<'a>, conditions: &Conditions<'a, '_>) -> Option<Motion> {
    let source = conditions.source;
    let axes = body.motion(source)?;
    let mut motion = Motion { by: Vector3::zeros(), curve: None };
    for (axis, value) in axes.into_iter().enumerate() {
        let Some(value) = value.filter(|value: &Scaled| value.value != 0.0) else { continue };
        let Course { factor, curve } = conditions.controllers.course(value)?;
        if motion.by != Vector3::zeros() && motion.curve != curve {
            source.refuse(value.node, "a rigid body moves along two curves", "a tool follows one");
            return None;
        }
        motion.by[axis] = value.value * factor;
        motion.curve = curve;
    }
    Some(motion)
}

/// Adds a tool.
fn tool(node: Node, surface: &Surface, motion: &Motion, penalty: &Penalty, conditions: &mut Conditions) {
    let units = conditions.units;
    let place = |point: &Vector3<f64>| list(point.iter().map(|x| units.lengths(*x)));
    let direction = |of: &Vector3<f64>| list(of.iter().map(|x| number(*x)));
    let name =
        node.attribute("name").map_or_else(|| format!("tool-{}", conditions.tools.len() + 1), String::from);
    let part = Part::new("[[tool]]").note(conditions.origin(node)).note(&penalty.note);
    let part = part.note("The whole boundary of the body can touch it, in the source one surface.");
    let part = part.key("name", quoted(&name));
    let (part, normal) = match surface {
        Surface::Plane(point, normal) => {
            let part = part.key("shape", quoted("plate")).key("axis", direction(normal));
            (part.key("at", place(point)), *normal)
        }
        Surface::Sphere(centre, radius) => {
            let part = part.note("The source has facets with corners on this sphere.");
            let part = part.key("shape", quoted("sphere")).key("radius", units.lengths(*radius));
            (part.key("at", place(centre)), Vector3::z())
        }
    };
    let along = motion.by.try_normalize(0.0).unwrap_or(normal);
    let curve = motion.curve.as_ref().map_or(String::new(), |curve| format!(", curve = {}", quoted(curve)));
    let part = part.key("along", direction(&along));
    let part = part.key("drive", format!("{{ closure = {}{curve} }}", units.lengths(motion.by.norm())));
    let part = part.key("penalty", units.slopes(penalty.normal));
    let part = match penalty.friction {
        Some((coefficient, stick)) => {
            part.key("friction", number(coefficient)).key("stick", units.slopes(stick))
        }
        None => part,
    };
    conditions.tools.push(part);
}

/// The plane or the sphere of a surface, by the corners of its facets.
fn surface(facets: &[Vec<Vector3<f64>>]) -> Option<Surface> {
    let points: Vec<Vector3<f64>> = facets.iter().flatten().copied().collect();
    let middle = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let size = points.iter().fold(0.0, |size: f64, x| size.max((x - middle).norm()));
    // Twice the vector area, from corners in order.
    let areas = facets.iter().flat_map(|facet| {
        (0..facet.len()).map(|i| (facet[i] - middle).cross(&(facet[(i + 1) % facet.len()] - middle)))
    });
    let normal = areas.sum::<Vector3<f64>>().try_normalize(0.0);
    let flat = |n: &Vector3<f64>| points.iter().all(|x| n.dot(&(x - middle)).abs() <= ROUNDING * size);
    if let Some(normal) = normal.filter(flat) {
        return Some(Surface::Plane(middle, normal));
    }
    // |x|^2 = 2 c x + (r^2 - c^2) about the middle, by least squares.
    let (mut matrix, mut rhs) = (Matrix4::zeros(), Vector4::zeros());
    for x in points.iter().map(|x| (x - middle) / size) {
        let row = Vector4::new(2.0 * x.x, 2.0 * x.y, 2.0 * x.z, 1.0);
        matrix += row * row.transpose();
        rhs += row * x.norm_squared();
    }
    let found = matrix.lu().solve(&rhs)?;
    let centre = found.xyz();
    let radius = (found.w + centre.norm_squared()).sqrt();
    let off = |x: &Vector3<f64>| ((x - middle) / size - found.xyz()).norm() - radius;
    let centre = middle + centre * size;
    // Neither a bowl nor a polyhedron with corners on a sphere.
    let is_outside = |facet: &Vec<Vector3<f64>>| {
        let out = facet.iter().sum::<Vector3<f64>>() / facet.len() as f64 - centre;
        let normal = (facet[1] - facet[0]).cross(&(facet[2] - facet[0]));
        normal.dot(&out) > 0.0 && out.norm() > (1.0 - FACETS) * radius * size
    };
    let is_ball = facets.iter().all(|facet| facet.len() > 2 && is_outside(facet));
    (is_ball && points.iter().all(|x| off(x).abs() <= ROUNDING))
        .then_some(Surface::Sphere(centre, radius * size))
}
