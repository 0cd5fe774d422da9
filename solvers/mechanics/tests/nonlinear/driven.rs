//! A tool driven by force does what the tool driven by closure does.
//!
//! ```text
//! Body        jittered box of 4 x 3 x 2 cells, neo-Hookean, nu = 0.45; z = 0 clamped.
//! Conditions  a sphere pressed into the top by a closure of 4 mm, without friction and with mu = 0.15 and 1.5; then the
//!             same by the force found, from where it just touches, in the same number of steps.
//! Must hold   the force is reached to 1e-8; without friction (no memory of the path) closure, moment and displacement agree to
//!             1e-8. With friction the two paths differ between their ends, so closures agree to 1 %.
//! ```

use fem::SurfaceRule;
use geometry::CellKind;
use mechanics::*;

use crate::common::*;

#[test]
fn force_and_closure_agree() {
    for method in METHODS.into_iter().filter(|m| m.0 != CellKind::Hex20) {
        let model = Model::block(method, [4, 3, 2]);
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.45).unwrap());
        let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
        let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
        let contact = ContactSurface::new(&surface);
        for (friction, agreement) in [(0.0, 1e-8), (0.15, 1e-2), (1.5, 1e-2)] {
            let name = format!("{method:?}, mu {friction}");
            let touch = if friction > 0.0 {
                ContactLaw::coulomb(1e7, friction, 1e6).unwrap()
            } else {
                ContactLaw::frictionless(1e7).unwrap()
            };
            let (radius, down) = (0.03, -Vector3::z());
            let at = Point3::new(0.022, 0.014, SIZE.z + radius);
            let sphere =
                Tool::new(ToolShape::Sphere { radius }, at, Matrix3::identity(), down, touch).unwrap();
            let run = |drive: Drive| {
                let tools = [DrivenTool { tool: &sphere, drive }];
                let problem = StaticProblem {
                    fixed: &fixed,
                    contact: Some(&contact),
                    tools: &tools,
                    ..model.problem(&law)
                };
                let path = solve(&name, &problem, &steps(8));
                (path.steps.last().unwrap().tools[0], path.u)
            };
            let (by_closure, u) = run(Drive::Closure(4e-3));
            let force = by_closure.force.z;
            assert!(force > 0.0, "{name}: {force}");
            let (by_force, v) = run(Drive::Force(force));
            let gap = (by_force.force.z / force - 1.0).abs();
            assert!(gap < 1e-8, "{name}: force {} for {force}", by_force.force.z);
            let gap = (by_force.closure / by_closure.closure - 1.0).abs();
            assert!(gap < agreement, "{name}: closure {} for {}", by_force.closure, by_closure.closure);
            if friction == 0.0 {
                let gap = (by_force.moment - by_closure.moment).norm() / (force * radius);
                assert!(gap < 1e-8, "{name}: moment {} for {}", by_force.moment, by_closure.moment);
                let largest = u.iter().map(Vector3::norm).fold(0.0, f64::max);
                let gap = u.iter().zip(&v).map(|(u, v)| (u - v).norm()).fold(0.0, f64::max) / largest;
                assert!(gap < 1e-8, "{name}: displacements differ by {gap:e}");
            }
        }
    }
}
