//! Closed surfaces of unlike shape through `init` and `run`, with defaults: no method fails.

mod common;

use std::f64::consts::TAU;

use common::implicit::{Vector, ellipsoid, length, rod, surface, turned, union};
use common::{inside, objects, tissuebench, write};

/// Makes a scene of the surface and runs it.
fn runs(name: &str, stl: &str) {
    let dir = tempfile::tempdir().unwrap();
    let file = write(&dir, &format!("{name}.stl"), stl);
    let scene = inside(&dir, &format!("{name}.toml"));
    let done = tissuebench(&["init", "--file", &file, "--out", &scene]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let done = tissuebench(&["run", &scene, "--once", "--format", "json"]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let runs = objects(&done.stdout);
    assert_eq!(runs.len(), 9, "{}", done.stdout);
    for run in &runs {
        let value = |metric: &str| run["metrics"][metric]["value"].as_f64().unwrap();
        let (force, load) = (value("tool-force"), value("load-carried"));
        assert!(force > 0.0 && load == 1.0, "{force} N at {load} of the load: {run}");
    }
    for warning in ["tool-untouched", "probe-outside", "tool-inside", "deep-penetration"] {
        assert!(!done.stderr.contains(warning), "{}", done.stderr);
    }
}

/// A tube along a curve.
fn tube(p: Vector, curve: impl Fn(f64) -> Vector, radii: [f64; 2], pieces: usize) -> f64 {
    let at = |k: usize| k as f64 / pieces as f64;
    let radius = |t: f64| radii[0] + t * (radii[1] - radii[0]);
    let piece = |k: usize| {
        let [from, to] = [at(k), at(k + 1)];
        rod(p, [curve(from), curve(to)], [radius(from), radius(to)])
    };
    (0..pieces).map(piece).fold(f64::MAX, f64::min)
}

/// A direction in the plane of x and y, times a length.
fn towards(angle: f64, length: f64) -> Vector {
    [length * angle.cos(), length * angle.sin(), 0.0]
}

/// A test for each surface.
macro_rules! surfaces {
    ($($(#[$attribute:meta])? $name:ident: |$p:ident| $inside:expr, $low:expr, $high:expr, $cells:expr;)*) => {$(
        #[test]
        $(#[$attribute])?
        fn $name() {
            let inside = |$p: Vector| -> f64 { $inside };
            runs(stringify!($name), &surface(&inside, [$low, $high], $cells));
        }
    )*};
}

surfaces! {
    ring: |p| length([length([p[0], p[1], 0.0]) - 30.0, p[2], 0.0]) - 9.0,
        [-42.0, -42.0, -12.0], [42.0, 42.0, 12.0], 40;
    dumbbell: |p| union([25.0, -25.0].map(|z| ellipsoid(p, [0.0, 0.0, z], [15.0; 3]))
        .into_iter().chain([rod(p, [[0.0, 0.0, -25.0], [0.0, 0.0, 25.0]], [3.0; 2])]), 3.0),
        [-18.0, -18.0, -43.0], [18.0, 18.0, 43.0], 40;
    starfish: |p| union((0..5).map(|k| rod(p, [[0.0; 3], towards(f64::from(k) * TAU / 5.0, 45.0)], [8.0, 2.0]))
        .chain([ellipsoid(p, [0.0; 3], [12.0, 12.0, 6.0])]), 5.0),
        [-55.0, -55.0, -15.0], [55.0, 55.0, 15.0], 60;
    bean: |p| ellipsoid([p[0] - 0.012 * p[1] * p[1], p[1], p[2]], [0.0; 3], [18.0, 35.0, 15.0]),
        [-22.0, -38.0, -18.0], [36.0, 38.0, 18.0], 32;
    dented_box: |p| (0..3).map(|x| p[x].abs() - [25.0, 20.0, 15.0][x]).fold(f64::MIN, f64::max)
        .max(18.0 - length([p[0] - 4.0, p[1], p[2] - 22.0])),
        [-28.0, -23.0, -18.0], [28.0, 23.0, 18.0], 36;
    two_lobes: |p| union([ellipsoid(p, [20.0, 0.0, 10.0], [22.0, 16.0, 30.0]), ellipsoid(p, [-20.0, 0.0, 5.0], [20.0, 16.0, 26.0])], 5.0),
        [-46.0, -20.0, -26.0], [46.0, 20.0, 44.0], 36;
    tongue: |p| union([ellipsoid(p, [0.0; 3], [40.0, 20.0, 9.0]), ellipsoid(p, [-30.0, 0.0, -18.0], [16.0, 15.0, 26.0])], 10.0),
        [-50.0, -24.0, -48.0], [44.0, 24.0, 14.0], 40;
    bowl: |p| ((length(p) - 26.0).abs() - 5.0).max(p[2] - 4.0),
        [-34.0, -34.0, -34.0], [34.0, 34.0, 8.0], 40;
    bone: |p| union([rod(p, [[0.0, 0.0, -150.0], [0.0, 0.0, 130.0]], [13.0, 12.0]), ellipsoid(p, [-35.0, 0.0, 155.0], [20.0; 3]),
        rod(p, [[0.0, 0.0, 130.0], [-30.0, 0.0, 150.0]], [12.0, 11.0]), ellipsoid(p, [-16.0, 0.0, -165.0], [17.0, 22.0, 18.0]),
        ellipsoid(p, [18.0, 0.0, -165.0], [17.0, 22.0, 18.0])], 8.0),
        [-62.0, -28.0, -190.0], [42.0, 28.0, 182.0], 84;
    #[ignore = "takes as long as all others together: cargo xtask nightly"]
    spiral: |p| tube(p, |t| { let [x, y, _] = towards(9.0 * t, 20.0 - 16.0 * t); [x, y, 47.0 * t] }, [9.0, 2.0], 24),
        [-32.0, -32.0, -12.0], [32.0, 32.0, 52.0], 44;
    animal: |p| union([ellipsoid(p, [0.0; 3], [32.0, 13.0, 14.0]), rod(p, [[28.0, 0.0, 5.0], [42.0, 0.0, 20.0]], [6.0, 5.0]),
        ellipsoid(p, [48.0, 0.0, 22.0], [10.0, 6.0, 6.0]), rod(p, [[-30.0, 0.0, 6.0], [-46.0, 3.0, -14.0]], [2.2, 1.2])]
        .into_iter()
        .chain([[22.0, 8.0], [22.0, -8.0], [-22.0, 8.0], [-22.0, -8.0]]
            .map(|[x, y]| rod(p, [[x, y, -5.0], [x, 1.1 * y, -34.0]], [5.0, 3.0]))), 4.0),
        [-55.0, -25.0, -42.0], [65.0, 25.0, 42.0], 64;
}

/// A plate from the side meets the rim of a coarse mesh.
#[test]
fn cone() {
    runs("cone", &turned(&[[8.0, 0.0], [0.0, 34.0]], 32));
}

#[test]
fn vase() {
    runs("vase", &turned(&[[14.0, 0.0], [24.0, 20.0], [8.0, 45.0], [11.0, 60.0]], 20));
}
