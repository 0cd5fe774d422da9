//! Implicit dynamics: conserved quantities, exact solutions, and contact.

use contact::{ContactLaw, ContactSurface, Drive, DrivenTool, Sphere, Tool, ToolShape};
use fem::SurfaceRule;
use geometry::CellKind;
use integration::cuboid::{Cuboid, distance, largest, moving, params};
use material::{Law, LinearElastic, NeoHookean};
use shape::{Curve, FixedDof, Matrix3, Point3, Vector3};
use statics::{
    Curves, Inertia, Load, Mass, NewtonParams, PenaltySurface, SolidDilation, StaticParams, StaticProblem,
    TimeError, TimeParams, TimeProblem, solve_in_time, solve_static,
};

const DENSITY: f64 = 1000.0;

fn soft(poisson: f64) -> Law {
    Law::NeoHookean(NeoHookean::new(20e3, poisson).unwrap())
}

fn linear() -> Law {
    Law::LinearElastic(LinearElastic::new(20e3, 0.3).unwrap())
}

/// A block of 4 x 3 x 2 cm.
fn block(kind: CellKind, cells: [usize; 3]) -> Cuboid {
    Cuboid::new(kind, [0.04, 0.03, 0.02], cells)
}

/// Returns a velocity field of stretching, bending and rotation, about 0.1 m/s.
fn stirred(block: &Cuboid) -> Vec<Vector3> {
    block.field(|x| Vector3::new(3.0 * x.x - 2.0 * x.z, 80.0 * x.x * x.x, 2.0 * x.x - 90.0 * x.y * x.z))
}

fn momentum(mass: &Mass, v: &[Vector3]) -> Vector3 {
    mass.times(v).iter().sum()
}

#[test]
fn a_free_body_flies_and_falls_exactly() {
    let block = block(CellKind::Tet10, [2, 2, 1]);
    let mass = block.consistent(DENSITY);
    let (v, g) = (Vector3::new(0.3, -0.2, 0.5), Vector3::new(0.0, 0.0, -9.81));
    let velocity = block.field(|_| v);
    let weight = vec![g * DENSITY; block.volume.weights().len()];
    for law in [linear(), soft(0.45)] {
        let laws = [law];
        for (loads, g) in [(vec![], Vector3::zeros()), (vec![Load::Body { values: weight.clone() }], g)] {
            let body = StaticProblem { loads: &loads, ..block.body(&laws, &[]) };
            let problem = moving(&body, &mass, &[], &velocity);
            for rho in [1.0, 0.6, 0.0] {
                let path = solve_in_time(&problem, &params(0.2, 10, rho), |done, motion, _| {
                    let t = done.step.time;
                    let exact = vec![v * t + g * (0.5 * t * t); motion.u.len()];
                    let error = distance(&motion.u, &exact) / largest(&exact);
                    assert!(error < 1e-11, "{rho} {t}: {error:e}");
                    let exact = vec![v + g * t; motion.u.len()];
                    assert!(distance(&motion.v, &exact) < 1e-10, "{rho} {t}");
                })
                .unwrap();
                assert_eq!(path.failure, None);
                assert_eq!((path.steps.len(), path.cut_back), (10, 0));
            }
        }
    }
}

#[test]
fn the_trapezoidal_rule_keeps_the_energy_of_a_linear_body() {
    for (kind, lumped) in [(CellKind::Hex8, true), (CellKind::Hex20, false), (CellKind::Tet10, false)] {
        let block = block(kind, [3, 2, 1]);
        let laws = [linear()];
        let fixed = block.constrained(|x, _| (x.x == 0.0).then_some(0.0));
        let body = block.body(&laws, &fixed);
        let mass = if lumped { block.lumped(DENSITY) } else { block.consistent(DENSITY) };
        let velocity = stirred(&block);
        let problem = moving(&body, &mass, &[], &velocity);
        let mut moved = 0.0f64;
        // Half of the energy is exchanged between the forms, so 1e-10 is relative to an energy of this size.
        solve_in_time(&problem, &params(0.1, 50, 1.0), |done, _, _| {
            let lost = done.energy.lost() / done.energy.start;
            moved = moved.max(done.energy.internal / done.energy.start);
            assert!(lost.abs() < 1e-10, "{kind:?} {}: {lost:e}", done.step.time);
        })
        .unwrap();
        assert!(moved > 0.3, "{moved}");

        // With damping and loads, all energy supplied and removed is accounted for.
        let traction = vec![Vector3::new(40.0, -30.0, 20.0); block.volume.weights().len()];
        let loads = [Load::Body { values: traction.iter().map(|t| t / 0.01).collect() }];
        let curves = Curves::all(Curve::growth(0.05));
        let body = StaticProblem { loads: &loads, curves, ..body.clone() };
        let inertia = Inertia {
            mass: &mass,
            damping: 20.0,
            stiffness_damping: 0.0,
            displacement: &[],
            velocity: &velocity,
        };
        let problem = TimeProblem { body: &body, inertia: Some(inertia), relaxation: &[] };
        let path = solve_in_time(&problem, &params(0.1, 50, 1.0), |_, _, _| ()).unwrap();
        let energy = path.steps.last().unwrap().energy;
        assert!(
            energy.damped > 0.2 * energy.start && energy.external.abs() > 0.05 * energy.start,
            "{energy:?}"
        );
        assert!(energy.lost().abs() < 1e-10 * energy.start, "{energy:?}");
    }
}

