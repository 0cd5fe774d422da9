//! Hertz contact of a sphere with a half-space.
//!
//! ```text
//! Source      cases::exact::Hertz (Johnson, Contact Mechanics, 1985, ch. 4).
//! Body        a quarter of the half-space: a cube of side L = 10 a on the symmetry planes x = 0, y = 0,
//!             graded towards the contact; linear law, nu = 0.3.
//! Conditions  Sphere without friction, R = 10 mm, depth R / 1000 (slope a / R = 0.03). The point force's
//!             field is prescribed on the three far faces, which makes the cube a half-space up to (a / L)^2
//!             = 1 %. Only the end is correct: the far field grows with t, the force with t^1.5. The path
//!             does not matter because there is no friction.
//! Must hold   The force converges to 4/3 E* sqrt(R) d^1.5 to 0.5 % (hex20) and 2.2 % (hex8), and at half the
//!             depth it is smaller by a factor of 2^1.5. The radius of the contact, from the area of the
//!             points in contact, is accurate to half a cell: 0.22 of it at 10 hex8 (measured 0.222), 0.16 at
//!             16 (0.118).
//! ```

use cases::exact::{Elastic, Exact as _, Hertz};
use contact::{ContactLaw, ContactSurface, Drive, DrivenTool, Sphere, Tool, ToolShape};
use fem::SurfaceRule;
use geometry::CellKind;
use geometry::generate::box_mesh;
use integration::model::*;
use material::{Law, LinearElastic};
use shape::{Matrix3, Point3, Vector3};
use statics::StaticProblem;

const RADIUS: f64 = 0.01;
const POISSON: f64 = 0.3;

/// Returns the force on the sphere and the radius of the contact, relative to those of Hertz.
fn ratios(kind: CellKind, cells: usize, depth: f64) -> [f64; 2] {
    let hertz = Hertz::new(Elastic::new(YOUNG, POISSON).unwrap(), RADIUS, depth).unwrap();
    let side = 10.0 * hertz.contact_radius();
    // The spacing grows by a factor of 40 from the contact to the far faces.
    let (low, high) = (Point3::new(0.0, 0.0, -side), Point3::new(side, side, 0.0));
    let mesh = box_mesh(kind, low, high, [cells; 3], [40.0, 40.0, 1.0 / 40.0], None).unwrap();
    let model = Model::new(mesh, Projection::Standard);
    let mut fixed = model.hold(&["x-max", "y-max", "z-min"], &[0, 1, 2], |x| hertz.displacement(x));
    for (side, axis) in [("x-min", 0), ("y-min", 1)] {
        let far: Vec<u32> = fixed.iter().filter(|f| f.axis == axis).map(|f| f.node).collect();
        let wall = model.hold(&[side], &[axis], |_| Vector3::zeros());
        fixed.extend(wall.into_iter().filter(|f| !far.contains(&f.node)));
    }
    let top = model.mesh.group("z-max").unwrap();
    let surface = fem::surface_rows(&model.mesh, top, &SurfaceRule::FINE).unwrap();
    let contact = ContactSurface::new(&surface);
    // The peak pressure causes a penetration of a 300th of the depth.
    let touch = ContactLaw::frictionless(300.0 * hertz.peak_pressure() / depth).unwrap();
    let at = Point3::new(0.0, 0.0, RADIUS);
    let shape = ToolShape::Sphere(Sphere { radius: RADIUS });
    let sphere = Tool::new(shape, at, Matrix3::identity(), -Vector3::z(), touch).unwrap();
    let tools = [DrivenTool { tool: &sphere, drive: Drive::Closure(depth) }];
    let law = Law::LinearElastic(LinearElastic::new(YOUNG, POISSON).unwrap());
    let problem =
        StaticProblem { fixed: &fixed, contact: Some(&contact), tools: &tools, ..model.problem(&law) };
    let path = solve("hertz", &problem, &steps(1));
    let end = path.steps.last().unwrap().tools[0];
    let exact = hertz.of_share(0.25).contact().unwrap();
    [end.force.z / exact.force, (end.area / exact.area).sqrt()]
}

#[test]
fn force_and_radius_converge_to_those_of_hertz() {
    // (kind, cells along each side, largest errors of force and radius)
    let levels = [
        (CellKind::Hex8, 6, 0.18, 0.29),
        (CellKind::Hex8, 10, 0.035, 0.23),
        (CellKind::Hex8, 16, 0.022, 0.125),
        (CellKind::Hex20, 3, 0.28, 0.35),
        (CellKind::Hex20, 5, 0.05, 0.14),
        (CellKind::Hex20, 8, 0.005, 0.11),
    ];
    for (kind, cells, of_force, of_radius) in levels {
        let [force, radius] = ratios(kind, cells, 1e-3 * RADIUS).map(|ratio| (ratio - 1.0_f64).abs());
        assert!(force < of_force, "{kind:?} of {cells}: force off by {force}");
        assert!(radius < of_radius, "{kind:?} of {cells}: radius off by {radius}");
    }
}

#[test]
fn force_goes_with_the_three_halves_power_of_the_depth() {
    // Ratios to Hertz's force at a depth and at half of it, with the same mesh scaled by the contact radius.
    let (deep, shallow) =
        (ratios(CellKind::Hex20, 5, 1e-3 * RADIUS)[0], ratios(CellKind::Hex20, 5, 5e-4 * RADIUS)[0]);
    assert!((deep / shallow - 1.0).abs() < 5e-3, "{deep} {shallow}");
}
