//! Laws in principal stretches and homogeneous states: properties of every isotropic law.

use tissuebench_cases::exact::{
    Elastic, Exact as _, FiniteBending, Hertz, Homogeneous, Hyperelastic, Inflation, Matrix3, Point3,
    PressedStrip, Vector3,
};

const YOUNG: f64 = 20e3;

fn laws(poisson: f64) -> [Hyperelastic; 7] {
    let elastic = Elastic::new(YOUNG, poisson).unwrap();
    let (mu, bulk) = (elastic.mu(), elastic.bulk());
    let rest = Box::new(Hyperelastic::MooneyRivlin { c10: 0.3 * mu, c01: 0.2 * mu, bulk: 0.0 });
    [
        Hyperelastic::SaintVenantKirchhoff(elastic),
        Hyperelastic::NeoHookean(elastic),
        Hyperelastic::Hencky(elastic),
        Hyperelastic::MooneyRivlin { c10: 0.3 * mu, c01: 0.2 * mu, bulk },
        Hyperelastic::Ogden { terms: vec![(0.4 * mu, 3.0), (-0.4 * mu, -2.0)], bulk },
        Hyperelastic::LogarithmicVolume { rest: rest.clone(), bulk },
        Hyperelastic::SimoTaylorVolume { rest, bulk },
    ]
}

#[test]
fn principal_stresses_derive_from_an_energy() {
    // dP_a/dl_b = dP_b/dl_a, by central differences with step 1e-5: truncation 1e-10, rounding 1e-11.
    let (at, h) = ([1.4, 0.7, 1.1], 1e-5);
    for law in laws(0.4) {
        let slope = |a: usize, b: usize| {
            let shifted = |s: f64| {
                let mut l = at;
                l[b] += s;
                law.principal_stress(l)[a]
            };
            (shifted(h) - shifted(-h)) / (2.0 * h)
        };
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let gap = (slope(a, b) - slope(b, a)).abs();
            assert!(gap < 1e-8 * slope(a, b).abs().max(YOUNG), "{law:?}: {gap:e}");
        }
    }
}

#[test]
fn small_strains_follow_hooke() {
    let elastic = Elastic::new(YOUNG, 0.4).unwrap();
    let strain = Vector3::new(1e-6, -2e-6, 0.5e-6);
    let hooke = elastic.stress(&Matrix3::from_diagonal(&strain));
    for law in laws(0.4) {
        let found = law.principal_stress([0, 1, 2].map(|a| 1.0 + strain[a]));
        for a in 0..3 {
            assert!(
                (found[a] - hooke[(a, a)]).abs() < 1e-5 * hooke.norm(),
                "{law:?}: {} {}",
                found[a],
                hooke
            );
        }
    }
}

#[test]
fn simple_shear_keeps_rivlins_relation() {
    // sigma_xx - sigma_yy = g sigma_xy for every isotropic elastic law (Rivlin 1948); J = 1.
    for law in laws(0.4) {
        for shear in [0.01, 0.5, 1.5] {
            let state = Homogeneous::simple_shear(&law, shear);
            let cauchy = state.stress * state.deformation.transpose();
            assert!((cauchy - cauchy.transpose()).norm() < 1e-13 * cauchy.norm(), "{law:?}: {cauchy}");
            let gap = cauchy[(0, 0)] - cauchy[(1, 1)] - shear * cauchy[(0, 1)];
            assert!(gap.abs() < 1e-12 * cauchy.norm(), "{law:?} at {shear}: {gap:e}");
        }
    }
}

#[test]
fn free_slip_has_free_sides_and_the_known_lateral_stretches() {
    let poisson = 0.4;
    for law in laws(poisson) {
        for stretch in [0.5, 0.9, 1.0, 1.5] {
            let state = Homogeneous::free_slip(&law, stretch).unwrap();
            let m = state.deformation[(0, 0)];
            let side = law.principal_stress([m, m, stretch])[0];
            assert!(side.abs() < 1e-13 * YOUNG / (1.0 - 2.0 * poisson), "{law:?} at {stretch}: {side:e}");
            // Bars under uniaxial stress: l_t = l^(-nu), and E_t = -nu E.
            let known = match law {
                Hyperelastic::Hencky(_) => stretch.powf(-poisson),
                Hyperelastic::SaintVenantKirchhoff(_) => (1.0 - poisson * (stretch * stretch - 1.0)).sqrt(),
                _ => continue,
            };
            assert!((m - known).abs() < 1e-14, "{law:?} at {stretch}: {m} for {known}");
        }
    }
}

#[test]
fn a_bar_pulled_to_nothing_is_refused() {
    let [saint_venant, ..] = laws(0.4);
    // 1 + 1 / nu = 3.5
    assert!(Homogeneous::free_slip(&saint_venant, 1.86).is_some_and(|s| s.deformation[(0, 0)] < 0.13));
    assert_eq!(Homogeneous::free_slip(&saint_venant, 1.88), None);
}

