//! Tools that travel farther in a load step than their own thickness.
//!
//! ```text
//! Body        jittered box of 40 x 30 x 20 mm in 6 x 5 x 3 hex8, neo-Hookean, nu = 0.3; z = 0 clamped.
//! Conditions  Without friction, so that the end does not depend on the path: a box 8 mm thick and a plate
//!             0.2 mm thick pressed 4 mm into the top from distances of 0.5 and 5 mm; a ball of 3 mm on faces
//!             of one cell, divided into parts.
//! Must hold   One step gives the result of 5 and of 20 steps, in statics and in quasi-static time, by
//!             prescribed displacement and in frames: to 1e-7 of the force. Tools that start beyond the body,
//!             pass by its side or stop short of it end without a force.
//! ```

use contact::{
    ContactError, ContactLaw, ContactSurface, Drive, DrivenTool, Outline, RoundedBox, Sphere, Tool, ToolShape,
};
use fem::SurfaceRule;
use geometry::CellKind;
use geometry::quadrature::Parts;
use integration::model::*;
use material::{Law, NeoHookean};
use shape::{Curve, FixedDof, Matrix3, Point3, Vector3};
use statics::{
    Curves, Frames, NewtonParams, StaticError, StaticParams, StaticPath, StaticProblem, TimeParams,
    TimeProblem, solve_in_time, solve_static,
};

const METHOD: (CellKind, Projection) = (CellKind::Hex8, Projection::Standard);
const JAW: ToolShape = ToolShape::RoundedBox(RoundedBox { half: [9e-3, 9e-3, 4e-3], radius: 1e-3 });
const SHEET: ToolShape = ToolShape::RoundedBox(RoundedBox { half: [9e-3, 9e-3, 1e-4], radius: 1e-4 });

/// A block with a tool over the middle of its top that moves downwards.
struct Pressed {
    model: Model,
    law: Law,
    fixed: Vec<FixedDof>,
    rows: shape::SurfaceRows,
    tool: Tool,
}

impl Pressed {
    fn new(shape: &ToolShape, at: Point3, cells: [usize; 3], parts: usize) -> Pressed {
        let model = Model::block(METHOD, cells);
        let fixed = model.hold(&["z-min"], &[0, 1, 2], |_| Vector3::zeros());
        let boundary = model.mesh.boundary();
        let parts = vec![Parts::Inside(parts); boundary.len()];
        let rows = fem::divided_surface_rows(&model.mesh, &boundary, &SurfaceRule::STANDARD, &parts).unwrap();
        let law = Law::NeoHookean(NeoHookean::new(YOUNG, 0.3).unwrap());
        let touch = ContactLaw::frictionless(5e9).unwrap();
        let tool = Tool::new(shape.clone(), at, Matrix3::identity(), -Vector3::z(), touch).unwrap();
        Pressed { model, law, fixed, rows, tool }
    }

    /// Builds the case with a tool over the top, its face at a distance of `off` from the top.
    fn over(shape: &ToolShape, off: f64) -> Pressed {
        let at = Point3::new(0.021, 0.014, SIZE.z + off + shape.bounds().1.z);
        Pressed::new(shape, at, [6, 5, 3], 1)
    }

    fn with<T>(&self, closure: f64, solve: impl FnOnce(&StaticProblem) -> T) -> T {
        let contact = ContactSurface::new(&self.rows);
        let tools = [DrivenTool { tool: &self.tool, drive: Drive::Closure(closure) }];
        solve(&StaticProblem {
            fixed: &self.fixed,
            contact: Some(&contact),
            tools: &tools,
            ..self.model.problem(&self.law)
        })
    }

    fn path(&self, closure: f64, count: usize) -> StaticPath {
        self.with(closure, |problem| solve_static(problem, &cut(count), |_, _| {}).unwrap())
    }

    /// Returns the force on the tool at the end, N.
    fn force(&self, closure: f64, count: usize) -> f64 {
        let path = self.path(closure, count);
        assert!(path.failure.is_none(), "{count} steps: {:?}", path.failure);
        // The reported steps are those requested.
        assert_eq!(path.steps.iter().filter(|step| step.wanted).count(), count);
        path.steps.last().unwrap().tools[0].force.z
    }
}

