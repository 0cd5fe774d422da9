//! Tools that turn: their frame, their friction, their search, and steps that take them through a surface.

use contact::{
    ContactCounts, ContactError, ContactHistory, ContactLaw, ContactSearch, ContactSurface, Motion, Plate,
    Pose, Slip, Sphere, Stand, Tool, ToolShape, Turn,
};
use geometry::CellKind;
use integration::block::{Block, SIDES};
use integration::tools::SHAPES;
use shape::{Matrix3, Point3, Vector3};

const ANGLE: f64 = 0.7;

fn law() -> ContactLaw {
    ContactLaw::coulomb(5e8, 0.15, 1e8).unwrap()
}

fn about() -> Turn {
    Turn { pin: Point3::new(0.01, -0.02, 0.005), axis: Vector3::new(1.0, 2.0, -2.0) / 3.0, arm: 0.04 }
}

/// A tool that first moves by 5 mm, and then turns about an axis that has moved with it.
fn turning(shape: &ToolShape) -> Tool {
    let rotation = Tool::turned_to(&Vector3::new(0.6, 0.0, 0.8));
    let at = Point3::new(0.02, 0.01, 0.03);
    let straight = Tool::new(shape.clone(), at, rotation, Vector3::x(), law()).unwrap();
    straight.then(5e-3, Motion::About(about())).unwrap()
}

fn world(pose: &Pose, p: &Vector3) -> Point3 {
    pose.place + pose.rotation * p
}

#[test]
fn the_pose_is_that_of_a_rigid_turn_about_the_pin() {
    let tool = turning(&SHAPES[1]);
    let turn = about();
    let rotation = nalgebra::Rotation3::new(turn.axis * ANGLE).into_inner();
    let pose = tool.pose(5e-3 + ANGLE * turn.arm);
    let pin = turn.pin + Vector3::x() * 5e-3;
    let moved = Point3::new(0.025, 0.01, 0.03);
    assert!((pose.place - (pin + rotation * (moved - pin))).norm() < 1e-15, "{}", pose.place);
    let start = Tool::turned_to(&Vector3::new(0.6, 0.0, 0.8));
    assert!((pose.rotation - rotation * start).norm() < 1e-14);
    // The same turn in the other direction brings it back.
    let back = Turn { axis: -turn.axis, ..turn };
    let there_and_back = tool.then(ANGLE * turn.arm, Motion::About(back)).unwrap();
    let end = there_and_back.pose(5e-3 + 2.0 * ANGLE * turn.arm);
    assert!((end.place - moved).norm() < 1e-15 && (end.rotation - start).norm() < 1e-14);
    assert_eq!(there_and_back.bends().count(), 2);
}

#[test]
fn tissue_that_turns_with_the_tool_sticks_and_tissue_at_rest_slips() {
    for shape in SHAPES.iter() {
        let tool = turning(shape);
        let (from, to) = (5e-3, 5e-3 + 1e-3 * about().arm);
        let (before, after) = (tool.pose(from), tool.pose(to));
        // A point that is 10 um deep below the top of the shape.
        let top = if shape.is_endless() { 0.0 } else { shape.bounds().1.z };
        let p = Vector3::new(1e-4, 2e-4, top - 1e-5);
        let touched = tool.contact(from, &world(&before, &p), &Slip::NONE, 0.0);
        assert!(touched.pressure > 0.0, "{shape:?}");
        let along = tool.contact(to, &world(&after, &p), &touched.slip, 0.0);
        let normal = after.rotation * before.rotation.transpose() * touched.traction;
        assert!((along.traction - normal).norm() < 1e-6 * normal.norm(), "{shape:?}: {}", along.traction);
        // At rest, the elastic slip is the motion of the tool's place there, against it.
        let x = world(&before, &p);
        let still = tool.contact(to, &x, &touched.slip, 0.0);
        let pin = about().pin + Vector3::x() * 5e-3;
        let motion = about().axis.cross(&(x - pin)) * 1e-3;
        let n = normal.normalize();
        let across = motion - n * n.dot(&motion);
        let slip = after.rotation * still.slip.stretch();
        // The stretch is limited by Coulomb's law: it has the direction.
        assert!(slip.normalize().dot(&-across.normalize()) > 0.99, "{shape:?}: {slip} {across}");
        assert!(still.traction.dot(&across) > 0.0, "{shape:?}: the tool drags the tissue along");
    }
}