#[test]
fn hertz_balances_its_far_field() {
    let elastic = Elastic::new(YOUNG, 0.3).unwrap();
    let radius = 0.01;
    let depth = 1e-5;
    let hertz = Hertz::new(elastic, radius, depth).unwrap();
    // F = (2/3) p0 pi a^2 (Johnson, eq. 4.23) is the resultant of the pressure.
    let resultant = 2.0 / 3.0 * hertz.peak_pressure() * std::f64::consts::PI * hertz.contact_radius().powi(2);
    assert!((resultant / hertz.force() - 1.0).abs() < 1e-14);
    // Tractions of the far field on a half sphere of radius L, by differences with step 1e-4 L and midpoint
    // sums.
    let (length, n) = (0.02, 400);
    let h = 1e-4 * length;
    let mut force = 0.0;
    for k in 0..n {
        let angle = 0.5 * std::f64::consts::PI * (k as f64 + 0.5) / n as f64;
        let normal = Vector3::new(angle.sin(), 0.0, -angle.cos());
        let x = Point3::from(normal * length);
        let slope = |axis: usize| {
            let step = Vector3::from_fn(|a, _| if a == axis { h } else { 0.0 });
            (hertz.displacement(&(x + step)) - hertz.displacement(&(x - step))) / (2.0 * h)
        };
        let stress = elastic.stress(&Matrix3::from_columns(&[slope(0), slope(1), slope(2)]));
        let ring = 2.0 * std::f64::consts::PI * length * length * angle.sin() * 0.5 * std::f64::consts::PI
            / n as f64;
        force += (stress * normal).z * ring;
    }
    assert!((force / hertz.force() - 1.0).abs() < 1e-5, "{force} for {}", hertz.force());
    assert!(Hertz::new(elastic, 0.0, depth).is_err() && Hertz::new(elastic, radius, f64::NAN).is_err());
}

#[test]
fn bent_blocks_balance_their_moments_and_keep_the_volume_when_nearly_incompressible() {
    let (thickness, curvature) = (0.01, 50.0);
    let law = Hyperelastic::NeoHookean(Elastic::new(YOUNG, 0.49999).unwrap());
    let bent = FiniteBending::new(&law, thickness, curvature).unwrap();
    let [inner, middle, outer] = [-0.5, 0.0, 0.5].map(|s| bent.radius(s * thickness));
    // Rivlin: r^2 is linear in X, k (r_o^2 - r_i^2) = 2 h, and the faces are free if r_i r_o = 1 / k^2.
    let volume = curvature * (outer * outer - inner * inner) / (2.0 * thickness);
    assert!((volume - 1.0).abs() < 1e-4, "{volume}");
    assert!((middle * middle / (0.5 * (inner * inner + outer * outer)) - 1.0).abs() < 1e-5, "{middle}");
    assert!((inner * outer * curvature * curvature - 1.0).abs() < 1e-4, "{inner} {outer}");
    // The resultant force vanishes: P_t sums to zero over the thickness, because both faces are free
    // (Simpson).
    let law = Hyperelastic::NeoHookean(Elastic::new(YOUNG, 0.3).unwrap());
    let bent = FiniteBending::new(&law, thickness, curvature).unwrap();
    let stress = |s: f64| {
        let (x, h) = (s * thickness, 1e-5 * thickness);
        let radial = (bent.radius(x + h) - bent.radius(x - h)) / (2.0 * h);
        law.principal_stress([radial, curvature * bent.radius(x), 1.0])[1]
    };
    let n = 50;
    let sum: f64 = (0..n)
        .map(|k| {
            [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)].map(|(t, w)| w * stress((k as f64 + t) / n as f64 - 0.5))
        })
        .map(|s| s.iter().sum::<f64>() / (6.0 * n as f64))
        .sum();
    assert!(sum.abs() < 1e-6 * YOUNG && stress(0.5) > 0.1 * YOUNG, "{sum} {}", stress(0.5));
    assert!(FiniteBending::new(&law, thickness, 101.0).is_err());
}

#[test]
fn inflated_walls_have_the_pressure_of_the_incompressible_closed_forms() {
    // Radii A = 10 mm and B = 20 mm with a = 1.3 A. The pressure is the integral of W' / (l^(m+1) - 1) over the
    // hoop stretches from B to A: neo-Hookean sphere 2 mu [-1/l - 1/(4 l^4)], tube mu [ln l - 1/(2 l^2)].
    let elastic = Elastic::new(YOUNG, 0.499_999).unwrap();
    let (law, mu) = (Hyperelastic::NeoHookean(elastic), elastic.mu());
    let sphere = |l: f64| 2.0 * mu * (-1.0 / l - 0.25 / l.powi(4));
    let tube = |l: f64| mu * (l.ln() - 0.5 / (l * l));
    for (is_sphere, integral) in [(true, &sphere as &dyn Fn(f64) -> f64), (false, &tube)] {
        let power = if is_sphere { 3 } else { 2 };
        let outer =
            (20.0f64.powi(power) + 13.0f64.powi(power) - 10.0f64.powi(power)).powf(1.0 / f64::from(power));
        let pressure = integral(1.3) - integral(outer / 20.0);
        let inflated = Inflation::new(&law, is_sphere, [0.01, 0.02], pressure).unwrap();
        assert!((inflated.radius(0.01) / 0.013 - 1.0).abs() < 1e-5, "{}", inflated.radius(0.01));
        assert!((inflated.radius(0.02) / (1e-3 * outer) - 1.0).abs() < 1e-5, "{}", inflated.radius(0.02));
    }
}

