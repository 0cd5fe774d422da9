//! Solutions that move, vibrate or relax.

use super::*;

/// Newton's law `rho u'' = div sigma = -b`, the gradient as derivative of the displacement, and the
/// conditions at both ends, for a pull that grows all the time. Times are before and after its front returns
/// from the fixed end; points are away from the front.
#[test]
fn waves_of_a_bar_obey_newton() {
    let (pull, length, density, over) = (30.0, 1.0, 2.0, 10.0);
    for poisson in [0.0, 0.3] {
        let bar = BarWave::new(Elastic::new(YOUNG, poisson).unwrap(), pull, [length, density], over).unwrap();
        assert!(bar.displacement(&Point3::new(length, 0.0, 0.0)).x == 0.0, "at rest at time 0");
        let passage = length / bar.speed();
        for (passages, places) in [(0.6, [0.6, 0.9]), (1.5, [0.1, 0.8]), (7.3, [0.2, 0.9])] {
            let time = passages * passage;
            let at = |t: f64| bar.at(t).unwrap();
            let now = at(time);
            let mut largest = 0.0f64;
            for x in places.map(|x| Point3::new(x, 0.2, -0.1)) {
                let gradient = now.gradient(&x)[(0, 0)];
                let difference = slope(|p| now.displacement(p).x, &x, 0);
                assert!((difference / gradient - 1.0).abs() < 1e-9, "{passages} {x}");
                let h = 0.01 * passage;
                let [before, here, after] = [time - h, time, time + h].map(|t| at(t).displacement(&x).x);
                let inertia = density * (after - 2.0 * here + before) / (h * h);
                let divergence = slope(|p| now.stress(p)[(0, 0)], &x, 0);
                let size = pull / over / bar.speed();
                assert!((divergence - inertia).abs() < 1e-8 * size, "{passages} {x}: {divergence} {inertia}");
                assert!((divergence + now.body_force(&x).x).abs() < 1e-9 * size, "{passages} {x}");
                largest = largest.max(divergence.abs() / size);
            }
            // The velocity is constant in the overlap of the wave and its reflection.
            assert!(largest > 0.99, "{passages}: nothing is accelerated");
            assert!(now.displacement(&Point3::origin()).norm() < 1e-15);
            let end = now.traction(&Point3::new(length, 0.0, 0.0), &Vector3::x()).x;
            assert!((end - pull * time / over).abs() < 1e-12 * pull, "{passages}: {end}");
        }
    }
}

#[test]
fn a_bar_pulled_at_once_swings_to_twice_its_static_length() {
    let bar = BarWave::new(Elastic::new(20e3, 0.0).unwrap(), 100.0, [0.1, 1000.0], 0.0).unwrap();
    let end = Point3::new(0.1, 0.0, 0.0);
    let passage = 0.1 / bar.speed();
    let still = 100.0 * 0.1 / 20e3;
    for (passages, part) in [(0.0, 0.0), (0.5, 0.5), (2.0, 2.0), (3.0, 1.0), (4.0, 0.0), (6.5, 1.5)] {
        let u = bar.at(passages * passage).unwrap().displacement(&end).x;
        assert!((u - part * still).abs() < 1e-12 * still, "{passages}: {u}");
    }
}

/// Bounds of a scene's checks on a metric, in SI.
fn bounds(scene: &str, metric: &str) -> [f64; 2] {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(scene);
    let scene = load(&path).unwrap();
    let check = scene.checks.iter().find(|check| check.address.to_string() == metric).unwrap();
    match check.bound {
        Bound::Within { at_least: Some(low), at_most: Some(high) } => [low, high],
        _ => panic!("{metric} has no two bounds"),
    }
}

/// The bounds are within 0.31 % of theory on both sides; Euler and Bernoulli's beam is outside of them.
#[test]
fn the_cantilever_swings_in_timoshenkos_period() {
    let elastic = Elastic::new(20e3, 0.0).unwrap();
    let beam = VibratingCantilever { elastic, density: 1000.0, length: 0.1, side: 0.01 };
    let [low, high] =
        bounds("scenes/dynamics/cantilever-vibration.toml", "period").map(|t| t / beam.timoshenko() - 1.0);
    assert!(low < -0.0029 && low > -0.0031 && high > 0.0029 && high < 0.0031, "{low} {high}");
    // First order in the slenderness by Rayleigh's quotient: 4.648 / 2 (1 + E / (k G)) / 1200.
    let lengthening = beam.timoshenko() / beam.bernoulli() - 1.0;
    assert!((lengthening / (0.5 * 4.648 * 3.4 / 1200.0) - 1.0).abs() < 0.02, "{lengthening}");
}

