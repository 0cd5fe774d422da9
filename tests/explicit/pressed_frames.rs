//! Frames under a ball that is pressed into a block, compared with the static solution of the same contact.

use contact::{ContactLaw, ContactSurface, Drive, DrivenTool, Sphere, Tool, ToolShape};
use explicit::{
    ExplicitBody, ExplicitError, FrameParams, FrameTool, Frames, Lumping, Prescribed, lumped_mass,
};
use fem::SurfaceRule;
use geometry::CellKind;
use integration::model::{Model, Projection, SIZE, YOUNG, solve, steps};
use material::{Law, StableNeoHookean};
use shape::{Matrix3, Point3, Vector3};
use statics::StaticProblem;

/// Displacement of the ball, m.
const CLOSURE: f64 = 3e-3;

fn ball(touch: ContactLaw) -> Tool {
    let (radius, down) = (0.015, -Vector3::z());
    let at = Point3::new(0.5 * SIZE.x, 0.5 * SIZE.y, SIZE.z + radius);
    Tool::new(ToolShape::Sphere(Sphere { radius }), at, Matrix3::identity(), down, touch).unwrap()
}

/// A ball of 15 mm pressed 3 mm deep: sweeps without mass and conjugate gradients end at the force of
/// Newton's method, small position-based steps near it.
#[test]
fn a_pressed_ball_has_the_force_of_the_static_solution() {
    let model = Model::block((CellKind::Tet4, Projection::Standard), [6, 5, 3]);
    let laws = [Law::StableNeoHookean(StableNeoHookean::new(YOUNG, 0.45).unwrap())];
    let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
    let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
    let contact = ContactSurface::new(&surface);
    let tool = ball(ContactLaw::frictionless(1e8).unwrap());
    let tools = [DrivenTool { tool: &tool, drive: Drive::Closure(CLOSURE) }];
    let problem =
        StaticProblem { fixed: &fixed, contact: Some(&contact), tools: &tools, ..model.problem(&laws[0]) };
    let path = solve("ball", &problem, &steps(4));
    let force = path.steps.last().unwrap().tools[0].force.z;
    assert!(force > 0.1, "{force}");

    let mass = lumped_mass(&model.volume, &[1000.0], &[], Lumping::RowSum).unwrap();
    let still = |_: f64| 0.0;
    let prescribed: Vec<Prescribed> =
        fixed.iter().map(|dof| Prescribed { node: dof.node, axis: dof.axis, motion: &still }).collect();
    let body = ExplicitBody { volume: &model.volume, laws: &laws, region: &[], axes: &[], groups: None };
    let closure = |t: f64| CLOSURE * (t / 0.5).min(1.0);
    let run = |frames: Frames, count: usize| {
        let tools = vec![FrameTool { tool: &tool, closure: &closure }];
        let mut frames = frames.with_tools(&contact, tools).unwrap();
        for _ in 0..count {
            frames.step(&mut |_, _| {}).unwrap();
        }
        let largest = path.u.iter().map(Vector3::norm).fold(0.0, f64::max);
        let gap = frames.u().iter().zip(&path.u).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        let found = frames.state().unwrap().tools[0].force.z;
        println!("force {:e}, displacement {:e}", found / force - 1.0, gap / largest);
        [(found / force - 1.0).abs(), gap / largest]
    };
    let params = |dt: f64, sweeps: usize, inertia: bool| FrameParams { dt, damping: 20.0, inertia, sweeps };
    let frames = Frames::vertex_descent(body, &mass, &prescribed, params(0.02, 60, false)).unwrap();
    let [found, gap] = run(frames, 200);
    assert!(found < 1e-6 && gap < 1e-6, "{found:e} {gap:e}");
    let frames = Frames::constraints(body, &mass, &prescribed, params(1e-4, 1, true)).unwrap();
    let [found, gap] = run(frames, 15_000);
    // One sweep a step leaves the stiff contact out of balance: 8 % of the force.
    assert!(found < 0.1 && gap < 0.015, "{found:e} {gap:e}");
    let iterated = params(0.02, 500, true);
    let frames = Frames::conjugate_gradients(body, &mass, &prescribed, iterated, [1e-10, 0.0]).unwrap();
    let [found, gap] = run(frames, 200);
    assert!(found < 1e-6 && gap < 1e-6, "{found:e} {gap:e}");
}

#[test]
fn a_tool_with_friction_is_an_error() {
    let model = Model::block((CellKind::Tet4, Projection::Standard), [1, 1, 1]);
    let laws = [Law::StableNeoHookean(StableNeoHookean::new(YOUNG, 0.45).unwrap())];
    let body = ExplicitBody { volume: &model.volume, laws: &laws, region: &[], axes: &[], groups: None };
    let surface = fem::surface_rows(&model.mesh, &model.mesh.boundary(), &SurfaceRule::STANDARD).unwrap();
    let contact = ContactSurface::new(&surface);
    let tool = ball(ContactLaw::coulomb(1e8, 0.2, 1e7).unwrap());
    let mass = vec![1.0; model.mesh.points().len()];
    let params = FrameParams { dt: 0.01, damping: 0.0, inertia: true, sweeps: 1 };
    let frames = Frames::vertex_descent(body, &mass, &[], params).unwrap();
    let tools = vec![FrameTool { tool: &tool, closure: &|_| 0.0 }];
    assert_eq!(frames.with_tools(&contact, tools).err(), Some(ExplicitError::Friction { tool: 0 }));
}
