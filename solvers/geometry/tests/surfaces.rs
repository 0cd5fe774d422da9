//! Surfaces: errors with their place, distances, and the inside test.

mod common;

use common::{bumpy, joined, moved, sphere_like, surface, torus};
use tissuebench_geometry::shapes::Shape;
use tissuebench_geometry::surface::{Soup, SurfaceProblem, Treatment};
use tissuebench_geometry::{Point3, Surface, cloud};

/// A tetrahedron with a volume of 1/6.
const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

fn refused(soup: Soup) -> SurfaceProblem {
    match Surface::new(soup, 1.0) {
        Ok(_) => panic!("not refused"),
        Err(problem) => problem,
    }
}

#[test]
fn an_open_surface_is_refused() {
    let open = refused({
        let mut soup = sphere_like(2, |n| n);
        soup.triangles.remove(17);
        soup.faces.remove(17);
        soup
    });
    assert!(matches!(open, SurfaceProblem::Open { edges: 3, .. }), "{open}");
}

/// Each repairable error states the number and position of the triangles, and a repair mends it.
#[test]
fn what_a_repair_has_to_do_is_said_and_done() {
    const REGIONS: &str = "give each body its own closed surface";
    let ball = || sphere_like(4, |n| n);
    let whole = surface(ball()).volume();
    let turn = |soup: &mut Soup, triangle: usize| soup.triangles[triangle].swap(1, 2);
    let edit = |change: &dyn Fn(&mut Soup)| {
        let mut soup = ball();
        change(&mut soup);
        let repaired =
            Surface::treated(soup.clone(), 1.0, Treatment::Repair).unwrap_or_else(|bad| panic!("{bad}"));
        let error = repaired.surface.volume() / whole - 1.0;
        // A cover of a hole is flatter than the ball.
        assert!((-3e-3..1e-12).contains(&error) && !repaired.changes.is_empty(), "{error}");
        let problem = refused(soup);
        assert!(problem.advice(false).is_some_and(|advice| advice.contains("make --repair")), "{problem}");
        assert!(problem.advice(true).is_some_and(|advice| advice.contains("make --wrap")), "{problem}");
        problem.to_string()
    };
    let without = |soup: &mut Soup, triangle: usize| {
        soup.triangles.remove(triangle);
        soup.faces.remove(triangle);
    };
    let all = ball().triangles.len();
    let holes = edit(&|soup| [all - 1, 0].iter().for_each(|&triangle| without(soup, triangle)));
    assert!(
        holes.contains("at a hole of 3 edges near (") && holes.contains("one of 2 holes of 6 edges"),
        "{holes}"
    );
    let some = edit(&|soup| [3, 7].iter().for_each(|&triangle| turn(soup, triangle)));
    assert!(some.contains(&format!("2 of {all} are clockwise (4 and 8)")), "{some}");
    let most = edit(&|soup| (1..all).for_each(|triangle| turn(soup, triangle)));
    assert!(most.contains(&format!("{} of {all} are clockwise (2, 3, 4, 5, ...)", all - 1)), "{most}");
    let inwards = edit(&|soup| (0..all).for_each(|triangle| turn(soup, triangle)));
    assert!(inwards.contains(&format!("{all} of {all} triangles face inwards")), "{inwards}");
    let twice = edit(&|soup| {
        soup.triangles.push(soup.triangles[4]);
        soup.faces.push(all as u32 + 1);
    });
    assert!(twice.contains(&format!("5 and {} have the same corners", all + 1)), "{twice}");
    // An edge of one triangle coincides with two edges of its neighbours.
    let split = edit(&|soup| {
        let [a, b, c] = soup.triangles[0];
        let middle = nalgebra::center(&soup.points[a as usize], &soup.points[b as usize]);
        soup.points.push(middle);
        let new = soup.points.len() as u32 - 1;
        soup.triangles[0] = [a, new, c];
        soup.triangles.push([new, b, c]);
        soup.faces.push(1);
    });
    assert!(split.contains("the corner (") && split.contains("between its ends (3 edges"), "{split}");
    for said in [holes, some, most, inwards, twice, split] {
        assert!(!said.contains("yet"), "{said}");
    }
    let tet = Soup {
        points: CORNERS.map(Point3::from).to_vec(),
        triangles: FACES.map(|face| face.map(|corner| corner as u32)).to_vec(),
        faces: vec![1, 2, 3, 4],
        ..Soup::default()
    };
    let mirrored = Soup {
        points: tet.points.iter().map(|p| Point3::new(-p.x, p.y, p.z)).collect(),
        triangles: tet.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        ..tet.clone()
    };
    let touching = refused(joined(tet, mirrored)).to_string();
    assert!(touching.contains("closed parts touch at the edge"), "{touching}");
    assert!(touching.contains(REGIONS), "{touching}");
}

