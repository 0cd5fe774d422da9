//! The pointwise law: friction of a single point, consistent tangents, rigid motions, refused parameters.

use contact::{
    Capsule, ContactCounts, ContactError, ContactHistory, ContactLaw, ContactSurface, Cylinder, Plate,
    RoundedBox, Slip, Sphere, Tool, ToolShape,
};
use geometry::CellKind;
use integration::block::Block;
use integration::tools::{SHAPES, differences, kink, rotation, vector};
use proptest::prelude::*;
use shape::{Matrix3, Point3, Vector3};

const PENALTY: f64 = 5e8;
const FRICTION: f64 = 0.15;
const STICK: f64 = 1e8;

fn coulomb() -> ContactLaw {
    ContactLaw::coulomb(PENALTY, FRICTION, STICK).unwrap()
}

fn tool(shape: ToolShape, law: ContactLaw) -> Tool {
    Tool::new(shape, Point3::origin(), Matrix3::identity(), Vector3::x(), law).unwrap()
}

/// A point 0.1 mm deep in a plate, dragged along x and back: slope during stick, slip at mu p, dissipation.
#[test]
fn friction_block_of_one_point() {
    let plate = tool(ToolShape::Plate(Plate), coulomb());
    let depth = 1e-4;
    let p = PENALTY * depth;
    let limit = FRICTION * p;
    let give = limit / STICK; // elastic slip at the limit, 75 um
    let at = |x: f64| Point3::new(x, 0.0, -depth);
    let mut history = plate.contact(0.0, &at(0.0), &Slip::NONE, 0.0).slip;
    let mut dissipated = 0.0;
    // To 4 times the elastic slip in 40 steps, to -4 times in 80, and to 0 in 40.
    let path: Vec<f64> = (1..=160)
        .map(|k| {
            f64::from(if k <= 40 {
                k
            } else if k <= 120 {
                80 - k
            } else {
                k - 160
            }) * 0.1
                * give
        })
        .collect();
    for (k, &x) in path.iter().enumerate() {
        let c = plate.contact(0.0, &at(x), &history, 0.0);
        let elastic = match k {
            0..40 => (x / give).min(1.0),
            40..120 => (1.0 - (4.0 * give - x) / give).max(-1.0),
            _ => (-1.0 + (x + 4.0 * give) / give).min(1.0),
        };
        assert!((c.traction.x + limit * elastic).abs() < 1e-9 * limit, "step {k}: {}", c.traction.x);
        assert!(c.traction.y == 0.0 && (c.traction.z - p).abs() < 1e-12 * p);
        assert!(c.traction.x.abs() <= limit * (1.0 + 1e-14));
        assert!(c.dissipated >= 0.0);
        assert!((c.slip.stretch() * STICK + c.traction - Vector3::z() * p).norm() < 1e-12 * p);
        dissipated += c.dissipated;
        history = c.slip;
    }
    // Slip, as multiples of the elastic slip: 3 outwards, 6 back, 2 in the last part.
    let exact = limit * give * (3.0 + 6.0 + 2.0);
    assert!((dissipated - exact).abs() < 1e-9 * exact, "{dissipated} {exact}");
}

/// The reference of stick moves with the tool.
#[test]
fn a_moving_tool_drags() {
    let plate = tool(ToolShape::Plate(Plate), coulomb());
    let x = Point3::new(1e-3, 2e-3, -1e-4);
    let history = plate.contact(0.0, &x, &Slip::NONE, 0.0).slip;
    let c = plate.contact(1e-5, &x, &history, 0.0);
    assert!((c.traction.x - STICK * 1e-5).abs() < 1e-9 * STICK * 1e-5, "{}", c.traction);
    // Tool and point move together, so nothing slips.
    let c = plate.contact(1e-5, &(x + Vector3::x() * 1e-5), &history, 0.0);
    assert!(c.traction.x.abs() < 1e-9 * STICK * 1e-5, "{}", c.traction);
}

#[test]
fn a_point_that_leaves_forgets() {
    let plate = tool(ToolShape::Plate(Plate), coulomb());
    let touch = |x: f64, z: f64, history: &Slip| plate.contact(0.0, &Point3::new(x, 0.0, z), history, 0.0);
    let stuck = touch(1e-5, -1e-4, &touch(0.0, -1e-4, &Slip::NONE).slip);
    assert!(stuck.slip.stretch().x > 0.9e-5);
    let left = touch(2e-5, 1e-6, &stuck.slip);
    assert_eq!((left.traction, left.stiffness, left.slip), (Vector3::zeros(), Matrix3::zeros(), Slip::NONE));
    assert_eq!((left.gap, left.pressure), (1e-6, 0.0));
    let back = touch(3e-5, -1e-4, &left.slip);
    assert_eq!(back.traction.x, 0.0);
    assert!(touch(4e-5, -1e-4, &back.slip).traction.x < -0.9e-5 * STICK);
}

