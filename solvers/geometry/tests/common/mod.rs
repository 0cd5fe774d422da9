//! Closed-form closed surfaces for tests.
#![allow(dead_code)] // each test takes some

use tissuebench_geometry::surface::Soup;
use tissuebench_geometry::{Point3, Surface, Vector3};

/// A sphere of 8 * 4^levels triangles, with `map` applied to its unit vectors.
pub fn sphere_like(levels: u32, map: impl Fn(Vector3) -> Vector3) -> Soup {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z(), -Vector3::x(), -Vector3::y(), -Vector3::z()];
    let mut points: Vec<Vector3> = axes.to_vec();
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut finer = Vec::new();
        for t in &triangles {
            let m = [0, 1, 2].map(|i| {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    points.push((points[a as usize] + points[b as usize]).normalize());
                    points.len() as u32 - 1
                })
            });
            finer.extend([[t[0], m[0], m[2]], [m[0], t[1], m[1]], [m[2], m[1], t[2]], m]);
        }
        triangles = finer;
    }
    let faces = (1..=triangles.len() as u32).collect();
    let points = points.into_iter().map(|p| Point3::from(map(p))).collect();
    Soup { points, triangles, faces, ..Soup::default() }
}

/// An organ-like surface with bumps and a hilum.
pub fn bumpy(levels: u32) -> Soup {
    sphere_like(levels, |n| {
        let radius = 1.0 + 0.12 * (5.0 * n.x).sin() * (4.0 * n.y).cos() + 0.08 * (7.0 * n.z).sin()
            - 0.35 * (-8.0 * (n - Vector3::x()).norm_squared()).exp();
        Vector3::new(1.4 * n.x, n.y, 0.8 * n.z) * radius
    })
}

/// A torus with the radii 1 and `tube`, of 2 * around * across triangles.
pub fn torus(tube: f64, around: u32, across: u32) -> Soup {
    let mut soup = Soup::default();
    let turn = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    for i in 0..around {
        for j in 0..across {
            let (u, v) = (turn(i, around), turn(j, across));
            let r = 1.0 + tube * v.cos();
            soup.points.push(Point3::new(r * u.cos(), r * u.sin(), tube * v.sin()));
            let at = |i: u32, j: u32| (i % around) * across + j % across;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    soup.faces = (1..=soup.triangles.len() as u32).collect();
    soup
}

/// A block of twelve triangles with a corner at the origin.
pub fn block(size: [f64; 3]) -> Soup {
    let points = (0..8).map(|i| {
        let end = |axis: usize| if i >> axis & 1 == 1 { size[axis] } else { 0.0 };
        Point3::new(end(0), end(1), end(2))
    });
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Soup { points: points.collect(), triangles, faces: (1..=12).collect(), ..Soup::default() }
}

/// Two soups merged into one soup.
pub fn joined(a: Soup, b: Soup) -> Soup {
    let (first, count) = (a.points.len() as u32, a.triangles.len() as u32);
    let mut all = a;
    all.points.extend(b.points);
    all.triangles.extend(b.triangles.iter().map(|t| t.map(|p| p + first)));
    all.faces.extend((1..=b.triangles.len() as u32).map(|face| count + face));
    all
}

/// The soup, translated.
pub fn moved(mut soup: Soup, by: [f64; 3]) -> Soup {
    soup.points.iter_mut().for_each(|p| *p += Vector3::from(by));
    soup
}

/// A valid surface of the soup, with lengths in metres.
pub fn surface(soup: Soup) -> Surface {
    Surface::new(soup, 1.0).unwrap_or_else(|bad| panic!("{bad}"))
}

/// A sphere whose corners are moved outwards by a random distance of up to `by`.
pub fn jagged(levels: u32, by: f64, seed: u64) -> Soup {
    let mut state = seed;
    let mut soup = sphere_like(levels, |n| n);
    for p in &mut soup.points {
        // Knuth's linear congruential generator gives the same numbers on every platform.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *p *= 1.0 + by * ((state >> 11) as f64 / (1u64 << 53) as f64);
    }
    soup
}

/// A body of revolution about z, from -2.5 to 2.5, with a positive radius between the ends.
pub fn turned(along: u32, around: u32, radius: impl Fn(f64) -> f64) -> Soup {
    let mut soup = Soup::default();
    soup.points.push(Point3::new(0.0, 0.0, -2.5));
    for i in 1..along {
        let z = -2.5 + 5.0 * f64::from(i) / f64::from(along);
        for j in 0..around {
            let angle = std::f64::consts::TAU * f64::from(j) / f64::from(around);
            soup.points.push(Point3::new(radius(z) * angle.cos(), radius(z) * angle.sin(), z));
        }
    }
    soup.points.push(Point3::new(0.0, 0.0, 2.5));
    let at = |i: u32, j: u32| 1 + (i - 1) * around + j % around;
    let last = soup.points.len() as u32 - 1;
    for j in 0..around {
        soup.triangles.push([0, at(1, j + 1), at(1, j)]);
        for i in 1..along - 1 {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
        soup.triangles.push([at(along - 1, j), at(along - 1, j + 1), last]);
    }
    soup.faces = (1..=soup.triangles.len() as u32).collect();
    soup
}