/// The bounds are within 4e-4 of theory on both sides: 40 x 40 mm pressed by 5 % in 0.2 s and held to 1 s.
#[test]
fn the_plate_feels_the_force_that_is_left() {
    let elastic = Elastic::new(20e3, 0.3).unwrap();
    let exact = RelaxingCompression::new(elastic, 0.05, 0.2, [0.6, 0.4]).unwrap().at(1.0).unwrap();
    let force = -exact.stress(&Point3::origin())[(2, 2)] * 0.04 * 0.04;
    let [low, high] = bounds("scenes/dynamics/relaxation.toml", "tool-force").map(|f| f / force - 1.0);
    assert!(low < -3e-4 && low > -4e-4 && high > 3e-4 && high < 4.5e-4, "{low} {high}");
}

/// The stress equals the convolution `K tr(d) I + 2 mu integral (1 - g + g exp(-(t - s) / tau)) dev d'(s)
/// ds`, computed by the trapezoidal rule on 4000 steps. The sides are free, and the plates carry the
/// pressure.
#[test]
fn relaxing_compression_is_the_convolution_of_its_past() {
    let elastic = Elastic::new(20e3, 0.3).unwrap();
    let (strain, over, share, tau) = (0.05, 0.2, 0.6, 0.4);
    let exact = RelaxingCompression::new(elastic, strain, over, [share, tau]).unwrap();
    let strains = |t: f64| exact.at(t).unwrap().gradient(&Point3::origin());
    let deviator = |h: &Matrix3| h - Matrix3::identity() * (h.trace() / 3.0);
    for time in [0.1, 0.2, 0.7, 3.0] {
        let steps = 4000;
        let dt = time / steps as f64;
        let kernel = |s: f64| 1.0 - share + share * (-(time - s) / tau).exp();
        let past: Matrix3 = (0..steps)
            .map(|k| {
                let (from, to) = (k as f64 * dt, (k + 1) as f64 * dt);
                deviator(&(strains(to) - strains(from))) * (0.5 * (kernel(from) + kernel(to)))
            })
            .sum();
        let now = strains(time);
        let stress = Matrix3::identity() * (elastic.bulk() * now.trace()) + past * (2.0 * elastic.mu());
        let stated = exact.at(time).unwrap().stress(&Point3::origin());
        assert!((stress - stated).norm() < 1e-6 * stated.norm(), "{time}: {stress} {stated}");
    }
    // After a sudden load the initial state is that of Hooke's law.
    let at_once = RelaxingCompression::new(elastic, strain, 0.0, [share, tau]).unwrap();
    let hooke = UniaxialCompression::new(elastic, strain);
    let x = Point3::new(0.1, 0.2, 0.3);
    assert!((at_once.displacement(&x) - hooke.displacement(&x)).norm() < 1e-16);
    assert!((at_once.stress(&x) - hooke.stress(&x)).norm() < 1e-9);
}