/// Returns parameters with a residual of 1e-9: at first touch forces are small compared with rounding.
fn cut(count: usize) -> StaticParams {
    let exact = steps(count);
    StaticParams { newton: NewtonParams { tolerance: 1e-9, ..exact.newton }, ..exact }
}

fn agree(found: f64, exact: f64, what: &str) {
    assert!(exact > 0.1 && (found / exact - 1.0).abs() < 1e-7, "{what}: {found} for {exact}");
}

#[test]
fn one_step_comes_to_where_many_do() {
    for (shape, off) in [(&JAW, 5e-4), (&SHEET, 5e-3)] {
        let pressed = Pressed::over(shape, off);
        let closure = off + 4e-3;
        let many = pressed.force(closure, 20);
        for count in [1, 2, 5] {
            agree(pressed.force(closure, count), many, &format!("{shape:?} in {count}"));
        }
    }
}

/// A travel of 12 mm in one step moves the jaw beyond the surface, with nothing near it.
#[test]
fn deep_is_as_deep_in_one_step() {
    let pressed = Pressed::over(&JAW, 5e-4);
    let many = pressed.force(9e-3, 10);
    agree(pressed.force(9e-3, 1), many, "in one");
}

#[test]
fn frames_and_time_steps_are_cut_as_well() {
    let pressed = Pressed::over(&SHEET, 5e-3);
    let many = pressed.force(9e-3, 20);
    pressed.with(9e-3, |problem| {
        let step = Frames::new(problem, &cut(1)).unwrap().to(1.0).unwrap();
        agree(step.tools[0].force.z, many, "a frame");
        let params = TimeParams {
            end: 2.0,
            steps: 1,
            smallest: 1.0 / 64.0,
            accuracy: None,
            rho_inf: 0.5,
            alpha: None,
            newton: cut(1).newton,
            augmentations: 0,
        };
        let slow = StaticProblem { curves: Curves::all(Curve::growth(2.0)), ..problem.clone() };
        let time = TimeProblem { body: &slow, inertia: None, relaxation: &[] };
        let path = solve_in_time(&time, &params, |_, _, _| {}).unwrap();
        assert!(path.failure.is_none(), "{:?}", path.failure);
        agree(path.steps.last().unwrap().step.tools[0].force.z, many, "a time step");
    });
}

/// A ball of 3 mm meets no point between points at a distance of 8 mm. If the faces are divided into fifths
/// it does, and its force converges as the points become denser.
#[test]
fn a_ball_needs_points_closer_than_itself() {
    let ball = ToolShape::Sphere(Sphere { radius: 3e-3 });
    let at = Point3::new(0.02, 0.015, SIZE.z + 3e-3);
    let force = |parts, count| Pressed::new(&ball, at, [2, 2, 1], parts).force(3e-3, count);
    assert_eq!(force(1, 1), 0.0);
    let many = force(8, 10);
    agree(force(8, 1), many, "in one");
    let finer = force(16, 4);
    assert!((many / finer - 1.0).abs() < 0.1, "{many} {finer}");
}

#[test]
fn tools_that_pass_by_meet_nothing() {
    let ball = ToolShape::Sphere(Sphere { radius: 3e-3 });
    for (at, closure) in [
        // Beyond the body from the start, past its side, and stopping 10 um before the body.
        (Point3::new(0.02, 0.015, -4e-3), 0.02),
        (Point3::new(0.02, 0.0335, 0.03), 0.06),
        (Point3::new(0.02, 0.015, SIZE.z + 5e-3), 1.99e-3),
    ] {
        let pressed = Pressed::new(&ball, at, [6, 5, 3], 4);
        for count in [1, 7] {
            let path = pressed.path(closure, count);
            assert!(path.failure.is_none() && path.cut_back == 0, "{at}: {:?}", path.failure);
            assert_eq!(path.steps.len(), count);
            assert!(path.steps.iter().all(|step| step.tools[0].active == 0), "{at}");
        }
    }
}