#[test]
fn a_scheme_with_dissipation_only_takes() {
    let block = block(CellKind::Hex8, [3, 2, 1]);
    let laws = [linear()];
    let mass = block.lumped(DENSITY);
    let velocity = stirred(&block);
    let body = block.body(&laws, &[]);
    let problem = moving(&body, &mass, &[], &velocity);
    let lost = |rho: f64| {
        let path = solve_in_time(&problem, &params(0.1, 50, rho), |_, _, _| ()).unwrap();
        path.steps.last().unwrap().energy.lost() / path.steps[0].energy.start
    };
    let lost = [lost(1.0), lost(0.8), lost(0.2)];
    assert!(lost[0].abs() < 1e-10 && lost[1] > 1e-3 && lost[2] > 2.0 * lost[1] && lost[2] < 1.0, "{lost:?}");
}

#[test]
fn a_neo_hookean_body_keeps_energy_within_bounds_and_momentum_exactly() {
    let block = block(CellKind::Hex8, [4, 3, 2]);
    let laws = [soft(0.3)];
    let body = block.body(&laws, &[]);
    let mass = block.consistent(DENSITY);
    let velocity: Vec<Vector3> = stirred(&block).iter().map(|v| v * 12.0).collect();
    let problem = moving(&body, &mass, &[], &velocity);
    let start = momentum(&mass, &velocity);
    let worst = |steps: usize| {
        let (mut worst, mut smallest) = (0.0f64, 1.0f64);
        let path = solve_in_time(&problem, &params(0.2, steps, 1.0), |done, motion, _| {
            let error = (momentum(&mass, &motion.v) - start).norm() / start.norm();
            assert!(error < 1e-11, "{}: {error:e}", done.step.time);
            worst = worst.max(done.energy.lost().abs() / done.energy.start);
            smallest = smallest.min(done.step.smallest);
        })
        .unwrap();
        assert_eq!((path.failure, path.cut_back), (None, 0));
        assert!(smallest < 0.95, "{smallest}: the body hardly deforms");
        worst
    };
    // The energy is not conserved, but the error is of second order and does not drift over a dozen periods.
    let (coarse, fine) = (worst(200), worst(400));
    assert!(coarse < 0.02 && fine < 0.35 * coarse, "{coarse:e} {fine:e}");
}

#[test]
fn the_same_bits_with_one_thread_and_two() {
    let block = block(CellKind::Tet10, [4, 3, 2]);
    let laws = [soft(0.45)];
    let fixed = block.constrained(|x, _| (x.x == 0.0).then_some(0.0));
    let mass = block.consistent(DENSITY);
    let velocity = stirred(&block);
    let groups = fem::element_dilation(&block.mesh, &fem::VolumeRule::STANDARD).unwrap();
    let mut body = block.body(&laws, &fixed);
    body.solid.dilation = SolidDilation::Groups(&groups);
    let relaxation = [Some(material::Prony::new(&[(0.4, 0.02)]).unwrap())];
    let problem = TimeProblem { relaxation: &relaxation, ..moving(&body, &mass, &[], &velocity) };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solve_in_time(&problem, &params(0.01, 5, 0.8), |_, _, _| ()).unwrap())
    };
    let (one, two) = (run(1), run(2));
    assert_eq!(one.motion, two.motion);
    assert_eq!(one.steps, two.steps);
    assert!(largest(&one.motion.u) > 1e-4);
}

