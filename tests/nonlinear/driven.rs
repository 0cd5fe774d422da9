//! A force-driven tool gives the same result as a displacement-driven tool.
//!
//! ```text
//! Body        jittered box of 4 x 3 x 2 cells, neo-Hookean, nu = 0.45; z = 0 clamped.
//! Conditions  A sphere is pressed into the top by a displacement of 4 mm, without friction and with mu =
//!             0.15 and 1.5. Then the resulting force is prescribed, from first touch, in the same number of
//!             steps.
//! Must hold   The force is reached to 1e-8, also in a single step by balls that start at a distance of 2 mm.
//!             Without friction (independent of the path) displacement of the tool, moment and displacement
//!             of the body agree to 1e-8. With friction the two paths differ between their ends, so
//!             displacements of the tool agree to 1 %, for the single step to 5 %.
//! ```

use contact::{ContactLaw, ContactSurface, Drive, DrivenTool, Sphere, Tool, ToolShape};
use fem::SurfaceRule;
use geometry::CellKind;
use integration::model::*;
use material::{Law, NeoHookean};
use shape::{Matrix3, Point3, Vector3};
use statics::{Frames, NewtonParams, StaticParams, StaticProblem, solve_static};

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
            let radius = 0.03;
            let down = -Vector3::z();
            let at = Point3::new(0.022, 0.014, SIZE.z + radius);
            let sphere =
                Tool::new(ToolShape::Sphere(Sphere { radius }), at, Matrix3::identity(), down, touch)
                    .unwrap();
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

/// Two balls at a distance of 2 mm above and below the free end of a block, with a force that presses each 3
/// mm into the block, in a single step. Newton's method alone would alternate between no contact and deep
/// contact.
#[test]
fn first_contact_in_one_step() {
    for method in METHODS.into_iter().filter(|m| m.0 != CellKind::Hex20) {
        let model = Model::block(method, [4, 3, 2]);
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.495).unwrap());
        let fixed = model.hold(&["x-min"], &[0, 1, 2], |_| Vector3::zeros());
        let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
        let contact = ContactSurface::new(&surface);
        let touch = ContactLaw::coulomb(5e8, 0.15, 1e8).unwrap();
        let radius = 0.012;
        let off = 2e-3;
        let ball = |z: f64, along: Vector3| {
            Tool::new(
                ToolShape::Sphere(Sphere { radius }),
                Point3::new(0.03, 0.014, z),
                Matrix3::identity(),
                along,
                touch,
            )
            .unwrap()
        };
        let balls = [ball(SIZE.z + radius + off, -Vector3::z()), ball(-radius - off, Vector3::z())];
        let run = |drives: [Drive; 2], count: usize| {
            let tools = [0, 1].map(|k| DrivenTool { tool: &balls[k], drive: drives[k] });
            let problem = StaticProblem {
                fixed: &fixed,
                contact: Some(&contact),
                tools: &tools,
                ..model.problem(&law)
            };
            solve_static(&problem, &steps(count), |_, _| {}).unwrap()
        };
        let path = run([Drive::Closure(5e-3); 2], 10);
        assert!(path.failure.is_none(), "{method:?}: {:?}", path.failure);
        let by_closure = &path.steps.last().unwrap().tools;
        let force = [by_closure[0].force.z, -by_closure[1].force.z];
        let path = run(force.map(Drive::Force), 1);
        assert!(path.failure.is_none() && path.cut_back == 0, "{method:?}: {} cut back", path.cut_back);
        let last = path.steps.last().unwrap();
        assert!(last.stable, "{method:?}");
        for (tool, force) in last.tools.iter().zip(force) {
            let gap = (tool.force.z.abs() / force - 1.0).abs();
            assert!(gap < 1e-8, "{method:?}: force {} for {force}", tool.force.z);
            // The two paths differ in the order of slip.
            let gap = (tool.closure / 5e-3 - 1.0).abs();
            assert!(gap < 0.05, "{method:?}: closure {}", tool.closure);
        }
    }
}

/// Frames of a simulator's loop, forwards and back, end at the states of the path; without friction they
/// return to the undeformed state. With kept factors they are the same and factor less often.
#[test]
fn frames_follow_the_path_both_ways() {
    for method in [(CellKind::Hex8, Projection::Element), (CellKind::Tet10, Projection::Mixed)] {
        let model = Model::block(method, [3, 2, 2]);
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.49).unwrap());
        let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
        let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
        let contact = ContactSurface::new(&surface);
        let touch = ContactLaw::frictionless(1e7).unwrap();
        let at = Point3::new(0.022, 0.014, SIZE.z + 0.03);
        let ball = Tool::new(
            ToolShape::Sphere(Sphere { radius: 0.03 }),
            at,
            Matrix3::identity(),
            -Vector3::z(),
            touch,
        )
        .unwrap();
        let tools = [DrivenTool { tool: &ball, drive: Drive::Closure(4e-3) }];
        let problem =
            StaticProblem { fixed: &fixed, contact: Some(&contact), tools: &tools, ..model.problem(&law) };
        let path = solve("path", &problem, &steps(4));
        let largest = path.u.iter().map(Vector3::norm).fold(0.0, f64::max);
        // A dense factor counts as cheap: its ratio is 0.
        let factorisations = [f64::INFINITY, -1.0].map(|keeps| {
            let params = steps(4);
            let params = StaticParams { newton: NewtonParams { keeps, ..params.newton }, ..params };
            let mut frames = Frames::new(&problem, &params).unwrap();
            for part in [0.25, 0.5, 0.75, 1.0, 0.5, 1e-3, 0.8, 1.0] {
                let step = frames.to(part).unwrap();
                assert_eq!(step.time, part);
                let gap =
                    frames.u().iter().zip(&path.u).map(|(u, v)| (u - v).norm()).fold(0.0, f64::max) / largest;
                match part {
                    1.0 => assert!(gap < 1e-9, "{method:?}: {gap:e}"),
                    1e-3 => assert!((gap - 1.0).abs() < 0.01, "{method:?}: not back: {gap:e}"),
                    _ => assert!(gap > 0.1, "{method:?}: {gap:e} at {part}"),
                }
            }
            frames.work().factorisations
        });
        let [renewed, kept] = factorisations;
        let saddle = method.1 == Projection::Mixed;
        assert!(
            if saddle { kept == renewed } else { 3 * kept < 2 * renewed },
            "{method:?}: {factorisations:?}"
        );
    }
}