#[test]
fn surfaces_that_cross_are_refused() {
    let crossing = refused(joined(sphere_like(3, |n| n), moved(sphere_like(3, |n| n), [0.7, 0.1, 0.2])));
    assert!(matches!(crossing, SurfaceProblem::Crossing { places: 50.., .. }), "{crossing}");
    // One part pushed through the opposite side.
    let pushed = refused(sphere_like(4, |n| if n.z > 0.8 { [n.x, n.y, n.z - 2.4].into() } else { n }));
    assert!(matches!(pushed, SurfaceProblem::Crossing { .. }), "{pushed}");
    // Exactly coplanar or with touching edges: exact signs decide, not rounding.
    let cube = |at: [f64; 3]| {
        let corner = |i: u32| Point3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]];
        let soup = Soup {
            points: (0..8).map(corner).collect(),
            triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
            faces: (1..=12).collect(),
            ..Soup::default()
        };
        moved(soup, at)
    };
    for by in [[0.5, 0.0, 0.0], [0.5, 0.5, 0.5], [1.0, 0.25, 0.25], [1.0, 1.0, 0.5]] {
        let problem = refused(joined(cube([0.0; 3]), cube(by)));
        assert!(
            matches!(problem, SurfaceProblem::Crossing { .. } | SurfaceProblem::Branched { .. }),
            "{by:?}: {problem}"
        );
    }
    surface(joined(cube([0.0; 3]), cube([1.5, 0.0, 0.0])));
}

