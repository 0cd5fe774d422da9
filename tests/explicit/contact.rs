//! Tools in explicit dynamics: momentum, energy, transferred forces, changing steps, and errors.

use contact::{ContactError, ContactLaw, ContactSurface, Drive, RoundedBox, Sphere, Tool, ToolShape};
use explicit::{
    Dynamics, DynamicsParams, ExplicitBody, ExplicitError, InternalForce, LanczosParams, Lumping, MovingTool,
    Prescribed, Springs, Tools, critical_step, critical_step_touching, lumped_mass,
};
use geometry::CellKind;
use integration::block::{Block, SIDES};
use lanes::LanePath;
use material::{Law, NeoHookean};
use shape::SurfaceRows;
use shape::{Matrix3, Point3, Vector3};

const RHO: f64 = 1060.0;
const LANCZOS: LanczosParams = LanczosParams { steps: 15, safety: 0.95 };

/// A block of 40 x 30 x 20 mm with all inputs of explicit dynamics.
struct Pressed {
    block: Block,
    surface: SurfaceRows,
    mass: Vec<f64>,
    laws: [Law; 1],
}

impl Pressed {
    fn new() -> Pressed {
        let block = Block::new(CellKind::Tet4, [6, 4, 3]);
        let surface = block.surface(&SIDES);
        let mass = lumped_mass(&block.volume, &[RHO], &[], Lumping::RowSum).unwrap();
        Pressed { block, surface, mass, laws: [Law::NeoHookean(NeoHookean::new(20e3, 0.4).unwrap())] }
    }

    fn force(&self) -> InternalForce<'_> {
        let body = ExplicitBody {
            volume: &self.block.volume,
            laws: &self.laws,
            region: &[],
            axes: &[],
            groups: None,
        };
        InternalForce::new(body, LanePath::best()).unwrap()
    }

    fn zero(&self) -> Vec<Vector3> {
        vec![Vector3::zeros(); self.mass.len()]
    }

    /// Returns a fraction of the critical step, with the penalty on the whole surface.
    fn step(&self, part: f64) -> f64 {
        let springs = Springs { surface: &self.surface, modulus: 1e8, damping: 0.0 };
        let mut force = self.force();
        let zero = self.zero();
        part * critical_step_touching(&mut force, &self.mass, &zero, |_| true, &[springs], LANCZOS)
            .unwrap()
            .dt
    }

    fn constrained<'a>(&self, hold: &'a (dyn Fn(f64) -> f64 + Sync)) -> Vec<Prescribed<'a>> {
        let nodes = self.block.nodes_of(&["z-min"]);
        nodes
            .iter()
            .flat_map(|&node| (0..3).map(move |axis| Prescribed { node, axis, motion: hold }))
            .collect()
    }
}

/// A jaw 5 mm above the middle of the block's top that moves along `along`.
fn jaw(along: Vector3, friction: f64) -> Tool {
    let law = if friction > 0.0 {
        ContactLaw::coulomb(1e8, friction, 2e7).unwrap()
    } else {
        ContactLaw::frictionless(1e8).unwrap()
    };
    let shape = ToolShape::RoundedBox(RoundedBox { half: [6e-3, 8e-3, 4e-3], radius: 2e-3 });
    Tool::new(shape, Point3::new(0.02, 0.015, 0.029), Matrix3::identity(), along.normalize(), law).unwrap()
}

fn params(dt: f64, damping: f64) -> DynamicsParams {
    DynamicsParams { dt, damping, critical: LANCZOS, recheck: 0, known: None }
}

fn no_load(_: f64, _: &[Vector3], _: &[Vector3], _: &mut [Vector3]) {}