#[test]
fn the_tangent_and_the_driving_force_are_derivatives() {
    let tool = turning(&ToolShape::Sphere(Sphere { radius: 5e-3 }));
    let closure = 5e-3 + ANGLE * about().arm;
    let pose = tool.pose(closure);
    let x = world(&pose, &Vector3::new(1e-3, -2e-3, 4.3e-3));
    let h = 1e-9;
    let at = |x: &Point3| tool.contact(closure, x, &Slip::NONE, 0.0).traction;
    let slope = tool.contact(closure, &x, &Slip::NONE, 0.0).stiffness;
    for axis in 0..3 {
        let step = Vector3::ith(axis, h);
        let difference = (at(&(x + step)) - at(&(x - step))) / (2.0 * h);
        assert!((difference - slope.column(axis)).norm() < 1e-5 * slope.norm());
    }
    // The energy of a penalty is k_n g^2 / 2 per area: its derivative by the travel is the driving force.
    let energy = |closure: f64| 0.5 * 5e8 * tool.gap(closure, &x).powi(2);
    let expected = (energy(closure + h) - energy(closure - h)) / (2.0 * h);
    let force = -at(&x);
    let found = tool.driving_force(closure, &force, &(x - pose.place).cross(&force));
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
}

#[test]
fn the_search_finds_the_contacts_of_each_state() {
    let block = Block::new(CellKind::Tet4, [5, 4, 2]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let u = vec![Vector3::zeros(); block.mesh.points().len()];
    // The plate's arm is a tenth of the distance of the farthest point of the block.
    let pin = Point3::new(0.0, 0.0, 0.0203);
    let turn = Turn { pin, axis: -Vector3::y(), arm: 4e-3 };
    let down = Tool::turned_to(&-Vector3::z());
    let start = nalgebra::Rotation3::new(-Vector3::y() * 0.06).into_inner();
    let plate =
        Tool::new(Plate.into(), pin, start * down, Motion::About(Turn { axis: Vector3::y(), ..turn }), law());
    let plate = plate.unwrap();
    let mut search = ContactSearch::new(&surface, 1);
    let history = ContactHistory::new(&plate, rows.points().len());
    let (mut touched, mut counts) = (0, [ContactCounts::default(); 2]);
    for k in 0..200 {
        let closure = 0.08 * turn.arm * f64::from(k) / 200.0;
        let found = search.at(&u).tractions(0, &plate, closure, &history, &mut counts[0]).unwrap();
        let expected = surface.tractions(&plate, closure, &u, &history, &mut counts[1]).unwrap();
        let points = |c: &Option<contact::Contacts>| c.as_ref().map_or(0, |c| c.points().len());
        assert_eq!(points(&found), points(&expected), "step {k}");
        touched += usize::from(points(&found) > 0);
    }
    assert!(touched > 20 && touched < 180, "{touched}");
}

#[test]
fn a_blade_that_sweeps_through_an_edge_in_one_step_is_found() {
    let block = Block::new(CellKind::Hex8, [16, 12, 8]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let u = vec![Vector3::zeros(); block.mesh.points().len()];
    // A ball on an arm of 30 mm about a pin above the block: it stands beside the block before and after.
    let pin = Point3::new(0.02, 0.015, 0.035);
    let ball = ToolShape::Sphere(Sphere { radius: 4e-3 });
    let swing = |arm: f64| {
        let turn = Turn { pin, axis: -Vector3::y(), arm: arm + 4e-3 };
        let at = pin - Vector3::x() * arm;
        Tool::new(ball.clone(), at, Matrix3::identity(), Motion::About(turn), law()).unwrap()
    };
    let half_a_turn = |tool: &Tool, arm: f64| {
        let end = std::f64::consts::PI * (arm + 4e-3);
        surface.check_passage(tool, Stand { closure: 0.0, u: &u }, Stand { closure: end, u: &u }, false)
    };
    // Its chord passes above the block, its arc 9 mm below the top.
    let through = half_a_turn(&swing(0.024), 0.024);
    assert!(matches!(through, Err(ContactError::JumpedOver { .. })), "{through:?}");
    assert_eq!(half_a_turn(&swing(0.008), 0.008), Ok(()));
}

#[test]
fn invalid_turns_are_refused() {
    let with = |turn: Turn| {
        Tool::new(Plate.into(), Point3::origin(), Matrix3::identity(), Motion::About(turn), law())
    };
    assert!(matches!(with(Turn { arm: 0.0, ..about() }), Err(ContactError::Size { .. })));
    assert!(matches!(with(Turn { arm: f64::NAN, ..about() }), Err(ContactError::Size { .. })));
    assert!(matches!(with(Turn { axis: Vector3::zeros(), ..about() }), Err(ContactError::Direction { .. })));
    let pin = Point3::new(f64::NAN, 0.0, 0.0);
    assert!(matches!(with(Turn { pin, ..about() }), Err(ContactError::Place { .. })));
}