#[test]
fn without_friction_nothing_is_remembered() {
    let sphere = tool(SHAPES[3].clone(), ContactLaw::frictionless(PENALTY).unwrap());
    let c = sphere.contact(0.0, &Point3::new(2e-3, 1e-3, 4.4e-3), &Slip::NONE, 0.0);
    assert!(c.pressure > 0.0);
    assert_eq!((c.slip, c.dissipated), (Slip::NONE, 0.0));
    assert!((c.stiffness - c.stiffness.transpose()).norm() < 1e-15 * c.stiffness.norm());
    assert!(c.traction.cross(&Vector3::new(2.0, 1.0, 4.4)).norm() < 1e-12 * c.traction.norm());
}

/// A multiplier shifts the pressure; the point stays in contact until the multiplier is used up.
#[test]
fn multipliers_add_to_the_pressure() {
    let plate = tool(ToolShape::Plate(Plate), ContactLaw::frictionless(PENALTY).unwrap());
    let pressure = |z| plate.contact(0.0, &Point3::new(0.0, 0.0, z), &Slip::NONE, 1e4).pressure;
    assert!((pressure(-1e-5) - 1.5e4).abs() < 1e-8);
    assert!((pressure(1e-5) - 5e3).abs() < 1e-8);
    assert_eq!(pressure(2.1e-5), 0.0);
}

/// A tool with the slip history of two committed contacts near its surface, and the point after a further
/// move.
struct Dragged {
    tool: Tool,
    history: Slip,
    x: Point3,
}

impl Dragged {
    /// Builds the case with a move by `drag` times the slip limit; `None` near a kink of the distance.
    fn new(shape: &ToolShape, turn: Matrix3, start: Vector3, depth: f64, drag: Vector3) -> Option<Dragged> {
        let at = Point3::new(1e-3, -2e-3, 3e-3);
        let along = turn * Vector3::new(2.0, -1.0, 2.0) / 3.0;
        let tool = Tool::new(shape.clone(), at, turn, along, coulomb()).unwrap();
        let foot = shape.distance(&start);
        let p = start - foot.gradient * (foot.value + depth);
        let give = FRICTION * PENALTY * depth / STICK;
        // The move is tangential, so the depth changes little, and slightly deeper.
        let n = shape.distance(&p).gradient;
        let tangent = |v: Vector3| v - n * n.dot(&v);
        let end = p + tangent(drag) * give - n * (0.05 * depth);
        if [p, end].iter().any(|p| kink(shape, p) < 5e-4) {
            return None;
        }
        let world = |p: Vector3| at + turn * p;
        let first = tool.contact(0.0, &world(p), &Slip::NONE, 0.0).slip;
        let pull = tangent(Vector3::new(drag.y, drag.z, drag.x)) * (0.3 * give);
        let history = tool.contact(0.0, &world(p + pull), &first, 0.0).slip;
        Some(Dragged { tool, history, x: world(end) })
    }

    /// Returns the tangential traction relative to the friction limit: 1 in slip.
    fn reach(&self) -> f64 {
        let c = self.tool.contact(0.0, &self.x, &self.history, 0.0);
        c.slip.stretch().norm() * STICK / (FRICTION * c.pressure)
    }