#[test]
fn the_body_gains_the_momentum_that_the_tool_gives() {
    let pressed = Pressed::new();
    let surface = ContactSurface::new(&pressed.surface);
    let tool = jaw(Vector3::new(0.5, 0.2, -1.0), 0.3);
    let mut force = pressed.force();
    let dt = pressed.step(0.8);
    let drive = Drive::Closure(12e-3);
    let moving = MovingTool { tool: &tool, drive, over: 300.0 * dt, curve: None, mass: 0.0, damping: 0.0 };
    let tools = Tools::new(&surface, &[moving], &pressed.zero()).unwrap();
    let mut motion =
        Dynamics::new(&mut force, &pressed.mass, &[], params(dt, 0.0), pressed.zero(), pressed.zero())
            .unwrap()
            .with_tools(tools)
            .unwrap();
    let (mut impulse, mut largest) = (Vector3::zeros(), 0.0f64);
    for step in 0..300 {
        motion.run(1, 0, &mut no_load, &mut |_, _| ()).unwrap();
        let on_tool = motion.tools().unwrap().motions().next().unwrap().state.force;
        impulse -= on_tool * if step == 0 { 0.5 * dt } else { dt };
        let momentum: Vector3 = motion.velocities().iter().zip(&pressed.mass).map(|(v, m)| v * *m).sum();
        largest = largest.max(impulse.norm());
        assert!((momentum - impulse).norm() <= 1e-12 * largest, "step {step}: {momentum} {impulse}");
    }
    // The impulse points down because of pressure, and sideways because of friction.
    assert!(impulse.z < -1e-3 && impulse.x > 1e-5 && impulse.y > 1e-6, "{impulse}");
    assert!(motion.tools().unwrap().energies().friction > 0.0);
}

#[test]
fn energy_balances_with_tools_that_slide_and_swing() {
    let pressed = Pressed::new();
    let surface = ContactSurface::new(&pressed.surface);
    let hold = |_: f64| 0.0;
    let constrained = pressed.constrained(&hold);
    let body: f64 = pressed.mass.iter().sum();
    let dt = pressed.step(0.6);
    let aslant = Vector3::new(0.8, 0.1, -1.0);
    for (what, friction, drive, damping) in [
        ("led", 0.0, Drive::Closure(9e-3), 0.0),
        ("led with friction", 0.2, Drive::Closure(9e-3), 20.0),
        ("force", 0.0, Drive::Force(0.6), 0.0),
        ("force with friction", 0.2, Drive::Force(0.6), 20.0),
    ] {
        let along = if friction > 0.0 { aslant } else { -Vector3::z() };
        let tool = jaw(along, friction);
        let moving =
            MovingTool { tool: &tool, drive, over: 1500.0 * dt, curve: None, mass: 0.1 * body, damping };
        let tools = Tools::new(&surface, &[moving], &pressed.zero()).unwrap();
        let mut force = pressed.force();
        let start = (pressed.zero(), pressed.zero());
        let mut motion =
            Dynamics::new(&mut force, &pressed.mass, &constrained, params(dt, damping), start.0, start.1)
                .unwrap()
                .with_tools(tools)
                .unwrap();
        let mut all = Vec::new();
        motion.run(2001, 50, &mut no_load, &mut |b, _| all.push(*b)).unwrap();
        let last = all.last().unwrap();
        let worst = all[5..].iter().map(|b| b.drift.abs()).fold(0.0, f64::max);
        // Observed: 4e-6 without friction, 9e-4 with friction; a tenth of the friction would be 3e-3.
        let bound = if friction > 0.0 { 1.5e-3 } else { 1e-5 };
        assert!(worst < bound, "{what}: {worst:e} {last:?}");
        let t = last.tools;
        assert!(t.work > 1e-5 && t.stored > 1e-3 * t.work && last.external == 0.0, "{what}: {t:?}");
        assert_eq!(t.friction > 1e-2 * t.work, friction > 0.0, "{what}: {t:?}");
        assert_eq!(all.iter().any(|b| b.tools.kinetic > 0.0), matches!(drive, Drive::Force(_)), "{what}");
    }
}

