//! Homogeneous states at finite strain: compression to one half between plates, confined compression, simple
//! shear.
//!
//! ```text
//! Source      cases::exact::Homogeneous, with the laws by principal stretches (cases::exact::Hyperelastic).
//! Body        jittered box of 2 x 2 x 2 cells, every law, every method.
//! Conditions  compression: no normal displacement at the planes x, y, z = 0; a plate without friction moves
//!             down on the top. With the penalty k_n its penetration is P / k_n everywhere, so a displacement
//!             of (1 - l) h + P / k_n gives the stretch l.
//!             shear: displacement on y = 0, dead tractions P N on all other faces.
//! Must hold   u affine and the plate's force P_zz A (undeformed area), to 1e-9.
//! ```

use cases::exact::{Homogeneous, Hyperelastic};
use cases::scene::medium;
use contact::{ContactLaw, ContactSurface, Drive, DrivenTool, Plate, Tool, ToolShape};
use fem::SurfaceRule;
use integration::model::*;
use material::Law;
use shape::{Matrix3, Point3, Vector3};
use statics::{Load, StaticProblem};

const POISSON: f64 = 0.45;
const PENALTY: f64 = 1e8;

/// Returns the laws of the solver for which exact solutions exist, each with its exact counterpart.
fn pairs() -> Vec<(Law, Hyperelastic)> {
    let exact = |law: &Law| medium(law, YOUNG, POISSON).unwrap().law;
    let pairs: Vec<_> =
        laws(YOUNG, POISSON).into_iter().filter_map(|law| exact(&law).map(|e| (law, e))).collect();
    assert_eq!(pairs.len(), 12);
    pairs
}

/// Presses the block to `state` by a plate and compares; `walls` are given in addition to x, y, z = 0.
fn compress(walls: &[(&str, u8)], state: impl Fn(&Hyperelastic) -> Homogeneous) {
    for method in METHODS {
        let model = Model::block(method, [2, 2, 2]);
        let mut fixed = model.walls();
        for (side, axis) in walls {
            fixed.extend(model.hold(&[side], &[*axis], |_| Vector3::zeros()));
        }
        let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
        let contact = ContactSurface::new(&surface);
        let down = -Vector3::z();
        let law = ContactLaw::frictionless(PENALTY).unwrap();
        let at = Point3::new(0.0, 0.0, SIZE.z);
        let plate = Tool::new(ToolShape::Plate(Plate), at, Tool::turned_to(&down), down, law).unwrap();
        for (law, exact) in pairs() {
            let name = format!("{method:?} {}", law.name());
            let state = state(&exact);
            let pressure = -state.stress[(2, 2)];
            let closure = (1.0 - state.deformation[(2, 2)]) * SIZE.z + pressure / PENALTY;
            let tools = [DrivenTool { tool: &plate, drive: Drive::Closure(closure) }];
            let problem = StaticProblem {
                fixed: &fixed,
                contact: Some(&contact),
                tools: &tools,
                ..model.problem(&law)
            };
            let path = solve(&name, &problem, &steps(10));
            let gradient = state.deformation - Matrix3::identity();
            let error = model.error(&path.u, |x| gradient * x.coords);
            assert!(error < 1e-9, "{name}: displacement off by {error:e}");
            let force = path.steps.last().unwrap().tools[0].force;
            let expected = Vector3::new(0.0, 0.0, pressure * SIZE.x * SIZE.y);
            let error = (force - expected).norm() / expected.norm();
            assert!(error < 1e-9, "{name}: force {force} for {expected}");
        }
    }
}

#[test]
fn free_slip_compression_to_one_half_is_exact() {
    compress(&[], |law| Homogeneous::free_slip(law, 0.5).unwrap());
}

#[test]
fn confined_compression_is_exact() {
    compress(&[("x-max", 0), ("y-max", 1)], |law| Homogeneous::confined(law, 0.7));
}

#[test]
fn simple_shear_carries_its_normal_stresses() {
    for method in METHODS {
        let model = Model::block(method, [2, 2, 2]);
        let sides: Vec<&str> = ALL_SIDES.into_iter().filter(|s| *s != "y-min").collect();
        let surface = fem::surface_rows(&model.mesh, &model.facets(&sides), &SurfaceRule::STANDARD).unwrap();
        for (law, exact) in pairs() {
            let name = format!("{method:?} {}", law.name());
            let state = Homogeneous::simple_shear(&exact, 0.3);
            let gradient = state.deformation - Matrix3::identity();
            let field = |x: &Point3| gradient * x.coords;
            let fixed = model.hold(&["y-min"], &[0, 1, 2], field);
            let values = surface.normals().iter().map(|n| state.stress * n).collect();
            let loads = [Load::Traction { surface: &surface, values }];
            let problem = StaticProblem { fixed: &fixed, loads: &loads, ..model.problem(&law) };
            let path = solve(&name, &problem, &steps(4));
            let error = model.error(&path.u, field);
            assert!(error < 1e-9, "{name}: displacement off by {error:e}");
        }
    }
}