    fn check(&self, multiplier: f64) -> Result<(), TestCaseError> {
        let contact = |closure: f64, x: &Point3| self.tool.contact(closure, x, &self.history, multiplier);
        let c = contact(0.0, &self.x);
        // Steps of 1e-8 m are small against curvature radii of 5e-4 m and elastic slips of 1e-5 m: the
        // truncation error is 1e-6 relative.
        let h = 1e-8;
        // There is no derivative between stick and slip: differences across the limit are meaningless.
        let slips = |closure: f64, x: &Point3| {
            let c = contact(closure, x);
            c.slip.stretch().norm() * STICK > (1.0 - 1e-9) * FRICTION * c.pressure
        };
        let here = slips(0.0, &self.x);
        let around = |a: usize, sign: f64| slips(0.0, &(self.x + Vector3::ith(a, sign * h)));
        if (0..3).any(|a| around(a, 1.0) != here || around(a, -1.0) != here)
            || [h, -h].iter().any(|&closure| slips(closure, &self.x) != here)
        {
            return Ok(());
        }
        let slopes = differences(h, |step| contact(0.0, &(self.x + step)).traction);
        let miss = (slopes - c.stiffness).norm() / slopes.norm();
        prop_assert!(miss < 1e-5, "{:?} {miss:e} {slopes} {}", self.tool.shape(), c.stiffness);
        let driven = (contact(h, &self.x).traction - contact(-h, &self.x).traction) / (2.0 * h);
        let miss = (driven + c.stiffness * self.tool.along()).norm() / slopes.norm();
        prop_assert!(miss < 1e-5, "closure: {miss:e}");
        Ok(())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    #[test]
    fn tangents_are_consistent(
        turn in rotation(), start in vector(12e-3), drag in vector(1.0), multiplier in 0.0..2e4f64
    ) {
        prop_assume!(drag.norm() > 0.2);
        for shape in SHAPES.iter() {
            // 0.1 mm deep; the limit of elastic slip is 75 um.
            for far in [0.3, 4.0] {
                let Some(dragged) = Dragged::new(shape, turn, start, 1e-4, drag.normalize() * far) else { continue };
                let reach = dragged.reach();
                // A drag along the normal causes no traction, and a drag at the limit has no derivative.
                if (0.02..0.99).contains(&reach) || (far > 1.0 && reach > 1.0 - 1e-12) {
                    dragged.check(0.0)?;
                }
                // Away from the limit also with a multiplier (which raises mu p by up to 40 %).
                if (0.02..0.6).contains(&reach) {
                    dragged.check(multiplier)?;
                }
            }
        }
    }

    /// If tool, point and history are rotated and moved together, traction and tangent rotate with them.
    #[test]
    fn rigid_motions_change_nothing(turn in rotation(), q in rotation(), start in vector(12e-3), drag in vector(3.0)) {
        for shape in SHAPES.iter() {
            let Some(a) = Dragged::new(shape, turn, start, 1e-4, drag) else { continue };
            let b = Dragged::new(shape, q * turn, start, 1e-4, drag).unwrap();
            let (ca, cb) = (a.tool.contact(0.0, &a.x, &a.history, 0.0), b.tool.contact(0.0, &b.x, &b.history, 0.0));
            // Positions of 1e-2 m are rounded by 1e-18 m; times the penalty this is 1e-9 Pa, compared with
            // 5e4 Pa.
            prop_assert!((q * ca.traction - cb.traction).norm() < 1e-11 * ca.traction.norm());
            let turned = q * ca.stiffness * q.transpose();
            prop_assert!((turned - cb.stiffness).norm() < 1e-9 * turned.norm());
            prop_assert!((ca.gap - cb.gap).abs() < 1e-16);
        }
    }

    /// Slip never returns work, on any shape.
    #[test]
    fn friction_dissipates(turn in rotation(), start in vector(12e-3), drag in vector(3.0)) {
        for shape in SHAPES.iter() {
            if let Some(d) = Dragged::new(shape, turn, start, 1e-4, drag) {
                let c = d.tool.contact(0.0, &d.x, &d.history, 0.0);
                prop_assert!(c.dissipated >= 0.0);
                prop_assert!(c.slip.stretch().norm() * STICK <= FRICTION * c.pressure * (1.0 + 1e-14));
            }
        }
    }
}

/// The sampling above covers both branches of friction on every shape.
#[test]
fn the_tangent_test_meets_stick_and_slip() {
    for shape in SHAPES.iter() {
        let start = Vector3::new(1e-3, 0.5e-3, 1.2e-2);
        let drag = Vector3::new(1.0, 0.5, 0.0);
        let reach =
            |far| Dragged::new(shape, Matrix3::identity(), start, 1e-4, drag * far).map(|d| d.reach());
        assert!(matches!(reach(0.3), Some(0.05..0.95)), "{shape:?} {:?}", reach(0.3));
        assert!((reach(4.0).unwrap() - 1.0).abs() < 1e-12, "{shape:?}");
    }
}

#[test]
fn bad_tools_are_refused_with_their_numbers() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            ContactLaw::frictionless(bad),
            Err(ContactError::Modulus { what: "penalty", value }) if value.to_bits() == bad.to_bits()
        ));
        assert!(matches!(
            ContactLaw::coulomb(1.0, 0.1, bad),
            Err(ContactError::Modulus { what: "stick slope", .. })
        ));
        assert!(matches!(ContactLaw::coulomb(1.0, bad, 1.0), Err(ContactError::Friction { .. })));
    }
    let law = ContactLaw::frictionless(1.0).unwrap();
    let make = |shape, at: f64, turn, along| Tool::new(shape, Point3::new(at, 0.0, 0.0), turn, along, law);
    let id = Matrix3::identity();
    let shape = |shape| make(shape, 0.0, id, Vector3::x()).unwrap_err();
    for bad in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            shape(ToolShape::Sphere(Sphere { radius: bad })),
            ContactError::Size { what: "the radius", .. }
        ));
        for end in [
            ToolShape::Cylinder(Cylinder { radius: 1.0, half_length: bad }),
            ToolShape::Capsule(Capsule { radius: 1.0, half_length: bad }),
        ] {
            assert!(matches!(shape(end), ContactError::Size { what: "the half length", .. }));
        }
        assert!(matches!(
            shape(ToolShape::RoundedBox(RoundedBox { half: [1.0, bad, 1.0], radius: 0.0 })),
            ContactError::Size { what: "a half extent", .. }
        ));
    }
    let rounded = shape(ToolShape::RoundedBox(RoundedBox { half: [3e-3, 2e-3, 1e-3], radius: 1.5e-3 }));
    assert_eq!(rounded, ContactError::Rounding { radius: 1.5e-3, half: 1e-3 });
    assert_eq!(
        rounded.to_string(),
        "the rounding radius of the box is 0.0015 m; it must be between 0 and the smallest half extent, 0.001 m"
    );
    assert!(matches!(
        shape(ToolShape::RoundedBox(RoundedBox { half: [1.0; 3], radius: f64::NAN })),
        ContactError::Rounding { .. }
    ));
    let ball = || ToolShape::Sphere(Sphere { radius: 1.0 });
    assert!(matches!(make(ball(), f64::NAN, id, Vector3::x()), Err(ContactError::Place { .. })));
    assert!(matches!(make(ball(), 0.0, id * 2.0, Vector3::x()), Err(ContactError::Rotation { .. })));
    assert!(matches!(make(ball(), 0.0, -id, Vector3::x()), Err(ContactError::Rotation { .. })), "a mirror");
    assert!(matches!(
        make(ball(), 0.0, id, Vector3::x() * 2.0),
        Err(ContactError::Direction { length: 2.0 })
    ));
    assert!(matches!(make(ball(), 0.0, id, Vector3::zeros()), Err(ContactError::Direction { .. })));
}