/// A ball pressed into a block: the quasi-static problem, and the same problem with mass.
#[test]
fn a_slow_tool_with_inertia_presses_as_a_static_one() {
    let block = block(CellKind::Hex8, [4, 4, 3]);
    let laws = [soft(0.3)];
    let fixed = block.constrained(|x, _| (x.z == 0.0).then_some(0.0));
    let rule = SurfaceRule::STANDARD;
    let surface = fem::surface_rows(&block.mesh, &block.mesh.boundary(), &rule).unwrap();
    let contact = ContactSurface::new(&surface);
    let law = ContactLaw::coulomb(1e8, 0.2, 2e7).unwrap();
    let at = Point3::new(0.02, 0.015, 0.0305);
    let tool =
        Tool::new(ToolShape::Sphere(Sphere { radius: 0.01 }), at, Matrix3::identity(), -Vector3::z(), law)
            .unwrap();
    let tools = [DrivenTool { tool: &tool, drive: Drive::Closure(4e-3) }];
    let body = StaticProblem { contact: Some(&contact), tools: &tools, ..block.body(&laws, &fixed) };
    let newton = NewtonParams {
        tolerance: 1e-9,
        iterations: 25,
        chords: true,
        keeps: f64::INFINITY,
        loosest: Some(NewtonParams::LOOSEST),
    };
    let quasi =
        StaticParams { steps: 20, smallest: 1.0 / 64.0, newton, augmentations: 0, limit_within: None };
    let body = StaticProblem { curves: Curves::proportional(), ..body };
    let still = solve_static(&body, &quasi, |_, _| ()).unwrap();
    assert_eq!(still.failure, None);

    let mass = block.lumped(DENSITY);
    // The lowest period is about 20 ms, so the loading takes a hundred periods.
    let slow = StaticProblem { curves: Curves::all(Curve::smooth_growth(2.0)), ..body };
    let inertia =
        Inertia { mass: &mass, damping: 0.0, stiffness_damping: 0.0, displacement: &[], velocity: &[] };
    let problem = TimeProblem { body: &slow, inertia: Some(inertia), relaxation: &[] };
    let path = solve_in_time(&problem, &TimeParams { newton, ..params(2.0, 20, 0.5) }, |_, _, _| ()).unwrap();
    assert_eq!(path.failure, None);
    let force = |tools: &[contact::ToolState]| tools[0].force.z;
    let moving = path.steps.last().unwrap().clone();
    let resting = force(&still.steps.last().unwrap().tools);
    let found = force(&moving.step.tools);
    assert!((found / resting - 1.0).abs() < 2e-3, "{found} {resting}");
    let error = distance(&path.motion.u, &still.u) / largest(&still.u);
    assert!(error < 1e-2, "{error:e}");
    assert!(moving.energy.kinetic < 1e-5 * moving.energy.internal, "{:?}", moving.energy);
    // The tool's work equals the block's energy, except for friction and the error of the trapezoidal rule.
    let ratio = moving.energy.internal / moving.energy.external;
    assert!(ratio > 0.9 && ratio < 1.02, "{ratio}");
    // The supports carry the force of the tool (the force on the tool points up).
    let error = path.motion.reaction.iter().map(|r| r.z).sum::<f64>() / found - 1.0;
    assert!(error.abs() < 1e-2, "{error:e}");
}

