//! One list of properties for every exact solution, and the boundary conditions specific to each.

mod moving;

use proptest::prelude::*;
use tissuebench_cases::exact::{
    BarWave, CantileverPlaneStrain, Elastic, Exact, ExactError, Hyperelastic, LameCube, Matrix3, Medium,
    Point3, PureBending, RelaxingCompression, RollerBox, SOLUTIONS, ThickSphere, Torsion,
    UniaxialCompression, Vector3, VibratingCantilever, Vibrations, exact_by_name,
};
use tissuebench_cases::scene::{Bound, load};

/// A solution's name, its parameters, and the box from which its points are drawn (for the sphere outside of
/// the hole).
type Sample = (&'static str, &'static [(&'static str, f64)], [[f64; 2]; 3]);

const UNIT: [[f64; 2]; 3] = [[-1.0, 1.0]; 3];
const SAMPLES: [Sample; 14] = [
    ("affine", &[("hxy", 0.2), ("hzz", -0.1), ("ty", 0.3)], UNIT),
    ("affine", &[], UNIT),
    ("quadratic-patch", &[("amplitude", 0.02)], UNIT),
    ("pure-bending", &[("curvature", 0.5)], UNIT),
    (
        "cantilever-plane-strain",
        &[("load", 7.0), ("length", 4.0), ("depth", 1.2)],
        [[0.0, 4.0], [-0.6, 0.6], [-1.0, 1.0]],
    ),
    (
        "saint-venant-flexure",
        &[("load", 3.0), ("length", 5.0), ("depth", 1.0), ("width", 1.0)],
        [[0.0, 5.0], [-0.45, 0.45], [-0.45, 0.45]],
    ),
    (
        "saint-venant-flexure",
        &[("load", 3.0), ("length", 5.0), ("depth", 0.6), ("width", 1.4)],
        [[0.0, 5.0], [-0.27, 0.27], [-0.65, 0.65]],
    ),
    (
        "torsion",
        &[("twist", 0.3), ("depth", 0.6), ("width", 1.4)],
        [[0.0, 5.0], [-0.27, 0.27], [-0.65, 0.65]],
    ),
    ("uniaxial-compression", &[("strain", 0.1)], UNIT),
    (
        "thick-sphere",
        &[("inner", 1.0), ("outer", 3.0), ("inner_pressure", 20.0), ("outer_pressure", 5.0)],
        [[0.6, 1.6]; 3],
    ),
    ("rigid", &[], UNIT),
    ("lame-cube", &[("side", 2.0), ("density", 3.0), ("amplitude", 0.1)], [[0.0, 2.0]; 3]),
    (
        "roller-box",
        &[("length", 2.0), ("depth", 1.6), ("width", 1.1), ("density", 3.0)],
        [[0.0, 2.0], [0.0, 1.6], [0.0, 1.1]],
    ),
    (
        "roller-box",
        &[("length", 0.7), ("depth", 2.0), ("width", 0.6), ("density", 3.0)],
        [[0.0, 0.7], [0.0, 2.0], [0.0, 0.6]],
    ),
];

/// Solutions that are at rest at time 0; separate tests check them at other times.
const IN_TIME: [&str; 2] = ["bar-wave", "relaxing-compression"];

/// Solutions of walls, which the tests of large strain check with every law.
const WALLS: [&str; 2] = ["inflated-sphere", "inflated-tube"];

/// Solutions at large strain, for a block of one metre; and a contact solution, evaluated far below the
/// contact.
const LARGE: [(&str, &[(&str, f64)]); 4] = [
    ("free-slip-stretch", &[("stretch", 0.6)]),
    ("confined-stretch", &[("stretch", 1.4)]),
    ("simple-shear", &[("shear", 0.8)]),
    ("finite-bending", &[("thickness", 1.0), ("curvature", 0.7)]),
];
const CONTACT: (&str, &[(&str, f64)]) = ("hertz", &[("radius", 1.0), ("depth", 1e-3)]);

const YOUNG: f64 = 1000.0;

fn medium(poisson: f64) -> Medium {
    Elastic::new(YOUNG, poisson).unwrap().into()
}

fn build(sample: &Sample, poisson: f64) -> Box<dyn Exact> {
    exact_by_name(sample.0, &medium(poisson), sample.1).unwrap()
}

fn place(bounds: &[[f64; 2]; 3], s: [f64; 3]) -> Point3 {
    Point3::from(Vector3::from_fn(|i, _| bounds[i][0] + s[i] * (bounds[i][1] - bounds[i][0])))
}

/// Fourth-order central difference of a field along an axis, with step 1e-3 m: exact up to quartic fields.
fn slope<T>(field: impl Fn(&Point3) -> T, x: &Point3, axis: usize) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    const H: f64 = 1e-3;
    let at = |steps: f64| {
        let mut p = *x;
        p[axis] += steps * H;
        field(&p)
    };
    (at(1.0) - at(-1.0)) * (8.0 / (12.0 * H)) - (at(2.0) - at(-2.0)) * (1.0 / (12.0 * H))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_solution_solves_its_equations(
        s in [0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64],
        poisson in prop_oneof![Just(0.0), Just(0.3), Just(0.4999), -0.5..0.5f64],
    ) {
        for sample in &SAMPLES {
            let exact = build(sample, poisson);
            let name = sample.0;
            let x = place(&sample.2, s);
            let elastic = Elastic::new(YOUNG, poisson).unwrap();
            let gradient = exact.gradient(&x);
            let size = gradient.norm();

            // The gradient is the derivative of the displacement. Rounding of u over the step: 1e-16 u /
            // 1e-3.
            let differences = Matrix3::from_columns(&[0, 1, 2].map(|j| slope(|p| exact.displacement(p), &x, j)));
            let error = (differences - gradient).norm();
            prop_assert!(error < 1e-9 * size, "{name}: gradient off by {error:e} of {size:e} at {x}");

            // Hooke's law. lambda multiplies the rounding of tr(H).
            let hooke = elastic.stress(&gradient);
            let stress = exact.stress(&x);
            let error = (hooke - stress).norm();
            let allowed = 1e-14 * (elastic.lambda().abs() + elastic.mu()) * size;
            prop_assert!(error <= allowed, "{name}: Hooke's law off by {error:e}, allowed {allowed:e}");
            prop_assert!((stress - stress.transpose()).norm() == 0.0, "{name}: unsymmetric stress");

            // Equilibrium: div sigma + b = 0, relative to the terms that cancel.
            let slopes = [0, 1, 2].map(|j| slope(|p| exact.stress(p), &x, j));
            let divergence: Vector3 = (0..3).map(|j| slopes[j].column(j).into_owned()).sum();
            let sizes: f64 = slopes.iter().map(|s| s.norm()).sum::<f64>() + stress.norm() + hooke.norm();
            let error = (divergence + exact.body_force(&x)).norm();
            prop_assert!(error <= 1e-9 * sizes + 1e-9 * allowed, "{name}: out of balance by {error:e} of {sizes:e}");

            let n = Vector3::new(0.6, 0.0, -0.8);
            prop_assert_eq!(exact.traction(&x, &n), stress * n);
        }
    }
}

#[test]
fn the_list_holds_every_solution() {
    for entry in SOLUTIONS {
        let name = entry.name;
        let large = LARGE.iter().chain([&CONTACT]).any(|s| s.0 == name);
        let elsewhere = IN_TIME.contains(&name) || WALLS.contains(&name);
        let known = SAMPLES.iter().any(|s| s.0 == name) || elsewhere || large;
        assert!(known, "{name} is not sampled");
    }
}

/// The gradient is the derivative of the displacement, `Div P = 0` with `P` from tractions of the undeformed
/// planes, and Cauchy's stress is `P F^T / J`. The radius of a bent block is a chain of a hundred cubics. The
/// second derivative of a cubic is most accurate at (3 - sqrt(3)) / 6 of its interval.
#[test]
fn solutions_at_large_strain_solve_their_equations() {
    let elastic = Elastic::new(YOUNG, 0.3).unwrap();
    for law in [Hyperelastic::NeoHookean(elastic), Hyperelastic::Hencky(elastic)] {
        let medium = Medium { elastic, law: Some(law) };
        for (name, given) in LARGE {
            let exact = exact_by_name(name, &medium, given).unwrap();
            assert!(exact.is_large_strain());
            for x in [Point3::new(0.312_113_25, 0.4, -0.2), Point3::new(-0.427_886_75, 0.9, 0.3)] {
                let gradient = exact.gradient(&x);
                let differences =
                    Matrix3::from_columns(&[0, 1, 2].map(|j| slope(|p| exact.displacement(p), &x, j)));
                assert!((differences - gradient).norm() < 1e-6, "{name}: gradient at {x}");
                let piola = |p: &Point3| {
                    Matrix3::from_columns(&[0, 1, 2].map(|j| exact.traction(p, &Vector3::ith(j, 1.0))))
                };
                let divergence: Vector3 = (0..3).map(|j| slope(piola, &x, j).column(j).into_owned()).sum();
                let size = piola(&x).norm();
                assert!(divergence.norm() < 1e-5 * size, "{name}: out of balance by {divergence} of {size}");
                let deformation = Matrix3::identity() + gradient;
                let cauchy = piola(&x) * deformation.transpose() / deformation.determinant();
                assert!((cauchy - exact.stress(&x)).norm() < 1e-12 * size, "{name}: stress at {x}");
            }
        }
    }
    // Hooke's law has no such solution, and the error says so.
    let none = exact_by_name("simple-shear", &medium(0.3), &[("shear", 0.1)]).map(|_| ()).unwrap_err();
    assert!(
        none.to_string().contains("is a large-strain solution, but the law is for small strain"),
        "{none}"
    );
}

/// Boussinesq's field below the sphere: its gradient, and `div sigma = 0`.
#[test]
fn the_field_far_from_a_contact_is_in_equilibrium() {
    let exact = exact_by_name(CONTACT.0, &medium(0.3), CONTACT.1).unwrap();
    assert!(
        exact.contact().is_some_and(|contact| contact.force > 0.0
            && (contact.area / (1e-3 * std::f64::consts::PI) - 1.0).abs() < 1e-14)
    );
    for x in [Point3::new(0.3, -0.2, -0.9), Point3::new(-1.1, 0.4, -0.3)] {
        let (gradient, stress) = (exact.gradient(&x), exact.stress(&x));
        let differences = Matrix3::from_columns(&[0, 1, 2].map(|j| slope(|p| exact.displacement(p), &x, j)));
        assert!((differences - gradient).norm() < 1e-9 * gradient.norm(), "{x}: {differences} {gradient}");
        let divergence: Vector3 =
            (0..3).map(|j| slope(|p| exact.stress(p), &x, j).column(j).into_owned()).sum();
        assert!(divergence.norm() < 1e-8 * stress.norm(), "{x}: {divergence}");
    }
}

#[test]
fn stresses_of_prescribed_loads_do_not_depend_on_poisson() {
    // Two of these solutions have stresses independent of nu. Locking is judged by these stresses, so no
    // digit may be lost.
    let x = Point3::new(0.7, 0.2, -0.4);
    for name in ["pure-bending", "uniaxial-compression"] {
        let sample = SAMPLES.iter().find(|s| s.0 == name).unwrap();
        let reference = build(sample, 0.0).stress(&x);
        for poisson in [0.3, 0.495, 0.4999, 0.499_999_99] {
            assert_eq!(build(sample, poisson).stress(&x), reference, "{name} at nu = {poisson}");
        }
    }
}

#[test]
fn pure_bending_is_a_couple() {
    let exact = PureBending::new(Elastic::new(2e4, 0.495).unwrap(), 0.5);
    let x = Point3::new(0.3, 0.02, -0.01);
    assert_eq!(exact.traction(&x, &Vector3::y()), Vector3::zeros());
    assert_eq!(exact.traction(&x, &Vector3::z()), Vector3::zeros());
    assert_eq!(exact.traction(&x, &Vector3::x()), Vector3::new(2e4 * 0.5 * 0.02, 0.0, 0.0));
    assert_eq!(exact.displacement(&Point3::new(0.08, 0.0, 0.0)).y, -0.5 * 0.5 * 0.08 * 0.08);
}

#[test]
fn plane_strain_cantilever_carries_its_load() {
    let (load, length, depth) = (1000.0, 48.0, 12.0);
    for poisson in [0.0, 0.3, 0.4999] {
        let elastic = Elastic::new(3e7, poisson).unwrap();
        let exact = CantileverPlaneStrain::new(elastic, load, length, depth).unwrap();
        let face = Point3::new(17.0, 0.5 * depth, 2.0);
        assert!(exact.traction(&face, &Vector3::y()).norm() < 1e-12 * load);
        let inner = Point3::new(17.0, 1.3, 2.0);
        let on_plane = exact.traction(&inner, &Vector3::z());
        assert_eq!((on_plane.x, on_plane.y, exact.displacement(&inner).z), (0.0, 0.0, 0.0));
        // Two Gauss points integrate the parabola exactly.
        let y = 0.5 * depth / 3f64.sqrt();
        let [low, high] = [-y, y].map(|y| exact.traction(&Point3::new(length, y, 0.0), &Vector3::x()));
        assert!((0.5 * depth * (low + high) - Vector3::new(0.0, load, 0.0)).norm() < 1e-12 * load);
        // Moment about z at the root is -P L.
        let root = [-y, y].map(|y| exact.stress(&Point3::new(0.0, y, 0.0))[(0, 0)]);
        let moment = 0.5 * depth * (root[1] - root[0]) * y;
        assert!((moment + load * length).abs() < 1e-12 * load * length);
    }
}

#[test]
fn plane_strain_cantilever_has_the_classic_tip_deflection() {
    // Plane stress with P = 1000, E = 3e7, nu = 0.3, D = 12, L = 48 gives .008533 + .000367 = .0089
    // (Timoshenko's beam data). These E and nu make plane strain the same problem: E / (1 - nu^2) = 3e7, nu /
    // (1 - nu) = 0.3.
    let poisson: f64 = 0.3 / 1.3;
    let elastic = Elastic::new(3e7 * (1.0 - poisson * poisson), poisson).unwrap();
    let exact = CantileverPlaneStrain::new(elastic, 1000.0, 48.0, 12.0).unwrap();
    let tip = exact.displacement(&Point3::new(48.0, 0.0, 0.0)).y;
    assert!((tip - 0.0089).abs() < 5e-8, "tip {tip}");
}

#[test]
fn compressed_prism_has_free_sides() {
    let exact = UniaxialCompression::new(Elastic::new(2e4, 0.4999).unwrap(), 0.1);
    let x = Point3::new(0.01, -0.02, 0.03);
    assert_eq!(exact.traction(&x, &Vector3::x()), Vector3::zeros());
    assert_eq!(exact.traction(&x, &Vector3::z()), Vector3::new(0.0, 0.0, -2e3));
    assert!((exact.displacement(&x).z + 0.003).abs() < 1e-17);
}

/// The sides are free up to edges and corners. The torque is Timoshenko and Goodier's `k1 mu k depth^3 width`
/// as a function of width over depth, for which they print three digits.
#[test]
fn a_turned_bar_has_free_sides_and_its_torque() {
    let elastic = Elastic::new(YOUNG, 0.3).unwrap();
    let twist = 0.1;
    for (depth, width, k1) in [(1.0, 1.0, 0.141), (0.5, 1.0, 0.229), (0.2, 1.0, 0.291)] {
        let bar = Torsion::new(elastic, twist, [depth, width]).unwrap();
        let size = elastic.mu() * twist * depth;
        for s in [-1.0, -0.7, 0.0, 0.4, 1.0] {
            let top = bar.traction(&Point3::new(0.3, 0.5 * depth, 0.5 * s * width), &Vector3::y());
            let side = bar.traction(&Point3::new(0.3, 0.5 * s * depth, -0.5 * width), &-Vector3::z());
            assert!(top.norm() < 1e-13 * size && side.norm() < 1e-13 * size, "{top} {side}");
        }
        // Midpoint sums of `y sigma_xz - z sigma_xy`.
        let n = 200;
        let middle = |k: usize, side: f64| side * ((k as f64 + 0.5) / n as f64 - 0.5);
        let torque: f64 = (0..n * n)
            .map(|q| {
                let p = Point3::new(0.0, middle(q % n, depth), middle(q / n, width));
                let stress = bar.stress(&p);
                p.y * stress[(0, 2)] - p.z * stress[(0, 1)]
            })
            .sum::<f64>()
            * (depth * width)
            / (n * n) as f64;
        let found = torque / (elastic.mu() * twist * depth.powi(3) * width);
        assert!((found - k1).abs() < 6e-4, "{found} for {k1}");
    }
}

#[test]
fn thick_sphere_carries_both_pressures() {
    let inner = 0.02;
    let outer = 0.05;
    let pressures = [3e3, 1e3];
    for poisson in [0.0, 0.3, 0.4999] {
        let exact = ThickSphere::new(Elastic::new(2e4, poisson).unwrap(), [inner, outer], pressures).unwrap();
        let n = Vector3::new(0.48, -0.6, 0.64);
        for (r, pressure) in [(inner, pressures[0]), (outer, pressures[1])] {
            let traction = exact.traction(&Point3::from(r * n), &n);
            assert!((traction + pressure * n).norm() < 1e-12 * pressure, "r = {r}: {traction}");
        }
    }
    // A thin wall has the hoop stress p r / (2 t).
    let thin = ThickSphere::new(Elastic::new(2e4, 0.3).unwrap(), [1.0, 1.001], [1.0, 0.0]).unwrap();
    let hoop = thin.stress(&Point3::new(1.0005, 0.0, 0.0))[(1, 1)];
    assert!((hoop / 500.0 - 1.0).abs() < 2e-3, "hoop {hoop}");
}

#[test]
fn affine_components_go_where_their_names_say() {
    let exact = build(&SAMPLES[0], 0.3);
    let h = exact.gradient(&Point3::origin());
    assert_eq!(h, Matrix3::new(0.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.1));
    assert_eq!(exact.displacement(&Point3::new(0.0, 1.0, 1.0)), Vector3::new(0.2, 0.3, -0.1));
}

#[test]
fn a_rigid_motion_strains_nothing() {
    let sample = SAMPLES.iter().find(|s| s.0 == "rigid").unwrap();
    let exact = build(sample, 0.3);
    assert_eq!(exact.stress(&Point3::new(0.1, 0.2, 0.3)), Matrix3::zeros());
    let values = [("tx", 1.0), ("rz", 0.5)];
    let exact = exact_by_name("rigid", &medium(0.3), &values).unwrap();
    assert_eq!(exact.displacement(&Point3::new(2.0, 4.0, 0.0)), Vector3::new(1.0 - 2.0, 1.0, 0.0));
}

#[test]
fn bad_requests_are_named() {
    let message = |name: &str, poisson: f64, values: &[(&str, f64)]| {
        exact_by_name(name, &medium(poisson), values).map(|_| ()).unwrap_err().to_string()
    };
    let bar = [("load", 1.0), ("length", 5.0), ("depth", 1.0)];
    let with = |extra: (&'static str, f64)| [bar.as_slice(), &[extra]].concat();
    for (text, parts) in [
        (message("thick-spere", 0.3, &[]), ["'thick-spere'", "did you mean 'thick-sphere'"]),
        (message("saint-venant-flexure", 0.3, &bar), ["needs width", "[m]"]),
        (message("saint-venant-flexure", 0.3, &with(("widht", 1.0))), ["'widht'", "did you mean 'width'"]),
        (message("saint-venant-flexure", 0.3, &with(("width", 0.0))), ["width = 0", "above zero"]),
        (message("saint-venant-flexure", 0.3, &with(("width", 60.0))), ["depth = 1", "0.02 of the width"]),
        (message("saint-venant-flexure", 0.3, &with(("width", f64::NAN))), ["NaN", "finite"]),
        (message("thick-sphere", 0.3, &[("inner", 2.0), ("outer", 1.0)]), ["outer = 1", "above the inner"]),
        (message("pure-bending", 0.3, &[]), ["needs curvature", "[1/m]"]),
        (message("cantilever-plane-strain", 0.3, &bar[..2]), ["needs depth", "[m]"]),
        (
            message("bar-wave", 0.3, &[("pull", 1.0), ("length", 1.0), ("density", 0.0)]),
            ["density = 0", "above zero"],
        ),
        (
            message("relaxing-compression", 0.3, &[("strain", 0.1), ("share", 1.0), ("tau", 1.0)]),
            ["share = 1", "below 1"],
        ),
        (message("affine", 0.3, &[("hyx2", 1.0)]), ["'hyx2'", "did you mean 'hyx'"]),
    ] {
        for part in parts {
            assert!(text.contains(part), "'{part}' is not in: {text}");
        }
    }
    assert!(matches!(Elastic::new(-1.0, 0.3), Err(ExactError::Material { what: "young", .. })));
    assert!(matches!(Elastic::new(f64::NAN, 0.3), Err(ExactError::Material { what: "young", .. })));
    assert!(matches!(Elastic::new(1.0, 0.5), Err(ExactError::Material { what: "poisson", .. })));
    assert!(matches!(Elastic::new(1.0, -1.0), Err(ExactError::Material { what: "poisson", .. })));
}
