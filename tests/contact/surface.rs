//! Contact over a surface: point-by-point evaluation, balance of force and moment, skips, threads,
//! multipliers.

use contact::{
    ContactCounts, ContactError, ContactHistory, ContactLaw, ContactSurface, Contacts, Plate, PointContact,
    Slip, Sphere, Tool, ToolShape,
};
use geometry::CellKind;
use integration::block::{Block, SIDES};
use integration::tools::{SHAPES, rotation, vector};
use proptest::prelude::*;
use shape::{Matrix3, Point3, Vector3};
use shape::{PointRows, Rows, SurfaceRows};

fn coulomb() -> ContactLaw {
    ContactLaw::coulomb(5e8, 0.15, 1e8).unwrap()
}

/// Returns an oscillating displacement of amplitude `size`, m.
fn wave(block: &Block, size: f64) -> Vec<Vector3> {
    let wave =
        |p: &Point3| Vector3::new((300.0 * p.y).sin(), (200.0 * p.z).cos(), (250.0 * p.x).sin()) * size;
    block.mesh.points().iter().map(wave).collect()
}

/// A tool of any shape at the block's top (z = 20 mm), with its face 0.5 mm inside, moving along x.
fn on_top(shape: &ToolShape, turn: Matrix3) -> Tool {
    let lift = shape.bounds().1.z;
    Tool::new(shape.clone(), Point3::new(0.02, 0.015, 0.0195 + lift), turn, Vector3::x(), coulomb()).unwrap()
}

/// Evaluates every point by [`Tool::contact`], without a broad phase.
fn one_by_one(
    tool: &Tool,
    closure: f64,
    rows: &SurfaceRows,
    u: &[Vector3],
    history: &ContactHistory,
) -> Vec<PointContact> {
    (0..rows.points().len())
        .map(|q| {
            let mut x = rows.points()[q];
            let (nodes, values) = rows.rows().row(q);
            nodes.iter().zip(values).for_each(|(&node, value)| x += u[node as usize] * *value);
            tool.contact(closure, &x, &history.slip(q), history.multiplier(q))
        })
        .collect()
}

fn agree(found: Option<&Contacts>, all: &[PointContact]) {
    let touching: Vec<u32> = (0..all.len() as u32).filter(|&q| all[q as usize].pressure > 0.0).collect();
    let Some(found) = found else {
        return assert!(touching.is_empty(), "skipped with {} points", touching.len());
    };
    assert_eq!(found.points(), touching);
    for (k, &q) in touching.iter().enumerate() {
        let c = &all[q as usize];
        assert_eq!((found.tractions()[k], found.stiffness()[k]), (c.traction, c.stiffness));
        assert_eq!((found.slip()[k], found.pressures()[k]), (c.slip, c.pressure));
    }
    let deepest = all.iter().fold(0.0f64, |m, c| m.max(-c.gap));
    assert_eq!(found.max_penetration(), deepest);
}