/// A base that moves smoothly and stops: the body ends in its static state, and the work of the supports
/// equals the kinetic and strain energy.
#[test]
fn a_moved_base_carries_the_body() {
    let block = block(CellKind::Hex8, [3, 2, 2]);
    let laws = [linear()];
    let fixed = block.constrained(|x, axis| (x.z == 0.0).then_some([5e-3, 0.0, 0.0][axis]));
    let body = block.body(&laws, &fixed);
    let mass = block.consistent(DENSITY);
    let curve = Curve::smooth_growth(0.05);
    let body = StaticProblem { curves: Curves::all(curve.clone()), ..body };
    let inertia =
        Inertia { mass: &mass, damping: 0.0, stiffness_damping: 0.0, displacement: &[], velocity: &[] };
    let problem = TimeProblem { body: &body, inertia: Some(inertia), relaxation: &[] };
    let lost = |steps: usize| {
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        solve_in_time(&problem, &params(0.06, steps, 1.0), |done, motion, _| {
            largest = largest.max(done.energy.kinetic);
            worst = worst.max(done.energy.lost().abs());
            let base = curve.value(done.step.time) * 5e-3;
            assert!((motion.u[fixed[0].node as usize].x - base).abs() < 1e-18);
        })
        .unwrap();
        worst / largest
    };
    let (coarse, fine) = (lost(60), lost(120));
    assert!(fine < 1e-3 && fine < 0.3 * coarse, "{coarse:e} {fine:e}");

    // With a slow ramp and damping, the whole body moves with the base.
    let inertia = Inertia { damping: 200.0, ..inertia };
    let slow = StaticProblem { curves: Curves::all(Curve::growth(0.5)), ..body.clone() };
    let problem = TimeProblem { body: &slow, inertia: Some(inertia), ..problem };
    let path = solve_in_time(&problem, &params(2.0, 400, 0.5), |_, _, _| ()).unwrap();
    assert_eq!(path.failure, None);
    let exact = vec![Vector3::new(5e-3, 0.0, 0.0); block.nodes().len()];
    let error = distance(&path.motion.u, &exact) / 5e-3;
    assert!(error < 1e-6, "{error:e}");
}

/// A surface constrained by a penalty moves like a surface constrained node by node.
#[test]
fn a_surface_held_by_penalty_is_driven_too() {
    let block = block(CellKind::Hex8, [3, 2, 2]);
    let laws = [linear()];
    let bottom = block.mesh.group("z-min").unwrap();
    let surface = fem::surface_rows(&block.mesh, bottom, &SurfaceRule::STANDARD).unwrap();
    let constrained = [PenaltySurface {
        surface: &surface,
        axes: [true; 3],
        along_normal: false,
        damping: 0.0,
        values: vec![Vector3::new(5e-3, 0.0, 0.0); surface.weights().len()],
        from: Vec::new(),
        beta: 1e10,
    }];
    let body = StaticProblem { penalties: &constrained, ..block.body(&laws, &[]) };
    let fixed = block.constrained(|x, axis| (x.z == 0.0).then_some([5e-3, 0.0, 0.0][axis]));
    let exact = block.body(&laws, &fixed);
    let mass = block.lumped(DENSITY);
    let run = |body: &StaticProblem| {
        let body = &StaticProblem { curves: Curves::all(Curve::smooth_growth(0.05)), ..body.clone() };
        let inertia = Some(Inertia {
            mass: &mass,
            damping: 0.0,
            stiffness_damping: 0.0,
            displacement: &[],
            velocity: &[],
        });
        let problem = TimeProblem { body, inertia, relaxation: &[] };
        solve_in_time(&problem, &params(0.05, 50, 0.5), |_, _, _| ()).unwrap().motion
    };
    let error = distance(&run(&body).u, &run(&exact).u) / 5e-3;
    assert!(error < 1e-4, "{error:e}");
}

#[test]
fn steps_follow_the_accuracy_asked_for() {
    let block = block(CellKind::Hex8, [3, 1, 1]);
    let laws = [linear()];
    let fixed = block.constrained(|x, _| (x.x == 0.0).then_some(0.0));
    let pull = vec![Vector3::new(2e4, 0.0, 0.0); block.volume.weights().len()];
    let loads = [Load::Body { values: pull }];
    let body = StaticProblem { loads: &loads, ..block.body(&laws, &fixed) };
    let mass = block.consistent(DENSITY);
    let problem = moving(&body, &mass, &[], &[]);
    let run = |accuracy: Option<f64>, steps: usize| {
        let path =
            solve_in_time(&problem, &TimeParams { accuracy, ..params(0.02, steps, 0.9) }, |_, _, _| ())
                .unwrap();
        assert_eq!(path.failure, None);
        assert!((path.time() - 0.02).abs() < 1e-15);
        assert_eq!(path.steps.iter().filter(|s| s.step.wanted).count(), steps);
        path
    };
    let exact = run(None, 2000).motion.u;
    let coarse = run(None, 4);
    let (loose, tight) = (run(Some(1e-5), 4), run(Some(1e-6), 4));
    let error = |u: &[Vector3]| distance(u, &exact) / largest(&exact);
    let errors = [error(&coarse.motion.u), error(&loose.motion.u), error(&tight.motion.u)];
    assert!(tight.steps.iter().all(|s| s.error <= 1e-6) && tight.cut_back > 0);
    assert!(tight.steps.len() > loose.steps.len() && loose.steps.len() > 8);
    assert!(errors[2] < 0.5 * errors[1] && errors[1] < 0.5 * errors[0] && errors[2] < 0.02, "{errors:?}");
}