/// A tool that grazes a side by a fifth of its radius touches it in one step as well as in ten.
#[test]
fn a_grazing_tool_touches() {
    let ball = ToolShape::Sphere(Sphere { radius: 3e-3 });
    let pressed = Pressed::new(&ball, Point3::new(0.02, 0.03 + 2.4e-3, 0.03), [6, 5, 3], 4);
    let closure = 0.018;
    let [one, ten] = [1, 10].map(|count| pressed.path(closure, count));
    for path in [&one, &ten] {
        assert!(path.failure.is_none(), "{:?}", path.failure);
        assert!(path.steps.last().unwrap().tools[0].active > 0);
    }
    let [one, ten] = [one, ten].map(|path| path.steps.last().unwrap().tools[0].force.y);
    assert!(ten > 0.0 && (one / ten - 1.0).abs() < 1e-6, "{one} {ten}");
}

/// A penalty too soft for the sheet: steps are cut to an eighth of the allowed penetration, then an error is
/// reported.
#[test]
fn a_step_that_no_cutting_saves_is_an_error() {
    let mut pressed = Pressed::over(&SHEET, 5e-3);
    let touch = ContactLaw::frictionless(1e6).unwrap();
    pressed.tool =
        Tool::new(SHEET, pressed.tool.place(0.0), Matrix3::identity(), -Vector3::z(), touch).unwrap();
    let path = pressed.path(9e-3, 1);
    let Some(StaticError::Stalled { time, step, cause }) = path.failure else {
        panic!("ended at {}", path.time())
    };
    assert!(step < 0.25 * 5e-5 / 9e-3 && time * 9e-3 > 5e-3 - 1e-9, "{time} {step}");
    assert!(
        matches!(*cause, StaticError::Contact { tool: 0, cause: ContactError::PassedThrough { .. } }),
        "{cause}"
    );
}

/// A ball of 20 mm that ends 0.1 mm deep in a face, between its points.
#[test]
fn an_overlap_without_a_force_is_an_error() {
    let ball = ToolShape::Sphere(Sphere { radius: 20e-3 });
    let pressed = Pressed::new(&ball, Point3::new(0.0198, 0.0151, SIZE.z + 20e-3), [2, 2, 1], 1);
    let top = pressed.model.facets(&["z-max"]);
    let outline = fem::outline_rows(&pressed.model.mesh, &top).unwrap();
    let nodes = pressed.model.mesh.facet_group_nodes(&top);
    let mut triangles = Vec::new();
    for (k, &facet) in top.iter().enumerate() {
        let row = |node: u32| nodes.binary_search(&node).unwrap() as u32;
        let corners: Vec<u32> = pressed.model.mesh.facet_nodes(facet).map(row).collect();
        triangles.extend((0..4).map(|i| [corners[i], corners[(i + 1) % 4], (nodes.len() + k) as u32]));
    }
    let contact =
        ContactSurface::new(&pressed.rows).with_outline(Outline::new(&outline, &triangles).unwrap());
    let run = |closure| {
        let tools = [DrivenTool { tool: &pressed.tool, drive: Drive::Closure(closure) }];
        let problem = StaticProblem {
            fixed: &pressed.fixed,
            contact: Some(&contact),
            tools: &tools,
            ..pressed.model.problem(&pressed.law)
        };
        solve_static(&problem, &cut(2), |_, _| {})
    };
    let path = run(1e-4).unwrap();
    // The half step is reported, because from there the points may still be about to touch.
    assert_eq!((path.time(), path.cut_back), (0.5, 1));
    let Some(StaticError::Stalled { cause, .. }) = path.failure else { panic!("{:?}", path.failure) };
    let StaticError::Contact { tool: 0, cause: ContactError::Overlap { depth, .. } } = *cause else {
        panic!("{cause}")
    };
    assert!((depth / 1e-4 - 1.0).abs() < 0.05, "{depth}");
    // With a deeper end the ball touches, after it has passed such a state.
    let path = run(4e-3).unwrap();
    assert!(path.failure.is_none() && path.steps.last().unwrap().tools[0].active > 0);
}