#[test]
fn the_same_as_point_by_point_and_in_balance() {
    for kind in [CellKind::Tet4, CellKind::Tet10, CellKind::Hex8] {
        let block = Block::new(kind, [16, 12, 3]);
        let rows = block.surface(&SIDES);
        let surface = ContactSurface::new(&rows);
        let u = wave(&block, 1e-4);
        for shape in SHAPES.iter() {
            // The plate faces down; the z axes of the others point up.
            let turn = if *shape == ToolShape::Plate(Plate) {
                Tool::turned_to(&-Vector3::z())
            } else {
                Matrix3::identity()
            };
            let tool = on_top(shape, turn);
            let mut history = ContactHistory::new(&tool, rows.points().len());
            let mut counts = ContactCounts::default();
            let first = surface.evaluate(&tool, 0.0, &u, &history, &mut counts).unwrap();
            agree(first.as_ref(), &one_by_one(&tool, 0.0, &rows, &u, &history));
            history.commit(first.as_ref());
            // A second step with history, after the tool has moved sideways.
            let found = surface.evaluate(&tool, 2e-5, &u, &history, &mut counts).unwrap();
            let all = one_by_one(&tool, 2e-5, &rows, &u, &history);
            agree(found.as_ref(), &all);
            let found = found.unwrap();
            let within = surface.within(&tool, 2e-5, &u);
            assert!(within.iter().all(|(x, gap)| *gap < 0.0 && tool.gap(2e-5, x) == *gap));
            assert_eq!(within.len(), all.iter().filter(|c| c.gap < 0.0).count());
            assert_eq!(within.iter().fold(0.0f64, |m, (_, gap)| m.max(-gap)), found.max_penetration());
            assert!(found.points().len() > 3 && counts.active >= found.points().len() as u64, "{shape:?}");
            assert!(found.force().x.abs() > 1e-6, "{shape:?} does not drag");
            let forces: Vec<f64> = found
                .points()
                .iter()
                .map(|&q| rows.weights()[q as usize] * all[q as usize].pressure)
                .collect();
            let sum = forces.iter().sum::<f64>();
            let most = forces.iter().copied().fold(0.0, f64::max);
            let squares: f64 = forces.iter().map(|f| f * f).sum();
            assert!((found.carriers() * squares / (sum * sum) - 1.0).abs() < 1e-12);
            assert!(found.carriers() <= forces.len() as f64 && found.carriers() >= sum / most - 1e-9);

            let light = surface.tractions(&tool, 2e-5, &u, &history, &mut counts).unwrap().unwrap();
            assert_eq!((light.tractions(), light.force()), (found.tractions(), found.force()));
            assert!(light.stiffness().is_empty());

            // The tissue's nodal loads balance the tool's force, and their moment balances its moment.
            let mut loads = vec![Vector3::zeros(); u.len()];
            found.add_force(&rows, &mut loads);
            let sum: Vector3 = loads.iter().sum();
            let size: f64 = loads.iter().map(|f| f.norm()).sum();
            assert!((sum + found.force()).norm() < 1e-14 * size, "{}", (sum + found.force()).norm() / size);
            let place = tool.place(2e-5);
            let moment: Vector3 =
                (0..u.len()).map(|i| (block.mesh.points()[i] + u[i] - place).cross(&loads[i])).sum();
            assert!((moment + found.moment()).norm() < 1e-14 * size * 0.04, "{kind:?} {shape:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// The broad phase loses no point, for any position of the tool and any basis (here without partition of
    /// unity and with negative values).
    #[test]
    fn the_broad_phase_loses_nothing(turn in rotation(), at in vector(0.03), scale in 0.9..1.1f64, amplitude in 0.0..5e-3f64) {
        let block = Block::new(CellKind::Tet4, [4, 3, 2]);
        let plain = block.surface(&SIDES);
        let rows = plain.rows();
        let mut values = rows.values().to_vec();
        for k in (0..values.len()).step_by(3) {
            let shift = scale - 0.8;
            values[k] += shift;
            values[k + 1] -= 0.7 * shift;
        }
        let rows = Rows::new(rows.node_count(), rows.offsets().to_vec(), rows.nodes().to_vec(), values, shape::Unity::NotPromised).unwrap();
        let at_points = PointRows::new(plain.points().to_vec(), rows).unwrap();
        let rows = SurfaceRows::new(at_points, plain.weights().to_vec(), plain.normals().to_vec()).unwrap();
        let surface = ContactSurface::new(&rows);
        let u = wave(&block, amplitude);
        for shape in SHAPES.iter() {
            let tool = Tool::new(shape.clone(), Point3::new(0.02, 0.015, 0.01) + at, turn, Vector3::x(), coulomb()).unwrap();
            let history = ContactHistory::new(&tool, rows.points().len());
            let all = one_by_one(&tool, 0.0, &rows, &u, &history);
            match surface.evaluate(&tool, 0.0, &u, &history, &mut ContactCounts::default()) {
                Ok(found) => agree(found.as_ref(), &all),
                Err(ContactError::PassedThrough { point, penetration, limit }) => {
                    prop_assert_eq!(Some(point), all.iter().position(|c| -c.gap > limit));
                    prop_assert_eq!((-all[point].gap, tool.deepest()), (penetration, limit));
                }
                Err(other) => panic!("{other}"),
            }
        }
    }
}

#[test]
fn a_far_tool_is_skipped_and_a_near_one_looks_at_few_points() {
    let block = Block::new(CellKind::Tet4, [16, 12, 8]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let u = wave(&block, 1e-4);
    let points = rows.points().len();
    let jaw = Tool::new(
        SHAPES[1].clone(),
        Point3::new(0.02, 0.015, 0.05),
        Matrix3::identity(),
        -Vector3::z(),
        coulomb(),
    )
    .unwrap();
    let mut history = ContactHistory::new(&jaw, points);
    let mut counts = ContactCounts::default();
    assert_eq!(surface.evaluate(&jaw, 0.0, &u, &history, &mut counts).unwrap(), None);
    assert_eq!(counts, ContactCounts { evaluations: 1, skipped: 1, distances: 0, active: 0 });
    let found = surface.evaluate(&jaw, 0.0263, &u, &history, &mut counts).unwrap();
    assert_eq!((counts.evaluations, counts.skipped), (2, 1));
    assert!(counts.active > 0 && counts.distances < points as u64 / 4, "{counts:?} of {points}");
    // In a skipped step there is no contact, so the history is dropped.
    history.commit(found.as_ref());
    let stuck = found.unwrap().points()[0] as usize;
    assert_ne!(history.slip(stuck), Slip::NONE);
    history.commit(None);
    assert_eq!(history, ContactHistory::new(&jaw, points));
}

#[test]
fn the_same_bits_at_any_number_of_threads() {
    let block = Block::new(CellKind::Tet4, [20, 15, 10]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let u = wave(&block, 1e-4);
    let tool = on_top(&ToolShape::Plate(Plate), Tool::turned_to(&-Vector3::z()));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut history = ContactHistory::new(&tool, rows.points().len());
            let mut counts = ContactCounts::default();
            let mut evaluate =
                |history: &ContactHistory, c| surface.evaluate(&tool, c, &u, history, &mut counts).unwrap();
            history.commit(evaluate(&history, 0.0).as_ref());
            let found = evaluate(&history, 1e-5).unwrap();
            // The points fill more than two chunks of clusters, so that other threads take part.
            assert!(found.points().len() > 1024, "{}", found.points().len());
            found
        })
    };
    let (one, two) = (run(1), run(2));
    assert_eq!(one, two);
    assert_eq!(one.force().map(f64::to_bits), two.force().map(f64::to_bits));
    assert_eq!(one.moment().map(f64::to_bits), two.moment().map(f64::to_bits));
}

/// One node on a spring `s` under a closing plate: `s u = w p` with `p = l - k g`, `g = face - u`. In closed
/// form the penetration is multiplied by `s / (s + w k)` in every augmentation.
#[test]
fn augmentation_closes_the_gap_geometrically() {
    let rows = Rows::new(1, vec![0, 1], vec![0], vec![1.0], shape::Unity::Within(0.0)).unwrap();
    let at = PointRows::new(vec![Point3::origin()], rows).unwrap();
    let w = 2e-6;
    let spring = 3e3;
    let k = 5e8;
    let rows = SurfaceRows::new(at, vec![w], vec![Vector3::z()]).unwrap();
    let surface = ContactSurface::new(&rows);
    let law = ContactLaw::frictionless(k).unwrap();
    let down = -Vector3::z();
    let plate =
        Tool::new(ToolShape::Plate(Plate), Point3::origin(), Tool::turned_to(&down), down, law).unwrap();
    let mut history = ContactHistory::new(&plate, 1);
    let closure = 1e-3;
    let mut u = [Vector3::zeros()];
    let mut counts = ContactCounts::default();
    let ratio = spring / (spring + w * k);
    for round in 0..8 {
        for _ in 0..2 {
            // A Newton step; the problem is linear while in contact.
            let c = surface.evaluate(&plate, closure, &u, &history, &mut counts).unwrap().unwrap();
            let residual = w * c.tractions()[0].z - spring * u[0].z;
            u[0].z += residual / (spring - w * c.stiffness()[0].m33);
        }
        let c = surface.evaluate(&plate, closure, &u, &history, &mut counts).unwrap().unwrap();
        let exact = closure * ratio.powi(round + 1);
        assert!((c.max_penetration() - exact).abs() < 1e-12 * closure, "{} {exact}", c.max_penetration());
        history.augment(Some(&c));
        assert_eq!(history.multiplier(0), c.pressures()[0]);
    }
    // Lifted by 1 um, outside the tool: the multiplier (about 1.5 GPa m^2 / m^2) still keeps the point in
    // contact.
    u[0].z = -closure - 1e-6;
    let c = surface.evaluate(&plate, closure, &u, &history, &mut counts).unwrap().expect("within reach");
    assert_eq!(c.max_penetration(), 0.0);
    assert!((c.pressures()[0] - (history.multiplier(0) - k * 1e-6)).abs() < 1e-6 * c.pressures()[0]);
    assert_eq!(counts.skipped, 0);
    // Lifted by the whole distance: the point is free, and the next augmentation removes the multiplier.
    u[0].z = -closure - 1.1 * history.multiplier(0) / k;
    let c = surface.evaluate(&plate, closure, &u, &history, &mut counts).unwrap();
    assert!(c.as_ref().is_none_or(|c| c.points().is_empty()));
    history.augment(c.as_ref());
    assert_eq!(history.multiplier(0), 0.0);
}

#[test]
fn states_without_meaning_are_refused() {
    let block = Block::new(CellKind::Tet4, [4, 3, 2]);
    let rows = block.surface(&["z-max"]);
    let surface = ContactSurface::new(&rows);
    let mut u = vec![Vector3::zeros(); block.mesh.points().len()];
    let jaw = Tool::new(
        SHAPES[1].clone(),
        Point3::new(0.02, 0.015, 0.024),
        Matrix3::identity(),
        -Vector3::z(),
        coulomb(),
    )
    .unwrap();
    let history = ContactHistory::new(&jaw, rows.points().len());
    let mut counts = ContactCounts::default();
    let mut evaluate = |closure, u: &[Vector3], history: &ContactHistory| {
        surface.evaluate(&jaw, closure, u, history, &mut counts).map(|c| c.map(|c| c.points().len()))
    };
    assert!(evaluate(1.9e-3, &u, &history).unwrap().unwrap() > 0);
    match evaluate(2.1e-3, &u, &history) {
        Err(ContactError::PassedThrough { penetration, limit, .. }) => {
            assert!((penetration - 2.1e-3).abs() < 1e-12 && limit == 2e-3);
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(evaluate(f64::NAN, &u, &history), Err(ContactError::Place { what: "the closure" }));
    assert_eq!(
        evaluate(0.0, &u[1..], &history),
        Err(ContactError::Length { what: "displacements", found: u.len() - 1, expected: u.len() })
    );
    let short = ContactHistory::new(&jaw, 3);
    assert!(matches!(evaluate(0.0, &u, &short), Err(ContactError::Length { found: 3, .. })));
    let node = rows.rows().row(0).0[0] as usize;
    u[node].y = f64::NAN;
    assert_eq!(evaluate(0.0, &u, &history), Err(ContactError::NotFinite { node }));
}

#[test]
fn a_tool_that_pushes_from_within_is_named_however_the_body_is_turned() {
    for kind in [CellKind::Tet4, CellKind::Hex8, CellKind::Hex20] {
        let block = Block::new(kind, [4, 3, 2]);
        let rows = block.surface(&SIDES);
        let surface = ContactSurface::new(&rows);
        for turn in [Matrix3::identity(), nalgebra::Rotation3::new(Vector3::new(0.3, 2.0, -0.4)).into_inner()]
        {
            let moved = |p: &Point3| turn * p.coords - p.coords;
            let u: Vec<Vector3> = block.mesh.points().iter().map(moved).collect();
            let side = |from_top: f64| {
                let ball = ToolShape::Sphere(Sphere { radius: 5e-3 });
                let at = Point3::from(turn * Vector3::new(0.02, 0.015, 0.02 + from_top));
                let tool = Tool::new(ball, at, Matrix3::identity(), -turn.column(2), coulomb()).unwrap();
                let history = ContactHistory::new(&tool, rows.points().len());
                let contacts = surface.tractions(&tool, 0.0, &u, &history, &mut ContactCounts::default());
                let contacts = contacts.unwrap().unwrap();
                assert!(!contacts.points().is_empty());
                surface.check_side(&contacts, &u)
            };
            assert_eq!(side(3e-3), Ok(()));
            assert!(
                matches!(side(-3e-3), Err(ContactError::WithinBody { .. })),
                "{kind:?}: {:?}",
                side(-3e-3)
            );
        }
    }
}

#[test]
fn a_surface_without_points_is_skipped() {
    let rows = Rows::new(1, vec![0], vec![], vec![], shape::Unity::NotPromised).unwrap();
    let rows = SurfaceRows::new(PointRows::new(vec![], rows).unwrap(), vec![], vec![]).unwrap();
    let surface = ContactSurface::new(&rows);
    let tool = on_top(&SHAPES[3], Matrix3::identity());
    let mut counts = ContactCounts::default();
    let history = ContactHistory::new(&tool, 0);
    assert_eq!(surface.evaluate(&tool, 0.0, &[Vector3::zeros()], &history, &mut counts), Ok(None));
    assert_eq!(counts.skipped, 1);
}

/// Bases that overshoot: a point that moves farther than all of its nodes is still found.
#[test]
fn boxes_hold_points_that_outrun_their_nodes() {
    // Values, displacements of the two nodes along z; the point moves by 1.5 * 1 + 0.5 * 1 and by 2 * 1 mm.
    for (values, u) in [([1.5, -0.5], [1e-3, -1e-3]), ([1.0, 1.0], [1e-3, 1e-3])] {
        let rows = Rows::new(2, vec![0, 2], vec![0, 1], values.to_vec(), shape::Unity::NotPromised).unwrap();
        let at = PointRows::new(vec![Point3::origin()], rows).unwrap();
        let rows = SurfaceRows::new(at, vec![1e-6], vec![Vector3::z()]).unwrap();
        let down = -Vector3::z();
        let face = Point3::new(0.0, 0.0, 1.99e-3);
        let plate =
            Tool::new(ToolShape::Plate(Plate), face, Tool::turned_to(&down), down, coulomb()).unwrap();
        let history = ContactHistory::new(&plate, 1);
        let u = u.map(|z| Vector3::z() * z);
        let mut counts = ContactCounts::default();
        let found = ContactSurface::new(&rows).evaluate(&plate, 0.0, &u, &history, &mut counts).unwrap();
        assert!((found.expect("near").max_penetration() - 1e-5).abs() < 1e-15, "{values:?}");
    }
}
