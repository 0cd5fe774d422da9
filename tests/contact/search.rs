//! The search over many steps: the same contacts as in each state alone, with fewer distance evaluations.

use contact::{
    ContactCounts, ContactError, ContactHistory, ContactLaw, ContactSearch, ContactSurface, Contacts, Plate,
    Tool, ToolShape,
};
use geometry::CellKind;
use integration::block::{Block, SIDES};
use integration::tools::{SHAPES, rotation, vector};
use proptest::prelude::*;
use shape::{Matrix3, Point3, SurfaceRows, Vector3};

fn law() -> ContactLaw {
    ContactLaw::coulomb(5e8, 0.15, 1e8).unwrap()
}

/// A plate that faces down at a height of `gap` above a block's top (z = 20 mm).
fn plate(gap: f64) -> Tool {
    let turn = Tool::turned_to(&-Vector3::z());
    let at = Point3::new(0.0, 0.0, 0.02 + gap);
    Tool::new(ToolShape::Plate(Plate), at, turn, -Vector3::z(), law()).unwrap()
}

fn spacing(rows: &SurfaceRows) -> f64 {
    (rows.weights().iter().sum::<f64>() / rows.points().len() as f64).sqrt()
}

/// Treats contacts without touching points as no contact.
fn touching(found: Result<Option<Contacts>, ContactError>) -> Result<Option<Contacts>, ContactError> {
    found.map(|found| found.filter(|contacts| !contacts.points().is_empty()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Two tools and a body that moves, oscillates and jumps by fractions or multiples of the margin, with
    /// friction, and multipliers that keep points outside in contact.
    #[test]
    fn the_same_contacts_as_of_each_state_alone(
        turn in rotation(),
        at in [vector(0.012), vector(0.012)],
        shapes in [0..SHAPES.len(), 0..SHAPES.len()],
        size in -5.5..-2.5f64,
        steps in prop::collection::vec((vector(1.0), -1.0..1.0f64, [-1.0..1.0f64, -1.0..1.0f64], 0..12u8), 40),
    ) {
        let block = Block::new(CellKind::Tet4, [5, 4, 2]);
        let rows = block.surface(&SIDES);
        let surface = ContactSurface::new(&rows);
        let tools = [0, 1].map(|k: usize| {
            let at = Point3::new(0.02, 0.015, [0.032, -0.012][k]) + at[k];
            Tool::new(SHAPES[shapes[k]].clone(), at, turn, Vector3::z() * [-1.0, 1.0][k], law()).unwrap()
        });
        let mut histories = [0, 1].map(|k: usize| ContactHistory::new(&tools[k], rows.points().len()));
        let mut search = ContactSearch::new(&surface, 2);
        let size = 10f64.powf(size);
        let mut shift = Vector3::zeros();
        let mut wave = 0.0;
        let mut closures = [0.0; 2];
        for (way, waved, closed, kind) in steps {
            // One state in twelve repeats the last state, and one is far away.
            let size = match kind { 0 => 0.0, 1 => 20.0 * size, _ => size };
            shift += way * size;
            wave += waved * size;
            closures = [0, 1].map(|k: usize| closures[k] + closed[k] * size);
            let moved = |x: &Point3| shift + Vector3::new((300.0 * x.y).sin(), (200.0 * x.z).cos(), (250.0 * x.x).sin()) * wave;
            let u: Vec<Vector3> = block.mesh.points().iter().map(moved).collect();
            let mut now = search.at(&u);
            for k in 0..2 {
                let history = &histories[k];
                let mut counts = [ContactCounts::default(); 2];
                let found = touching(now.tractions(k, &tools[k], closures[k], history, &mut counts[0]));
                let expected = touching(surface.tractions(&tools[k], closures[k], &u, history, &mut counts[1]));
                prop_assert_eq!(&found, &expected);
                prop_assert_eq!(counts[0].active, counts[1].active);
                prop_assert!(counts[0].distances <= rows.points().len() as u64);
                if let Ok(found) = found {
                    histories[k].commit(found.as_ref());
                    if kind == 2 {
                        histories[k].augment(found.as_ref());
                    }
                }
            }
        }
    }
}

/// Steps of a tenth of the margin, of the body, the tool and both. The tool is alone, or follows another tool
/// whose jumps require a new list in every state.
#[test]
fn a_tool_that_comes_near_is_found_when_it_touches() {
    let block = Block::new(CellKind::Tet4, [16, 12, 3]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let points = rows.points().len();
    let step = 0.0125 * spacing(&rows);
    let jumping = plate(0.1);
    for (body, tool) in [(1.0, 0.0), (0.0, 1.0), (0.6, 0.6)] {
        for (gap, jumps) in [(10.5, false), (12.5, false), (17.5, true), (35.5, false), (35.5, true)] {
            let plate = plate(gap * step);
            let history = ContactHistory::new(&plate, points);
            let mut search = ContactSearch::new(&surface, 2);
            let [mut counts, mut all] = [ContactCounts::default(); 2];
            for k in 0..60 {
                let way = f64::from(k) * step;
                let u = vec![Vector3::new(way, -way, way) * body; block.mesh.points().len()];
                let mut now = search.at(&u);
                if jumps {
                    let closure = 20.0 * step * f64::from(k % 2);
                    let found = now.tractions(1, &jumping, closure, &history, &mut ContactCounts::default());
                    assert_eq!(found, Ok(None));
                }
                let found = now.tractions(0, &plate, tool * way, &history, &mut counts);
                let expected = surface.tractions(&plate, tool * way, &u, &history, &mut all);
                assert_eq!(touching(found), touching(expected), "{body} {tool} {gap} {jumps} {k}");
                assert_eq!(counts.active > 0, f64::from(k) * (body + tool) > gap, "{body} {tool} {gap} {k}");
            }
        }
    }
}

#[test]
fn small_steps_look_at_few_points_and_at_no_other() {
    let block = Block::new(CellKind::Tet4, [16, 12, 8]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let at = Point3::new(0.02, 0.015, 0.0199 + SHAPES[1].bounds().1.z);
    let jaw = Tool::new(SHAPES[1].clone(), at, Matrix3::identity(), -Vector3::z(), law()).unwrap();
    let history = ContactHistory::new(&jaw, rows.points().len());
    let mut search = ContactSearch::new(&surface, 1);
    let [mut counts, mut all] = [ContactCounts::default(); 2];
    for k in 0..50 {
        let u = vec![Vector3::repeat(1e-7 * f64::from(k)); block.mesh.points().len()];
        search.at(&u).tractions(0, &jaw, 0.0, &history, &mut counts).unwrap();
        surface.tractions(&jaw, 0.0, &u, &history, &mut all).unwrap();
    }
    assert_eq!((counts.evaluations, counts.active), (50, all.active));
    assert!(counts.active > 0 && 2 * counts.distances < all.distances, "{counts:?} {all:?}");
    // A tool that nothing can touch is skipped entirely, before and after.
    let far = plate(0.1);
    let mut search = ContactSearch::new(&surface, 1);
    let mut counts = ContactCounts::default();
    let u = vec![Vector3::zeros(); block.mesh.points().len()];
    for _ in 0..2 {
        assert_eq!(search.at(&u).tractions(0, &far, 0.0, &history, &mut counts), Ok(None));
    }
    assert_eq!(counts, ContactCounts { evaluations: 2, skipped: 2, distances: 0, active: 0 });
}

#[test]
fn refuses_what_a_state_alone_refuses() {
    let block = Block::new(CellKind::Tet4, [4, 3, 2]);
    let rows = block.surface(&SIDES);
    let surface = ContactSurface::new(&rows);
    let plate = plate(1e-3);
    let history = ContactHistory::new(&plate, rows.points().len());
    let mut search = ContactSearch::new(&surface, 1);
    let mut counts = ContactCounts::default();
    let still = vec![Vector3::zeros(); block.mesh.points().len()];
    let mut found =
        |u: &[Vector3], closure| search.at(u).tractions(0, &plate, closure, &history, &mut counts);
    assert!(found(&still, 0.0).is_ok());
    let seen = rows.rows().nodes()[0] as usize;
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut u = still.clone();
            u[seen][axis] = value;
            assert_eq!(found(&u, 0.0), Err(ContactError::NotFinite { node: seen }), "{value} {axis}");
            assert!(found(&still, 0.0).is_ok());
        }
    }
    assert!(matches!(found(&still[1..], 0.0), Err(ContactError::Length { .. })));
    assert!(matches!(found(&still, f64::NAN), Err(ContactError::Place { .. })));
    let deep = plate.deepest();
    assert!(deep.is_infinite() || matches!(found(&still, 1.0), Err(ContactError::PassedThrough { .. })));
}