#[test]
fn a_force_comes_to_rest_where_the_tissue_carries_it() {
    let pressed = Pressed::new();
    let surface = ContactSurface::new(&pressed.surface);
    let tool = jaw(-Vector3::z(), 0.0);
    let hold = |_: f64| 0.0;
    let constrained = pressed.constrained(&hold);
    let body: f64 = pressed.mass.iter().sum();
    let dt = pressed.step(0.9);
    let mut ends = Vec::new();
    for mass in [0.1 * body, 0.3 * body] {
        let drive = Drive::Force(0.5);
        let damping = 200.0;
        let moving = MovingTool { tool: &tool, drive, over: 0.05, curve: None, mass, damping };
        let tools = Tools::new(&surface, &[moving], &pressed.zero()).unwrap();
        let mut force = pressed.force();
        let start = (pressed.zero(), pressed.zero());
        let mut motion =
            Dynamics::new(&mut force, &pressed.mass, &constrained, params(dt, damping), start.0, start.1)
                .unwrap()
                .with_tools(tools)
                .unwrap();
        // The tool starts at first touch, after 5 mm.
        let at = motion.tools().unwrap().motions().next().unwrap().state.closure;
        assert!((at - 5e-3).abs() < 2e-9, "{at}");
        motion.run((0.3 / dt) as usize, 0, &mut no_load, &mut |_, _| ()).unwrap();
        let end = motion.tools().unwrap().motions().next().unwrap().state;
        assert!((end.force.z / 0.5 - 1.0).abs() < 1e-3, "{}", end.force.z);
        ends.push(end.closure);
    }
    // The rest position does not depend on the mass.
    assert!(ends[0] > 5.5e-3 && (ends[0] / ends[1] - 1.0).abs() < 1e-3, "{ends:?}");
}

/// Half of the travel with one step and half with another gives the same motion as a small step.
#[test]
fn a_step_may_change_on_the_way() {
    let pressed = Pressed::new();
    let surface = ContactSurface::new(&pressed.surface);
    let tool = jaw(-Vector3::z(), 0.0);
    let hold = |_: f64| 0.0;
    let constrained = pressed.constrained(&hold);
    let body: f64 = pressed.mass.iter().sum();
    let dt = pressed.step(0.8);
    let run = |plan: &[(f64, usize)]| {
        let drive = Drive::Force(0.5);
        let moving =
            MovingTool { tool: &tool, drive, over: 400.0 * dt, curve: None, mass: 0.1 * body, damping: 30.0 };
        let tools = Tools::new(&surface, &[moving], &pressed.zero()).unwrap();
        let mut force = pressed.force();
        let start = (pressed.zero(), pressed.zero());
        let mut motion =
            Dynamics::new(&mut force, &pressed.mass, &constrained, params(dt, 30.0), start.0, start.1)
                .unwrap()
                .with_tools(tools)
                .unwrap();
        let mut drift = 0.0f64;
        for &(dt, steps) in plan {
            motion.set_step(dt).unwrap();
            motion
                .run(steps, 25, &mut no_load, &mut |b, _| {
                    if b.step > 100 {
                        drift = drift.max(b.drift.abs());
                    }
                })
                .unwrap();
        }
        assert!(drift < 2e-4, "{drift:e}");
        assert!((motion.time() / (600.0 * dt) - 1.0).abs() < 1e-12);
        motion.displacements().to_vec()
    };
    let fine = run(&[(dt / 8.0, 4800)]);
    let size = fine.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let error = |u: &[Vector3]| u.iter().zip(&fine).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / size;
    let constant = error(&run(&[(dt, 600)]));
    let changed = error(&run(&[(dt, 200), (dt / 4.0, 800), (dt, 200)]));
    assert!(changed < 2.0 * constant && constant < 2e-2, "{changed:e} {constant:e}");
}