#[test]
fn a_tool_can_be_turned_to_any_axis() {
    for axis in [Vector3::z(), -Vector3::z(), Vector3::x(), Vector3::new(2.0, -1.0, -2.0) / 3.0] {
        let turn = Tool::turned_to(&axis);
        assert!((turn * Vector3::z() - axis).norm() < 1e-15);
        assert!((turn.determinant() - 1.0).abs() < 1e-15);
    }
}

/// A block 0.1 mm below a plate rises by 0.2 mm and moves 40 um sideways. It touches half way, so friction
/// acts over half of the 40 um.
#[test]
fn friction_begins_at_the_touch() {
    let block = Block::new(CellKind::Hex8, [1, 1, 1]);
    let rows = block.surface(&["z-max"]);
    let surface = ContactSurface::new(&rows);
    let at = Point3::new(0.02, 0.015, 0.0201);
    let shape = ToolShape::Plate(Plate);
    let plate = Tool::new(shape, at, Tool::turned_to(&-Vector3::z()), -Vector3::z(), coulomb()).unwrap();
    let all = |u: Vector3| vec![u; block.mesh.points().len()];
    let mut history = ContactHistory::new(&plate, rows.points().len());
    history.commit_all(None, &surface, &plate, 0.0, &all(Vector3::zeros()));
    let found = |u: Vector3| {
        surface.evaluate(&plate, 0.0, &all(u), &history, &mut ContactCounts::default()).unwrap().unwrap()
    };
    let u = Vector3::new(4e-5, 0.0, 2e-4);
    let contacts = found(u);
    let expected = Vector3::new(-STICK * 2e-5, 0.0, -PENALTY * 1e-4);
    assert_eq!(contacts.points().len(), rows.points().len());
    for traction in contacts.tractions() {
        assert!((traction - expected).norm() < 1e-9 * expected.norm(), "{traction}");
    }
    // On a path that goes deeper, the touch comes earlier; the tangent includes this effect.
    let slopes = differences(1e-9, |step| found(u + step).tractions()[0]);
    let miss = (slopes - contacts.stiffness()[0]).norm() / slopes.norm();
    assert!(miss < 1e-5, "{miss:e} {slopes} {}", contacts.stiffness()[0]);
}