#[test]
fn cavities_are_clockwise_and_bodies_within_bodies_are_none() {
    let turned =
        |soup: Soup| Soup { triangles: soup.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..soup };
    let [outer, inner] = [1.0, 0.5].map(|r| sphere_like(4, move |n| r * n));
    let hollow = surface(joined(outer.clone(), turned(inner.clone())));
    assert!((hollow.volume() / (7.0 / 8.0 * 4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.01);
    assert!(hollow.signed_distance(&Point3::origin()) > 0.49);
    let solid = refused(joined(outer, inner));
    assert!(matches!(solid, SurfaceProblem::InsideOut { within: 1, .. }), "{solid}");
    let flat = refused(sphere_like(1, |n| [n.x, n.y, 0.0 * n.z].into()));
    assert!(
        matches!(
            flat,
            SurfaceProblem::Crossing { .. }
                | SurfaceProblem::Flat
                | SurfaceProblem::Branched { .. }
                | SurfaceProblem::Turned { .. }
        ),
        "{flat}"
    );
}

#[test]
fn corners_apart_by_rounding_are_one() {
    let mut soup = Soup::default();
    for (at, t) in sphere_like(3, |n| 40.0 * n).triangles.iter().enumerate() {
        let base = sphere_like(3, |n| 40.0 * n);
        let first = soup.points.len() as u32;
        soup.points.extend(t.map(|p| base.points[p as usize] * (1.0 + 1e-8 * (at % 7) as f64)));
        soup.triangles.push([first, first + 1, first + 2]);
        soup.faces.push(at as u32 + 1);
    }
    assert_eq!(surface(soup).points().len(), 258);
}

#[test]
fn distances_have_the_sign_of_the_body() {
    let ball = surface(sphere_like(5, |n| n));
    let ring = surface(torus(0.4, 128, 64));
    for i in 0..2000u32 {
        let at = |n: u32| {
            1.7 * (2.0
                * f64::from((i.wrapping_mul(2_654_435_761) ^ n.wrapping_mul(40_503 * (i + 1))) % 10_007)
                / 10_007.0
                - 1.0)
        };
        let p = Point3::new(at(1), at(2), at(3));
        assert!((ball.signed_distance(&p) - (p.coords.norm() - 1.0)).abs() < 2e-3, "{p}");
        let around = (p.x.hypot(p.y) - 1.0).hypot(p.z) - 0.4;
        assert!((ring.signed_distance(&p) - around).abs() < 3e-3, "{p}");
    }
}

#[test]
fn a_surface_is_a_body_for_clouds() {
    let organ = surface(bumpy(4));
    let nodes = cloud(&organ, 200, 1, &[]).unwrap();
    assert_eq!(nodes.points.len(), 200);
    let outer = nodes.points.iter().filter(|p| organ.signed_distance(p).abs() < 1e-12).count();
    assert!(
        nodes.points.iter().all(|p| organ.signed_distance(p) < 1e-12) && (100..180).contains(&outer),
        "{outer}"
    );
    let [low, high] = Shape::bounds(&organ);
    assert!(low.x < -1.2 && high.y > 0.8);
}

/// A box in which one side has a corner in the middle of another side's edge, closed by a triangle without
/// area. In further cases several corners lie on the edge, so that one needle leans on another.
#[test]
fn needles_that_close_a_t_junction_are_no_crossing() {
    let corner = |x: f64, y: f64, z: f64| Point3::new(x, y, z);
    for between in [vec![5.0], vec![3.0, 7.0], vec![2.0, 5.0, 8.0]] {
        let mut soup = Soup {
            points: vec![
                corner(0.0, 0.0, 0.0),
                corner(10.0, 0.0, 0.0),
                corner(10.0, 10.0, 0.0),
                corner(0.0, 10.0, 0.0),
                corner(0.0, 0.0, 10.0),
                corner(10.0, 0.0, 10.0),
                corner(10.0, 10.0, 10.0),
                corner(0.0, 10.0, 10.0),
            ],
            ..Soup::default()
        };
        soup.triangles = vec![
            [0, 2, 1],
            [0, 3, 2],
            [4, 5, 6],
            [4, 6, 7],
            [1, 2, 6],
            [1, 6, 5],
            [2, 3, 7],
            [2, 7, 6],
            [3, 0, 4],
            [3, 4, 7],
        ];
        let mut row = vec![0u32];
        for &x in &between {
            row.push(soup.points.len() as u32);
            soup.points.push(corner(x, 0.0, 0.0));
        }
        row.push(1);
        // The front: a fan from the upper left corner to the row, and the remaining triangle.
        soup.triangles.extend(row.windows(2).map(|two| [4, two[0], two[1]]));
        soup.triangles.push([4, 1, 5]);
        // Needles between the row and the edge of the bottom.
        soup.triangles.extend(row[1..].windows(2).map(|two| [0, two[1], two[0]]));
        soup.faces = (1..=soup.triangles.len() as u32).collect();
        let count = soup.triangles.len();
        let surface = Surface::new(soup, 1.0).unwrap_or_else(|bad| panic!("{between:?}: {bad}"));
        assert!((surface.volume() - 1000.0).abs() < 1e-9 && (surface.area() - 600.0).abs() < 1e-9);
        assert_eq!(surface.triangles().len(), count);
        assert!((surface.signed_distance(&corner(5.0, -1.0, 0.0)) - 1.0).abs() < 1e-12);
        assert!((surface.signed_distance(&corner(5.0, 2.0, 1.0)) + 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_surface_without_groups_has_no_names() {
    assert!(surface(sphere_like(5, |n| n)).groups().names().is_empty());
}