/// `omega^2 = 2 pi^2 mu / (rho L^2)` for any Poisson's ratio; no traction anywhere on the surface; three
/// modes, whose Gram matrix follows from the integral of `sin`.
#[test]
fn lames_cube_is_free() {
    let (side, density) = (2.0, 3.0);
    for poisson in [0.0, 0.3, 0.495] {
        let elastic = Elastic::new(YOUNG, poisson).unwrap();
        let cube = LameCube::new(elastic, side, density, 0.1).unwrap();
        let vibrations = cube.vibrations().unwrap();
        let squared = 2.0 * std::f64::consts::PI.powi(2) * elastic.mu() / (density * side * side);
        assert!((vibrations.omega().powi(2) / squared - 1.0).abs() < 1e-14);
        assert_eq!(vibrations.lowest(5), None);
        let inside = elastic.mu() * cube.gradient(&Point3::new(1.0, 1.0, 1.0)).norm();
        for (a, b) in [(0.3, 1.1), (1.7, 0.6), (1.0, 1.0)] {
            for axis in 0..3 {
                for (end, sign) in [(0.0, -1.0), (side, 1.0)] {
                    let mut x = Point3::new(a, b, a + 0.1);
                    x[axis] = end;
                    let force = cube.traction(&x, &(Vector3::ith(axis, 1.0) * sign));
                    assert!(force.norm() < 1e-14 * inside, "{poisson} {x}: {force}");
                }
            }
        }
        // After a quarter of a period the body is at rest; after half a period the displacement is reversed.
        let period = 2.0 * std::f64::consts::PI / vibrations.omega();
        let x = Point3::new(0.3, 1.7, 0.4);
        assert!(cube.at(0.25 * period).unwrap().displacement(&x).norm() < 1e-16);
        let opposite = cube.at(0.5 * period).unwrap().displacement(&x) + cube.displacement(&x);
        assert!(opposite.norm() < 1e-15);
    }
    let cube = LameCube::new(Elastic::new(YOUNG, 0.3).unwrap(), side, density, 0.1).unwrap();
    let middles = |n: usize| (0..n).map(move |i| side * (i as f64 + 0.5) / n as f64);
    let mut gram = Matrix3::zeros();
    for x in middles(16) {
        for y in middles(16) {
            for z in middles(16) {
                let u = Matrix3::from_columns(&cube.shapes(&Point3::new(x, y, z)));
                gram += u.transpose() * u;
            }
        }
    }
    let ratio = gram[(0, 1)] / gram[(0, 0)];
    assert!((ratio + 4.0 / std::f64::consts::PI.powi(2)).abs() < 2e-3, "{ratio}");
}

/// The lowest frequencies of a box of 4 x 3 x 2 pi, counted by hand: `|k|^2` are sums of `i^2/16, j^2/9,
/// l^2/4`.
#[test]
fn modes_of_a_box_on_rollers_are_counted() {
    let pi = std::f64::consts::PI;
    // mu = 4, lambda + 2 mu = 12 at nu = 0.25: with rho = 4, shear waves at speed 1 and compression at
    // sqrt(3).
    let elastic = Elastic::new(10.0, 0.25).unwrap();
    let size = [4.0 * pi, 3.0 * pi, 2.0 * pi];
    let body = RollerBox::new(elastic, size, 4.0, 0.1).unwrap();
    let squares: Vec<f64> = body.lowest(12).unwrap().iter().map(|w| w * w).collect();
    let (x, y, z) = (1.0 / 16.0, 1.0 / 9.0, 1.0 / 4.0);
    let expected = [
        x + y,       // shear (1, 1, 0): 0.174
        3.0 * x,     // compression (1, 0, 0): 0.188
        x + z,       // shear (1, 0, 1): 0.313
        3.0 * y,     // compression (0, 1, 0): 0.333
        4.0 * x + y, // shear (2, 1, 0): 0.361
        y + z,       // shear (0, 1, 1): 0.361
        x + y + z,   // shear (1, 1, 1), twice: 0.424
        x + y + z,
        4.0 * x + z,     // shear (2, 0, 1): 0.5
        x + 4.0 * y,     // shear (1, 2, 0): 0.507
        3.0 * (x + y),   // compression (1, 1, 0): 0.521
        4.0 * x + y + z, // shear (2, 1, 1), twice: 0.611
    ];
    for (found, expected) in squares.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{squares:?}");
    }
    assert!((body.omega() - squares[0].sqrt()).abs() < 1e-14);
    // Near incompressibility compression waves are far above shear waves; the search for many modes still
    // ends.
    let stiff = RollerBox::new(Elastic::new(10.0, 0.4999).unwrap(), size, 4.0, 0.1).unwrap();
    assert_eq!(stiff.lowest(100).unwrap().len(), 100);
    // In a slender box the first mode is compression along its length.
    let slender = RollerBox::new(elastic, [1.0, 5.0, 0.5], 4.0, 0.1).unwrap();
    assert!((slender.omega() / (3.0f64.sqrt() * pi / 5.0) - 1.0).abs() < 1e-14);
    // Nothing moves through the walls, and no shear acts on them.
    for body in [body, slender] {
        let [a, b, c] = if body == slender { [1.0, 5.0, 0.5] } else { size };
        for x in [Point3::new(a, 0.3 * b, 0.7 * c), Point3::new(0.0, 0.6 * b, 0.2 * c)] {
            let (u, stress) = (body.displacement(&x), body.stress(&x));
            let scale = stress.norm() + elastic.mu() * 0.1;
            assert!(u.x.abs() < 1e-15 && stress[(0, 1)].abs() + stress[(0, 2)].abs() < 1e-13 * scale);
        }
    }
}