#[test]
fn what_ends_early_is_named() {
    let block = block(CellKind::Hex8, [3, 1, 1]);
    let laws = [soft(0.3)];
    let fixed = block.constrained(|x, _| (x.x == 0.0).then_some(0.0));
    let push = vec![Vector3::new(-3e7, 0.0, 0.0); block.volume.weights().len()];
    let loads = [Load::Body { values: push }];
    let body = StaticProblem { loads: &loads, ..block.body(&laws, &fixed) };
    let mass = block.consistent(DENSITY);
    let problem = moving(&body, &mass, &[], &[]);
    let newton = NewtonParams {
        tolerance: 1e-11,
        iterations: 2,
        chords: true,
        keeps: f64::INFINITY,
        loosest: Some(NewtonParams::LOOSEST),
    };
    let path =
        solve_in_time(&problem, &TimeParams { newton, smallest: 0.5, ..params(0.1, 5, 1.0) }, |_, _, _| ())
            .unwrap();
    let failure = path.failure.unwrap();
    assert!(
        matches!(&failure, TimeError::Stalled { time, cause, .. }
        if *time < 0.1 && matches!(**cause, TimeError::Static(_))),
        "{failure}"
    );
    let path =
        solve_in_time(&problem, &TimeParams { accuracy: Some(1e-12), ..params(0.1, 5, 1.0) }, |_, _, _| ());
    let failure = path.unwrap().failure.unwrap();
    assert!(
        matches!(&failure, TimeError::Stalled { cause, .. }
        if matches!(**cause, TimeError::Inaccurate { allowed: 1e-12, .. })),
        "{failure}"
    );
}

#[test]
fn unusable_problems_are_refused() {
    let block = block(CellKind::Tet10, [1, 1, 1]);
    let laws = [linear()];
    let body = block.body(&laws, &[]);
    let mass = block.consistent(DENSITY);
    let problem = moving(&body, &mass, &[], &[]);
    let good = params(1.0, 1, 0.5);
    let refused = |params: TimeParams| solve_in_time(&problem, &params, |_, _, _| ()).unwrap_err();
    for (what, params) in [
        ("the end time", TimeParams { end: 0.0, ..good }),
        ("rho_inf", TimeParams { rho_inf: 1.1, ..good }),
        ("rho_inf", TimeParams { rho_inf: f64::NAN, ..good }),
        ("the smallest step fraction", TimeParams { smallest: 0.0, ..good }),
        ("the accuracy", TimeParams { accuracy: Some(0.0), ..good }),
    ] {
        assert!(matches!(refused(params), TimeError::Parameter { what: found, .. } if found == what));
    }
    let short = vec![Vector3::zeros(); 3];
    let bad = moving(&body, &mass, &[], &short);
    assert!(matches!(solve_in_time(&bad, &good, |_, _, _| ()).unwrap_err(), TimeError::Static(_)));
    let fixed = [FixedDof { node: 0, axis: 0, value: 1e-3 }];
    let jump = block.body(&laws, &fixed);
    let bad = moving(&jump, &mass, &[], &[]);
    assert!(matches!(
        solve_in_time(&bad, &good, |_, _, _| ()).unwrap_err(),
        TimeError::Parameter { what: "the displacement of a support at the start", .. }
    ));
    // Row sums of a tet10 are negative at its corners; four points give a singular mass matrix.
    assert!(matches!(
        Mass::lumped(&[1.0, -1.0]).unwrap_err(),
        TimeError::NodalMass { node: 1, mass } if mass == -1.0
    ));
    assert!(matches!(
        Mass::consistent(&block.volume, &[], &[]).unwrap_err(),
        TimeError::Parameter { what: "a density", .. }
    ));
    let few = Mass::consistent(&block.volume, &[DENSITY], &[]).unwrap();
    let stretched = block.field(|x| Vector3::new(0.01 * x.x * x.x, 0.0, 0.0));
    let bad = moving(&body, &few, &stretched, &[]);
    let found = solve_in_time(&bad, &good, |_, _, _| ()).unwrap_err();
    assert!(matches!(found, TimeError::SingularMass { .. }), "{found}");
}
