//! Coulomb friction under a stiff block: stick below mu p, slip at mu p.
//!
//! ```text
//! Source      Coulomb; Wriggers, Computational Contact Mechanics (2006), ch. 5.2.
//! Body        box of 2 x 2 x 2 cells, E = 1e13 Pa (its compliance h / E is 1e-6 of the contact's 1 / k), top
//!             fixed.
//! Conditions  A plate moves up from 0.02 mm below and sideways at the same time, in 10 steps, along (sin b,
//!             0, cos b). After the touch, the pressure is k_n d cos b and the elastic slip k_t d sin b, with
//!             the travel d since the touch.
//! Must hold   Below the limit tan b = mu k_n / k_t by 0.1 %: stick, T / N = 0.999 mu to 1e-4 of it. Above by
//!             0.1 %: slip, T / N = mu to 1e-9. Far above: still mu, against the motion.
//! ```

use contact::{ContactLaw, ContactSurface, Drive, DrivenTool, Plate, Tool, ToolShape};
use fem::SurfaceRule;
use geometry::CellKind;
use integration::model::*;
use material::{Law, NeoHookean};
use shape::{Matrix3, Point3, Vector3};
use statics::StaticProblem;

const COEFFICIENT: f64 = 0.15;
const NORMAL: f64 = 1e8;
const STICK: f64 = 5e7;

/// Returns the force on the plate at the end, N, for `tan b` as a multiple of the limit; the direction of the
/// sideways motion is `sideways` (unit).
fn drag(projection: (CellKind, Projection), factor: f64, sideways: Vector3) -> Vector3 {
    let model = Model::block(projection, [2, 2, 2]);
    let law = Law::NeoHookean(NeoHookean::new(1e13, 0.3).unwrap());
    let fixed = model.hold(&["z-max"], &[0, 1, 2], |_| Vector3::zeros());
    let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
    let contact = ContactSurface::new(&surface);
    let slope = factor * COEFFICIENT * NORMAL / STICK;
    let along = (Vector3::z() + sideways * slope).normalize();
    let touch = ContactLaw::coulomb(NORMAL, COEFFICIENT, STICK).unwrap();
    let plate =
        Tool::new(ToolShape::Plate(Plate), Point3::new(0.0, 0.0, -2e-5), Matrix3::identity(), along, touch)
            .unwrap();
    let tools = [DrivenTool { tool: &plate, drive: Drive::Closure(1e-4) }];
    let problem =
        StaticProblem { fixed: &fixed, contact: Some(&contact), tools: &tools, ..model.problem(&law) };
    let path = solve(&format!("{factor}"), &problem, &steps(10));
    path.steps.last().unwrap().tools[0].force
}

#[test]
fn the_block_sticks_below_the_limit_and_slips_at_it() {
    let sideways = Vector3::new(0.6, -0.8, 0.0);
    for method in [(CellKind::Hex8, Projection::Standard), (CellKind::Tet10, Projection::Mixed)] {
        for (factor, constrained, tolerance) in
            [(0.5, 0.5, 1e-4), (0.999, 0.999, 1e-4), (1.001, 1.0, 1e-9), (3.0, 1.0, 1e-9)]
        {
            // The block pushes the plate down and resists its sideways motion.
            let force = drag(method, factor, sideways);
            let tangential = Vector3::new(force.x, force.y, 0.0);
            let ratio = tangential.norm() / (COEFFICIENT * -force.z);
            assert!((ratio - constrained).abs() < tolerance, "{method:?} at {factor}: T / (mu N) = {ratio}");
            assert!(tangential.normalize().dot(&sideways) < -1.0 + 1e-9, "{method:?} at {factor}: {force}");
        }
    }
}
