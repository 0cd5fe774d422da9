//! Search compared with brute force, on points with many equal distances.

use proptest::prelude::*;
use tissuebench_geometry::{Neighbour, Point3, Search, SearchError};

fn brute(points: &[Point3], at: &Point3) -> Vec<Neighbour> {
    let mut all: Vec<(f64, u32)> = points
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let d = p - at;
            (d.x * d.x + d.y * d.y + d.z * d.z, i as u32)
        })
        .collect();
    all.sort_by(|a, b| a.partial_cmp(b).unwrap());
    all.into_iter().map(|(s, index)| Neighbour { index, distance: s.sqrt() }).collect()
}

/// A lattice, in which every query at a node has ties at 1, sqrt 2, sqrt 3, ... spacings.
fn lattice(n: usize) -> Vec<Point3> {
    let at = |c: usize| 0.1 * c as f64;
    (0..n * n * n).map(|i| Point3::new(at(i % n), at(i / n % n), at(i / n / n))).collect()
}

#[test]
fn ties_are_broken_by_index() {
    let points = lattice(6);
    let search = Search::new(&points).unwrap();
    for at in points.iter().step_by(7) {
        for k in [1, 2, 4, 7, 11, 14, 27, 100, 216, 500] {
            let expected = &brute(&points, at)[..k.min(216)];
            assert_eq!(search.nearest(at, k), expected, "k = {k}");
        }
    }
}

#[test]
fn coincident_points_are_all_found() {
    let points = vec![Point3::new(1.0, 2.0, 3.0); 300];
    let search = Search::new(&points).unwrap();
    let near: Vec<u32> = search.nearest(&points[0], 5).iter().map(|n| n.index).collect();
    assert_eq!(near, [0, 1, 2, 3, 4]);
    assert_eq!(search.within(&points[0], 0.0).len(), 300);
}

#[test]
fn edges_of_the_question() {
    let points = lattice(3);
    let search = Search::new(&points).unwrap();
    assert!(search.nearest(&points[0], 0).is_empty());
    assert_eq!(search.within(&points[0], 0.1), [0, 1, 3, 9], "the sphere itself counts");
    assert!(search.within(&points[0], -1.0).is_empty() && search.within(&points[0], f64::NAN).is_empty());
    assert_eq!(search.within(&points[0], f64::INFINITY).len(), 27);
    assert_eq!(Search::new(&[]).err(), Some(SearchError::Count { count: 0 }));
    let bad = [Point3::origin(), Point3::new(0.0, f64::NAN, 0.0)];
    assert_eq!(Search::new(&bad).err(), Some(SearchError::NotFinite { point: 1 }));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn agrees_with_brute_force(
        cloud in prop::collection::vec([-1.0..1.0f64, -1.0..1.0, -1.0..1.0], 1..200),
        at in [-1.5..1.5f64, -1.5..1.5, -1.5..1.5],
        k in 1usize..40,
        radius in 0.0..2.0f64,
    ) {
        let points: Vec<Point3> = cloud.iter().map(|&p| Point3::from(p)).collect();
        let at = Point3::from(at);
        let search = Search::new(&points).unwrap();
        let all = brute(&points, &at);
        prop_assert_eq!(&search.nearest(&at, k), &all[..k.min(points.len())]);
        let mut inside: Vec<u32> = all.iter().filter(|n| n.distance <= radius).map(|n| n.index).collect();
        inside.sort_unstable();
        prop_assert_eq!(search.within(&at, radius), inside);
    }
}