#[test]
fn bits_do_not_depend_on_threads_and_far_tools_cost_nothing() {
    let pressed = Pressed::new();
    let surface = ContactSurface::new(&pressed.surface);
    let dt = pressed.step(0.8);
    let near = jaw(Vector3::new(0.3, 0.0, -1.0), 0.2);
    let shape = ToolShape::Sphere(Sphere { radius: 5e-3 });
    let law = ContactLaw::frictionless(1e8).unwrap();
    let far = Tool::new(shape, Point3::new(0.2, 0.0, 0.0), Matrix3::identity(), Vector3::x(), law).unwrap();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let each = [&near, &far].map(|tool| MovingTool {
                tool,
                drive: Drive::Closure(8e-3),
                over: 100.0 * dt,
                curve: None,
                mass: 0.0,
                damping: 0.0,
            });
            let tools = Tools::new(&surface, &each, &pressed.zero()).unwrap();
            let mut force = pressed.force();
            let start = (pressed.zero(), pressed.zero());
            let mut motion = Dynamics::new(&mut force, &pressed.mass, &[], params(dt, 0.0), start.0, start.1)
                .unwrap()
                .with_tools(tools)
                .unwrap();
            motion.run(100, 0, &mut no_load, &mut |_, _| ()).unwrap();
            let counts = motion.tools().unwrap().counts();
            assert_eq!(counts.evaluations, 200);
            assert!(counts.skipped >= 100 && counts.active > 0, "{counts:?}");
            motion.displacements().to_vec()
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn what_cannot_go_on_is_named() {
    let pressed = Pressed::new();
    let surface = ContactSurface::new(&pressed.surface);
    let tool = jaw(-Vector3::z(), 0.0);
    let mut force = pressed.force();
    let dt = pressed.step(0.9);
    let moving = MovingTool {
        tool: &tool,
        drive: Drive::Force(1.0),
        over: 0.0,
        curve: None,
        mass: 1e-6,
        damping: 0.0,
    };
    let mut ends = |moving: MovingTool, dt: f64| {
        let tools = Tools::new(&surface, &[moving], &pressed.zero())?;
        Dynamics::new(&mut force, &pressed.mass, &[], params(dt, 0.0), pressed.zero(), pressed.zero())?
            .with_tools(tools)?
            .run(500, 0, &mut no_load, &mut |_, _| ())
    };
    let error = ends(moving, dt).unwrap_err();
    assert!(
        matches!(error, ExplicitError::LightTool { tool: 0, critical, .. } if critical < 2.0 * dt),
        "{error}"
    );
    // The tool's own critical step must be at least twice the step; here it is 1.5 times the step.
    let ExplicitError::LightTool { critical, .. } = error else { panic!("{error}") };
    let mass = moving.mass * (1.5 * dt / critical).powi(2);
    let error = ends(MovingTool { mass, ..moving }, dt).unwrap_err();
    assert!(
        matches!(error, ExplicitError::LightTool { critical, .. } if critical > dt && critical < 2.0 * dt),
        "{error}"
    );
    let error = ends(MovingTool { mass: 0.0, ..moving }, dt).unwrap_err();
    assert!(matches!(error, ExplicitError::BadParameter { what: "mass of a tool driven by force", .. }));
    let error = ends(MovingTool { over: f64::NAN, ..moving }, dt).unwrap_err();
    assert!(matches!(error, ExplicitError::BadParameter { what: "ramp of a tool", .. }));
    // A step that is stable for the body alone, but not with the penalty on its surface.
    let zero = pressed.zero();
    let mut alone = pressed.force();
    let free = critical_step(&mut alone, &pressed.mass, &zero, |_| true, LANCZOS).unwrap().dt;
    assert!(free > 1.05 * dt / 0.9);
    let error = ends(MovingTool { mass: 1e-2, ..moving }, 0.99 * free).unwrap_err();
    assert!(matches!(error, ExplicitError::StepTooLarge { step: 0, .. }), "{error}");
    // The tool reaches deep into the block at once.
    let led = MovingTool { drive: Drive::Closure(15e-3), over: 2.0 * dt, ..moving };
    let error = ends(led, dt).unwrap_err();
    assert!(
        matches!(error, ExplicitError::ContactAt { step: 1, cause: ContactError::PassedThrough { .. }, .. }),
        "{error}"
    );
}