#[test]
fn inflated_walls_balance_their_pressure_point_by_point() {
    let (inner, outer, pressure, h) = (0.4, 1.2, 0.1 * YOUNG, 1e-3);
    for law in laws(0.3) {
        for is_sphere in [true, false] {
            let inflated = Inflation::new(&law, is_sphere, [inner, outer], pressure).unwrap();
            let x = Point3::new(0.31, 0.42, if is_sphere { -0.2 } else { 0.7 });
            let slope = |field: &dyn Fn(&Point3) -> Vector3, axis: usize| {
                let step = Vector3::ith(axis, h);
                (field(&(x + step)) - field(&(x - step))) / (2.0 * h)
            };
            let columns = [0, 1, 2].map(|j| slope(&|p| inflated.displacement(p), j));
            let off = (Matrix3::from_columns(&columns) - inflated.gradient(&x)).norm();
            assert!(off < 1e-5, "{law:?}: gradient off by {off:e}");
            let divergence: Vector3 =
                (0..3).map(|j| slope(&|p| inflated.traction(p, &Vector3::ith(j, 1.0)), j)).sum();
            assert!(divergence.norm() < 1e-3 * pressure / inner, "{law:?}: {divergence}");
            // The Cauchy stress on the walls.
            for (radius, expected) in [(inner, -pressure), (outer, 0.0)] {
                let stress = inflated.stress(&Point3::new(0.6 * radius, 0.8 * radius, 0.0));
                let out = Vector3::new(0.6, 0.8, 0.0);
                let off = (stress * out - out * expected).norm();
                assert!(off < 1e-7 * pressure, "{law:?} at {radius}: off by {off:e}");
            }
        }
    }
}

#[test]
fn a_pressure_beyond_the_limit_point_has_no_equilibrium() {
    // Limit pressure 1.5185 kPa at an inner stretch of 1.49, from a search over the inner radius.
    let law = Hyperelastic::NeoHookean(Elastic::new(20e3, 0.45).unwrap());
    let at = |pressure: f64| Inflation::new(&law, true, [0.01, 0.012], pressure);
    let stretch = at(1518.0).unwrap().radius(0.01) / 0.01;
    assert!((1.4..1.49).contains(&stretch), "{stretch}");
    let refused = at(1519.0).unwrap_err().to_string();
    assert!(refused.contains("below the limit point"), "{refused}");
    assert!(at(-1.0).is_err() && Inflation::new(&law, true, [0.01, 0.01], 1.0).is_err());
}

#[test]
fn a_wall_that_collapses_under_the_pressure_is_refused() {
    // The radial stress of Saint-Venant and Kirchhoff's law has a maximum under compression: this sphere carries
    // 3.66 kPa, and its equations have other, spurious roots above it.
    let law = Hyperelastic::SaintVenantKirchhoff(Elastic::new(30e3, 0.3).unwrap());
    let at = |pressure: f64| Inflation::new(&law, true, [0.01, 0.02], pressure);
    let moved = at(3500.0).unwrap().radius(0.01) - 0.01;
    assert!((1.26e-3..1.29e-3).contains(&moved), "{moved}");
    for pressure in [3700.0, 4000.0, 6000.0] {
        assert!(at(pressure).unwrap_err().to_string().contains("below the "), "{pressure}");
    }
}

#[test]
fn a_pressed_strip_bends_as_a_beam_and_then_curls() {
    let strip = |pressure: f64| PressedStrip { young: 1e6, length: 0.1, thickness: 0.004, pressure };
    let bending = 1e6 * 0.004f64.powi(3) / 12.0;
    let small = strip(1e-3).end();
    let beam = 1e-3 * 0.1f64.powi(4) / (8.0 * bending);
    assert!((small.z / beam - 1.0).abs() < 1e-6 && small.x.abs() < 1e-4 * small.z, "{small}");
    // The scene `beam/pressed-strip`: p L^3 / (E I) = 6.
    let end = strip(32.0).end() * 1e3;
    assert!((end - Vector3::new(STRIP[0], 0.0, STRIP[1])).norm() < 1e-3, "{end}");
}

/// Displacement (mm) of the end in the scene `beam/pressed-strip`.
const STRIP: [f64; 2] = [-28.7036, 64.5099];
