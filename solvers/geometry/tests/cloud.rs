//! Clouds: exact counts, bitwise reproducibility, even spacing, coverage of the surface; and the closed-form
//! bodies that they fill.

use tissuebench_geometry::generate::{box_mesh, raise_order};
use tissuebench_geometry::shapes::{Ball, Cuboid, Cylinder, HalfKidney, Shape, SphereShell};
use tissuebench_geometry::{
    CellKind, Cloud, CloudError, Kidney, Point3, Refinement, Search, Sizes, Vector3, cloud, cloud_from_mesh,
    cloud_of_sizes,
};

fn shapes() -> Vec<(&'static str, Box<dyn Shape>)> {
    vec![
        ("ball", Box::new(Ball { radius: 0.4 })),
        ("shell", Box::new(SphereShell { inner: 0.3, outer: 0.5 })),
        ("cuboid", Box::new(Cuboid { min: Point3::new(-1.0, 0.0, 0.5), max: Point3::new(1.0, 0.7, 1.3) })),
        ("cylinder", Box::new(Cylinder { radius: 0.2, height: 0.5 })),
        ("kidney", Box::new(Kidney)),
        ("half kidney", Box::new(HalfKidney)),
    ]
}

/// Pseudo-random numbers in [0, 1), from a linear congruential generator.
fn numbers(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Distance from every node to its nearest neighbour.
fn gaps(points: &[Point3]) -> Vec<f64> {
    let search = Search::new(points).unwrap();
    points.iter().map(|p| search.nearest(p, 2)[1].distance).collect()
}

#[test]
fn counts_are_exact_and_nodes_lie_in_the_body() {
    for (name, shape) in shapes() {
        for n in [4, 5, 13, 83, 166, 332] {
            let cloud = cloud(&*shape, n, 1, &[]).unwrap();
            assert_eq!((cloud.points.len(), cloud.spacing.len()), (n, n), "{name}");
            for p in &cloud.points {
                assert!(shape.level(p) < 1e-12, "{name}, {n} nodes: {p} is outside by {}", shape.level(p));
            }
        }
    }
    for n in [665, 1330, 1331] {
        assert_eq!(cloud(&Kidney, n, 1, &[]).unwrap().points.len(), n);
    }
}

#[test]
fn a_thinned_cloud_is_spread_out_as_the_nodes_are() {
    let full = cloud(&Kidney, 900, 3, &[]).unwrap();
    let thin = full.thinned(300).unwrap();
    assert_eq!(thin.points.len(), 300);
    assert!(thin.points.iter().all(|p| full.points.contains(p)));
    let gaps = gaps(&thin.points);
    let low = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(low > 0.5 * gaps.iter().sum::<f64>() / 300.0, "{low}");
    // Every node is near one of those that remain.
    let search = Search::new(&thin.points).unwrap();
    let away = full.points.iter().map(|p| search.nearest(p, 1)[0].distance).fold(0.0, f64::max);
    assert!(away < 1.5 * low, "{away} {low}");
    // More nodes than there are: all of them.
    assert_eq!(full.thinned(1000).unwrap().points.len(), 900);
}

#[test]
fn clouds_are_even_and_cover_surface_and_inside() {
    for (name, shape) in shapes() {
        let n = 332;
        let points = cloud(&*shape, n, 7, &[]).unwrap().points;
        let gaps = gaps(&points);
        let mean = gaps.iter().sum::<f64>() / n as f64;
        let (low, high) = gaps.iter().fold((f64::INFINITY, 0.0f64), |(l, h), &g| (l.min(g), h.max(g)));
        assert!(low > 0.5 * mean && high < 1.6 * mean, "{name}: {low} {mean} {high}");
        let on_surface = points.iter().filter(|p| shape.level(p).abs() < 1e-9).count();
        assert!(on_surface > n / 4 && on_surface < 4 * n / 5, "{name}: {on_surface} of {n} on the surface");
        // No point of the body, its surface included, is far from a node.
        let search = Search::new(&points).unwrap();
        let mut state = 1u64;
        let mut unit = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..2000 {
            for p in [shape.volume_sample(&mut unit), shape.surface_sample(&mut unit)] {
                let away = search.nearest(&p, 1)[0].distance;
                assert!(away < 1.5 * mean, "{name}: {p} is {away} from any node, mean gap {mean}");
            }
        }
    }
}

#[test]
fn the_seed_and_nothing_else_decides() {
    let first = cloud(&Kidney, 83, 5, &[]).unwrap();
    assert_eq!(first, cloud(&Kidney, 83, 5, &[]).unwrap());
    assert_ne!(first, cloud(&Kidney, 83, 6, &[]).unwrap());
    // A frozen value: a change here alters every recorded result.
    let sum: f64 = first.points.iter().map(|p| p.x + 2.0 * p.y + 3.0 * p.z).sum();
    assert!((sum - 0.3166643226159171).abs() < 1e-14, "{sum}");
}

#[test]
fn refinement_draws_nodes_closer() {
    let centre = Point3::new(0.0, -0.02, 0.013);
    let refinement = Refinement { centre, radius: 0.008, reach: 0.02, ratio: 2.5 };
    let graded = cloud(&Kidney, 332, 1, &[refinement]).unwrap();
    let even = cloud(&Kidney, 332, 1, &[]).unwrap();
    let mean_gap = |cloud: &Cloud, near: bool| {
        let gaps = gaps(&cloud.points);
        let kept: Vec<f64> = (cloud.points.iter().zip(&gaps))
            .filter(|(p, _)| if near { (*p - centre).norm() < 0.008 } else { (*p - centre).norm() > 0.028 })
            .map(|(_, g)| *g)
            .collect();
        kept.iter().sum::<f64>() / kept.len() as f64
    };
    let ratio = mean_gap(&graded, false) / mean_gap(&graded, true);
    assert!((2.0..3.0).contains(&ratio), "asked for 2.5, got {ratio}");
    assert!((0.9..1.1).contains(&(mean_gap(&even, false) / mean_gap(&even, true))));
}

#[test]
fn spacing_of_meshes_and_of_bare_points() {
    let mesh =
        |kind| box_mesh(kind, Point3::origin(), Point3::new(4.0, 4.0, 4.0), [4; 3], [1.0; 3], None).unwrap();
    // The centre node of a Kuhn mesh has 6 edges along the axes, 6 face diagonals and 2 body diagonals.
    let middle = 62;
    let tets = cloud_from_mesh(&mesh(CellKind::Tet4));
    let expected = (6.0 + 6.0 * 2f64.sqrt() + 2.0 * 3f64.sqrt()) / 14.0;
    assert!((tets.spacing[middle] - expected).abs() < 1e-14);
    let hexes = cloud_from_mesh(&mesh(CellKind::Hex8));
    assert!(hexes.spacing.iter().all(|s| (s - 1.0).abs() < 1e-14));
    let quadratic = cloud_from_mesh(&raise_order(&mesh(CellKind::Hex8)));
    assert!(quadratic.spacing.iter().all(|s| (s - 0.5).abs() < 1e-14));
    // A cloud without a mesh: of the 14 nearest lattice points, 6 are at 1 and 8 at sqrt 2.
    let bare = Cloud::from_points(hexes.points).unwrap();
    assert!((bare.spacing[middle] - (6.0 + 8.0 * 2f64.sqrt()) / 14.0).abs() < 1e-14);
    let two = Cloud::from_points(vec![Point3::origin(), Point3::new(0.0, 0.0, 2.0)]).unwrap();
    assert_eq!(two.spacing, [2.0, 2.0]);
    let twice = vec![Point3::origin(), Point3::new(0.0, 0.0, 2.0), Point3::origin()];
    assert_eq!(Cloud::from_points(twice), Err(CloudError::Coincident { first: 0, second: 2 }));
}

#[test]
fn bad_requests_are_named() {
    let refine = |centre, radius, reach, ratio| {
        let r = Refinement { centre, radius, reach, ratio };
        cloud(&Kidney, 83, 1, &[r]).unwrap_err().to_string()
    };
    let o = Point3::origin();
    assert_eq!(cloud(&Kidney, 3, 1, &[]), Err(CloudError::TooFew { nodes: 3, least: 4 }));
    assert!(matches!(cloud(&Kidney, usize::MAX, 1, &[]), Err(CloudError::TooMany { .. })));
    assert!(refine(Point3::new(f64::NAN, 0.0, 0.0), 1.0, 1.0, 2.0).contains("centre of refinement 0"));
    assert!(refine(o, -1.0, 1.0, 2.0).contains("radius of refinement 0 is -1"));
    assert!(refine(o, 1.0, 0.0, 2.0).contains("transition width"));
    assert!(refine(o, 1.0, 1.0, 0.5).contains("ratio"));
    assert!(refine(o, 1.0, 1.0, f64::NAN).contains("NaN"));
    let flat = Cuboid { min: o, max: Point3::new(1.0, 1.0, 0.0) };
    assert!(cloud(&flat, 83, 1, &[]).unwrap_err().to_string().contains("1 x 1 x 0 m"));
}

#[test]
fn shapes_hold_together() {
    let mut unit = numbers(3);
    for (name, shape) in shapes() {
        let [min, max] = shape.bounds();
        let size = max - min;
        let (mut inside, mut low, mut high) = (0, max, min);
        let samples = 40_000;
        let mut volume_mean = Vector3::zeros();
        let mut box_mean = Vector3::zeros();
        for _ in 0..samples {
            let p = min + size.component_mul(&Vector3::new(unit(), unit(), unit()));
            if shape.inside(&p) {
                inside += 1;
                box_mean += p.coords;
            }
            let v = shape.volume_sample(&mut unit);
            let s = shape.surface_sample(&mut unit);
            assert!(shape.level(&v) <= 1e-12, "{name}: sample {v}");
            assert!(shape.level(&s).abs() < 1e-12, "{name}: surface sample {s}");
            let projected = shape.project_to_surface(&p);
            assert!(shape.level(&projected).abs() < 1e-12, "{name}: {p} -> {projected}");
            volume_mean += v.coords / samples as f64;
            (low, high) = (low.inf(&s), high.sup(&s));
        }
        // Four standard deviations of the count.
        let share = shape.volume() / size.product();
        let spread = 4.0 * (share * (1.0 - share) / samples as f64).sqrt();
        assert!((inside as f64 / samples as f64 - share).abs() <= spread + 1e-12, "{name}: volume");
        box_mean /= inside as f64;
        assert!((volume_mean - box_mean).norm() < 0.02 * size.norm(), "{name}: samples are lopsided");
        assert!((low - min).norm() + (high - max).norm() < 0.03 * size.norm(), "{name}: bounds {low} {high}");
        assert!(shape.level(&shape.project_to_surface(&Point3::origin())).abs() < 1e-12, "{name}: centre");
    }
}

/// Surface samples are uniform: the fraction of samples on a part equals the part's fraction of the area,
/// from a fine triangulation.
#[test]
fn kidney_surface_samples_are_uniform() {
    let mesh = tissuebench_geometry::generate::kidney_mesh(CellKind::Tet4, 24).unwrap();
    let parts: [fn(&Point3) -> bool; 4] =
        [|p| p.x < 0.0, |p| p.y.abs() < 0.015, |p| p.z.abs() < 0.005, |p| p.x > 0.012 && p.y.abs() > 0.015];
    let mut area = 0.0;
    let mut share = [0.0; 4];
    for &f in mesh.group("surface").unwrap() {
        let p: Vec<Point3> = mesh.facet_nodes(f).map(|n| mesh.points()[n as usize]).collect();
        let a = 0.5 * (p[1] - p[0]).cross(&(p[2] - p[0])).norm();
        let middle = Point3::from((p[0].coords + p[1].coords + p[2].coords) / 3.0);
        area += a;
        for (share, part) in share.iter_mut().zip(parts) {
            *share += if part(&middle) { a } else { 0.0 };
        }
    }
    let mut unit = numbers(9);
    let samples: Vec<Point3> = (0..60_000).map(|_| Kidney.surface_sample(&mut unit)).collect();
    for (i, (share, part)) in share.iter().zip(parts).enumerate() {
        let found = samples.iter().filter(|p| part(p)).count() as f64 / samples.len() as f64;
        let exact = share / area;
        // Four standard deviations (0.8 %), plus the mesh's error of 0.3 %.
        assert!((found - exact).abs() < 0.011, "part {i}: {found} for {exact}");
    }
}

#[test]
fn kidney_map_and_box() {
    let [min, max] = Kidney.bounds();
    let size = (max - min) * 1e3;
    assert!((size - Vector3::new(40.0, 75.0, 30.0)).norm() < 1e-12);
    assert!((Kidney.volume() * 1e9 / (4.0 / 3.0 * std::f64::consts::PI * 1e4) - 1.0).abs() < 1e-14);
    let p = Point3::new(0.3, -0.5, 0.2);
    assert!((Kidney.preimage(&Kidney.map(&p)) - p).norm() < 1e-15);
    // The hilum: x = 17.78 mm at y = 0, and 22.22 mm (4.44 mm more) at y = 32.5 mm.
    assert!((Kidney.map(&Point3::new(1.0, 0.0, 0.0)).x - 0.16 / 9.0).abs() < 1e-17);
    assert!(Kidney.inside(&Point3::new(0.0222, 0.0375 * 0.75f64.sqrt(), 0.0)));
    assert!(!Kidney.inside(&Point3::new(0.0222, 0.0, 0.0)));
}

#[test]
fn surface_samples_divide_by_area() {
    let mut unit = numbers(5);
    let mut share = |shape: &dyn Shape, part: &dyn Fn(&Point3) -> bool| {
        (0..20_000).filter(|_| part(&shape.surface_sample(&mut unit))).count() as f64 / 20_000.0
    };
    let cylinder = Cylinder { radius: 0.2, height: 0.5 };
    let shell = SphereShell { inner: 0.3, outer: 0.5 };
    let cuboid = Cuboid { min: Point3::origin(), max: Point3::new(2.0, 0.7, 0.8) };
    let found = [
        (share(&cylinder, &|p| p.z > 0.0 && p.z < 0.5), 0.5 / 0.7),
        (share(&cylinder, &|p| p.z == 0.5), 0.1 / 0.7),
        (share(&shell, &|p| p.coords.norm() < 0.4), 0.09 / 0.34),
        (share(&cuboid, &|p| p.x == 0.0), 0.56 / (2.0 * (1.4 + 1.6 + 0.56))),
        (share(&cuboid, &|p| p.z == 0.8), 1.4 / (2.0 * (1.4 + 1.6 + 0.56))),
    ];
    for (found, exact) in found {
        // Four standard deviations of 20 000 draws.
        assert!((found - exact).abs() < 0.0142, "{found} for {exact}");
    }
}

#[test]
fn sizes_spend_the_nodes_where_the_error_is() {
    let body = Cuboid { min: Point3::origin(), max: Point3::new(1.0, 1.0, 1.0) };
    let even = cloud(&body, 400, 1, &[]).unwrap();
    // An error that is a hundred times larger in one corner than elsewhere, and a uniform error.
    let corner: Vec<f64> =
        even.points.iter().map(|p| if p.coords.norm() < 0.4 { 1.0 } else { 0.01 }).collect();
    let refined = |error: &[f64], ratio: f64| {
        let sizes = Sizes::new(&even, error, ratio).unwrap();
        assert!(sizes.finest() >= 1.0 / ratio * (1.0 - 1e-12));
        let made = cloud_of_sizes(&body, 400, 1, &sizes).unwrap();
        assert_eq!(made, cloud_of_sizes(&body, 400, 1, &sizes).unwrap());
        assert_eq!(made.points.len(), 400);
        made.points.iter().filter(|p| p.coords.norm() < 0.4).count()
    };
    let before = even.points.iter().filter(|p| p.coords.norm() < 0.4).count();
    assert!(refined(&corner, 3.0) > 2 * before, "{before}, {}", refined(&corner, 3.0));
    // A ratio of 1 forces a uniform spacing.
    assert!(refined(&corner, 1.0).abs_diff(before) <= before / 3, "{before}, {}", refined(&corner, 1.0));
    assert!(refined(&vec![0.0; 400], 3.0).abs_diff(before) <= before / 2);
}

/// Samples of the half kidney are uniform on its face, by area, and on its rim, by length.
#[test]
fn half_kidney_samples_are_uniform() {
    let mut unit = numbers(11);
    let mesh = tissuebench_geometry::generate::half_kidney_mesh(
        CellKind::Tet4,
        8,
        tissuebench_geometry::generate::Drawn::Strongly,
    )
    .unwrap();
    let area = |group| -> f64 {
        let facets = mesh.group(group).unwrap().iter();
        let corners = facets.map(|&f| mesh.facet_nodes(f).map(|n| mesh.points()[n as usize]).collect());
        corners.map(|p: Vec<Point3>| 0.5 * (p[1] - p[0]).cross(&(p[2] - p[0])).norm()).sum()
    };
    let expected = area("symmetry") / (area("symmetry") + area("surface"));
    let samples: Vec<Point3> = (0..60_000).map(|_| HalfKidney.surface_sample(&mut unit)).collect();
    let share = samples.iter().filter(|p| p.z == 0.0).count() as f64 / samples.len() as f64;
    // The standard deviation is 0.2 %; the mesh's facets lie 0.3 % inside the surface.
    assert!((share - expected).abs() < 0.01, "{share} of {expected}");

    // Length of the rim by 10,000 chords, in total and beyond y = 20 mm.
    let at = |i: usize| {
        let angle = i as f64 * std::f64::consts::TAU / 10_000.0;
        Kidney.map(&Point3::new(angle.cos(), angle.sin(), 0.0))
    };
    let chords: Vec<(f64, f64)> = (0..10_000).map(|i| ((at(i + 1) - at(i)).norm(), at(i).y)).collect();
    let whole: f64 = chords.iter().map(|c| c.0).sum();
    let beyond: f64 = chords.iter().filter(|c| c.1 > 0.02).map(|c| c.0).sum();
    let rim: Vec<Point3> = (0..60_000).map(|_| HalfKidney.edge_sample(&mut unit).unwrap()).collect();
    assert!(rim.iter().all(|p| p.z == 0.0 && HalfKidney.level(p).abs() < 1e-12));
    let share = rim.iter().filter(|p| p.y > 0.02).count() as f64 / rim.len() as f64;
    assert!((share - beyond / whole).abs() < 0.01, "{share} of {}", beyond / whole);
}
